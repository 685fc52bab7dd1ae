/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_DATA_FORMAT_H
#define GM_APP_DATA_FORMAT_H

#include <stdio.h>

#include "app/data/column.h"
#include "app/data/npz.h"
#include "app/data/part.h"
#include "core/quantity.h"
#include "scenes/common/lane.h"

/* What a format does with the states of lanes: rows to the lanes' files, and these to the file. */

enum { GM_COLUMNS = GM_QUANTITIES + 1 };

/* A lane of the file: what there is of it, and its columns while it runs. */
struct gm_saved {
    size_t index; /* of the lane */
    struct gm_quantity quantities[GM_QUANTITIES];
    size_t sizes[GM_QUANTITIES]; /* how many numbers each has (gm_quantity_size) */
    size_t count, members;
    uint64_t rows;
    int file; /* in the part; -1: closed */
    struct gm_column columns[GM_COLUMNS];
    double *scratch;  /* room for the longest quantity that is derived; NULL once the lane has ended */
    char *meta;       /* JSON: what was run; of a lane that has ended */
    size_t meta_size; /* bytes that it will have, about */
    uint64_t size;    /* bytes of its file that belong to it; of a lane that has ended */
    uint64_t heads;   /* of .csv: lines before the rows */
    /* of .npz */
    bool plain; /* every row is the numbers of the state, one a column */
    struct gm_npz *npz;
    uint64_t capacity, starts[GM_COLUMNS]; /* rows that there is room for; where the columns begin */
};

struct gm_saving {
    const char *path;   /* of the file */
    const char *folder; /* the path without its ending: of the files beside it */
    const struct gm_part *part;
    struct gm_saved *lanes; /* `begun` of them are there */
    size_t begun, count;
    bool kept; /* there is a checkpoint: what it counts of the parts is to stay as it is */
};

/* A format's functions are false with errno. */
struct gm_data_format {
    const char *ending;
    /* Opens the lane's file, with as many rows as it has already; `expected`: how many there will be, 0 where
       that is not known. */
    bool (*begin)(const struct gm_saving *saving, struct gm_saved *lane, const struct gm_run *run,
                  uint64_t expected);
    bool (*row)(const struct gm_saving *saving, struct gm_saved *lane, const struct gm_run *run);
    /* Many rows at once, of a lane that is plain, which it counts itself (gm_save_rows). NULL: never. */
    bool (*rows)(const struct gm_saving *saving, struct gm_saved *lane, const struct gm_run *run,
                 const double *rows, size_t count);
    /* After a write that failed, and a flush of all columns: lane->rows is how many there are. */
    void (*cut)(const struct gm_saving *saving, struct gm_saved *lane);
    /* The lane is over, and has its meta; what was put was flushed. */
    bool (*end)(const struct gm_saving *saving, struct gm_saved *lane);
    /* Makes the file of the lanes, now and then while rows come, too. NULL: it is their files one behind the
       other, and then what `finish`, if there is one, writes behind those of the first `lanes`. */
    bool (*list)(const struct gm_saving *saving, FILE *file);
    /* ... and gives back the room of the last rows of a lane that has ended; false: of all but the first. */
    bool (*drop)(const struct gm_saving *saving, struct gm_saved *lane);
    bool (*finish)(const struct gm_saving *saving, size_t lanes, int file);
    /* A sentence why these two lanes cannot be in one file of this format, or NULL; NULL: all can, always. */
    const char *(*refuse)(const struct gm_run *one, const struct gm_run *other);
};

extern const struct gm_data_format gm_data_format_npz, gm_data_format_csv, gm_data_format_pvd,
    gm_data_format_xdmf;

#endif
