/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Fields u, v .. on a ring whose rates somebody wrote,
       (M u)_t = R(x, u, u_x, u_xx, u_xxx, u_xxxx, v, ..),
   as a system of ordinary differential equations: u of all nodes, then v. Derivatives are central differences
   of order 2, or those of the sum of waves through the nodes. */
#ifndef GM_CORE_ODE_USER_EVOLUTION_H
#define GM_CORE_ODE_USER_EVOLUTION_H

#include "core/ode/ode.h"
#include "core/user/line.h"

enum gm_derivatives { GM_SPACE_DIFFERENCES, GM_SPACE_FOURIER };

/* The formulas of the rates, in the graph of the system. They have new variables: derivative k of field i of
   n fields is number k n + i, then come x and t, then the parameters. */
struct gm_user_evolution {
    const struct gm_user_system *system;
    gm_node_id rates[GM_MOST_FIELDS]; /* R = line + rest */
    gm_node_id lines[GM_MOST_FIELDS]; /* the parts of R that are linear with constant coefficients */
    gm_node_id rests[GM_MOST_FIELDS];
    gm_node_id linear[GM_MOST_FIELDS]; /* the lines, in the system's own variables */
    gm_node_id masses[GM_MOST_FIELDS]; /* M u */
    struct gm_line_formulas formulas;
    gm_node_id *densities; /* one of each invariant or observed item, in their order */
    size_t density_count;
    gm_node_id kink; /* the term of a rate, in fields and derivatives, that is not smooth; GM_NO_NODE: none */
    size_t kinked;   /* the number of that rate */
};

/* Derives the formulas; the system's graph and arena grow. Returns false when out of memory. */
bool gm_user_evolution_derive(struct gm_user_evolution *evolution, struct gm_user_system *system);

/* Opens the problem with these values of all variables (gm_equations_start) on this ring. Returns false when
   out of memory. The caller closes it (gm_user_line_close). */
bool gm_user_evolution_open(struct gm_problem *problem, const struct gm_user_evolution *evolution,
                            const double *values, const struct gm_grid1 *grid, enum gm_derivatives space);

/* Returns true if the start is finite and closes (as fields of core/field/user/potential.h do), the rates are
   finite there, and no wave's mass vanishes; with walls each field or its negative must have the mirrored
   rate. Otherwise the fault has the reason. */
bool gm_user_evolution_closes(const struct gm_problem *problem, struct gm_fault *fault);

/* Writes the state at t = 0. */
void gm_user_evolution_start(const struct gm_problem *problem, double *y);

/* Returns the integral of a density, or of its magnitude. */
double gm_user_evolution_integral(const struct gm_problem *problem, size_t density, bool magnitude,
                                  const double *y);

#endif
