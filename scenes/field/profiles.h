/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_FIELD_PROFILES_H
#define GM_SCENES_FIELD_PROFILES_H

#include "scenes/field/field.h"

/* Draws fields that are seen from frames of reference: the profiles at rest, in a panel for each scheme, and the graphs over
   time; of several schemes in several frames over the velocity of the frame. The problems' parameters begin with struct
   gm_framed. */
void gm_draw_profiles(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                      const struct gm_field_look *look, const struct gm_graph *graphs, size_t graph_count);

#endif
