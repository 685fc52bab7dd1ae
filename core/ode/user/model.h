/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The formulas that follow from a user-defined system before its parameters have values. */
#ifndef GM_CORE_ODE_USER_MODEL_H
#define GM_CORE_ODE_USER_MODEL_H

#include "core/ode/user/formulas.h"

/* Opens the model in the system's arena; the system's graph grows. Returns false when out of memory. */
bool gm_user_model_open(struct gm_user_model *model, struct gm_user_system *system);

/* Reads a system again with these values of its parameters, or its motion without tangents; inside a body of the
   arena, which is left when out of memory. The caller closes it in all cases. */
void gm_user_system_again(struct gm_arena *arena, const struct gm_user_system *system, const double *values,
                          bool without_tangents, struct gm_user_system *again);

/* Returns why no scheme can advance such a system, "" if some can. */
const char *gm_user_model_lacks(const struct gm_user_model *model);

/* Returns true if a fact is known with these values of the system's variables; a fact that was tested, not
   proved, holds for the tested parameters. */
bool gm_user_model_holds(const struct gm_user_model *model, const double *values, enum gm_fact fact);
/* Returns the rates for these values of the system's variables. */
const struct gm_user_rates *gm_user_model_rates(const struct gm_user_model *model, const double *values);
/* Returns true if variational schemes can advance it. */
bool gm_user_model_has_action(const struct gm_user_model *model);
/* Returns true if a force of the file acts on a coordinate. */
bool gm_user_model_is_forced(const struct gm_user_model *model);
/* Returns true if velocity and force split its field, with these values. */
bool gm_user_model_splits(const struct gm_user_model *model, const double *values);
/* Returns why no kernels can be written; NULL: they may be. */
const char *gm_user_model_refuses_kernels(const struct gm_user_model *model);

#endif
