/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_OUTPUT_ROW_H
#define GM_APP_OUTPUT_ROW_H

#include <stdbool.h>
#include <stdio.h>

/* Named cells one after the other: as the head of a table, as its row, or as members of a JSON object. */

enum gm_row_form { GM_ROW_HEAD, GM_ROW_CSV, GM_ROW_JSON };

enum { GM_ROW_DEPTH = 8 };
struct gm_row {
    FILE *stream;
    enum gm_row_form form;
    bool begun; /* a cell precedes the next one */
    /* JSON: the number of brackets around its cells, without the outermost; the outermost object, NULL: it is that;
       and of the outermost the open brackets' ends */
    int depth;
    struct gm_row *outermost;
    int open;
    char ends[GM_ROW_DEPTH];
};

/* Cells by their keys: "scheme %s, dt %.17g, steps %.0f, order %i, holds %d", where %s is a text, %.Ng a number
   with N digits, %.0f and %i are counts, and %d is true or false. NAN is an empty cell, or null; NULL is null,
   only in JSON, which has 17 digits in any case and replaces bytes that are not UTF-8 by U+FFFD. */
__attribute__((format(printf, 2, 3))) void gm_row_put(struct gm_row *row, const char *format, ...);

/* One cell whose key is not known before. */
void gm_row_text(struct gm_row *row, const char *key, const char *text);
void gm_row_number(struct gm_row *row, const char *key, double value, int digits);

/* JSON only: numbers as one cell. */
void gm_row_list(struct gm_row *row, const char *key, const double *values, size_t count);
/* An object or a list, which ends with '}' or ']' when the next cell is put into what it is in. Cells of a list have
   the key NULL. The outermost object is not copied before it is closed; a text follows it. */
struct gm_row gm_row_begin(FILE *stream); /* the outermost object */
struct gm_row gm_row_open(struct gm_row *row, const char *key, char end);
void gm_row_close(struct gm_row *outermost, const char *after);

/* A cell of CSV that is a text in quotes. */
void gm_csv_put_quoted(FILE *stream, const char *text);
/* The cell number `index` of a row, and the text after it; "" if the row has fewer. */
const char *gm_csv_cell(const char *row, size_t index);

/* The lines of a table, read one after the other; {.stream = ...} is at the first. */
struct gm_csv_lines {
    FILE *stream; /* NULL: no lines */
    char *line;   /* the last line that was read, whole or incomplete; NULL: none */
    size_t room;
    /* Lines whose cell of this number is above 0 belong to the one before; 0: each is alone. A head has a name there. */
    size_t group;
    char *ahead; /* the line after a group */
    size_t ahead_room;
    bool is_ahead;
};
/* The next line, or group of lines, with its end; NULL after the last one, or if it is incomplete: `line` is then its part, ""
   for an empty one, or NULL when out of memory. */
const char *gm_csv_next(struct gm_csv_lines *lines);
void gm_csv_close(void *lines);

#endif
