/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_OUTPUT_FOLDER_H
#define GM_APP_OUTPUT_FOLDER_H

#include <stdbool.h>
#include <stddef.h>

/* Makes a folder and its parents, if they are missing; NULL: the current one. Returns false with a
   sentence (GM_MESSAGE bytes). */
bool gm_folder_make(const char *path, char *message);

/* The same for the folder of a file that will be written. */
bool gm_folder_make_for(const char *file, char *message);

/* NAME-0001.png, or the first number that is free here, for the ending ".png". */
void gm_folder_free_file(const char *name, const char *ending, char *file, size_t size);

#endif
