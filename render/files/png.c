/* SPDX-License-Identifier: GPL-3.0-or-later */
/* PNG files, made in memory. */
#include "render/files/images.h"
#include "render/files/png_memory.h"

#include <errno.h>
#include <libdeflate.h>
#include <math.h>
#include <png.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "render/files/temporary.h"

/* The structure of the file is libpng's, the image data libdeflate's. Measured on plots of 1280x720 pixels
   (curves and text; in brackets: with a field of smooth colours), one core, milliseconds and kilobytes:

       libpng, its defaults                     25.4   117    (85.3   405)
       libpng, level 1, no filter                5.2   114    (15.1   591)
       libdeflate, level 1, no filter            3.7   104    ( 7.9   564)
       libdeflate, level 1, filter up            8.3   129    (10.1   443)
       libdeflate, level 2, no filter            5.2   101    (11.0   545)

   so that a filter would make the usual picture larger and take twice the time. */

enum {
    LEVEL = 1,               /* level of libdeflate for pixels */
    BEST = 9,                /* and for numbered colours */
    LONGEST_CHUNK = 1 << 30, /* the format allows 2^31 - 1 */
};

static bool is_ascii(const char *text)
{
    for (; *text; text++) {
        if ((unsigned char)*text > 126) {
            return false;
        }
    }
    return true;
}

/* Returns the rows, each after its filter's number, in zlib's format; the caller frees them. Rows of a
   palette are differences to the row above, because the fields of colours are smooth. */
static unsigned char *deflate_rows(const struct gm_png *image, size_t *size)
{
    const bool differences = image->palette != NULL;
    const size_t row = (size_t)image->width * (differences ? 1 : 3), height = (size_t)image->height;
    const size_t total = (row + 1) * height;
    unsigned char *rows = malloc(total);
    gm_deflate_prepare();
    struct libdeflate_compressor *compressor = libdeflate_alloc_compressor(differences ? BEST : LEVEL);
    const size_t bound = compressor ? libdeflate_zlib_compress_bound(compressor, total) : 0;
    unsigned char *packed = bound ? malloc(bound) : NULL;
    *size = 0;
    for (size_t y = 0; rows && packed && y < height; y++) {
        const unsigned char *from = image->pixels + y * row;
        unsigned char *to = rows + y * (row + 1);
        *to++ = differences ? PNG_FILTER_VALUE_UP : PNG_FILTER_VALUE_NONE;
        memcpy(to, from, row);
        for (size_t x = 0; differences && y > 0 && x < row; x++) {
            to[x] = (unsigned char)(from[x] - from[x - row]);
        }
    }
    if (rows && packed) {
        *size = libdeflate_zlib_compress(compressor, rows, total, packed, bound);
    }
    if (compressor) {
        libdeflate_free_compressor(compressor);
    }
    free(rows);
    if (*size == 0) {
        free(packed);
        return NULL;
    }
    return packed;
}

static void set_palette(png_structp png, png_infop info, const uint8_t palette[GM_PALETTE][4])
{
    png_color colours[GM_PALETTE];
    png_byte opacities[GM_PALETTE];
    for (size_t i = 0; i < GM_PALETTE; i++) {
        colours[i] = (png_color){palette[i][0], palette[i][1], palette[i][2]};
        opacities[i] = palette[i][3];
    }
    png_set_PLTE(png, info, colours, GM_PALETTE);
    png_set_tRNS(png, info, opacities, GM_PALETTE, NULL);
}

/* The image data of a file, and the texts as libpng takes them. */
struct contents {
    unsigned char *packed;
    size_t packed_size;
    png_text *texts;
};

/* Only the two structures outlive the jump out of libpng's errors. */
static bool write_structure(FILE *out, const struct gm_png *image, const struct contents *contents,
                            int *error, char *reason)
{
    png_structp png = png_create_write_struct_2(PNG_LIBPNG_VER_STRING, reason, gm_png_note_error,
                                                gm_png_ignore_warning, error, gm_png_take, gm_png_give_back);
    png_infop info = png ? png_create_info_struct(png) : NULL;
    if (!info) {
        png_destroy_write_struct(&png, NULL);
        *error = ENOMEM;
        return false;
    }
    if (setjmp(png_jmpbuf(png))) {
        png_destroy_write_struct(&png, &info);
        return false;
    }
    png_init_io(png, out);
    png_set_user_limits(png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    png_set_IHDR(png, info, (png_uint_32)image->width, (png_uint_32)image->height, 8,
                 image->palette ? PNG_COLOR_TYPE_PALETTE : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (image->palette) {
        set_palette(png, info, image->palette);
    }
    if (image->dpi > 0) {
        const png_uint_32 per_metre = (png_uint_32)lround(image->dpi / 0.0254);
        png_set_pHYs(png, info, per_metre, per_metre, PNG_RESOLUTION_METER);
    }
    png_set_text(png, info, contents->texts, (int)image->text_count);
    png_write_info(png, info);
    for (size_t at = 0; at < contents->packed_size; at += LONGEST_CHUNK) {
        size_t left = contents->packed_size - at;
        png_write_chunk(png, (png_const_bytep) "IDAT", contents->packed + at,
                        left < LONGEST_CHUNK ? left : LONGEST_CHUNK);
    }
    /* png_write_end fails: libpng itself has written no image data */
    png_write_chunk(png, (png_const_bytep) "IEND", NULL, 0);
    png_destroy_write_struct(&png, &info);
    return true;
}

unsigned char *gm_png_pack(const struct gm_png *image, size_t *size, char *reason)
{
    struct contents contents = {.texts = calloc(image->text_count + 1, sizeof *contents.texts)};
    int error = 0;
    char *bytes = NULL;
    bool written = false;
    contents.packed = contents.texts ? deflate_rows(image, &contents.packed_size) : NULL;
    for (size_t i = 0; contents.texts && i < image->text_count; i++) {
        const struct gm_png_text *text = &image->texts[i];
        contents.texts[i] = (png_text){
            .compression = is_ascii(text->text) ? PNG_TEXT_COMPRESSION_NONE : PNG_ITXT_COMPRESSION_NONE,
            /* libpng's struct is not const; it copies both */
            .key = (char *)text->key,
            .text = (char *)text->text,
            .text_length = strlen(text->text),
        };
    }
    FILE *out = contents.packed ? open_memstream(&bytes, size) : NULL;
    if (out) {
        written = write_structure(out, image, &contents, &error, reason);
        error = ferror(out) ? ENOMEM : error;
        written = fclose(out) == 0 && written;
    }
    free(contents.packed);
    free(contents.texts);
    if (!out || error) {
        snprintf(reason, GM_PNG_REASON, "%s", strerror(ENOMEM));
    }
    if (!written) {
        free(bytes);
    }
    return written ? (unsigned char *)bytes : NULL;
}

bool gm_png_write(const char *path, const struct gm_png *image, char *message)
{
    char reason[GM_PNG_REASON] = "a picture has at least one pixel, and fits in memory";
    size_t size = 0;
    const bool fits = image->width >= 1 && image->height >= 1 &&
                      (size_t)image->height <= SIZE_MAX / 4 / (size_t)image->width;
    unsigned char *bytes = fits ? gm_png_pack(image, &size, reason) : NULL;
    const int error = bytes ? gm_temporary_write(path, bytes, size) : 0;
    free(bytes);
    return (bytes && error == 0) || gm_temporary_refuse(message, path, error ? strerror(error) : reason);
}
