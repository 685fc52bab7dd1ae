/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Texts of a system's file with values in them: {x}, {dt:pi}, {schemes}. */
#ifndef GM_SCENES_COMMON_SYSTEM_TEXTS_H
#define GM_SCENES_COMMON_SYSTEM_TEXTS_H

#include "scenes/common/graph.h"
#include "scenes/common/system/look.h"

/* Opens the tapes of texts, requirements and levels. */
void gm_system_open_items(struct gm_system_scene *system_scene);

/* Returns the text of a line in a picture of lanes; `otherwise` if the file has no such line. Parts of a
   subtitle, between semicolons, are left out if they differ between lanes. */
const char *gm_system_shown_text(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                                 enum gm_system_word word, const char *otherwise);

/* Sets the style of a graph as a line graph: says. */
void gm_system_graph(const struct gm_system_item *item, struct gm_graph *graph);

/* Returns true if these values of all variables at the start, of which `lane` has the keys, fulfil every
   require:; else false with a sentence. */
bool gm_system_is_admitted(const struct gm_system_lane *lane, const double *values, char *sentence);

#endif
