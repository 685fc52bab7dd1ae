/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The row of a Runge-Kutta method, which the loops of explicit and of implicit ones share. */
#ifndef GM_CORE_ODE_FAMILIES_RUNGE_KUTTA_ROW_H
#define GM_CORE_ODE_FAMILIES_RUNGE_KUTTA_ROW_H

#include "core/ode/families/compositions.h"
#include "core/ode/kernel/stages.h"

/* The largest number of stages with an implicit loop compiled for it. */
enum { GM_IMPLICIT_KNOWN_STAGES = 4 };

/* A Runge-Kutta method, or a composition of an implicit one with itself. */
struct gm_tableau {
    int stages;
    int listed; /* explicit: its number in the list explicit.def, from 1 on; 0: it is not in it */
    double a[GM_TABLEAU_STAGES][GM_TABLEAU_STAGES];
    double b[GM_TABLEAU_STAGES];
    const struct gm_composition *composition; /* implicit; NULL: explicit */
};

#endif
