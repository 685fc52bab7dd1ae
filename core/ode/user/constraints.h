/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The constraints of a system, g(q) = 0, with their exact derivatives. */
#ifndef GM_CORE_ODE_USER_CONSTRAINTS_H
#define GM_CORE_ODE_USER_CONSTRAINTS_H

#include "core/model/system.h"
#include "core/tape.h"

/* The formulas of the constraints, derived once for all values of the parameters. */
struct gm_user_constraints_model {
    const struct gm_formula *graph;
    size_t half, count;
    gm_node_id *nodes;       /* g, the slopes, and the slopes of these */
    struct gm_sparse slopes; /* dg[row] / dq */
    struct gm_sparse second; /* the slopes' derivatives over q: row is an entry of slopes */
};
/* Derives the formulas; the graph of the system grows, and `count` is 0 without constraints. The arena owns
   them; both open functions leave its body when out of memory. */
void gm_user_constraints_model_open(struct gm_arena *arena, struct gm_user_constraints_model *model,
                                    struct gm_user_system *system);

/* The tape of the constraints for given values of parameters; the model outlives it. */
struct gm_user_constraints {
    const struct gm_user_constraints_model *model;
    struct gm_tape tape;
};
void gm_user_constraints_open(struct gm_arena *arena, struct gm_user_constraints *constraints,
                              const struct gm_user_constraints_model *model, const double *values);

/* gm_action.constrain; NaN when out of memory, which is noted */
void gm_user_constraints_values(const struct gm_user_constraints *constraints, const double *q,
                                const double *multipliers, double *g, double *slopes, double *curvature);

#endif
