/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_FLOW_ROOM_LINES_H
#define GM_SCENES_FLOW_ROOM_LINES_H

#include "scenes/flow/room_scene.h"

/* Reads the lines other than the boundary, while the scene is made in its arena. */
void gm_room_take_lines(struct gm_user_room *user_room);
/* Sets the look that the lines of a lane's room describe. */
void gm_room_take_look(const struct gm_user_room *user_room, const struct gm_room *room,
                       struct gm_picture *picture, struct gm_look *look);

#endif
