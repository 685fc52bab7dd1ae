/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "app/data/column.h"
#include "render/files/deflate.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

enum { BLOCK = 1 << 14 };

static size_t block_of(uint64_t size)
{
    return size < BLOCK ? (size_t)size : BLOCK;
}

void gm_bytes_note(struct gm_bytes *bytes, bool done)
{
    bytes->why = done || bytes->why != 0 ? bytes->why : errno;
}

struct gm_bytes gm_bytes_of(int file)
{
    return (struct gm_bytes){.file = file, .why = file < 0 ? errno : 0};
}

bool gm_bytes_close(struct gm_bytes *bytes)
{
    gm_bytes_note(bytes, bytes->file < 0 || close(bytes->file) == 0);
    bytes->file = -1;
    errno = bytes->why;
    return bytes->why == 0;
}

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

void gm_bytes_write(struct gm_bytes *to, const void *bytes, size_t size, uint64_t place)
{
    if (to->why == 0) {
        gm_bytes_note(to, write_most(to->file, bytes, size, place) == size);
    }
}

void gm_bytes_read(struct gm_bytes *from, void *bytes, size_t size, uint64_t place)
{
    size_t got = 0;
    while (got < size && from->why == 0) {
        const ssize_t done = pread(from->file, (char *)bytes + got, size - got, (off_t)(place + got));
        got += done > 0 ? (size_t)done : 0;
        errno = done == 0 ? EIO : errno;
        gm_bytes_note(from, done > 0 || (done < 0 && errno == EINTR));
    }
}

void gm_bytes_sync(struct gm_bytes *bytes)
{
    gm_bytes_note(bytes, bytes->why != 0 || fsync(bytes->file) == 0);
}

void gm_bytes_truncate(struct gm_bytes *bytes, uint64_t size)
{
    gm_bytes_note(bytes, bytes->why != 0 || ftruncate(bytes->file, (off_t)size) == 0);
}

/* Reads a block, and cuts it off if `shorten`; a failure is one of the file to which it goes. */
static void fetch(struct gm_bytes *from, void *block, size_t size, uint64_t place, struct gm_bytes *to,
                  bool shorten)
{
    gm_bytes_read(from, block, size, place);
    if (shorten) {
        gm_bytes_truncate(from, place);
    }
    to->why = to->why != 0 ? to->why : from->why;
}

void gm_bytes_copy(struct gm_bytes *from, uint64_t place, uint64_t size, struct gm_bytes *to, uint64_t there,
                   uint32_t *crc)
{
    unsigned char block[BLOCK] = {0};
    struct gm_bytes *noting = to ? to : from;
    for (uint64_t at = 0; at < size && noting->why == 0; at += BLOCK) {
        const size_t part = block_of(size - at);
        fetch(from, block, part, place + at, noting, false);
        gm_bytes_write(noting, block, to ? part : 0, there + at);
        *crc = gm_deflate()->libdeflate_crc32(*crc, block, part);
    }
}

void gm_bytes_clear(struct gm_bytes *bytes, uint64_t place, uint64_t size)
{
    static const char nothing[BLOCK];
    for (uint64_t at = 0; at < size && bytes->why == 0; at += BLOCK) {
        gm_bytes_write(bytes, nothing, block_of(size - at), place + at);
    }
}

void gm_bytes_move(struct gm_bytes *from, uint64_t place, uint64_t size, struct gm_bytes *to, uint64_t there)
{
    /* the end comes last: until then there is room to spare, as blocks of the disk begin elsewhere in the two */
    unsigned char end[BLOCK], block[BLOCK];
    const bool shorten = from != to;
    const size_t last = block_of(size);
    uint64_t left = size - last;
    fetch(from, end, last, place + left, to, shorten);
    while (left > 0 && to->why == 0) {
        const size_t part = block_of(left);
        left -= part;
        fetch(from, block, part, place + left, to, shorten);
        gm_bytes_write(to, block, part, there + left);
    }
    gm_bytes_write(to, end, last, there + size - last);
}

void gm_column_open(struct gm_column *column)
{
    column->used = 0;
    column->buffer = malloc(GM_COLUMN_BUFFER);
    errno = ENOMEM;
    gm_bytes_note(column->file, column->buffer);
}

void gm_column_close(struct gm_column *column)
{
    free(column->buffer);
    column->buffer = NULL;
}

/* Writes bytes; those before a failure count, since a disk may be full in the middle. */
static void write_out(struct gm_column *column, const unsigned char *bytes, size_t size)
{
    if (!column->failed) {
        const size_t written = write_most(column->file->file, bytes, size, column->place);
        column->failed = written < size;
        gm_bytes_note(column->file, !column->failed);
        column->crc = gm_deflate()->libdeflate_crc32(column->crc, bytes, written);
        column->place += written;
    }
}

static void flush(struct gm_column *column)
{
    write_out(column, column->buffer, column->used);
    column->used = 0;
}

void gm_columns_flush(struct gm_column *columns, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        if (columns[i].buffer) {
            flush(&columns[i]);
        }
    }
}

void gm_column_put_full(struct gm_column *column, const void *bytes, size_t size)
{
    flush(column);
    if (size > GM_COLUMN_BUFFER) {
        write_out(column, bytes, size);
    } else {
        gm_column_put(column, bytes, size);
    }
}

void gm_column_put_every(struct gm_column *column, const double *numbers, size_t stride, size_t count)
{
    if (count * sizeof *numbers > GM_COLUMN_BUFFER - column->used) {
        flush(column);
    }
    unsigned char *to = column->buffer + column->used;
    for (size_t i = 0; i < count; i++) {
        memcpy(to + i * sizeof *numbers, numbers + i * stride, sizeof *numbers);
    }
    column->used += count * sizeof *numbers;
}

void gm_column_print(struct gm_column *column, const char *format, ...)
{
    char text[512];
    va_list arguments;
    va_start(arguments, format);
    const int length = vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    errno = length < 0 ? errno : EOVERFLOW;
    gm_bytes_note(column->file, length >= 0 && (size_t)length < sizeof text);
    gm_column_put(column, text, strlen(text));
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

void gm_lines_open(struct gm_column *column, struct gm_bytes *file, uint64_t lines)
{
    *column = (struct gm_column){.file = file};
    if (file->why == 0) {
        errno = EILSEQ;
        gm_bytes_note(file, count_lines(file->file, lines, &column->place) == lines &&
                                ftruncate(file->file, (off_t)column->place) == 0);
        gm_column_open(column);
    }
}

uint64_t gm_lines_cut(struct gm_column *column)
{
    const uint64_t lines = count_lines(column->file->file, UINT64_MAX, &column->place);
    column->used = 0;
    return ftruncate(column->file->file, (off_t)column->place) == 0 ? lines : 0;
}
