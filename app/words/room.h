/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rooms that somebody wrote: where their files are, and the scenes that are made of them. */
#ifndef GM_APP_OWN_ROOM_H
#define GM_APP_OWN_ROOM_H

#include <stdbool.h>
#include <stddef.h>

struct gm_scene;

/* The path of a room's file: a word that ends with .room is one; other words are names of those that the
   program brings, in the folder that GEOMINT_ROOMS says. False where there is no such room. */
bool gm_room_path(const char *word, char *path, size_t size);
bool gm_room_is(const char *word);
/* Calls `each` for the name of every room that the program brings. */
void gm_room_each(void (*each)(const char *name, const void *data), const void *data);

/* The scene of that room; it lives as long as the program, and the same text means the same scene. NULL with
   a sentence, which may have three lines, and then an exit status. */
const struct gm_scene *gm_room_scene(const char *word, int *status, char *message);

#endif
