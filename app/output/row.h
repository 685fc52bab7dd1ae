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

/* NULL is null, in JSON alone. */
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

#endif
