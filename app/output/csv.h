/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_OUTPUT_CSV_H
#define GM_APP_OUTPUT_CSV_H

#include <stdio.h>

/* A cell of CSV that is a text: in quotes where it needs them. */
void gm_csv_put_text(FILE *stream, const char *text);
void gm_csv_put_quoted(FILE *stream, const char *text);
/* The cell number `index` of a row, and what follows; "" where it has fewer. */
const char *gm_csv_cell(const char *row, size_t index);

#endif
