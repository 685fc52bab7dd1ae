/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_MESH_SOLVER_H
#define GM_CORE_MESH_SOLVER_H

#include "core/linear/banded.h"
#include "core/problem.h"

/* The non-linear equations of one step, shared by the families on meshes: `per_node` unknowns at every node,
   node by node, so that matrices are banded.

   The LU factors are kept over iterations and steps until they converge too slowly. They are derived data:
   what they were made from (a state and unknowns) is part of the scheme's memory, so a run that is resumed
   makes the same factors again and goes on with the same bits. First guesses are extrapolated from the last
   six steps. */

struct gm_step_equations {
    void *self;
    size_t nodes, per_node, state; /* state: numbers of the canonical state */
    double noise;                  /* change of the unknowns that round-off alone makes */
    const double *weights;         /* per_node, of a change of an unknown in the test of convergence */
    double step;
    /* takes the state that a step of this length starts from */
    void (*place)(void *self, const double *state, double step);
    /* the unknowns of a scheme that has no past */
    void (*guess)(void *self, double *unknowns);
    /* false: a cell is not positive */
    bool (*residual)(void *self, const double *unknowns, double *residual);
    /* adds the derivative of the residual, at the unknowns of the last call of it, to a zero matrix */
    void (*jacobian)(void *self, const double *unknowns, struct gm_banded *matrix);
};

struct gm_solver {
    struct gm_banded matrix;
    double stamp; /* of the factors it holds; 0: none */
    double *unknowns, *residual, *trial;
};

/* Where things are in a scheme's memory. */
enum {
    GM_MEMORY_PAST,       /* how many steps are remembered, at most 6 */
    GM_MEMORY_STAMP,      /* factorisations so far: a name for the present factors */
    GM_MEMORY_SLOW,       /* 1: the last step converged slowly, so the factors are made again */
    GM_MEMORY_MULTIPLIER, /* largest multiplier of the last step */
    GM_MEMORY_STEP,       /* length of the step that the factors were made for */
    GM_MEMORY_HEAD,       /* then 6 past unknowns, newest first, then state and unknowns of the factors */
};

size_t gm_solver_memory(size_t nodes, size_t per_node, size_t state);
bool gm_solver_open(struct gm_solver *solver, size_t nodes, size_t per_node, size_t band);
void gm_solver_close(struct gm_solver *solver);

/* A memory without a past. */
void gm_solver_start(struct gm_solver *solver, double *memory);

/* Solves for the step from `state`; leaves the unknowns in solver->unknowns, the residual's by-products
   there, and remembers. Counts into progress. */
enum gm_status gm_solver_solve(struct gm_solver *solver, const struct gm_step_equations *equations,
                               double *memory, const double *state, struct gm_progress *progress);

#endif
