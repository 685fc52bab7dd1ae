/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Parts of files that grow; those that are lines. */
#include "app/data/column.h"

#include <errno.h>
#include <libdeflate.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "app/data/bytes.h"

bool gm_column_open(struct gm_column *column)
{
    column->used = 0;
    column->failure = 0;
    column->buffer = malloc(GM_COLUMN_BUFFER);
    column->full = malloc(GM_COLUMN_BUFFER);
    if (column->buffer && column->full) {
        return true;
    }
    gm_column_close(column);
    errno = ENOMEM;
    return false;
}

void gm_column_close(struct gm_column *column)
{
    gm_beside_end(&column->writing);
    free(column->buffer);
    free(column->full);
    column->buffer = column->full = NULL;
}

/* Of a write that fails, what comes before the failure counts: a disk may be full in the middle. */
static bool write_out(struct gm_column *column, const unsigned char *bytes, size_t size)
{
    const size_t written = gm_bytes_write_most(column->file, bytes, size, column->place);
    column->crc = libdeflate_crc32(column->crc, bytes, written);
    column->place += written;
    return written == size;
}

static void write_full(void *data)
{
    struct gm_column *column = data;
    column->failure = write_out(column, column->full, column->full_used) ? 0 : errno;
}

/* Waits for the other core. After a failure what is in the buffer would leave a hole: it is dropped. */
static bool settle(struct gm_column *column)
{
    gm_beside_end(&column->writing);
    if (column->failure != 0) {
        errno = column->failure;
        column->failure = 0;
        column->used = 0;
        return false;
    }
    return true;
}

bool gm_column_flush(struct gm_column *column)
{
    if (!settle(column)) {
        return false;
    }
    const size_t used = column->used;
    column->used = 0;
    return write_out(column, column->buffer, used);
}

bool gm_column_put_full(struct gm_column *column, const void *bytes, size_t size)
{
    if (size > GM_COLUMN_BUFFER) {
        return gm_column_flush(column) && write_out(column, bytes, size);
    }
    if (!settle(column)) {
        return false;
    }
    unsigned char *const full = column->buffer;
    column->full_used = column->used;
    column->buffer = column->full;
    column->full = full;
    column->used = 0;
    column->writing = (struct gm_beside){.work = write_full, .data = column};
    gm_beside_begin(&column->writing, false);
    return gm_column_put(column, bytes, size);
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
