/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_FILES_TEMPORARY_H
#define GM_RENDER_FILES_TEMPORARY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

/* Files are written beside their place and renamed when complete, so that a killed program leaves no half
   file under a name that anybody asked for. */

/* True if path is free or an ordinary file. Devices, pipes and symbolic links (of which /dev/stdout is one)
   are not: renaming would put a file in their place. */
bool gm_temporary_fits(const char *path);

/* The same for what can only be written so; false with a sentence (GM_MESSAGE). */
bool gm_temporary_can_replace(const char *path, char *message);

/* Writes into a message (GM_MESSAGE) that the path cannot be written, and why; /dev/stdout has the name by
   which it is asked for. False, as of a refusal. */
bool gm_temporary_refuse(char *message, const char *path, const char *reason);

/* Writes bytes to path: by way of a temporary name where that fits, else directly. 0, or an errno. */
int gm_temporary_write(const char *path, const void *bytes, size_t size);

/* A name in path's folder that no other thread or process uses, ending in `ending`; malloc'ed. */
char *gm_temporary_name(const char *path, const char *ending);

/* Removes those that this process has now, as the last thing that it does; a signal's handler may. */
void gm_temporary_remove_all(void);

/* Removes the temporaries of path that processes left which are gone. */
void gm_temporary_sweep(const char *path);

/* Whether a file's name is such a name, of a process that is gone (of this machine's processes). */
bool gm_temporary_is_stale(const char *name);

/* Makes the file of that path: `write` writes it beside its place, from there it is renamed, once it is on
   the disk. False with errno if that could not be done; the path is then what it was, and nothing is left. */
bool gm_temporary_make(const char *path, bool (*write)(FILE *file, const void *context), const void *context);

#endif
