/* SPDX-License-Identifier: GPL-3.0-or-later */
/* States as NumPy's arrays: t, a quantity each, meta; of several lanes with the prefix lane0/ and so on.
   Column 0 is t, the others are the quantities in their order. */
#include <stdlib.h>
#include <unistd.h>

#include "app/data/format.h"
#include "app/data/npz.h"
#include "core/run.h"

static bool put_quantity(struct gm_saved *lane, size_t i, const struct gm_run *run, const double *state)
{
    const struct gm_quantity *quantity = &lane->quantities[i];
    struct gm_column *column = &lane->columns[i + 1];
    const size_t size = lane->sizes[i];
    const double *values = quantity->derive ? gm_quantity_values(run, quantity, lane->scratch)
                                            : state + quantity->first * lane->members;
    if (!quantity->whole) {
        return gm_column_put(column, values, size * sizeof *values);
    }
    for (size_t k = 0; k < size; k++) {
        const int64_t number = (int64_t)values[k];
        if (!gm_column_put(column, &number, sizeof number)) {
            return false;
        }
    }
    return true;
}

/* Whether all quantities are single numbers of the state in its order, as of most ordinary differential
   equations: saving them is to cost little beside a step. */
static bool is_plain(const struct gm_saved *lane)
{
    bool plain = lane->members == 1;
    for (size_t i = 0; i < lane->count; i++) {
        const struct gm_quantity *quantity = &lane->quantities[i];
        plain = plain && lane->sizes[i] == 1 && quantity->first == i && !quantity->derive &&
                !quantity->whole && !quantity->fixed;
    }
    return plain;
}

static bool begin(const struct gm_saving *saving, struct gm_saved *lane, const struct gm_run *run)
{
    const double *state = gm_run_state(run);
    lane->plain = is_plain(lane);
    bool good = gm_column_open(saving->part, lane->index, 0, lane->rows, sizeof(double), &lane->columns[0]);
    for (size_t i = 0; i < lane->count && good; i++) {
        const struct gm_quantity *quantity = &lane->quantities[i];
        good = gm_column_open(saving->part, lane->index, i + 1, quantity->fixed ? 0 : lane->rows,
                              lane->sizes[i] * sizeof(double), &lane->columns[i + 1]) &&
               (!quantity->fixed || put_quantity(lane, i, run, state));
    }
    return good;
}

static bool row(const struct gm_saving *saving, struct gm_saved *lane, const struct gm_run *run)
{
    (void)saving;
    const double *state = gm_run_state(run);
    bool good = gm_column_put(&lane->columns[0], &run->t, sizeof run->t);
    for (size_t i = 0; i < lane->count && good && lane->plain; i++) {
        good = gm_column_put(&lane->columns[i + 1], state + i, sizeof *state);
    }
    for (size_t i = 0; i < lane->count && good && !lane->plain; i++) {
        good = lane->quantities[i].fixed || put_quantity(lane, i, run, state);
    }
    return good;
}

static size_t shape_of(const struct gm_saved *lane, const struct gm_quantity *quantity,
                       uint64_t shape[GM_NPZ_AXES])
{
    size_t lengths[GM_QUANTITY_AXES], axes = 0;
    if (!quantity->fixed) {
        shape[axes++] = lane->rows;
    }
    const size_t own = gm_quantity_shape(quantity, lane->members, lengths);
    for (size_t i = 0; i < own; i++) {
        shape[axes++] = lengths[i];
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

const struct gm_data_format gm_data_format_npz = {.ending = ".npz", .begin = begin, .row = row, .join = join};
