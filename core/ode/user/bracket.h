/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The bracket of a Poisson system: its structure, and the pieces of its energy that have exact flows. */
#ifndef GM_CORE_ODE_USER_BRACKET_H
#define GM_CORE_ODE_USER_BRACKET_H

#include "core/model/system.h"
#include "core/ode/families/splitting/linear_flow.h"
#include "core/ode/ode.h"

/* The formulas of a bracket, derived once for all values of the parameters. */
struct gm_user_bracket_model {
    gm_node_id *gradient;    /* dH/dy, n; NULL: not a Poisson system, or H holds the time */
    struct gm_poisson facet; /* but for the moments of inertia */
    /* A piece of the energy is a function of components that commute, {y_i, y_j} = 0, and so rest in its flow; the
       others move linearly. */
    struct gm_linear_flow *pieces;
};
/* Derives the formulas; the graph of the system grows. The arena owns them; both open functions leave its
   body when out of memory. */
void gm_user_bracket_model_open(struct gm_arena *arena, struct gm_user_bracket_model *model,
                                struct gm_user_system *system);

/* Opens the facet of schemes for brackets, whose flow is NaN where the motion is too fast for its exponential. */
void gm_user_bracket_open(const struct gm_problem *problem);

#endif
