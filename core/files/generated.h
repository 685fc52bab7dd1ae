/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Functions for programs that the build runs, which read files of share/ and write C. */
#ifndef GM_CORE_FILES_GENERATED_H
#define GM_CORE_FILES_GENERATED_H

#include <stddef.h>
#include <stdio.h>

/* The bytes of a file, with a zero behind them; malloc'ed. NULL: it cannot be read. */
char *gm_input_read(const char *path, size_t *length);

/* Writes a string of C; a line of the text is a line of it. */
void gm_string_put(FILE *out, const char *text, size_t length);

#endif
