/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The parts of a user-defined system that have names: its lines `part:` and `let:`, and those of its structure. */
#ifndef GM_CORE_ODE_USER_PARTS_H
#define GM_CORE_ODE_USER_PARTS_H

#include "core/ode/ode.h"
#include "core/ode/user/model.h"

/* Fills the facet's names, or returns false: no part has a name. The arena's body is left when out of memory. */
bool gm_user_parts_open(struct gm_arena *arena, const struct gm_user_model *model, const double *values,
                        struct gm_parts *parts);

/* The functions of struct gm_parts, with these values of the system's variables. */
bool gm_user_part_rates(const struct gm_user_model *model, const double *values, const char *name,
                        struct gm_formula *graph, gm_node_id *rates);
const char *gm_user_parts_differ(const struct gm_user_model *model, const double *values,
                                 const char *const *names, size_t count, struct gm_arena *arena);

#endif
