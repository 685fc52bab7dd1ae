/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Constants of a user-defined system, by name. */
#ifndef GM_CORE_ODE_USER_CONSERVED_H
#define GM_CORE_ODE_USER_CONSERVED_H

#include "core/ode/user/model.h"

/* gm_ode.conserved, for these values of the system's variables. */
gm_node_id gm_user_conserved(const struct gm_user_model *model, const double *values, const char *name,
                             struct gm_formula *graph, char lacks[GM_FAULT_SENTENCE]);

#endif
