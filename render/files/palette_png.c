/* SPDX-License-Identifier: GPL-3.0-or-later */
/* PNG with a palette, for images within drawings. The rows are differences to the row above, because the
   fields of colours are smooth. */
#include "render/files/images.h"
#include "render/files/png_memory.h"

#include <libdeflate.h>
#include <stdlib.h>
#include <string.h>

enum { LEVEL = 9, CHUNK = 12 /* bytes of a chunk besides its data */, HEAD = 13, FILTER_UP = 2 };

static void put_number(unsigned char *at, uint32_t number)
{
    for (int i = 0; i < 4; i++) {
        at[i] = (unsigned char)(number >> (24 - 8 * i));
    }
}

/* Returns the place after the chunk. */
static unsigned char *put_chunk(unsigned char *at, const char *kind, const void *bytes, size_t size)
{
    put_number(at, (uint32_t)size);
    memcpy(at + 4, kind, 4);
    if (size > 0) {
        memcpy(at + 8, bytes, size);
    }
    put_number(at + 8 + size, libdeflate_crc32(0, at + 4, size + 4));
    return at + size + CHUNK;
}

/* Returns the rows, each after its filter's number, in zlib's format; the caller frees them. */
static unsigned char *pack(const uint8_t *pixels, size_t columns, size_t rows, size_t *size)
{
    const size_t total = (columns + 1) * rows;
    unsigned char *filtered = malloc(total);
    gm_deflate_prepare();
    struct libdeflate_compressor *compressor = libdeflate_alloc_compressor(LEVEL);
    const size_t bound = compressor ? libdeflate_zlib_compress_bound(compressor, total) : 0;
    unsigned char *packed = bound ? malloc(bound) : NULL;
    *size = 0;
    if (filtered && packed) {
        for (size_t y = 0; y < rows; y++) {
            unsigned char *row = filtered + y * (columns + 1);
            row[0] = FILTER_UP;
            for (size_t x = 0; x < columns; x++) {
                const unsigned above = y > 0 ? pixels[(y - 1) * columns + x] : 0;
                row[x + 1] = (unsigned char)(pixels[y * columns + x] - above);
            }
        }
        *size = libdeflate_zlib_compress(compressor, filtered, total, packed, bound);
    }
    if (compressor) {
        libdeflate_free_compressor(compressor);
    }
    free(filtered);
    if (*size == 0) {
        free(packed);
        return NULL;
    }
    return packed;
}

unsigned char *gm_palette_png(const uint8_t *pixels, int columns, int rows,
                              const uint8_t palette[GM_PALETTE][4], size_t *size)
{
    static const unsigned char signature[8] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    unsigned char head[HEAD] = {[8] = 8 /* bits */, [9] = 3 /* palette */}, colours[GM_PALETTE][3],
                  opacities[GM_PALETTE];
    put_number(head, (uint32_t)columns);
    put_number(head + 4, (uint32_t)rows);
    for (size_t i = 0; i < GM_PALETTE; i++) {
        memcpy(colours[i], palette[i], 3);
        opacities[i] = palette[i][3];
    }
    size_t packed_size = 0;
    unsigned char *packed = pack(pixels, (size_t)columns, (size_t)rows, &packed_size);
    *size =
        sizeof signature + sizeof head + sizeof colours + sizeof opacities + packed_size + 5 * (size_t)CHUNK;
    unsigned char *png = packed ? malloc(*size) : NULL;
    if (png) {
        memcpy(png, signature, sizeof signature);
        unsigned char *at = put_chunk(png + sizeof signature, "IHDR", head, sizeof head);
        at = put_chunk(at, "PLTE", colours, sizeof colours);
        at = put_chunk(at, "tRNS", opacities, sizeof opacities);
        at = put_chunk(at, "IDAT", packed, packed_size);
        put_chunk(at, "IEND", NULL, 0);
    }
    free(packed);
    return png;
}
