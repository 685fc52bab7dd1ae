/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Bytes at places of open files; parts of files that grow, and those that are lines. */
#include "app/data/column.h"

#include <errno.h>
#include <libdeflate.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

enum { BLOCK = 1 << 18, SMALL_BLOCK = 1 << 14 /* without malloc */ };

/* Writes as many of the bytes as possible and returns their number; sets errno if it is not all. */
static size_t write_most(int file, const void *bytes, size_t size, uint64_t place)
{
    size_t written = 0;
    while (written < size) {
        const ssize_t done =
            pwrite(file, (const char *)bytes + written, size - written, (off_t)(place + written));
        if (done < 0 && errno == EINTR) {
            continue;
        }
        if (done <= 0) {
            break;
        }
        written += (size_t)done;
    }
    return written;
}

bool gm_bytes_write(int file, const void *bytes, size_t size, uint64_t place)
{
    return write_most(file, bytes, size, place) == size;
}

bool gm_bytes_read(int file, void *bytes, size_t size, uint64_t place)
{
    char *to = bytes;
    while (size > 0) {
        const ssize_t done = pread(file, to, size, (off_t)place);
        if (done < 0 && errno == EINTR) {
            continue;
        }
        if (done <= 0) {
            errno = done == 0 ? EIO : errno;
            return false;
        }
        to += done;
        size -= (size_t)done;
        place += (uint64_t)done;
    }
    return true;
}

bool gm_bytes_copy(int from, uint64_t place, uint64_t size, int to, uint64_t there, uint32_t *crc)
{
    unsigned char *block = malloc(BLOCK);
    bool good = block != NULL;
    errno = good ? errno : ENOMEM;
    for (uint64_t at = 0; at < size && good;) {
        const size_t part = size - at < BLOCK ? (size_t)(size - at) : BLOCK;
        good = gm_bytes_read(from, block, part, place + at) &&
               (to < 0 || gm_bytes_write(to, block, part, there + at));
        *crc = libdeflate_crc32(*crc, block, part);
        at += part;
    }
    free(block);
    return good;
}

bool gm_bytes_clear(int file, uint64_t place, uint64_t size)
{
    static const char nothing[SMALL_BLOCK];
    bool good = true;
    for (uint64_t at = 0; at < size && good; at += SMALL_BLOCK) {
        good = gm_bytes_write(file, nothing, size - at < SMALL_BLOCK ? (size_t)(size - at) : SMALL_BLOCK,
                              place + at);
    }
    return good;
}

/* Moves blocks from the end and truncates the source after each. */
static bool move(int from, uint64_t place, uint64_t size, int to, uint64_t there, bool shorten)
{
    unsigned char block[SMALL_BLOCK];
    bool good = true;
    while (size > 0 && good) {
        const size_t part = size < SMALL_BLOCK ? (size_t)size : SMALL_BLOCK;
        size -= part;
        good = gm_bytes_read(from, block, part, place + size) &&
               (!shorten || ftruncate(from, (off_t)(place + size)) == 0) &&
               gm_bytes_write(to, block, part, there + size);
    }
    return good;
}

bool gm_bytes_raise(int file, uint64_t place, uint64_t size, uint64_t there)
{
    return move(file, place, size, file, there, false);
}

bool gm_bytes_take(int from, uint64_t size, int to, uint64_t there)
{
    /* the end comes last: until then there is room to spare, as blocks of the disk begin elsewhere in the two */
    unsigned char end[SMALL_BLOCK];
    const size_t part = size < SMALL_BLOCK ? (size_t)size : SMALL_BLOCK;
    size -= part;
    return gm_bytes_read(from, end, part, size) && ftruncate(from, (off_t)size) == 0 &&
           move(from, 0, size, to, there, true) && gm_bytes_write(to, end, part, there + size);
}

bool gm_column_open(struct gm_column *column)
{
    column->used = 0;
    column->buffer = malloc(GM_COLUMN_BUFFER);
    errno = column->buffer ? errno : ENOMEM;
    return column->buffer != NULL;
}

void gm_column_close(struct gm_column *column)
{
    free(column->buffer);
    column->buffer = NULL;
}

/* Writes bytes; those before a failure count, since a disk may be full in the middle. */
static bool write_out(struct gm_column *column, const unsigned char *bytes, size_t size)
{
    const size_t written = write_most(column->file, bytes, size, column->place);
    column->crc = libdeflate_crc32(column->crc, bytes, written);
    column->place += written;
    return written == size;
}

bool gm_column_flush(struct gm_column *column)
{
    const size_t used = column->used;
    column->used = 0;
    return write_out(column, column->buffer, used);
}

bool gm_column_put_full(struct gm_column *column, const void *bytes, size_t size)
{
    return gm_column_flush(column) &&
           (size > GM_COLUMN_BUFFER ? write_out(column, bytes, size) : gm_column_put(column, bytes, size));
}

bool gm_column_put_every(struct gm_column *column, const double *numbers, size_t stride, size_t count)
{
    if (count * sizeof *numbers > GM_COLUMN_BUFFER - column->used && !gm_column_flush(column)) {
        return false;
    }
    unsigned char *to = column->buffer + column->used;
    for (size_t i = 0; i < count; i++) {
        memcpy(to + i * sizeof *numbers, numbers + i * stride, sizeof *numbers);
    }
    column->used += count * sizeof *numbers;
    return true;
}

bool gm_column_print(struct gm_column *column, const char *format, ...)
{
    char text[512];
    va_list arguments;
    va_start(arguments, format);
    const int length = vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    return length >= 0 && (size_t)length < sizeof text && gm_column_put(column, text, (size_t)length);
}

/* The number of lines of a file, `most` at most, and the end of the last one. */
static uint64_t count_lines(int file, uint64_t most, uint64_t *end)
{
    char block[1 << 14];
    uint64_t lines = 0, at = 0;
    ssize_t got = 0;
    *end = 0;
    while (lines < most && (got = pread(file, block, sizeof block, (off_t)at)) > 0) {
        for (ssize_t i = 0; i < got && lines < most; i++) {
            if (block[i] == '\n') {
                lines++;
                *end = at + (uint64_t)i + 1;
            }
        }
        at += (uint64_t)got;
    }
    return lines;
}

bool gm_lines_open(struct gm_column *column, int file, uint64_t lines)
{
    *column = (struct gm_column){.file = file};
    if (count_lines(file, lines, &column->place) < lines) {
        errno = EILSEQ;
        return false;
    }
    return ftruncate(file, (off_t)column->place) == 0 && gm_column_open(column);
}

uint64_t gm_lines_cut(struct gm_column *column)
{
    const uint64_t lines = count_lines(column->file, UINT64_MAX, &column->place);
    column->used = 0;
    return ftruncate(column->file, (off_t)column->place) == 0 ? lines : 0;
}
