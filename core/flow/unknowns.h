/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_FLOW_UNKNOWNS_H
#define GM_CORE_FLOW_UNKNOWNS_H

#include "core/arena.h"
#include "core/flow/flow.h"
#include "core/linear/cholesky.h"

/* The unknowns psi: E takes unknowns to vertices. All vertices of a hole's wall share one, after all
   others. On a closed surface psi is determined up to a constant: vertex 0 is pinned and the mean is
   subtracted afterwards. */
struct gm_unknowns {
    size_t count;
    int *start;  /* [count + 1], index of an unknown's first vertex */
    int *vertex; /* vertices of the unknowns */
    int *index;  /* unknown of a vertex; -1: psi is given */
    bool closed;
};

/* The unknowns of a flow, in a body of the arena. */
struct gm_unknowns gm_unknowns_of(struct gm_arena *arena, const struct gm_flow *flow);

/* into[i] = the sum of values over the vertices of unknown i: E' values */
void gm_unknowns_gather(const struct gm_unknowns *unknowns, const double *values, double *into);

/* The factor of shift K between unknowns, E' K E; of a rough one shift K + viscosity K W K, W = 1 / star0
   where omega is by the formula. Returns NULL when out of memory, or if it is not positive definite. */
struct gm_cholesky *gm_unknowns_factor(const struct gm_unknowns *unknowns, const struct gm_flow *flow,
                                       enum gm_cholesky_precision precision, double shift, double viscosity);

/* Solves E' K psi = E' right (NULL: 0) for the unknown values of psi, the others being given in psi. b, x:
   scratch, a number for each unknown. On a closed surface sum star0 psi = 0 afterwards. */
void gm_unknowns_solve_poisson(const struct gm_unknowns *unknowns, const struct gm_flow *flow,
                               struct gm_cholesky *factor, const double *right, double *b, double *x,
                               double *psi);

#endif
