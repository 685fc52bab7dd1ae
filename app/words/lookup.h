/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Systems by their names: where their files are, and which there are. */
#ifndef GM_APP_OWN_FOUND_H
#define GM_APP_OWN_FOUND_H

#include <stdbool.h>
#include <stddef.h>

extern const char gm_system_ending[]; /* ".system" */

/* Whether a word means a system: a path that ends with .system, or the name of one in the folder of
   GEOMINT_SYSTEMS, else of those that the program brings, or in the user's own ($XDG_CONFIG_HOME/geomint, or
   ~/.config/geomint). Writes its path. */
bool gm_system_path(const char *word, char *path, size_t size);

/* The folder of the systems that the program brings; false: it is not there. */
bool gm_system_folder(char *folder, size_t size);

/* Calls `each` for the names of the systems there are. */
void gm_system_each(void (*each)(const char *name, const void *data), const void *data);

/* Of the names of scenes, systems and rooms the one that is nearest to a word, written to `near`; NULL: none is
   near. */
enum { GM_NEAR = 64 };
const char *gm_system_near(const char *word, char near[GM_NEAR]);

#endif
