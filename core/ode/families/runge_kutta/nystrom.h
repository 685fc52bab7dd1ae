/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The row of a Nystrom method: a and b for positions, bv for velocities, c the times of the stages. */
#ifndef GM_CORE_ODE_FAMILIES_RUNGE_KUTTA_NYSTROM_H
#define GM_CORE_ODE_FAMILIES_RUNGE_KUTTA_NYSTROM_H

enum { GM_NYSTROM_STAGES = 16 };

struct gm_nystrom_row {
    int stages;
    double a[GM_NYSTROM_STAGES][GM_NYSTROM_STAGES];
    double b[GM_NYSTROM_STAGES], bv[GM_NYSTROM_STAGES], c[GM_NYSTROM_STAGES];
};

#endif
