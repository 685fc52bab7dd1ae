/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_REQUEST_SHARE_H
#define GM_APP_REQUEST_SHARE_H

#include <stddef.h>

/* The folder of that name among the data that the program brings: what the variable of the environment says, or
   beside the installed program, or where it was installed to. Returns path. */
const char *gm_share_folder(const char *name, const char *variable, char *path, size_t size);

#endif
