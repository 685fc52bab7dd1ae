/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The equations of motion of a system, and whether what its file says of it is so. */
#ifndef GM_CORE_MODEL_EQUATIONS_H
#define GM_CORE_MODEL_EQUATIONS_H

#include "core/model/system.h"

/* Derives the equations of a system that was read (gm_system_read), and checks Jacobi's identity, Casimirs,
   invariants, symmetries, whose momentum maps are appended, and the start: constraints, the Legendre transform,
   what is not finite. False with a fault, whose sentence is empty where memory was refused. */
bool gm_equations_derive(struct gm_user_system *system, struct gm_fault *fault);
/* Reads a system and derives its equations. To be closed, by gm_system_close, in both cases. */
bool gm_equations_open(struct gm_user_system *system, const char *text, size_t length,
                       const struct gm_system_value *values, size_t count, struct gm_fault *fault);

/* Values for all variables at the start, t = 0: parameters, and components as `start` says; a Lagrangian's
   momenta of its velocities, where these are given. `given`, of all variables, has what takes the place of
   that, NaN where nothing does; NULL: nowhere. What needs itself is NaN. malloc'ed; NULL where memory is
   short. */
double *gm_equations_start(const struct gm_user_system *system, const double *given);
/* Of a Lagrangian: whether momenta determine velocities at these values of all variables (gm_equations_start),
   which it leaves as they are. False with a fault, whose sentence is untouched where memory was refused. */
bool gm_equations_check_legendre(const struct gm_user_system *system, double *start, struct gm_fault *fault);

/* The field of an evolution that a mass is of; system->n where it is of none, or of several, or memory was
   refused. */
size_t gm_system_mass_field(const struct gm_user_system *system, gm_node_id node);
/* Splits what a rate or a mass of an evolution is: gm_linear_part in the fields and their derivatives. */
bool gm_system_linear_part(struct gm_user_system *system, gm_node_id node, gm_node_id *line,
                           gm_node_id *rest);

/* The rate of change of a node along the motion; GM_NO_NODE where it is not known (of a Lagrangian, or with a
   constraint) or memory was refused. */
gm_node_id gm_equations_rate_of(struct gm_user_system *system, gm_node_id node);
/* Of a Lagrangian: dL/dv takes the place of the momenta in nodes. False where memory was refused. */
bool gm_equations_in_velocities(struct gm_user_system *system, gm_node_id *nodes, size_t count);
/* Whether a node is 0 whatever the state: parameters have any value, or else the system's own. */
enum gm_identity gm_equations_vanishes(const struct gm_user_system *system, gm_node_id node);

#endif
