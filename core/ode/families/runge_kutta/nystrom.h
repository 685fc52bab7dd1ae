/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The row of a Nystrom method: a and b for positions, bv for velocities, c the times of the stages. */
#ifndef GM_CORE_ODE_FAMILIES_RUNGE_KUTTA_NYSTROM_H
#define GM_CORE_ODE_FAMILIES_RUNGE_KUTTA_NYSTROM_H

#include "core/ode/kernel/stages.h"

struct gm_nystrom_row {
    int stages;
    double a[GM_TABLEAU_STAGES][GM_TABLEAU_STAGES];
    double b[GM_TABLEAU_STAGES], bv[GM_TABLEAU_STAGES], c[GM_TABLEAU_STAGES];
};

#endif
