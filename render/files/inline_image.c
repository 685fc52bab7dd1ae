/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Kitty's images are numbered and compressed tiles; a tile that changed is replaced. libchafa 1.12 sends four
 * bytes per pixel, not compressed and as one image without a number, 4.7 MB for each picture of 1020 x 860.
 *
 * Sixels cover older ones without a trace, so the one rectangle around all changes is sent. */
#include "render/files/images.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "render/files/deflate.h"
#include "render/grow.h"

/* ---- sixels ---- */

/* Sixels: pictures of up to 256 colours for terminals in the tradition of the VT340 (DEC, VT330/VT340
   Programmer Reference Manual, vol. 2, chapter 14). The colours are chosen for each picture. */

/* The colours of a picture are counted in a grid of 64^3. Their set is cut in two again and again: always the
 * part with the greatest sum of squared deviations, through its mean. So the colours of the paper and of
 * every line are kept, whatever their share, and shades of a field are spaced evenly.
 *
 * libchafa 1.12, tried first, chose 23 colours for a picture of two lanes: a red circle became orange, the
 * mean error was five times as large, the time the same. */

enum { COLOURS = 256, BAND = 6, SHIFT = 2, SIDE_BITS = 8 - SHIFT, CELLS = 1 << 3 * SIDE_BITS };

/* A cell of the grid of colours: the pixels in it. */
struct cell {
    uint32_t count, sum[3];
    uint8_t colour; /* number in the palette */
};

/* A set of colours: a part of the list of cells. */
struct part {
    uint32_t first, end;
    double deviation; /* the greatest of the three channels' sums of squared deviations */
    int channel;      /* the channel that has it */
    double mean;      /* the mean of this channel */
};

struct sixel {
    struct cell cells[CELLS];
    uint32_t used[CELLS]; /* the numbers of the cells that are not empty */
    size_t used_count;
    struct part parts[COLOURS];
    uint8_t palette[COLOURS][3];
    /* the picture in numbers of the palette, and for each of them a band's sixels */
    uint8_t *pixels, *bands;
    char *text; /* of a band */
    size_t pixel_room, band_room, text_room;
};

static void close_sixel(struct sixel *sixel)
{
    if (sixel) {
        free(sixel->pixels);
        free(sixel->bands);
        free(sixel->text);
    }
    free(sixel);
}

/* ---- colours ---- */

static uint32_t cell_of(const unsigned char *rgb)
{
    return (uint32_t)(rgb[0] >> SHIFT) << 2 * SIDE_BITS | (uint32_t)(rgb[1] >> SHIFT) << SIDE_BITS |
           (uint32_t)(rgb[2] >> SHIFT);
}

