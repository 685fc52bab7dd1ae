/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The row of a partitioned Runge-Kutta method: a and b for q', c and d for p'. */
#ifndef GM_CORE_ODE_FAMILIES_RUNGE_KUTTA_PARTITIONED_H
#define GM_CORE_ODE_FAMILIES_RUNGE_KUTTA_PARTITIONED_H

#include "core/ode/kernel/stages.h"

struct gm_partitioned_row {
    size_t stages;
    double a[GM_TABLEAU_STAGES][GM_TABLEAU_STAGES], c[GM_TABLEAU_STAGES][GM_TABLEAU_STAGES];
    double b[GM_TABLEAU_STAGES], d[GM_TABLEAU_STAGES];
};

#endif
