/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_GROUND_SHARE_H
#define GM_APP_GROUND_SHARE_H

#include <stdbool.h>
#include <stddef.h>

/* The folder of that name among the data that the program brings: what the variable of the environment says,
   or beside the installed program, or where it was installed to. Returns path. */
const char *gm_share_folder(const char *name, const char *variable, char *path, size_t size);

/* The path of the file that a folder has of a name and an ending; false where it has none. */
bool gm_share_find(const char *folder, const char *name, const char *ending, char *path, size_t size);
/* Calls `each` for the name of every file in a folder with an ending; "": nothing. */
void gm_share_each(const char *folder, const char *ending, void (*each)(const char *name, const void *data),
                   const void *data);
/* What a file says behind `title:`, as far as it fits; "" where it says nothing. */
void gm_share_title(const char *path, char *title, size_t size);

#endif
