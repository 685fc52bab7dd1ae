/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The bracket of a Poisson system: its structure, and the pieces of its energy that have exact flows. */
#ifndef GM_CORE_ODE_USER_BRACKET_H
#define GM_CORE_ODE_USER_BRACKET_H

#include "core/model/system.h"
#include "core/ode/families/splitting/linear_flow.h"

/* The formulas of a bracket, derived once for all values of the parameters. */
struct gm_user_bracket_model {
    const struct gm_user_system *system;
    gm_node_id *gradient; /* dH/dy, n; NULL: not a Poisson system, or H holds the time */
    double turning;       /* turning, spins and axes are the fields of struct gm_poisson */
    size_t spins;
    bool axes;
    /* A piece of the energy is a function of components that commute, {y_i, y_j} = 0, and so rest in its flow; the
       others move linearly. */
    struct gm_linear_flow *pieces;
    size_t piece_count; /* 0: the energy does not split into such pieces */
};
/* Derives the formulas; the graph of the system grows. The arena owns them; both open functions leave its
   body when out of memory. */
void gm_user_bracket_model_open(struct gm_arena *arena, struct gm_user_bracket_model *model,
                                struct gm_user_system *system);

/* The tapes of a bracket for given values of parameters; the model outlives it. */
struct gm_user_bracket {
    const struct gm_user_bracket_model *model;
    struct gm_tape energy, gradient, matrix;
    struct gm_tape *pieces; /* rates and slopes of each */
};
void gm_user_bracket_open(struct gm_arena *arena, struct gm_user_bracket *bracket,
                          const struct gm_user_bracket_model *model, const double *values);

/* gm_poisson.flow; NaN where the motion is too fast for its exponential */
void gm_user_bracket_flow(const struct gm_user_bracket *bracket, size_t piece, double h, double *y);

#endif
