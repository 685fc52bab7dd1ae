/* SPDX-License-Identifier: GPL-3.0-or-later */
/* States as NumPy's arrays: t, a quantity each, meta; of several lanes with the prefix lane0/ and so on.
   Column 0 is t, the others are the quantities in their order. */
#include <stdlib.h>
#include <unistd.h>

#include "app/data/format.h"
#include "app/data/npz.h"

static bool put_quantity(struct gm_saved *lane, size_t i, const struct gm_run *run)
{
    const struct gm_quantity *quantity = &lane->quantities[i];
    const size_t size = gm_quantity_size(run, quantity);
    const double *values = gm_quantity_values(run, quantity, lane->scratch);
    if (!quantity->whole) {
        return gm_column_put(&lane->columns[i + 1], values, size * sizeof *values);
    }
    for (size_t k = 0; k < size; k++) {
        const int64_t number = (int64_t)values[k];
        if (!gm_column_put(&lane->columns[i + 1], &number, sizeof number)) {
            return false;
        }
    }
    return true;
}

static bool begin(const struct gm_saving *saving, struct gm_saved *lane, const struct gm_run *run)
{
    bool good = gm_column_open(saving->part, lane->index, 0, lane->rows, sizeof(double), &lane->columns[0]);
    for (size_t i = 0; i < lane->count && good; i++) {
        const struct gm_quantity *quantity = &lane->quantities[i];
        const size_t size = gm_quantity_size(run, quantity) * sizeof(double);
        good = gm_column_open(saving->part, lane->index, i + 1, quantity->fixed ? 0 : lane->rows, size,
                              &lane->columns[i + 1]) &&
               (!quantity->fixed || put_quantity(lane, i, run));
    }
    return good;
}

static bool row(const struct gm_saving *saving, struct gm_saved *lane, const struct gm_run *run)
{
    (void)saving;
    bool good = gm_column_put(&lane->columns[0], &run->t, sizeof run->t);
    for (size_t i = 0; i < lane->count && good; i++) {
        good = lane->quantities[i].fixed || put_quantity(lane, i, run);
    }
    return good;
}

static size_t shape_of(const struct gm_saved *lane, const struct gm_quantity *quantity,
                       uint64_t shape[GM_NPZ_AXES])
{
    size_t axes = 0;
    if (!quantity->fixed) {
        shape[axes++] = lane->rows;
    }
    if (quantity->support != GM_ON_RUN) {
        shape[axes++] = quantity->count;
    }
    if (lane->members > 1) {
        shape[axes++] = lane->members;
    }
    if (quantity->width > 1) {
        shape[axes++] = quantity->width;
    }
    return axes;
}

static bool add_column(const struct gm_saving *saving, struct gm_npz *npz, const struct gm_saved *lane,
                       size_t column, const char *prefix)
{
    const struct gm_quantity *quantity = column > 0 ? &lane->quantities[column - 1] : NULL;
    char name[80];
    uint64_t shape[GM_NPZ_AXES] = {lane->rows};
    const size_t axes = quantity ? shape_of(lane, quantity, shape) : 1;
    const int source = gm_column_read(saving->part, lane->index, column);
    snprintf(name, sizeof name, "%s%s", prefix, quantity ? quantity->name : "t");
    const bool good =
        source >= 0 && gm_npz_array(npz, name, quantity && quantity->whole ? GM_NPZ_WHOLE : GM_NPZ_REAL,
                                    shape, axes, NULL, source);
    if (source >= 0) {
        close(source);
    }
    return good;
}

static bool join(const struct gm_saving *saving, FILE *file)
{
    struct gm_npz *npz = gm_npz_open(file);
    bool good = npz != NULL;
    for (size_t i = 0; i < saving->begun && good; i++) {
        const struct gm_saved *lane = &saving->lanes[i];
        char prefix[40] = "", name[80];
        if (saving->count > 1) {
            snprintf(prefix, sizeof prefix, "lane%zu/", lane->index);
        }
        for (size_t column = 0; column <= lane->count && good; column++) {
            good = add_column(saving, npz, lane, column, prefix);
        }
        snprintf(name, sizeof name, "%smeta", prefix);
        good = good && gm_npz_text(npz, name, lane->meta);
    }
    return npz && gm_npz_close(npz) && good;
}

const struct gm_format gm_format_npz = {.ending = ".npz", .begin = begin, .row = row, .join = join};
