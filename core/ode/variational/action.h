/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a Lagrangian says at one state, whichever way the problem gives it. */
#ifndef GM_CORE_ODE_VARIATIONAL_ACTION_H
#define GM_CORE_ODE_VARIATIONAL_ACTION_H

#include "core/ode/ode.h"

/* Whether the problem has a Lagrangian: its own, or that of H = T(p) + V(q) with a quadratic T,
       L = p v - H,  v = A p + b,  p = A^-1 (v - b). */
bool gm_has_action(const struct gm_problem *problem);

/* So many constraints hold it; 0: none. */
size_t gm_action_constraints(const struct gm_problem *problem);

/* One problem's action, with all the room that its evaluation takes. */
struct gm_action_at {
    const struct gm_problem *problem;
    size_t half;
    struct gm_motion motion;
    double *known, *mass, *drift, *state, *field,
        *jacobian; /* of a quadratic T: whether A^-1 and b are known */
};

/* Doubles of room, which begins as zeros and keeps A^-1 and b from one evaluation to the next. */
size_t gm_action_room(const struct gm_problem *problem);
struct gm_action_at gm_action_lay(const struct gm_problem *problem, double *scratch);

/* Fills action->motion at `at`: q, v and, where the state has it, t. False where A is singular. */
bool gm_action_evaluate(const struct gm_action_at *action, const double *at);

#endif
