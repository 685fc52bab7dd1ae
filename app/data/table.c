/* SPDX-License-Identifier: GPL-3.0-or-later */
/* States as CSV: a row per time, a column per number; the lanes one after the other, under one head. */
#include <string.h>

#include "app/data/format.h"

/* A name for each number of a row, in their order: "q", "u[3]", "velocity[7][1]". */
static void put_names(const struct gm_saving *saving, const struct gm_saved *lane, struct gm_column *column)
{
    gm_column_print(column, saving->count > 1 ? "t,lane" : "t");
    for (size_t i = 0; i < lane->count; i++) {
        const struct gm_quantity *quantity = &lane->quantities[i];
        size_t lengths[GM_QUANTITY_AXES];
        const size_t axes = gm_quantity_shape(quantity, lane->members, lengths);
        const size_t size = quantity->count * lane->members * quantity->width;
        for (size_t k = 0; k < size && !quantity->fixed; k++) {
            size_t block = size, rest = k;
            gm_column_print(column, ",%s", quantity->name);
            for (size_t axis = 0; axis < axes; axis++) {
                block /= lengths[axis];
                gm_column_print(column, "[%zu]", rest / block);
                rest %= block;
            }
        }
    }
    gm_column_put(column, "\n", 1);
}

/* The head of the table is the first line of the first lane's file. */
static void begin(const struct gm_saving *saving, struct gm_saved *lane, const struct gm_run *run,
                  uint64_t expected)
{
    (void)run, (void)expected;
    struct gm_column *column = &lane->columns[0];
    const bool fresh = lane->rows == 0;
    lane->heads = saving->begun == 1;
    lane->file = gm_bytes_of(gm_part_file(saving->part, lane->index, false));
    gm_lines_open(column, &lane->file, fresh ? 0 : lane->heads + lane->rows);
    if (lane->file.why == 0 && fresh && lane->heads > 0) {
        put_names(saving, lane, column);
    }
}

static void row(const struct gm_saving *saving, struct gm_saved *lane, const struct gm_run *run)
{
    struct gm_column *column = &lane->columns[0];
    gm_column_print(column, "%.17g", run->t);
    if (saving->count > 1) {
        gm_column_print(column, ",%zu", lane->index);
    }
    for (size_t i = 0; i < lane->count; i++) {
        const struct gm_quantity *quantity = &lane->quantities[i];
        if (quantity->fixed) {
            continue;
        }
        const double *values = gm_quantity_values(run, quantity, lane->scratch);
        for (size_t k = 0; k < lane->sizes[i]; k++) {
            gm_column_print(column, ",%.17g", values[k]);
        }
    }
    gm_column_put(column, "\n", 1);
}

static void cut(const struct gm_saving *saving, struct gm_saved *lane)
{
    (void)saving;
    const uint64_t lines = gm_lines_cut(&lane->columns[0]);
    lane->rows = lines > lane->heads ? lines - lane->heads : 0;
}

static const char *refuse(const struct gm_run *one, const struct gm_run *other)
{
    struct gm_quantity of_one[GM_QUANTITIES], of_other[GM_QUANTITIES];
    const size_t count = gm_quantities_beside_time(one, false, of_one);
    bool same =
        count == gm_quantities_beside_time(other, false, of_other) && one->problem->m == other->problem->m;
    for (size_t i = 0; i < count && same; i++) {
        same = strcmp(of_one[i].name, of_other[i].name) == 0 && of_one[i].count == of_other[i].count &&
               of_one[i].fixed == of_other[i].fixed;
    }
    return same ? NULL
                : "the lanes' states differ in their columns, which one table does not hold; .npz does";
}

const struct gm_data_format gm_data_format_csv = {
    .ending = ".csv", .begin = begin, .row = row, .cut = cut, .refuse = refuse};
