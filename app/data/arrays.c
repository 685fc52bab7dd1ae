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

static void put_quantity(struct gm_saved *lane, size_t i, const struct gm_run *run, const double *state)
{
    const struct gm_quantity *quantity = &lane->quantities[i];
    struct gm_column *column = &lane->columns[i + 1];
    const size_t size = lane->sizes[i];
    const double *values = quantity->derive ? gm_quantity_values(run, quantity, lane->scratch)
                                            : state + quantity->first * lane->members;
    if (!quantity->whole) {
        gm_column_put(column, values, size * sizeof *values);
        return;
    }
    for (size_t k = 0; k < size; k++) {
        const int64_t number = (int64_t)values[k];
        gm_column_put(column, &number, sizeof number);
    }
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

/* The archive of `file` with room for `capacity` rows, existing or new. */
static struct gm_npz_layout lay_out(const struct gm_saving *saving, const struct gm_saved *lane,
                                    struct gm_bytes *file, uint64_t capacity)
{
    struct gm_npz_layout layout = {.npz.file = file, .capacity = capacity};
    for (size_t i = 0; i <= lane->count; i++) {
        char name[80];
        const struct gm_npz_shape shape = shape_of(lane, i, capacity);
        name_of(saving, lane, i > 0 ? lane->quantities[i - 1].name : "t", name);
        layout.starts[i] = gm_npz_reserve(&layout.npz, name, &shape, &layout.crcs[i]);
    }
    return layout;
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

/* The lane's file has from now on this archive, in which its rows are, unless `empty`. */
static void adopt(struct gm_saved *lane, const struct gm_npz_layout *layout, bool empty)
{
    gm_npz_close(&lane->layout.npz);
    lane->layout = *layout;
    lane->layout.npz.file = &lane->file;
    for (size_t i = 0; i <= lane->count; i++) {
        lane->columns[i].file = &lane->file;
        lane->columns[i].place = layout->starts[i] + (empty ? 0 : size_of(lane, i));
        lane->columns[i].crc = layout->crcs[i];
    }
}

/* Writes the lane's file again, with its rows and room for `capacity` rows. Returns false with errno if there is
   no room for that: the file stays. */
static bool make(const struct gm_saving *saving, struct gm_saved *lane, uint64_t capacity)
{
    const bool empty = lane->file.file < 0;
    struct gm_bytes file = gm_bytes_of(gm_part_file(saving->part, lane->index, true));
    struct gm_npz_layout layout = lay_out(saving, lane, &file, capacity);
    gm_bytes_clear(&file, layout.npz.place, end_size(lane));
    for (size_t i = 0; i <= lane->count; i++) {
        gm_npz_settle(&layout.npz, i, layout.crcs[i]);
        gm_bytes_copy(&lane->file, lane->layout.starts[i], empty ? 0 : size_of(lane, i), &file,
                      layout.starts[i], &layout.crcs[i]);
    }
    if (file.why != 0 || !gm_part_take(saving->part, lane->index)) {
        gm_bytes_note(&file, false);
        gm_npz_close(&layout.npz);
        gm_part_drop(saving->part, lane->index, true);
        return gm_bytes_close(&file);
    }
    gm_bytes_close(&lane->file);
    lane->file = file;
    adopt(lane, &layout, empty);
    return true;
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

static void begin(const struct gm_saving *saving, struct gm_saved *lane, const struct gm_run *run,
                  uint64_t expected)
{
    const bool fresh = lane->rows == 0;
    lane->plain = is_plain(lane);
    if (!fresh) {
        lane->file = gm_bytes_of(gm_part_file(saving->part, lane->index, false));
    }
    if (!fresh && lane->file.why == 0) {
        lane->layout = lay_out(saving, lane, &lane->file, gm_npz_length(lane->file.file));
        errno = EILSEQ;
        gm_bytes_note(&lane->file, lane->layout.capacity >= lane->rows);
    }
    if (lane->file.why == 0) {
        gm_bytes_note(&lane->file, make(saving, lane, capacity_of(saving, lane, expected)));
    }
    for (size_t i = 0; i <= lane->count && lane->file.why == 0; i++) {
        gm_column_open(&lane->columns[i]);
        if (lane->file.why == 0 && fresh && is_fixed(lane, i)) {
            put_quantity(lane, i - 1, run, gm_run_state(run));
        }
    }
    gm_columns_flush(lane->columns, GM_COLUMNS);
}

/* Moves the full columns apart within their file. Their room is reserved first, since a failure in the middle
   would lose them; returns false without that room. */
static bool widen(const struct gm_saving *saving, struct gm_saved *lane, uint64_t capacity)
{
    struct gm_bytes *file = &lane->file;
    const uint64_t before = lane->layout.npz.place + end_size(lane);
    struct gm_npz_layout layout = lay_out(saving, lane, file, capacity);
    gm_bytes_clear(file, before, layout.npz.place + end_size(lane) - before);
    if (file->why != 0) {
        gm_npz_close(&layout.npz);
        file->why = ftruncate(file->file, (off_t)before) == 0 ? 0 : errno;
        return false;
    }
    for (size_t i = lane->count + 1; i-- > 0;) {
        gm_bytes_move(file, lane->layout.starts[i], size_of(lane, i), file, layout.starts[i]);
    }
    for (size_t i = 0; i <= lane->count; i++) {
        gm_npz_settle(&layout.npz, i, layout.crcs[i]);
        gm_bytes_copy(file, layout.starts[i], size_of(lane, i), NULL, 0, &layout.crcs[i]);
    }
    adopt(lane, &layout, file->why != 0);
    return true;
}

/* Lengthens the file if a second one has no room: up to `wanted` rows, and by more than 1/PART of its
   rows. */
static bool use_up(const struct gm_saving *saving, struct gm_saved *lane, uint64_t wanted)
{
    enum { PART = 64 };
    const uint64_t own = lane->layout.npz.place + end_size(lane), room = most_rows(saving, lane, own),
                   most = room < wanted ? room : wanted;
    uint64_t more = most > lane->rows ? most - lane->rows : 0;
    while (more > lane->rows / PART && !widen(saving, lane, lane->rows + more)) {
        more /= 2;
    }
    return more > lane->rows / PART;
}

/* There are more rows than there is room for. */
static void grow(const struct gm_saving *saving, struct gm_saved *lane)
{
    const uint64_t wanted = MORE * lane->rows;
    gm_columns_flush(lane->columns, GM_COLUMNS);
    if (lane->file.why == 0 && !make(saving, lane, capacity_of(saving, lane, wanted))) {
        const int why = errno;
        const bool widened = !saving->kept && use_up(saving, lane, wanted);
        errno = why;
        gm_bytes_note(&lane->file, widened);
    }
}

static void row(const struct gm_saving *saving, struct gm_saved *lane, const struct gm_run *run)
{
    const double *state = gm_run_state(run);
    if (lane->rows >= lane->layout.capacity) {
        grow(saving, lane);
    }
    if (lane->file.why == 0) {
        gm_column_put(&lane->columns[0], &run->t, sizeof run->t);
    }
    for (size_t i = 0; i < lane->count && lane->file.why == 0; i++) {
        if (!lane->quantities[i].fixed) {
            put_quantity(lane, i, run, state);
        }
    }
}

/* Copies the columns' numbers out of the rows. If a column fails the rows are counted (cut). */
static void rows(const struct gm_saving *saving, struct gm_saved *lane, const struct gm_run *run,
                 const double *rows, size_t count)
{
    const size_t width = 1 + run->problem->n;
    for (size_t done = 0, part = 0; done < count && lane->file.why == 0; done += part) {
        if (lane->rows == lane->layout.capacity) {
            grow(saving, lane);
        }
        const uint64_t room = lane->file.why == 0 ? lane->layout.capacity - lane->rows : 0;
        part = room < count - done ? room : count - done;
        for (size_t i = 0; i <= lane->count; i++) {
            gm_column_put_every(&lane->columns[i], rows + done * width + i, width, part);
        }
        lane->rows += part;
    }
}

static void cut(const struct gm_saving *saving, struct gm_saved *lane)
{
    (void)saving;
    for (size_t i = 0; i <= lane->count; i++) {
        const uint64_t there = (lane->columns[i].place - lane->layout.starts[i]) / bytes_of(lane, i);
        lane->rows = !is_fixed(lane, i) && there < lane->rows ? there : lane->rows;
    }
}

static void end(const struct gm_saving *saving, struct gm_saved *lane)
{
    char name[80];
    const bool full = lane->rows == lane->layout.capacity || make(saving, lane, lane->rows);
    struct gm_npz *npz = &lane->layout.npz;
    gm_bytes_note(&lane->file, full || !saving->kept); /* rows that the checkpoint counts must not move */
    /* without room for another file the one that there is has gaps, of which a reader knows nothing */
    for (size_t i = 0; i <= lane->count && lane->file.why == 0; i++) {
        if (full || is_fixed(lane, i)) {
            gm_npz_settle(npz, i, lane->columns[i].crc);
        } else {
            gm_npz_shorten(npz, i, lane->rows);
        }
    }
    name_of(saving, lane, "meta", name);
    gm_npz_text(npz, name, lane->meta);
    lane->size = npz->place;
}

static void finish(const struct gm_saving *saving, size_t lanes, struct gm_bytes *file)
{
    struct gm_npz npz = {.file = file};
    for (size_t i = 0; i < lanes; i++) {
        gm_npz_include(&npz, &saving->lanes[i].layout.npz);
    }
    gm_npz_finish(&npz);
    gm_npz_close(&npz);
}

const struct gm_data_format gm_data_format_npz = {
    .ending = ".npz", .begin = begin, .row = row, .rows = rows, .cut = cut, .end = end, .finish = finish};
