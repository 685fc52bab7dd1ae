/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_FLOW_SOLVER_H
#define GM_CORE_FLOW_SOLVER_H

#include "core/flow/matrices.h"
#include "core/linear/gmres.h"

/* The workspace of steps: index sets, matrices, factors, scratch, all derived from the flow and the time
   step. */
struct gm_flow_solver {
    struct gm_arena *arena;     /* holds the solver and all but the factors */
    const struct gm_flow *flow; /* `now` if its boundary changes in time */
    struct gm_flow *now;        /* flow at the time of gm_flow_solver_give; NULL: constant */
    struct gm_unknowns unknowns;
    bool vorticity_form;
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
    double *b, *x;                       /* all unknowns */
    double *small_b;                     /* unknowns of the flow, scratch of the preconditioner */
    double *gmres, *bicgstab;
};

/* Open and close the workspace of a family, a solver. */
void *gm_flow_solver_open(const struct gm_problem *problem, const struct gm_scheme *scheme);
void gm_flow_solver_close(void *workspace);

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
