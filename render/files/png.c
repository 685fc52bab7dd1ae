/* SPDX-License-Identifier: GPL-3.0-or-later */
/* PNG files: written to a temporary name and renamed. */
#include "render/files/images.h"
#include "render/files/png_memory.h"

#include <errno.h>
#include <fcntl.h>
#include <libdeflate.h>
#include <math.h>
#include <png.h>
#include <pthread.h>
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

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
    SIGNATURE = 8, /* bytes */
    CHECKSUM = 4,
    LEVEL = 1,
    LONGEST_CHUNK = 1 << 30, /* the format allows 2^31 - 1 */
};

static void ignore_warning(png_structp png, png_const_charp text)
{
    (void)png;
    (void)text;
}

/* The state of libpng's callbacks while it reads or writes. */
struct stream {
    FILE *file;
    int error;       /* errno of the call that failed, 0 if none did */
    char reason[96]; /* libpng's message, if libpng found the fault */
};

static void note_error(png_structp png, png_const_charp text)
{
    struct stream *stream = png_get_error_ptr(png);
    snprintf(stream->reason, sizeof stream->reason, "%s", text);
    png_longjmp(png, 1);
}

static void write_bytes(png_structp png, png_bytep bytes, size_t size)
{
    struct stream *stream = png_get_io_ptr(png);
    errno = 0;
    if (fwrite(bytes, 1, size, stream->file) != size) {
        stream->error = errno ? errno : EIO;
        png_error(png, "write error");
    }
}

/* fclose reports failures of what is left in the buffer */
static void flush_bytes(png_structp png)
{
    (void)png;
}

