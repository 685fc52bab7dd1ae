/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_MODEL_DECLARATIONS_H
#define GM_CORE_MODEL_DECLARATIONS_H

#include "core/model/scope.h"

/* What a system declares, in this order: each needs what came before. */

/* What kind of a system the lines make, and that every line is one of it. */
bool gm_declared_kind(struct gm_reading *reading);
bool gm_declared_parameters(struct gm_reading *reading);
/* Components, velocities and the time; the variables then stand as struct gm_system_variable says. */
bool gm_declared_state(struct gm_reading *reading);
/* How parameters follow from others, now that these have their numbers. */
bool gm_declared_relations(struct gm_reading *reading);
/* And observables, but for those of a list. */
bool gm_declared_lets(struct gm_reading *reading);

#endif
