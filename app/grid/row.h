/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_STUDIES_ROW_H
#define GM_APP_STUDIES_ROW_H

#include <stdbool.h>
#include <stdio.h>

/* Named cells one after the other: as the head of a table, as its row, or as members of a JSON object. */

enum gm_row_form { GM_ROW_HEAD, GM_ROW_CSV, GM_ROW_JSON };

struct gm_row {
    FILE *stream;
    enum gm_row_form form;
    bool begun; /* a cell stands before the next one */
};

void gm_row_text(struct gm_row *row, const char *key, const char *text);
/* With so many digits; in JSON with 17. NAN is an empty cell, or null. */
void gm_row_number(struct gm_row *row, const char *key, double value, int digits);
/* A number of things, rounded. */
void gm_row_count(struct gm_row *row, const char *key, double value);
/* The numbers as one cell, in JSON alone. */
void gm_row_list(struct gm_row *row, const char *key, const double *values, size_t count);

#endif
