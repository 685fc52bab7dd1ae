/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The constraints of a system, g(q) = 0, with their exact derivatives. */
#ifndef GM_CORE_ODE_USER_CONSTRAINTS_H
#define GM_CORE_ODE_USER_CONSTRAINTS_H

#include "core/model/system.h"
#include "core/tape.h"

/* What follows from them once. */
struct gm_user_constraints_model {
    const struct gm_formula *graph;
    size_t half, count;
    gm_node_id *nodes;       /* g */
    struct gm_sparse slopes; /* dg[row] / dq */
    struct gm_sparse second; /* of the slopes: row is one of their entries */
};
/* The graph of the system grows; without constraints `count` is 0. False: out of memory. To be closed in both
   cases. */
bool gm_user_constraints_model_open(struct gm_user_constraints_model *model, struct gm_user_system *system);
void gm_user_constraints_model_close(struct gm_user_constraints_model *model);

/* The same with the values of parameters; the model outlives it. */
struct gm_user_constraints {
    const struct gm_user_constraints_model *model;
    struct gm_tape tape;
};
bool gm_user_constraints_open(struct gm_user_constraints *constraints,
                              const struct gm_user_constraints_model *model, const double *values);
void gm_user_constraints_close(struct gm_user_constraints *constraints);

/* gm_action.constrain; NaN where memory is short, which is noted */
void gm_user_constraints_values(const struct gm_user_constraints *constraints, const double *q,
                                const double *multipliers, double *g, double *slopes, double *curvature);

#endif
