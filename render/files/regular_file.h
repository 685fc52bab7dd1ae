/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_FILES_REGULAR_FILE_H
#define GM_RENDER_FILES_REGULAR_FILE_H

#include <stdbool.h>
#include <stdio.h>

/* Files that are read: regular ones alone, so that nobody waits for a FIFO or reads a device without end. */

enum { GM_REGULAR_REASON = 96 }; /* bytes of a reason, the final zero among them */

/* Opens a regular file of at most `most` bytes for reading and sets *size, in bytes. NULL with a reason,
   which completes "PATH could not be read: ". */
FILE *gm_regular_open(const char *path, size_t most, size_t *size, char *reason);

/* The whole file with a zero behind it; malloc'ed. NULL with a reason. */
char *gm_regular_read(const char *path, size_t most, size_t *size, char *reason);

#endif
