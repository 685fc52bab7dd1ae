/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_FILES_TEMPORARY_H
#define GM_RENDER_FILES_TEMPORARY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

/* Files are written to a temporary name in the same folder and renamed when complete, so that a killed
   program leaves no half file under the user's name for it. */

/* Returns true if path is free or an ordinary file, not a device, a pipe or a symbolic link (such as
   /dev/stdout): renaming would replace those by a file. */
bool gm_temporary_fits(const char *path);

/* Returns true if gm_temporary_fits; otherwise false with a sentence (GM_MESSAGE). */
bool gm_temporary_can_replace(const char *path, char *message);

/* Writes into a message (GM_MESSAGE) that the path cannot be written, and why; /dev/stdout is called standard
   output. Returns false, like gm_refuse. */
bool gm_temporary_refuse(char *message, const char *path, const char *reason);

/* Writes bytes to path, with a temporary name if path fits, otherwise directly. Returns 0 or an errno. */
int gm_temporary_write(const char *path, const void *bytes, size_t size);

/* Returns a name in path's folder that no other thread or process uses, with this ending; the caller frees
   it. */
char *gm_temporary_name(const char *path, const char *ending);

/* Removes the temporary files of this process, as its last action; a signal handler may call it. */
void gm_temporary_remove_all(void);

/* Removes the temporary files of path whose processes have ended. */
void gm_temporary_sweep(const char *path);

/* Returns true if the name is that of a temporary file whose process, on this machine, has ended. */
bool gm_temporary_is_stale(const char *name);

/* Makes the file at path: `write` writes a temporary file, which is renamed once it is on the disk. Returns
   false with errno on failure; path is then unchanged, and nothing is left. */
bool gm_temporary_make(const char *path, bool (*write)(FILE *file, const void *context), const void *context);

#endif
