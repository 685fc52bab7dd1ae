/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_REQUEST_SYSTEM_H
#define GM_APP_REQUEST_SYSTEM_H

#include "core/formula/equations.h"

/* Whether a word means a system: a path that ends with .system, or the name of one in the folder of
   GEOMINT_SYSTEMS, else of those that the program brings, or in the user's own ($XDG_CONFIG_HOME/geomint, or
   ~/.config/geomint). Writes its path. */
bool gm_system_path(const char *word, char *path, size_t size);

/* Opens the system of a file. Returns 0, or an exit status, and has complained: on the next two lines the text that is
   wrong, with a caret. To be closed in both cases. */
int gm_system_open(struct gm_own_system *system, const char *path, const struct gm_system_value *values,
                   size_t count);

#endif
