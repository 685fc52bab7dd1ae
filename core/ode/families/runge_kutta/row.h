/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The rows of Runge-Kutta methods. */
#ifndef GM_CORE_ODE_FAMILIES_RUNGE_KUTTA_ROW_H
#define GM_CORE_ODE_FAMILIES_RUNGE_KUTTA_ROW_H

#include "core/ode/families/compositions.h"
#include "core/ode/kernel/stages.h"

/* A Runge-Kutta method, or a composition of an implicit one with itself. */
struct gm_tableau {
    int stages;
    int listed; /* explicit: its number in the list explicit.def, from 1 on; 0: it is not in it */
    double a[GM_TABLEAU_STAGES][GM_TABLEAU_STAGES];
    double b[GM_TABLEAU_STAGES];
    const struct gm_composition *composition; /* implicit; NULL: explicit */
};

/* A partitioned method: a and b for q', c and d for p'. */
struct gm_partitioned_row {
    size_t stages;
    double a[GM_TABLEAU_STAGES][GM_TABLEAU_STAGES], c[GM_TABLEAU_STAGES][GM_TABLEAU_STAGES];
    double b[GM_TABLEAU_STAGES], d[GM_TABLEAU_STAGES];
};

/* A Nystrom method: a and b for positions, bv for velocities, c the times of the stages. */
struct gm_nystrom_row {
    int stages;
    double a[GM_TABLEAU_STAGES][GM_TABLEAU_STAGES];
    double b[GM_TABLEAU_STAGES], bv[GM_TABLEAU_STAGES], c[GM_TABLEAU_STAGES];
};

#endif