static bool same(const unsigned char *a, const unsigned char *b)
{
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

/* Returns the number of pixels from x on with the colour of the one at x. */
static int run_length(const unsigned char *line, int x, int width)
{
    int end = x + 1;
    while (end < width && same(line + 3 * (size_t)x, line + 3 * (size_t)end)) {
        end++;
    }
    return end - x;
}

static void count_colours(struct sixel *sixel, const unsigned char *rgb, size_t stride, int width, int height)
{
    sixel->used_count = 0;
    for (int y = 0; y < height; y++) {
        const unsigned char *line = rgb + (size_t)y * stride;
        for (int x = 0, run; x < width; x += run) {
            const unsigned char *pixel = line + 3 * (size_t)x;
            run = run_length(line, x, width);
            uint32_t number = cell_of(pixel);
            struct cell *cell = &sixel->cells[number];
            if (cell->count == 0) {
                sixel->used[sixel->used_count++] = number;
            }
            cell->count += (uint32_t)run;
            for (int i = 0; i < 3; i++) {
                cell->sum[i] += (uint32_t)run * pixel[i];
            }
        }
    }
}

static double cell_mean(const struct cell *cell, int channel)
{
    return (double)cell->sum[channel] / cell->count;
}

static void measure(const struct sixel *sixel, struct part *part)
{
    double count = 0, sum[3] = {0}, squares[3] = {0};
    for (uint32_t i = part->first; i < part->end; i++) {
        const struct cell *cell = &sixel->cells[sixel->used[i]];
        count += cell->count;
        for (int k = 0; k < 3; k++) {
            sum[k] += cell->sum[k];
            squares[k] += cell->sum[k] * cell_mean(cell, k);
        }
    }
    part->deviation = -1;
    for (int k = 0; k < 3; k++) {
        double deviation = squares[k] - sum[k] * sum[k] / count;
        if (deviation > part->deviation) {
            part->deviation = deviation;
            part->channel = k;
            part->mean = sum[k] / count;
        }
    }
    if (part->end - part->first < 2) {
        part->deviation = 0;
    }
}

/* Cuts a part at its mean. Returns the start of the second half. */
static uint32_t cut(struct sixel *sixel, const struct part *part)
{
    uint32_t low = part->first, high = part->end;
    while (low < high) {
        uint32_t number = sixel->used[low];
        if (cell_mean(&sixel->cells[number], part->channel) <= part->mean) {
            low++;
        } else {
            sixel->used[low] = sixel->used[--high];
            sixel->used[high] = number;
        }
    }
    return low;
}

/* Returns the number of colours; each cell stores its own. */
static int choose_colours(struct sixel *sixel)
{
    int count = 1;
    sixel->parts[0] = (struct part){.end = (uint32_t)sixel->used_count};
    measure(sixel, &sixel->parts[0]);
    while (count < COLOURS) {
        struct part *widest = &sixel->parts[0];
        for (int i = 1; i < count; i++) {
            if (sixel->parts[i].deviation > widest->deviation) {
                widest = &sixel->parts[i];
            }
        }
        uint32_t middle = widest->deviation > 0 ? cut(sixel, widest) : widest->end;
        if (middle == widest->first || middle == widest->end) { /* all that is left is round-off */
            break;
        }
        sixel->parts[count] = (struct part){.first = middle, .end = widest->end};
        widest->end = middle;
        measure(sixel, widest);
        measure(sixel, &sixel->parts[count++]);
    }
    for (int i = 0; i < count; i++) {
        uint64_t all = 0, sum[3] = {0};
        for (uint32_t k = sixel->parts[i].first; k < sixel->parts[i].end; k++) {
            struct cell *cell = &sixel->cells[sixel->used[k]];
            cell->colour = (uint8_t)i;
            all += cell->count;
            for (int channel = 0; channel < 3; channel++) {
                sum[channel] += cell->sum[channel];
            }
        }
        for (int channel = 0; channel < 3; channel++) { /* in percent, the unit of sixels */
            sixel->palette[i][channel] = (uint8_t)((double)sum[channel] / (double)all * (100.0 / 255) + 0.5);
        }
    }
    return count;
}

/* Converts the pixels, and empties the grid for the next picture. */
static void map_pixels(struct sixel *sixel, const unsigned char *rgb, size_t stride, int width, int height)
{
    uint8_t *to = sixel->pixels;
    for (int y = 0; y < height; y++) {
        const unsigned char *line = rgb + (size_t)y * stride;
        for (int x = 0, run; x < width; x += run, to += run) {
            run = run_length(line, x, width);
            memset(to, sixel->cells[cell_of(line + 3 * (size_t)x)].colour, (size_t)run);
        }
    }
    for (size_t i = 0; i < sixel->used_count; i++) {
        sixel->cells[sixel->used[i]] = (struct cell){0};
    }
}

/* ---- bytes ---- */

/* Returns the end of a number that is written at `to`; so do the next two. */
static char *put_number(char *to, unsigned number)
{
    to = number > 9 ? put_number(to, number / 10) : to;
    *to = (char)('0' + number % 10);
    return to + 1;
}

static char *put_run(char *to, uint8_t bits, int count)
{
    if (count > 3) {
        *to++ = '!';
        to = put_number(to, (unsigned)count);
        count = 1;
    }
    memset(to, '?' + bits, (size_t)count);
    return to + count;
}

/* Writes one colour of a band, from the first to the last column that has it. */
static char *put_line(char *to, unsigned colour, const uint8_t *bits, int first, int last)
{
    *to++ = '#';
    to = put_run(put_number(to, colour), 0, first);
    for (int x = first; x <= last;) {
        int end = x + 1;
        while (end <= last && bits[end] == bits[x]) {
            end++;
        }
        to = put_run(to, bits[x], end - x);
        x = end;
    }
    return to;
}

static bool put_band(struct sixel *sixel, const uint8_t *pixels, int width, int rows, FILE *out)
{
    int first[COLOURS], last[COLOURS];
    uint8_t present[COLOURS];
    int count = 0;
    memset(last, -1, sizeof last);
    for (int y = 0; y < rows; y++) {
        for (int x = 0; x < width; x++) {
            uint8_t colour = pixels[(size_t)y * (size_t)width + (size_t)x];
            uint8_t *bits = sixel->bands + (size_t)colour * (size_t)width;
            if (last[colour] < 0) {
                present[count++] = colour;
                first[colour] = last[colour] = x;
                memset(bits, 0, (size_t)width);
            }
            first[colour] = x < first[colour] ? x : first[colour];
            last[colour] = x > last[colour] ? x : last[colour];
            bits[x] |= (uint8_t)(1 << y);
        }
    }
    if (!gm_grow(&sixel->text, &sixel->text_room, (size_t)count * ((size_t)width + 16), 1)) {
        return false;
    }
    char *to = sixel->text;
    for (int i = 0; i < count; i++) {
        const unsigned colour = present[i];
        if (i > 0) {
            *to++ = '$';
        }
        to = put_line(to, colour, sixel->bands + (size_t)colour * (size_t)width, first[colour], last[colour]);
    }
    fwrite(sixel->text, 1, (size_t)(to - sixel->text), out);
    return true;
}

/* Encodes width x height pixels of 3 bytes each, `stride` bytes from row to row. Returns false when out of memory,
   which `out` may report, too. */
static bool encode_sixel(struct sixel *sixel, const unsigned char *rgb, size_t stride, int width, int height,
                         FILE *out)
{
    if (!gm_grow(&sixel->pixels, &sixel->pixel_room, (size_t)width * (size_t)height, 1) ||
        !gm_grow(&sixel->bands, &sixel->band_room, (size_t)width, COLOURS)) {
        return false;
    }
    count_colours(sixel, rgb, stride, width, height);
    const int colours = choose_colours(sixel);
    map_pixels(sixel, rgb, stride, width, height);
    /* square pixels; pixels that are not drawn stay as they were */
    fprintf(out, "\033P0;1;0q\"1;1;%d;%d", width, height);
    for (int i = 0; i < colours; i++) {
        fprintf(out, "#%d;2;%d;%d;%d", i, sixel->palette[i][0], sixel->palette[i][1], sixel->palette[i][2]);
    }
    for (int y = 0; y < height; y += BAND) {
        const int rows = height - y < BAND ? height - y : BAND;
        fputs(y > 0 ? "-" : "", out); /* no new line after the last: it could make the screen scroll */
        if (!put_band(sixel, sixel->pixels + (size_t)y * (size_t)width, width, rows, out)) {
            return false;
        }
    }
    fputs("\033\\", out);
    return true;
}

enum {
    TILE_COLUMNS = 24, /* cells of a Kitty tile, about square */
    TILE_ROWS = 12,
    FIRST_NUMBER = 7100, /* first number of the tiles: other programs' images in the same terminal stay */
    CHUNK = 4096,        /* characters of base64 in one sequence, as Kitty's protocol bounds it */
    LEVEL = 1,           /* level of zlib: a higher one costs more time than the bytes it saves */
};

struct gm_inline {
    enum gm_inline_kind kind;
    struct gm_inline_place place;
    int width, height, most_width, most_height;
    int unit_rows;         /* patches are a multiple of this number of cell rows high */
    unsigned char *before; /* the picture that was sent last */
    bool sent;
    struct sixel *sixel;
    struct libdeflate_compressor *compressor;
    unsigned char *raw, *packed; /* a tile, raw and compressed */
    size_t packed_size;
    FILE *out; /* open while a picture is encoded, into `bytes` */
    char *bytes;
    size_t length;
    bool failed;
};

/* A rectangle of cells. */
struct patch {
    int column, row, columns, rows;
};

static int least(int a, int b)
{
    return a < b ? a : b;
}

/* ---- pictures of either kind: sizes ---- */

/* Returns the rows of cells after which rows of cells and bands of sixels end together. */
static int sixel_unit(int cell_height)
{
    for (int rows = 1; rows < BAND; rows++) {
        if (rows * cell_height % BAND == 0) {
            return rows;
        }
    }
    return BAND;
}

void gm_inline_size(const struct gm_inline_place *place, enum gm_inline_kind kind, int *width, int *height)
{
    *width = place->columns * place->cell_width;
    *height = place->rows * place->cell_height;
    if (kind == GM_INLINE_SIXEL) {
        *height -= *height % BAND;
    }
}

struct gm_inline *gm_inline_open(enum gm_inline_kind kind, const struct gm_inline_place *place,
                                 int most_width, int most_height)
{
    struct gm_inline *image = calloc(1, sizeof *image);
    if (!image) {
        return NULL;
    }
    image->kind = kind;
    image->place = *place;
    image->most_width = most_width > 0 ? most_width : 1 << 15;
    image->most_height = most_height > 0 ? most_height : 1 << 15;
    image->unit_rows = kind == GM_INLINE_SIXEL ? sixel_unit(place->cell_height) : TILE_ROWS;
    gm_inline_size(place, kind, &image->width, &image->height);
    image->before = malloc((size_t)image->width * (size_t)image->height * 3);
    bool good = image->before;
    if (kind == GM_INLINE_SIXEL) {
        image->sixel = calloc(1, sizeof *image->sixel);
        good = good && image->sixel;
    }
    if (kind == GM_INLINE_KITTY) {
        size_t size =
            (size_t)(TILE_COLUMNS * place->cell_width) * (size_t)(TILE_ROWS * place->cell_height) * 3;
        image->compressor = gm_deflate()->libdeflate_alloc_compressor(LEVEL);
        image->packed_size =
            image->compressor ? gm_deflate()->libdeflate_zlib_compress_bound(image->compressor, size) : 0;
        image->raw = malloc(size);
        image->packed = malloc(image->packed_size + 1);
        good = good && image->compressor && image->raw && image->packed;
    }
    if (!good) {
        gm_inline_close(image);
        return NULL;
    }
    return image;
}

void gm_inline_close(struct gm_inline *image)
{
    if (!image) {
        return;
    }
    if (image->compressor) {
        gm_deflate()->libdeflate_free_compressor(image->compressor);
    }
    close_sixel(image->sixel);
    free(image->before);
    free(image->raw);
    free(image->packed);
    free(image->bytes);
    free(image);
}

/* ---- what changed ---- */

/* Gives the patch's rectangle in pixels; the last rows of cells may be cut. */
static void pixels_of(const struct gm_inline *image, const struct patch *patch, int *x, int *y, int *width,
                      int *height)
{
    *x = patch->column * image->place.cell_width;
    *y = patch->row * image->place.cell_height;
    *width = patch->columns * image->place.cell_width;
    *height = least(patch->rows * image->place.cell_height, image->height - *y);
}

static bool differs(const struct gm_inline *image, const unsigned char *rgb, const struct patch *patch)
{
    int x, y, width, height;
    pixels_of(image, patch, &x, &y, &width, &height);
    for (int row = y; row < y + height; row++) {
        size_t at = ((size_t)row * (size_t)image->width + (size_t)x) * 3;
        if (memcmp(image->before + at, rgb + at, (size_t)width * 3) != 0) {
            return true;
        }
    }
    return false;
}

/* Returns the smallest patch of whole units that holds all changes; no columns if nothing changed. */
static struct patch changed_part(const struct gm_inline *image, const unsigned char *rgb)
{
    const struct gm_inline_place *place = &image->place;
    int left = place->columns, right = 0, top = place->rows, bottom = 0;
    for (int row = 0; row < place->rows; row += image->unit_rows) {
        struct patch line = {0, row, place->columns, least(image->unit_rows, place->rows - row)};
        if (!differs(image, rgb, &line)) {
            continue;
        }
        top = least(top, row);
        bottom = row + line.rows;
        for (int column = 0; column < left; column++) {
            if (differs(image, rgb, &(struct patch){column, row, 1, line.rows})) {
                left = column;
            }
        }
        for (int column = place->columns - 1; column >= right; column--) {
            if (differs(image, rgb, &(struct patch){column, row, 1, line.rows})) {
                right = column + 1;
            }
        }
    }
    return bottom > top ? (struct patch){left, top, right - left, bottom - top} : (struct patch){0};
}

/* Moves the cursor to the patch's first cell. */
static void put_place(struct gm_inline *image, const struct patch *patch)
{
    fprintf(image->out, "\033[%d;%dH", image->place.row + patch->row + 1,
            image->place.column + patch->column + 1);
}

/* ---- sixels of a patch ---- */

static void put_sixel(struct gm_inline *image, const unsigned char *rgb, const struct patch *patch)
{
    int x, y, width, height;
    pixels_of(image, patch, &x, &y, &width, &height);
    if (height <= 0) {
        return;
    }
    const unsigned char *from = rgb + ((size_t)y * (size_t)image->width + (size_t)x) * 3;
    put_place(image, patch);
    image->failed |= !encode_sixel(image->sixel, from, (size_t)image->width * 3, width, height, image->out);
}

/* Sends a patch in pieces that the terminal takes at once. */
static void put_sixels(struct gm_inline *image, const unsigned char *rgb, const struct patch *whole)
{
    int columns = image->most_width / image->place.cell_width;
    int units = image->most_height / (image->place.cell_height * image->unit_rows);
    columns = columns < 1 ? 1 : columns;
    int rows = (units < 1 ? 1 : units) * image->unit_rows;
    for (int row = whole->row; row < whole->row + whole->rows; row += rows) {
        for (int column = whole->column; column < whole->column + whole->columns; column += columns) {
            struct patch part = {column, row, least(columns, whole->column + whole->columns - column),
                                 least(rows, whole->row + whole->rows - row)};
            put_sixel(image, rgb, &part);
        }
    }
}

/* ---- Kitty ---- */

/* A tile replaces the previous one with its number. q=2: the terminal answers nothing; C=1: the cursor stays.
   The tile is not below the text (z < 0): Kitty 0.26 with llvmpipe then leaves old letters in all of its
   window, on a wrong ground. */
static void put_tile(struct gm_inline *image, const unsigned char *rgb, const struct patch *patch, int number)
{
    int x, y, width, height;
    pixels_of(image, patch, &x, &y, &width, &height);
    size_t line = (size_t)width * 3;
    for (int row = 0; row < height; row++) {
        memcpy(image->raw + (size_t)row * line,
               rgb + ((size_t)(y + row) * (size_t)image->width + (size_t)x) * 3, line);
    }
    size_t packed = gm_deflate()->libdeflate_zlib_compress(
        image->compressor, image->raw, line * (size_t)height, image->packed, image->packed_size);
    const size_t step = CHUNK / 4 * 3;
    put_place(image, patch);
    for (size_t at = 0; at < packed; at += step) {
        bool more = at + step < packed;
        if (at == 0) {
            fprintf(image->out, "\033_Ga=T,q=2,f=24,o=z,i=%d,p=1,s=%d,v=%d,c=%d,r=%d,C=1,m=%d;",
                    FIRST_NUMBER + number, width, height, patch->columns, patch->rows, more);
        } else {
            fprintf(image->out, "\033_Gq=2,m=%d;", more);
        }
        gm_base64_put(image->packed + at, more ? step : packed - at, image->out);
        fputs("\033\\", image->out);
    }
}

static void put_tiles(struct gm_inline *image, const unsigned char *rgb, bool whole)
{
    const struct gm_inline_place *place = &image->place;
    int number = 0;
    for (int row = 0; row < place->rows; row += TILE_ROWS) {
        for (int column = 0; column < place->columns; column += TILE_COLUMNS, number++) {
            struct patch tile = {column, row, least(TILE_COLUMNS, place->columns - column),
                                 least(TILE_ROWS, place->rows - row)};
            if (whole || differs(image, rgb, &tile)) {
                put_tile(image, rgb, &tile, number);
            }
        }
    }
}

bool gm_inline_encode(struct gm_inline *image, const unsigned char *rgb, bool whole, const char **bytes,
                      size_t *size)
{
    whole = whole || !image->sent;
    free(image->bytes);
    image->bytes = NULL;
    image->out = open_memstream(&image->bytes, &image->length);
    image->failed = !image->out;
    if (image->out && image->kind == GM_INLINE_KITTY) {
        put_tiles(image, rgb, whole);
    } else if (image->out) {
        struct patch part =
            whole ? (struct patch){0, 0, image->place.columns, image->place.rows} : changed_part(image, rgb);
        if (part.columns > 0) {
            put_sixels(image, rgb, &part);
        }
    }
    image->failed |= image->out && (ferror(image->out) | fclose(image->out)) != 0;
    memcpy(image->before, rgb, (size_t)image->width * (size_t)image->height * 3);
    image->sent = !image->failed;
    *bytes = image->bytes;
    *size = image->length;
    return !image->failed;
}

const char *gm_inline_removal(enum gm_inline_kind kind)
{
    return kind == GM_INLINE_KITTY ? "\033_Ga=d,d=A,q=2\033\\" : "";
}
