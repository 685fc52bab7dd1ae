/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The equations of motion of a system, and the checks of its file's claims. */
#ifndef GM_CORE_MODEL_EQUATIONS_H
#define GM_CORE_MODEL_EQUATIONS_H

#include "core/model/system.h"

/* Derives the equations of a system read by gm_system_read, and checks Jacobi's identity, Casimirs,
   invariants, symmetries, whose momentum maps are appended, and the start: constraints, the Legendre
   transform, values that are not finite. False with a fault, whose sentence is empty when out of memory. */
bool gm_equations_derive(struct gm_user_system *system, struct gm_fault *fault);
/* Reads a system and derives its equations. The caller closes it with gm_system_close in both cases. */
bool gm_equations_open(struct gm_user_system *system, const char *text, size_t length,
                       const struct gm_system_value *values, size_t count, struct gm_fault *fault);

/* Returns values of all variables at the start, t = 0: parameters, and components with their `start`; momenta
   of a Lagrangian follow from velocities if these are given. `given` has a value per variable that replaces
   the file's, or NaN; NULL: none. A start that depends on itself is NaN. The caller frees; NULL when out of
   memory. */
double *gm_equations_start(const struct gm_user_system *system, const double *given);
/* True if momenta of a Lagrangian, or the form of theta, determine velocities at these values of all variables
   (gm_equations_start), which stay unchanged; or if the system has neither. False with a fault, whose sentence is
   untouched when out of memory. */
bool gm_equations_check_velocities(const struct gm_user_system *system, double *start,
                                   struct gm_fault *fault);

/* The field of a mass of an evolution; system->n if it has none or several, or when out of memory. */
size_t gm_system_mass_field(const struct gm_user_system *system, gm_node_id node);
/* Splits a rate or a mass of an evolution: gm_linear_part in the fields and their derivatives. */
bool gm_system_linear_part(struct gm_user_system *system, gm_node_id node, gm_node_id *line,
                           gm_node_id *rest);

/* The derivatives of a node over all variables, 0 for those that are not marked; `marked` is NULL: all are. Inside a
   body of the system's arena. */
gm_node_id *gm_equations_gradient(struct gm_user_system *system, gm_node_id node, const bool *marked);
/* The values of all nodes for these variables. Inside a body of the system's arena. */
double *gm_equations_values(const struct gm_user_system *system, const double *variables);
/* Replaces the momenta of a Lagrangian in nodes by dL/dv. False when out of memory. */
bool gm_equations_in_velocities(struct gm_user_system *system, gm_node_id *nodes, size_t count);
/* The values of parameters; NaN for other variables. The caller frees; NULL when out of memory. */
double *gm_equations_fixed(const struct gm_user_system *system);
/* Tests if a node is 0 for all states: for all parameters, or else for the system's own. */
enum gm_identity gm_equations_vanishes(const struct gm_user_system *system, gm_node_id node);

#endif
