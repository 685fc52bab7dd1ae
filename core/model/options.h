/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_MODEL_OPTIONS_H
#define GM_CORE_MODEL_OPTIONS_H

#include "core/model/scope.h"

/* Adds a node, or the nodes of formulas separated by commas, to an item. */
void gm_item_add(struct gm_reading *reading, struct gm_system_item *item, gm_node_id node);
void gm_item_add_formulas(struct gm_reading *reading, struct gm_system_item *item, struct gm_span rest);

/* Reads options, separated by semicolons, into the item of their line. */
void gm_options_read(struct gm_reading *reading, struct gm_system_item *item, struct gm_span rest);

/* Reads a text with {FORMULA}, {FORMULA:pi} and the like into an item. The formulas become its nodes, in
   order; GM_NO_NODE stands for a key of the scene that the system does not define ({dt}, {schemes}). */
void gm_text_read(struct gm_reading *reading, struct gm_system_item *item, struct gm_span span);

#endif
