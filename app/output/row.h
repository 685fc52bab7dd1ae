/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_OUTPUT_ROW_H
#define GM_APP_OUTPUT_ROW_H

#include <stdbool.h>
#include <stdio.h>

/* Named cells one after the other: as the head of a table, as its row, or as members of a JSON object. */

enum gm_row_form { GM_ROW_HEAD, GM_ROW_CSV, GM_ROW_JSON };

struct gm_row {
    FILE *stream;
    enum gm_row_form form;
    bool begun; /* a cell stands before the next one */
    char end;   /* of JSON */
};

/* NULL is null, in JSON alone, where bytes that are no UTF-8 become U+FFFD. */
void gm_row_text(struct gm_row *row, const char *key, const char *text);
/* With so many digits; in JSON with 17. NAN is an empty cell, or null. */
void gm_row_number(struct gm_row *row, const char *key, double value, int digits);
/* A number of things, rounded. */
void gm_row_count(struct gm_row *row, const char *key, double value);

/* In JSON alone: true or false; numbers as one cell. */
void gm_row_flag(struct gm_row *row, const char *key, bool value);
void gm_row_list(struct gm_row *row, const char *key, const double *values, size_t count);
/* An object or a list, which ends with '}' or ']': its cells are put between open and close. Those of a list have no
   key: it is NULL. */
struct gm_row gm_row_begin(FILE *stream); /* the outermost object */
struct gm_row gm_row_open(struct gm_row *row, const char *key, char end);
void gm_row_close(const struct gm_row *row);

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
