/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_FLOW_ROOM_LINES_H
#define GM_SCENES_FLOW_ROOM_LINES_H

#include "scenes/flow/room_scene.h"

/* What lines say beside the boundary, while the scene is made in its arena. */
void gm_room_take_lines(struct gm_user_room *user_room);
/* The ends of a graph, of a lane's room. */
void gm_room_graph(const struct gm_room *room, size_t number, struct gm_look *look);

#endif
