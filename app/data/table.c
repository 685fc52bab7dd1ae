/* SPDX-License-Identifier: GPL-3.0-or-later */
/* States as CSV: a row a time, a column a number; one column of lines a lane, joined under one head. */
#include <errno.h>
#include <string.h>

#include "app/data/format.h"

/* Calls for each number of a row but t, in their order: "q", "u[3]", "velocity[7][1]". */
static bool put_names(const struct gm_saved *lane, FILE *file)
{
    for (size_t i = 0; i < lane->count; i++) {
        const struct gm_quantity *quantity = &lane->quantities[i];
        size_t lengths[GM_QUANTITY_AXES];
        const size_t axes = gm_quantity_shape(quantity, lane->members, lengths);
        const size_t size = quantity->count * lane->members * quantity->width;
        for (size_t k = 0; k < size && !quantity->fixed; k++) {
            size_t block = size, rest = k;
            fprintf(file, ",%s", quantity->name);
            for (size_t axis = 0; axis < axes; axis++) {
                block /= lengths[axis];
                fprintf(file, "[%zu]", rest / block);
                rest %= block;
            }
        }
    }
    return !ferror(file);
}

static bool begin(const struct gm_saving *saving, struct gm_saved *lane, const struct gm_run *run)
{
    (void)run;
    return gm_column_open(saving->part, lane->index, 0, lane->rows, 0, &lane->columns[0]);
}

static bool row(const struct gm_saving *saving, struct gm_saved *lane, const struct gm_run *run)
{
    struct gm_column *column = &lane->columns[0];
    bool good = gm_column_print(column, "%.17g", run->t) &&
                (saving->count == 1 || gm_column_print(column, ",%zu", lane->index));
    for (size_t i = 0; i < lane->count && good; i++) {
        const struct gm_quantity *quantity = &lane->quantities[i];
        if (quantity->fixed) {
            continue;
        }
        const double *values = gm_quantity_values(run, quantity, lane->scratch);
        for (size_t k = 0; k < lane->sizes[i] && good; k++) {
            good = gm_column_print(column, ",%.17g", values[k]);
        }
    }
    return good && gm_column_put(column, "\n", 1);
}

static bool join(const struct gm_saving *saving, FILE *file)
{
    bool good = fputs(saving->count > 1 ? "t,lane" : "t", file) >= 0 && put_names(&saving->lanes[0], file) &&
                fputc('\n', file) != EOF;
    for (size_t i = 0; i < saving->begun && good; i++) {
        good = gm_column_copy(saving->part, saving->lanes[i].index, 0, file);
    }
    return good;
}

static const char *refuse(const struct gm_saving *saving)
{
    const struct gm_saved *first = &saving->lanes[0], *last = &saving->lanes[saving->begun - 1];
    bool same = first->count == last->count && first->members == last->members;
    for (size_t i = 0; i < first->count && same; i++) {
        const struct gm_quantity *one = &first->quantities[i], *other = &last->quantities[i];
        same =
            strcmp(one->name, other->name) == 0 && one->count == other->count && one->fixed == other->fixed;
    }
    return same ? NULL
                : "the lanes' states differ in their columns, which one table does not hold; .npz does";
}

const struct gm_data_format gm_data_format_csv = {
    .ending = ".csv", .begin = begin, .row = row, .join = join, .refuse = refuse};
