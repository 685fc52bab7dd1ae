/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_FLOW_SOLVER_H
#define GM_CORE_FLOW_SOLVER_H

#include "core/arena.h"
#include "core/flow/flow.h"
#include "core/linear/cholesky.h"
#include "core/linear/gmres.h"

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

/* The workspace of steps: index sets, matrices, factors, scratch, all derived from the flow and the time
   step. */
struct gm_flow_solver {
    struct gm_arena *arena;     /* holds the solver and all but the factors */
    const struct gm_flow *flow; /* `now` if its boundary changes in time */
    struct gm_flow *now;        /* flow at the time of gm_flow_solver_give; NULL: constant */
    struct gm_unknowns unknowns;
    bool vorticity_form;
    size_t soft;                   /* vertices whose omega is an unknown of its own */
    int *soft_vertex, *soft_index; /* these, and the column of a vertex; -1: it has none */
    size_t warm;                   /* vertices whose temperature is an unknown, of steady states */
    int *warm_vertex, *warm_index;
    bool *held; /* vertices whose omega has no equation of its own */
    struct gm_cholesky *poisson;
    double energy_limit;     /* largest energy that these boundaries can drive; set with the factors */
    double shift, viscosity; /* arguments of the factor `stokes` */
    struct gm_cholesky *stokes;
    unsigned long factor_solves;         /* systems solved with poisson and stokes in steps, so far */
    struct gm_transport transport, heat; /* heat: of temperature in steady states */
    struct gm_transport convection;      /* the preconditioner's part of transport, as a matrix */
    struct gm_transport carried;         /* transport of the scalar, concurrent with the flow's step */
    double *flux, *centre;               /* edges, triangles */
    double *rate, *field, *velocities;   /* vertices, vertices, 3 * vertices */
    double *carried_rate;                /* vertices */
    double *b, *x;                       /* unknowns, soft and warm vertices */
    double *small_b;                     /* unknowns, scratch of the preconditioner */
    double *gmres, *bicgstab;
};

struct gm_flow_solver *gm_flow_solver_open(const struct gm_flow *flow);
void gm_flow_solver_close(struct gm_flow_solver *solver);

/* Sets the boundary values to those at the time t. Returns false if they are not valid (struct gm_flow,
   give). */
bool gm_flow_solver_give(struct gm_flow_solver *solver, double t);

/* Makes the factors of K_II and, if psi is stepped, of shift K_II + viscosity K_I W K_I (solver.c);
   existing ones are reused. Returns false if one is not positive definite, or when out of memory. */
bool gm_flow_solver_factor(struct gm_flow_solver *solver, double shift, double viscosity);

/* The unknowns (psi, then omega of soft vertices) of the correction that takes the residual solver->b to
   0, for the matrix in solver->transport: into solver->x. With GMRES, or with LU if that fails. `size`:
   the scale of residuals. */
bool gm_flow_solver_correct(struct gm_flow_solver *solver, double size, unsigned long *iterations);

/* Newton's correction of a steady state, into solver->x: includes the derivative of the fluxes, with LU.
   omega, temperature (NULL without heat): of the state. The corrections of temperature follow the others;
   their matrix is solver->heat, and their residual is made here. */
bool gm_flow_solver_newton(struct gm_flow_solver *solver, const double *omega, const double *temperature);

#endif
