/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The matrices of a flow's equations: of transport, and of Poisson's equation between the unknowns psi. */
#ifndef GM_CORE_FLOW_MATRICES_H
#define GM_CORE_FLOW_MATRICES_H

#include "core/arena.h"
#include "core/flow/flow.h"
#include "core/linear/cholesky.h"

/* The matrix
       shift star0 + share [-d0' diag(F) A + diag(boundary) + diffusion K],
   vertices by vertices, in the pattern of the complex' rings. */
struct gm_transport {
    const struct gm_complex *complex;
    double *diagonal; /* vertices */
    double *pivot;    /* vertices: of gm_transport_factor */
    double *ring;     /* 2 * edges: row v in ring_start[v] .. ring_start[v + 1] */
};

/* The diagonal of boundary cells, q = d0' F being the flux out of the domain. */
enum gm_backflow {
    GM_BACKFLOW_ZERO, /* max(q, 0): what flows back in brings 0 with it */
    GM_BACKFLOW_OWN,  /* q: it brings the boundary's own value */
};

/* A matrix that is not assembled yet, in a body of the arena. */
struct gm_transport gm_transport_of(struct gm_arena *arena, const struct gm_complex *complex);

void gm_transport_assemble(struct gm_transport *transport, const double *flux, double shift, double share,
                           double diffusion, enum gm_backflow backflow);

/* y = matrix x */
void gm_transport_apply(const struct gm_transport *transport, const double *x, double *y);

/* The pivots D of (D + L) D^-1 (D + U), whose diagonal is the matrix', L and U being the matrix below and
   above it, without the rows and columns that are fixed (DILU: Barrett et al., Templates for the solution of
   linear systems (1994), 3.4); then x of (D + L) D^-1 (D + U) x = r, 0 where fixed. */
void gm_transport_factor(struct gm_transport *transport, const bool *fixed);
void gm_transport_precondition(const struct gm_transport *transport, const double *r, double *x);

/* Solves the rows that are not fixed for x there, to round-off: by BiCGStab with that preconditioner (van
   der Vorst, SIAM J. Sci. Stat. Comput. 13 (1992) 631), repeated on the residual; by LU if that fails. x:
   first guess, with the fixed values in place. scratch: 8 * vertices. Adds to *iterations. */
bool gm_transport_solve(struct gm_transport *transport, const bool *fixed, const double *right, double *x,
                        double *scratch, unsigned long *iterations);
/* Solves the same rows with LU, for steady states. */
bool gm_transport_solve_directly(const struct gm_transport *transport, const bool *fixed, const double *right,
                                 double *x);

/* The unknowns: psi, then omega of vertices without a formula, then temperature, of steady states. E takes them to
   vertices. All vertices of a hole's wall share one psi, after all others. On a closed surface psi is determined up
   to a constant: vertex 0 is pinned and the mean is subtracted afterwards. */
struct gm_unknowns {
    size_t count, flow, all; /* psi; with omega; with temperature */
    int *start;              /* [all + 1], index of an unknown's first vertex */
    int *vertex;             /* vertices of the unknowns */
    int *index;              /* unknown psi of a vertex; -1: psi is given */
    int *soft, *warm;        /* unknown omega and temperature of a vertex; -1: none */
    bool closed;
};

/* The unknowns of a flow, in a body of the arena. */
struct gm_unknowns gm_unknowns_of(struct gm_arena *arena, const struct gm_flow *flow);

/* into[i] = the sum of values over the vertices of unknown i, psi or omega: E' values */
void gm_unknowns_gather(const struct gm_unknowns *unknowns, const double *values, double *into);

/* The factor of shift K between unknowns, E' K E; of a rough one shift K + viscosity K W K, W = 1 / star0
   where omega is by the formula. Returns NULL when out of memory, or if it is not positive definite. */
struct gm_cholesky *gm_unknowns_factor(const struct gm_unknowns *unknowns, const struct gm_flow *flow,
                                       enum gm_cholesky_precision precision, double shift, double viscosity);

/* Solves E' K psi = E' right (NULL: 0) for the unknown values of psi, the others being given in psi. b: scratch,
   two numbers for each unknown. On a closed surface sum star0 psi = 0 afterwards. */
void gm_unknowns_solve_poisson(const struct gm_unknowns *unknowns, const struct gm_flow *flow,
                               struct gm_cholesky *factor, const double *right, double *b, double *psi);

#endif
