/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_FLOW_USER_ROOM_H
#define GM_SCENES_FLOW_USER_ROOM_H

#include "core/flow/room.h"
#include "scenes/common/scene.h"

/* The scene of a room, which it takes; `word` is what it was asked for by, `path` that of its file, to which
   the mesh's is relative. The mesh of a built-in room is built in; so is one that its file names, and that is not beside
   the file. NULL with a sentence. */
const struct gm_scene *gm_user_room_open(struct gm_room *room, const char *name, const char *word,
                                         const char *path, bool built_in, char *sentence);
void gm_user_room_close(const struct gm_scene *scene);

#endif
