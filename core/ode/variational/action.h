/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The values of a Lagrangian at one state, for every form in which a problem gives it. */
#ifndef GM_CORE_ODE_VARIATIONAL_ACTION_H
#define GM_CORE_ODE_VARIATIONAL_ACTION_H

#include "core/ode/ode.h"

/* Returns true if the problem has a Lagrangian, or H = T(p, t) + V(q, t) with a quadratic T,
   L = p v - H, v = A p + b, p = A^-1 (v - b). */
bool gm_has_action(const struct gm_problem *problem);

/* Returns the number of constraints; 0: none. */
size_t gm_action_constraints(const struct gm_problem *problem);

/* One problem's action, with the scratch of its evaluation. */
struct gm_action_at {
    const struct gm_problem *problem;
    size_t half;
    struct gm_motion motion;
    double *known, *mass, *drift, *state, *field,
        *jacobian; /* for a quadratic T; known: A^-1 and b are computed */
};

/* Returns the scratch size in doubles. The caller fills it with zeros; it stores A^-1 and b between
   evaluations. */
size_t gm_action_room(const struct gm_problem *problem);
struct gm_action_at gm_action_lay(const struct gm_problem *problem, double *scratch);

/* Fills action->motion at `at`: q, v and, if the state has it, t. Returns false if A is singular. */
bool gm_action_evaluate(const struct gm_action_at *action, const double *at);

#endif
