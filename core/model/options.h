/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_MODEL_OPTIONS_H
#define GM_CORE_MODEL_OPTIONS_H

#include "core/model/scope.h"

/* Reads options, which semicolons separate, into the item of their line. */
bool gm_options_read(struct gm_reading *reading, struct gm_system_item *item, struct gm_span rest);

/* Reads a text with {FORMULA}, {FORMULA:pi} and the like into an item: the formulas become its nodes, in their order,
   GM_NO_NODE for a key of the scene that is no name of the system ({dt}, {schemes}). */
bool gm_text_read(struct gm_reading *reading, struct gm_system_item *item, struct gm_span span);

#endif
