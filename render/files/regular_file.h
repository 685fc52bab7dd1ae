/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_FILES_REGULAR_FILE_H
#define GM_RENDER_FILES_REGULAR_FILE_H

#include <stdbool.h>
#include <stdio.h>

/* Files to read: regular ones alone, so that no read waits for a FIFO or reads a device without end. */

enum { GM_REGULAR_REASON = 96 }; /* bytes of a reason, the final zero among them */

/* Opens a regular file of at most `most` bytes for reading and sets *size, in bytes. Returns NULL with a
   reason, which completes "PATH could not be read: ". */
FILE *gm_regular_open(const char *path, size_t most, size_t *size, char *reason);

/* Returns the whole file and a final zero, which the caller frees; NULL with a reason. */
char *gm_regular_read(const char *path, size_t most, size_t *size, char *reason);

/* Called with the path of every file that is opened; NULL: nothing is. */
extern void (*gm_regular_watch)(const char *path);

#endif
