/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_ODE_HAMILTONIAN_H
#define GM_CORE_ODE_HAMILTONIAN_H

#include "core/ode/ode.h"

/* Reads the formula of a Hamiltonian in the problem's components, with the names of struct gm_ode; lists,
   "x[]", by their number from 1. It is gm_hamiltonian.formula of a problem whose energy is computed by hand.
   */
bool gm_hamiltonian_read(const struct gm_problem *problem, const char *text, struct gm_formula *graph,
                         gm_node_id *energy);

#endif
