/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_FLOW_USER_ROOM_H
#define GM_SCENES_FLOW_USER_ROOM_H

#include "scenes/flow/room_scene.h"

/* Opens the scene of a room. Its mesh is a file, relative to the room's own, or else built in. On failure
   returns NULL with a sentence, and with a fault if the text is wrong. */
const struct gm_scene *gm_user_room_open(const struct gm_room_file *file, struct gm_fault *fault,
                                         char *sentence);
void gm_user_room_close(const struct gm_scene *scene);

#endif
