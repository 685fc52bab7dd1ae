/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_FLOW_SOLVER_H
#define GM_CORE_FLOW_SOLVER_H

#include "core/flow/transport.h"
#include "core/flow/unknowns.h"
#include "core/linear/gmres.h"

/* What steps of a flow need besides the state: index sets, matrices, factors, scratch. All derived from the
   flow and the time step. */
struct gm_flow_solver {
    const struct gm_flow *flow; /* where its boundary changes in time: `now` */
    struct gm_flow *now; /* what it gives at the time of `gm_flow_solver_give`; NULL: nothing changes */
    struct gm_unknowns unknowns;
    bool vorticity_form;
    size_t soft; /* vertices whose omega is an unknown of its own */
    int *soft_vertex;
    size_t warm; /* vertices whose temperature is an unknown, of steady states */
    int *warm_vertex;
    bool *held; /* vertices whose omega has no equation of its own */
    struct gm_cholesky *poisson;
    double energy_limit;     /* no flow that these boundaries drive has more; set with the factors */
    double shift, viscosity; /* that stokes was made for */
    struct gm_cholesky *stokes;
    unsigned long factor_solves;         /* systems solved with poisson and stokes in steps, so far */
    struct gm_transport transport, heat; /* the latter of temperature in steady states */
    struct gm_transport convection;      /* what the preconditioner takes of transport, as a matrix */
    struct gm_transport carried;         /* of the scalar, which is carried while the flow moves on */
    double *numbers;                     /* the memory of all that follows */
    double *flux, *centre;               /* edges, triangles */
    double *rate, *field, *velocities;   /* vertices, vertices, 3 * vertices */
    double *carried_rate;                /* vertices */
    double *b, *x;                       /* unknowns, soft and warm vertices */
    double *small_b;                     /* unknowns, scratch of the preconditioner */
    double *gmres, *bicgstab;
};

struct gm_flow_solver *gm_flow_solver_open(const struct gm_flow *flow);
void gm_flow_solver_close(struct gm_flow_solver *solver);

/* Has the boundary give what it does at the time t. False where that is none (struct gm_flow, give). */
bool gm_flow_solver_give(struct gm_flow_solver *solver, double t);

/* Makes the factors of K_II and, where steps are made for psi, of shift K_II + viscosity K_I W K_I (solver.c);
   nothing to do if they are there. False if one is not positive definite or memory is short. */
bool gm_flow_solver_factor(struct gm_flow_solver *solver, double shift, double viscosity);

/* The unknowns (psi, then omega of soft vertices) of the correction that takes the residual solver->b to 0,
   for the matrix in solver->transport: into solver->x. By GMRES; by LU where that fails. `size`: what
   residuals are compared with. */
bool gm_flow_solver_correct(struct gm_flow_solver *solver, double size, unsigned long *iterations);

/* Newton's correction of a steady state: the same with the derivative of the fluxes, by LU. omega,
   temperature (NULL without heat): of the state. With heat the corrections of temperature stand behind the
   others in solver->x; its matrix is solver->heat, and its residual is made here. */
bool gm_flow_solver_newton(struct gm_flow_solver *solver, const double *omega, const double *temperature);

#endif
