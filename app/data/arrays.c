/* SPDX-License-Identifier: GPL-3.0-or-later */
/* States as NumPy arrays: t, one array per quantity, meta; several lanes have the prefix lane0/ and so on.
   Column 0 is t, the others are the quantities in their order. A lane's file is its part of the archive
   from the start: each column has room for the expected number of rows, so that written rows never move.
   If there are more rows, or fewer at the end, the file is written again beside the old one, with room for
   that number. */
#include <errno.h>
#include <unistd.h>

#include "app/data/format.h"
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

/* Returns true if all quantities are single numbers of the state in its order, as for most ordinary
   differential equations; saving them must cost little compared with a step. */
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

static bool is_fixed(const struct gm_saved *lane, size_t column)
{
    return column > 0 && lane->quantities[column - 1].fixed;
}

/* The bytes of one row of a column, or of all of a fixed column. */
static size_t bytes_of(const struct gm_saved *lane, size_t column)
{
    return (column > 0 ? lane->sizes[column - 1] : 1) * sizeof(double);
}

static struct gm_npz_shape shape_of(const struct gm_saved *lane, size_t column, uint64_t rows)
{
    const struct gm_quantity *quantity = column > 0 ? &lane->quantities[column - 1] : NULL;
    struct gm_npz_shape shape = {.type = quantity && quantity->whole ? GM_NPZ_WHOLE : GM_NPZ_REAL};
    size_t lengths[GM_QUANTITY_AXES];
    if (!is_fixed(lane, column)) {
        shape.lengths[shape.axes++] = rows;
    }
    const size_t own = quantity ? gm_quantity_shape(quantity, lane->members, lengths) : 0;
    for (size_t i = 0; i < own; i++) {
        shape.lengths[shape.axes++] = lengths[i];
    }
    return shape;
}

static void name_of(const struct gm_saving *saving, const struct gm_saved *lane, const char *name,
                    char whole[80])
{
    if (saving->count > 1) {
        snprintf(whole, 80, "lane%zu/%s", lane->index, name);
    } else {
        snprintf(whole, 80, "%s", name);
    }
}

/* The archive of `file` with room for `capacity` rows, existing or new; NULL with errno. */
static struct gm_npz *lay_out(const struct gm_saving *saving, const struct gm_saved *lane, int file,
                              uint64_t capacity, uint64_t starts[], uint32_t crcs[])
{
    struct gm_npz *npz = gm_npz_open(file);
    bool good = npz != NULL;
    for (size_t i = 0; i <= lane->count && good; i++) {
        char name[80];
        const struct gm_npz_shape shape = shape_of(lane, i, capacity);
        name_of(saving, lane, i > 0 ? lane->quantities[i - 1].name : "t", name);
        good = gm_npz_reserve(npz, name, &shape, &starts[i], &crcs[i]);
    }
    if (!good) {
        gm_npz_close(npz);
    }
    return good ? npz : NULL;
}

enum { CONTENTS = 1 << 16, HEADS = 512 /* bytes of a column's head */ };

/* The size of the archive's end, meta and table of contents. It is reserved at the start, for a full disk. */
static uint64_t end_size(const struct gm_saved *lane)
{
    enum { LETTER = sizeof(uint32_t) };
    return CONTENTS + (lane->meta_size + GM_MESSAGE) * LETTER;
}

/* The bytes of a column's rows. */
static uint64_t size_of(const struct gm_saved *lane, size_t column)
{
    return bytes_of(lane, column) * (is_fixed(lane, column) ? 1 : lane->rows);
}

/* The lane's file is from now on the one of this archive. */
static void adopt(struct gm_saved *lane, struct gm_npz *npz, int file, uint64_t capacity,
                  const uint64_t starts[], const uint32_t crcs[])
{
    gm_npz_close(lane->npz);
    lane->npz = npz;
    lane->file = file;
    lane->capacity = capacity;
    for (size_t i = 0; i <= lane->count; i++) {
        lane->starts[i] = starts[i];
        lane->columns[i].file = file;
        lane->columns[i].crc = crcs[i];
    }
}

