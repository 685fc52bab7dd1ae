/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_OUTPUT_FOLDER_H
#define GM_APP_OUTPUT_FOLDER_H

#include <stdbool.h>
#include <stddef.h>

/* Makes a folder, and those that it lies in, where they are not there already; NULL: the present one. False
   with a sentence (GM_MESSAGE bytes). */
bool gm_folder_make(const char *path, char *message);

/* The same for the folder that a file is to be written to. */
bool gm_folder_make_for(const char *file, char *message);

/* NAME-0001.png, or the first number that is free here, for the ending ".png". */
void gm_folder_free_file(const char *name, const char *ending, char *file, size_t size);

#endif
