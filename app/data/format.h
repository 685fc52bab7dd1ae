/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_DATA_FORMAT_H
#define GM_APP_DATA_FORMAT_H

#include <stdio.h>

#include "app/data/part.h"
#include "core/quantity.h"
#include "scenes/frame/lane.h"

/* What a format does with the states of lanes: rows to columns, and columns to the file. */

enum { GM_COLUMNS = GM_QUANTITIES + 1 };

/* A lane of the file: what there is of it, and its columns while it runs. */
struct gm_saved {
    size_t index; /* of the lane */
    struct gm_quantity quantities[GM_QUANTITIES];
    size_t sizes[GM_QUANTITIES]; /* how many numbers each has (gm_quantity_size) */
    size_t count, members;
    bool plain; /* every row is the numbers of the state, one a column (npz) */
    uint64_t rows;
    struct gm_column columns[GM_COLUMNS];
    double *scratch; /* room for the longest quantity that is derived; NULL once the lane has ended */
    char *meta;      /* JSON: what was run; of a lane that has ended */
};

struct gm_saving {
    const char *path; /* of the file */
    const struct gm_part *part;
    struct gm_saved *lanes; /* `begun` of them are there */
    size_t begun, count;
};

struct gm_data_format {
    const char *ending;
    bool grows; /* the file is made anew now and then while rows come */
    /* Opens the columns of a lane, with as many rows as it has already; these and the following are false
       with errno. */
    bool (*begin)(const struct gm_saving *saving, struct gm_saved *lane, const struct gm_run *run);
    bool (*row)(const struct gm_saving *saving, struct gm_saved *lane, const struct gm_run *run);
    /* Makes the file of the columns of all lanes that have begun. */
    bool (*join)(const struct gm_saving *saving, FILE *file);
    /* A sentence why these lanes cannot be in one file of this format; NULL: they can, always. */
    const char *(*refuse)(const struct gm_saving *saving);
};

extern const struct gm_data_format gm_data_format_npz, gm_data_format_csv, gm_data_format_pvd;

#endif