/* Writes the lane's file again, with its rows and room for `capacity` rows. */
static bool make(const struct gm_saving *saving, struct gm_saved *lane, uint64_t capacity)
{
    uint64_t starts[GM_COLUMNS] = {0};
    uint32_t crcs[GM_COLUMNS] = {0};
    const int file = gm_part_file(saving->part, lane->index, true);
    struct gm_npz *npz = file < 0 ? NULL : lay_out(saving, lane, file, capacity, starts, crcs);
    bool good = npz && gm_bytes_clear(file, gm_npz_size(npz), end_size(lane));
    for (size_t i = 0; i <= lane->count && good; i++) {
        const uint64_t size = lane->file < 0 ? 0 : size_of(lane, i);
        good = gm_npz_settle(npz, i, crcs[i]) &&
               gm_bytes_copy(lane->file, lane->starts[i], size, file, starts[i], &crcs[i]);
        lane->columns[i].place = starts[i] + size;
    }
    if (!good || !gm_part_take(saving->part, lane->index)) {
        const int why = errno;
        gm_npz_close(npz);
        if (file >= 0) {
            close(file);
            gm_part_drop(saving->part, lane->index, true);
        }
        errno = why;
        return false;
    }
    if (lane->file >= 0) {
        close(lane->file);
    }
    adopt(lane, npz, file, capacity, starts, crcs);
    return true;
}

/* Opens the rows saved before. */
static bool open_again(const struct gm_saving *saving, struct gm_saved *lane)
{
    uint32_t crcs[GM_COLUMNS];
    lane->file = gm_part_file(saving->part, lane->index, false);
    if (lane->file < 0) {
        return false;
    }
    lane->capacity = gm_npz_length(lane->file);
    lane->npz = lay_out(saving, lane, lane->file, lane->capacity, lane->starts, crcs);
    if (lane->npz && lane->capacity < lane->rows) {
        errno = EILSEQ;
    }
    return lane->npz && lane->capacity >= lane->rows;
}

enum { FEW_ROWS = 1 << 12, MORE = 4 };

/* The largest number of rows for a file that already has `own` bytes of the disk. */
static uint64_t most_rows(const struct gm_saving *saving, const struct gm_saved *lane, uint64_t own)
{
    uint64_t row = 0, beside = end_size(lane);
    for (size_t i = 0; i <= lane->count; i++) {
        row += is_fixed(lane, i) ? 0 : bytes_of(lane, i);
        beside += HEADS + (is_fixed(lane, i) ? bytes_of(lane, i) : 0);
    }
    const uint64_t room = gm_part_capacity(saving->part, own);
    return room > beside ? (room - beside) / row : 0;
}

/* The capacity of the file, in rows: no more than the disk has. */
static uint64_t capacity_of(const struct gm_saving *saving, const struct gm_saved *lane, uint64_t expected)
{
    const uint64_t most = most_rows(saving, lane, 0);
    const uint64_t wanted = expected > 0 ? expected : FEW_ROWS, fitting = wanted < most ? wanted : most;
    return fitting > lane->rows ? fitting : lane->rows + 1;
}

static bool begin(const struct gm_saving *saving, struct gm_saved *lane, const struct gm_run *run,
                  uint64_t expected)
{
    const bool fresh = lane->rows == 0;
    lane->plain = is_plain(lane);
    bool good =
        (fresh || open_again(saving, lane)) && make(saving, lane, capacity_of(saving, lane, expected));
    for (size_t i = 0; i <= lane->count && good; i++) {
        good = gm_column_open(&lane->columns[i]) &&
               (!fresh || !is_fixed(lane, i) ||
                (put_quantity(lane, i - 1, run, gm_run_state(run)) && gm_column_flush(&lane->columns[i])));
    }
    return good;
}

/* Moves the full columns apart within their file. Their room is reserved first: a failure in the middle
   would lose them. */
static bool widen(const struct gm_saving *saving, struct gm_saved *lane, uint64_t capacity)
{
    uint64_t starts[GM_COLUMNS] = {0};
    uint32_t crcs[GM_COLUMNS] = {0};
    struct gm_npz *npz = lay_out(saving, lane, lane->file, capacity, starts, crcs);
    const uint64_t before = gm_npz_size(lane->npz) + end_size(lane);
    bool good = npz && gm_bytes_clear(lane->file, before, gm_npz_size(npz) + end_size(lane) - before);
    if (!good) {
        const int why = errno;
        gm_npz_close(npz);
        errno = ftruncate(lane->file, (off_t)before) == 0 ? why : errno;
        return false;
    }
    for (size_t i = lane->count + 1; i-- > 0 && good;) {
        good = gm_bytes_raise(lane->file, lane->starts[i], size_of(lane, i), starts[i]);
    }
    for (size_t i = 0; i <= lane->count; i++) {
        good = good && gm_npz_settle(npz, i, crcs[i]) &&
               gm_bytes_copy(lane->file, starts[i], size_of(lane, i), -1, 0, &crcs[i]);
    }
    adopt(lane, npz, lane->file, capacity, starts, crcs);
    for (size_t i = 0; i <= lane->count; i++) {
        lane->columns[i].place = starts[i] + (good ? size_of(lane, i) : 0);
    }
    return good;
}

