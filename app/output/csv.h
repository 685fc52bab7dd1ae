/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_OUTPUT_CSV_H
#define GM_APP_OUTPUT_CSV_H

#include <stdio.h>

/* A cell of CSV that is a text: in quotes where it needs them. */
void gm_csv_put_text(FILE *stream, const char *text);
void gm_csv_put_quoted(FILE *stream, const char *text);
/* The cell number `index` of a row, and what follows; "" where it has fewer. */
const char *gm_csv_cell(const char *row, size_t index);

/* The lines of a table, read one after the other; {.stream = ...} is at the first. */
struct gm_csv_lines {
    FILE *stream; /* NULL: there are none */
    char *line;   /* the last one that was read, whole or torn; NULL: none was */
    size_t room;
};
/* The next line with its end; NULL behind the last one, or where that is torn: `line` is then what there is of
   it, "" for nothing, or NULL where memory is short. */
const char *gm_csv_next(struct gm_csv_lines *lines);
void gm_csv_close(struct gm_csv_lines *lines);

#endif
