/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_FILES_IMAGES_H
#define GM_RENDER_FILES_IMAGES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* PNG files: written whole or not at all; their texts can be read again. */

/* A key and a text of a PNG's text chunks (UTF-8 goes to iTXt). */
struct gm_png_text {
    const char *key, *text;
};

/* The contents of a file: height rows of width pixels, top first, of three bytes for red, green and blue, or,
   with a palette of red, green, blue and opacity, of one byte, the number of a colour. */
enum { GM_PALETTE = 256 };
struct gm_png {
    int width, height;
    double dpi; /* resolution in pixels per inch; 0: none */
    const unsigned char *pixels;
    const uint8_t (*palette)[4]; /* GM_PALETTE colours, for the shortest file; NULL: none */
    const struct gm_png_text *texts;
    size_t text_count;
};

/* Returns a PNG in memory and its bytes in *size. The caller frees it; NULL with a reason of
   GM_PNG_REASON bytes. */
enum { GM_PNG_REASON = 96 };
unsigned char *gm_png_pack(const struct gm_png *image, size_t *size, char *reason);

/* Writes a PNG to path. A killed program leaves no half file. Returns false on failure, with one sentence in
   message (GM_MESSAGE bytes). */
bool gm_png_write(const char *path, const struct gm_png *image, char *message);

/* Reads the first text of each of these keys, in one walk over the chunks that unpacks nothing else. The
   caller frees texts[i], which is NULL for a missing key; together they have at most GM_PNG_TEXTS_MOST bytes.
   Returns false with a sentence, and no text, if the file is damaged, a device or a pipe. */
enum { GM_PNG_TEXTS_MOST = 1 << 22 };
bool gm_png_read_texts(const char *path, const char *const *keys, char **texts, size_t count, char *message);

/* Returns the text of one key, which the caller frees; NULL with a sentence if there is no such text. */
char *gm_png_read_text(const char *path, const char *key, char *message);

/* Returns true if path is a whole PNG, with correct checksums, that holds this key with this text (ASCII). */
bool gm_png_tells(const char *path, const char *key, const char *text);

/* Reads a PNG of this size into rgb (height rows of width * 3 bytes, top first); false with a sentence. */
bool gm_png_read(const char *path, int width, int height, unsigned char *rgb, char *message);

/* Writes bytes in base64 (RFC 4648), padded. */
void gm_base64_put(const void *data, size_t size, FILE *out);

/* Pictures of pixels among the text of a terminal, as bytes to send. A picture fills whole character cells.
   After the first picture only the parts that changed are sent. */

enum gm_inline_kind { GM_INLINE_NONE, GM_INLINE_KITTY, GM_INLINE_SIXEL, GM_INLINE_COUNT };

struct gm_inline_place {
    int column, row;             /* the upper left cell, from 0 on */
    int columns, rows;           /* number of cells that it fills */
    int cell_width, cell_height; /* size of a cell, in pixels */
};

/* The size in pixels of a picture at a place. Sixels come in bands of six rows, so up to five rows of pixels
   above the last cells' end stay blank. */
void gm_inline_size(const struct gm_inline_place *place, enum gm_inline_kind kind, int *width, int *height);

struct gm_inline;

/* Opens an encoder. The terminal takes no larger image at once than most_width x most_height pixels (0: any
   size). Returns NULL when out of memory. */
struct gm_inline *gm_inline_open(enum gm_inline_kind kind, const struct gm_inline_place *place,
                                 int most_width, int most_height);
void gm_inline_close(struct gm_inline *image);

/* Encodes a picture of gm_inline_size, 3 bytes per pixel, top row first: all of it with `whole`, else the
   changes. *bytes belongs to the image until the next call; *size is 0 without a change. The cursor may be
   anywhere afterwards. Returns false when out of memory. */
bool gm_inline_encode(struct gm_inline *image, const unsigned char *rgb, bool whole, const char **bytes,
                      size_t *size);

/* Returns the bytes that remove such pictures; "" if text written over them does. */
const char *gm_inline_removal(enum gm_inline_kind kind);

#endif
