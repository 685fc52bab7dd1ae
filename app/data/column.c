/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Parts of files that grow; those that are lines. */
#include "app/data/format.h"

#include <errno.h>
#include <libdeflate.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

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

/* Of a write that fails, what comes before the failure counts: a disk may be full in the middle. */
static bool write_out(struct gm_column *column, const unsigned char *bytes, size_t size)
{
    const size_t written = gm_bytes_write_most(column->file, bytes, size, column->place);
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

/* How many lines a file has, `most` at most, and where the last of them ends. */
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