/* Lengthens the file if a second one has no room: up to `wanted` rows, and by more than 1/PART of its
   rows. */
static bool use_up(const struct gm_saving *saving, struct gm_saved *lane, uint64_t wanted)
{
    enum { PART = 64 };
    const uint64_t own = gm_npz_size(lane->npz) + end_size(lane), room = most_rows(saving, lane, own),
                   most = room < wanted ? room : wanted;
    bool good = false;
    for (uint64_t more = most > lane->rows ? most - lane->rows : 0; more > lane->rows / PART && !good;
         more /= 2) {
        good = widen(saving, lane, lane->rows + more);
    }
    return good;
}

/* There are more rows than there is room for. */
static bool grow(const struct gm_saving *saving, struct gm_saved *lane)
{
    const uint64_t wanted = MORE * lane->rows;
    bool good = true;
    for (size_t i = 0; i <= lane->count && good; i++) {
        good = gm_column_flush(&lane->columns[i]);
    }
    if (!good || make(saving, lane, capacity_of(saving, lane, wanted))) {
        return good;
    }
    const int why = errno;
    good = !saving->kept && use_up(saving, lane, wanted);
    errno = good ? errno : why;
    return good;
}

static bool row(const struct gm_saving *saving, struct gm_saved *lane, const struct gm_run *run)
{
    const double *state = gm_run_state(run);
    bool good = (lane->rows < lane->capacity || grow(saving, lane)) &&
                gm_column_put(&lane->columns[0], &run->t, sizeof run->t);
    for (size_t i = 0; i < lane->count && good; i++) {
        good = lane->quantities[i].fixed || put_quantity(lane, i, run, state);
    }
    return good;
}

/* Copies the columns' numbers out of the rows. If a column fails the rows are counted (cut). */
static bool rows(const struct gm_saving *saving, struct gm_saved *lane, const struct gm_run *run,
                 const double *rows, size_t count)
{
    const size_t width = 1 + run->problem->n;
    bool good = true;
    for (size_t done = 0, part = 0; done < count && good; done += part) {
        if (lane->rows == lane->capacity && !grow(saving, lane)) {
            return false;
        }
        part = lane->capacity - lane->rows < count - done ? lane->capacity - lane->rows : count - done;
        for (size_t i = 0; i <= lane->count; i++) {
            good = gm_column_put_every(&lane->columns[i], rows + done * width + i, width, part) && good;
        }
        lane->rows += part;
    }
    return good;
}

static void cut(const struct gm_saving *saving, struct gm_saved *lane)
{
    (void)saving;
    for (size_t i = 0; i <= lane->count; i++) {
        const uint64_t there = (lane->columns[i].place - lane->starts[i]) / bytes_of(lane, i);
        lane->rows = !is_fixed(lane, i) && there < lane->rows ? there : lane->rows;
    }
}

static bool end(const struct gm_saving *saving, struct gm_saved *lane)
{
    char name[80];
    bool good = true;
    const bool full = lane->rows == lane->capacity || make(saving, lane, lane->rows);
    if (!full && saving->kept) { /* rows that the checkpoint counts must not move */
        return false;
    }
    /* without room for another file the one that there is has gaps, of which a reader knows nothing */
    for (size_t i = 0; i <= lane->count && good; i++) {
        good = full || is_fixed(lane, i) ? gm_npz_settle(lane->npz, i, lane->columns[i].crc)
                                         : gm_npz_shorten(lane->npz, i, lane->rows);
    }
    name_of(saving, lane, "meta", name);
    good = good && gm_npz_text(lane->npz, name, lane->meta);
    lane->size = gm_npz_size(lane->npz);
    return good;
}

static bool finish(const struct gm_saving *saving, size_t lanes, int file)
{
    struct gm_npz *npz = gm_npz_open(file);
    bool good = npz != NULL;
    for (size_t i = 0; i < lanes && good; i++) {
        good = gm_npz_include(npz, saving->lanes[i].npz);
    }
    good = good && gm_npz_finish(npz);
    gm_npz_close(npz);
    return good;
}

const struct gm_data_format gm_data_format_npz = {
    .ending = ".npz", .begin = begin, .row = row, .rows = rows, .cut = cut, .end = end, .finish = finish};
