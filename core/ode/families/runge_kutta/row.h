/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The row of an implicit Runge-Kutta method, which its loops over kernels, over nodes and over waves share. */
#ifndef GM_CORE_ODE_FAMILIES_RUNGE_KUTTA_ROW_H
#define GM_CORE_ODE_FAMILIES_RUNGE_KUTTA_ROW_H

#include "core/ode/families/compositions.h"
#include "core/ode/kernel/stages.h"

/* The largest number of stages with a loop compiled for it, and the largest at all. */
enum { GM_IMPLICIT_KNOWN_STAGES = 4, GM_IMPLICIT_STAGES = GM_TABLEAU_STAGES };

/* An implicit Runge-Kutta method, or a composition of one with itself. */
struct gm_implicit_row {
    int stages;
    double a[GM_IMPLICIT_STAGES][GM_IMPLICIT_STAGES];
    double b[GM_IMPLICIT_STAGES];
    const struct gm_composition *composition;
};

#endif
