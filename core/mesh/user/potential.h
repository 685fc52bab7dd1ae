/* SPDX-License-Identifier: GPL-3.0-or-later */
/* u_tt = u_xx - V'(u) with a potential that somebody wrote, between ends that hold u, on a moving mesh. A potential that
   is recognised (enum gm_known_potential) has exact means over elements. */
#ifndef GM_CORE_MESH_USER_POTENTIAL_H
#define GM_CORE_MESH_USER_POTENTIAL_H

#include "core/mesh/user/formulas.h"

/* The number of Gauss points for the mean of V over an element: exact if V is a polynomial of degree 19 or
   less in u, else 10. */
size_t gm_user_mesh_order(const struct gm_user_wave *wave);

/* The problem with these values of all variables (gm_equations_start). Returns false when out of memory;
   the caller closes it (gm_user_line_close). */
bool gm_user_mesh_open(struct gm_problem *problem, const struct gm_user_wave *wave, const double *values,
                       const struct gm_user_mesh *chosen);

/* The numbers that formulas of its mesh may hold: alpha, steepest and bend, resolved. */
const struct gm_mesh_names *gm_user_mesh_names(const struct gm_problem *problem);

/* Writes the velocities of nodes alone between them, at m places: `at` holds the inputs of `between`,
   [number * m + place]. */
void gm_user_mesh_between(const struct gm_problem *problem, const double *at, double *velocity, size_t m);

/* Returns true if the start is finite and, unless a line ends: holds it there, rests at both ends up to a thousandth of
   its largest rate; else the fault has the reason. */
bool gm_user_mesh_rests(const struct gm_problem *problem, struct gm_fault *fault);

#endif