/* Returns the rows, each after its filter's number (0: none), in zlib's format; the caller frees them. */
static unsigned char *deflate_rows(int width, int height, const unsigned char *rgb, size_t *size)
{
    size_t row = (size_t)width * 3;
    size_t total = (row + 1) * (size_t)height;
    unsigned char *rows = malloc(total);
    gm_deflate_prepare();
    struct libdeflate_compressor *compressor = libdeflate_alloc_compressor(LEVEL);
    size_t bound = compressor ? libdeflate_zlib_compress_bound(compressor, total) : 0;
    unsigned char *packed = bound ? malloc(bound) : NULL;
    *size = 0;
    if (rows && packed) {
        for (size_t y = 0; y < (size_t)height; y++) {
            rows[y * (row + 1)] = PNG_FILTER_VALUE_NONE;
            memcpy(rows + y * (row + 1) + 1, rgb + y * row, row);
        }
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

static bool is_ascii(const char *text)
{
    for (; *text; text++) {
        if ((unsigned char)*text > 126) {
            return false;
        }
    }
    return true;
}

struct image {
    int width, height;
    double dpi; /* pixels per inch; 0: none */
    const unsigned char *packed;
    size_t packed_size;
    png_text *texts;
    int text_count;
};

/* Only the two structures outlive the jump out of libpng's errors. */
static bool write_structure(struct stream *stream, const struct image *image)
{
    png_structp png = png_create_write_struct_2(PNG_LIBPNG_VER_STRING, stream, note_error, ignore_warning,
                                                &stream->error, gm_png_take, gm_png_give_back);
    png_infop info = png ? png_create_info_struct(png) : NULL;
    if (!info) {
        png_destroy_write_struct(&png, NULL);
        stream->error = ENOMEM;
        return false;
    }
    if (setjmp(png_jmpbuf(png))) {
        png_destroy_write_struct(&png, &info);
        return false;
    }
    png_set_write_fn(png, stream, write_bytes, flush_bytes);
    png_set_user_limits(png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    png_set_IHDR(png, info, (png_uint_32)image->width, (png_uint_32)image->height, 8, PNG_COLOR_TYPE_RGB,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (image->dpi > 0) {
        const png_uint_32 per_metre = (png_uint_32)lround(image->dpi / 0.0254);
        png_set_pHYs(png, info, per_metre, per_metre, PNG_RESOLUTION_METER);
    }
    png_set_text(png, info, image->texts, image->text_count);
    png_write_info(png, info);
    for (size_t at = 0; at < image->packed_size; at += LONGEST_CHUNK) {
        size_t left = image->packed_size - at;
        png_write_chunk(png, (png_const_bytep) "IDAT", image->packed + at,
                        left < LONGEST_CHUNK ? left : LONGEST_CHUNK);
    }
    /* png_write_end fails: libpng itself has written no image data */
    png_write_chunk(png, (png_const_bytep) "IEND", NULL, 0);
    png_destroy_write_struct(&png, &info);
    return true;
}

/* Writes to the descriptor and closes it. Returns false with an errno or a reason. */
static bool write_descriptor(int descriptor, struct stream *stream, const struct image *image)
{
    stream->file = fdopen(descriptor, "wb");
    if (!stream->file) {
        stream->error = errno;
        close(descriptor);
        return false;
    }
    bool written = write_structure(stream, image);
    if (fclose(stream->file) != 0 && written) {
        stream->error = errno;
        written = false;
    }
    return written;
}

static bool write_directly(const char *path, struct stream *stream, const struct image *image)
{
    int descriptor = open(path, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (descriptor < 0) {
        stream->error = errno;
        return false;
    }
    return write_descriptor(descriptor, stream, image);
}

static bool write_aside(const char *path, struct stream *stream, const struct image *image)
{
    char *temporary = gm_temporary_name(path, ".tmp");
    int descriptor = temporary ? open(temporary, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666) : -1;
    if (descriptor < 0) {
        stream->error = temporary ? errno : ENOMEM;
        free(temporary);
        return false;
    }
    bool written = write_descriptor(descriptor, stream, image);
    if (written && rename(temporary, path) != 0) {
        stream->error = errno;
        written = false;
    }
    if (!written) {
        unlink(temporary);
    }
    free(temporary);
    return written;
}

static bool write_and_rename(const char *path, struct stream *stream, const struct image *image)
{
    /* a signal that ends the process would leave a half file; packing, which takes long, is over */
    sigset_t ends, unblocked;
    sigemptyset(&ends);
    sigaddset(&ends, SIGINT);
    sigaddset(&ends, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &ends, &unblocked);
    const bool written = write_aside(path, stream, image);
    pthread_sigmask(SIG_SETMASK, &unblocked, NULL);
    return written;
}

bool gm_png_write(const char *path, int width, int height, double dpi, const unsigned char *rgb,
                  const struct gm_png_text *texts, size_t count, char *message)
{
    if (width < 1 || height < 1 || (size_t)height > SIZE_MAX / 4 / (size_t)width) {
        return gm_temporary_refuse(message, path, "a picture has at least one pixel, and fits in memory");
    }
    struct image image = {.width = width, .height = height, .dpi = dpi, .text_count = (int)count};
    image.texts = calloc(count ? count : 1, sizeof *image.texts);
    unsigned char *packed = deflate_rows(width, height, rgb, &image.packed_size);
    if (!image.texts || !packed) {
        free(image.texts);
        free(packed);
        return gm_temporary_refuse(message, path, strerror(ENOMEM));
    }
    image.packed = packed;
    for (size_t i = 0; i < count; i++) {
        image.texts[i] = (png_text){
            .compression = is_ascii(texts[i].text) ? PNG_TEXT_COMPRESSION_NONE : PNG_ITXT_COMPRESSION_NONE,
            /* libpng's struct is not const; it copies both */
            .key = (char *)texts[i].key,
            .text = (char *)texts[i].text,
            .text_length = strlen(texts[i].text),
        };
    }
    struct stream stream = {.error = 0};
    bool written = gm_temporary_fits(path) ? write_and_rename(path, &stream, &image)
                                           : write_directly(path, &stream, &image);
    free(packed);
    free(image.texts);
    return written ||
           gm_temporary_refuse(message, path, stream.error ? strerror(stream.error) : stream.reason);
}
