/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The scenes that are made of the files of rooms. */
#ifndef GM_APP_WORDS_ROOM_H
#define GM_APP_WORDS_ROOM_H

struct gm_scene;

/* The scene of the room that a word means (app/base/files.h); it lives as long as the program, and the same text means the same scene. NULL with
   a sentence, which may have three lines, and then an exit status. */
const struct gm_scene *gm_room_scene(const char *word, int *status, char *message);

#endif
