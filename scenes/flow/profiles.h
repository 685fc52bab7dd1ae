/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_FLOW_PROFILES_H
#define GM_SCENES_FLOW_PROFILES_H

#include "scenes/flow/room_scene.h"

/* Draws a panel for each quantity, the exact one broad and grey, published points in red; writes rows of
   CSV. */
void gm_room_draw_profiles(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture,
                           enum gm_place place);
void gm_room_write_profiles(const struct gm_view *view, const char *front, FILE *stream);

#endif
