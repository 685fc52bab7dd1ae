/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Kitty's images are numbered and compressed tiles; a tile that changed is replaced. libchafa 1.12 sends four
 * bytes per pixel, not compressed and as one image without a number, 4.7 MB for each picture of 1020 x 860.
 *
 * Sixels cover older ones without a trace, so the one rectangle around all changes is sent. */
#include "render/files/images.h"

#include <libdeflate.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    SIXEL = 6,
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
    struct gm_sixel *sixel;
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

/* ---- sizes ---- */

/* Returns the rows of cells after which rows of cells and bands of sixels end together. */
static int sixel_unit(int cell_height)
{
    for (int rows = 1; rows < SIXEL; rows++) {
        if (rows * cell_height % SIXEL == 0) {
            return rows;
        }
    }
    return SIXEL;
}

void gm_inline_size(const struct gm_inline_place *place, enum gm_inline_kind kind, int *width, int *height)
{
    *width = place->columns * place->cell_width;
    *height = place->rows * place->cell_height;
    if (kind == GM_INLINE_SIXEL) {
        *height -= *height % SIXEL;
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
        image->sixel = gm_sixel_open();
        good = good && image->sixel;
    }
    if (kind == GM_INLINE_KITTY) {
        size_t size =
            (size_t)(TILE_COLUMNS * place->cell_width) * (size_t)(TILE_ROWS * place->cell_height) * 3;
        image->compressor = libdeflate_alloc_compressor(LEVEL);
        image->packed_size = image->compressor ? libdeflate_zlib_compress_bound(image->compressor, size) : 0;
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
        libdeflate_free_compressor(image->compressor);
    }
    gm_sixel_close(image->sixel);
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

/* ---- sixels ---- */

static void put_sixel(struct gm_inline *image, const unsigned char *rgb, const struct patch *patch)
{
    int x, y, width, height;
    pixels_of(image, patch, &x, &y, &width, &height);
    if (height <= 0) {
        return;
    }
    const unsigned char *from = rgb + ((size_t)y * (size_t)image->width + (size_t)x) * 3;
    put_place(image, patch);
    image->failed |=
        !gm_sixel_encode(image->sixel, from, (size_t)image->width * 3, width, height, image->out);
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
    size_t packed = libdeflate_zlib_compress(image->compressor, image->raw, line * (size_t)height,
                                             image->packed, image->packed_size);
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
