/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_FLOW_USER_ROOM_H
#define GM_SCENES_FLOW_USER_ROOM_H

#include "scenes/flow/room_scene.h"

/* The scene of a room. Its mesh is relative to the path of its file; that of a built-in room is built in, and so is one
   that its file names, and that is not beside the file. NULL with a sentence, and with a fault where it is the text that
   is wrong. */
const struct gm_scene *gm_user_room_open(const struct gm_room_file *file, struct gm_fault *fault,
                                         char *sentence);
void gm_user_room_close(const struct gm_scene *scene);

#endif
