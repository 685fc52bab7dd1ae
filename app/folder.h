/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_FOLDER_H
#define GM_APP_FOLDER_H

#include <stdbool.h>

/* Makes a folder that may be there already, or be NULL: the present one. False with a sentence (GM_MESSAGE
   bytes). */
bool gm_folder_make(const char *path, char *message);

#endif
