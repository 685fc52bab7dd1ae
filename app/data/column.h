/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_DATA_COLUMN_H
#define GM_APP_DATA_COLUMN_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* A part of a file that grows from its place on, by way of a buffer. */

struct gm_column {
    int file;       /* the caller's */
    uint64_t place; /* of what is put next, but for what is in the buffer */
    uint32_t crc;   /* the checksum (CRC-32) of what was written, and of what the caller began it with */
    unsigned char *buffer; /* NULL: closed */
    size_t used;
};

/* The buffer's size: writes of 64 KB took twice the time of these, longer ones no less. */
enum { GM_COLUMN_BUFFER = 1 << 18 };

/* Makes the buffer; false with errno. */
bool gm_column_open(struct gm_column *column);
/* Frees it, and what was put and not flushed is lost. */
void gm_column_close(struct gm_column *column);

/* Appends where there is no room in the buffer; false with errno. */
bool gm_column_put_full(struct gm_column *column, const void *bytes, size_t size);
/* Appends; false with errno. Here, since it is called for every number of a row. */
static inline bool gm_column_put(struct gm_column *column, const void *bytes, size_t size)
{
    if (size > GM_COLUMN_BUFFER - column->used) {
        return gm_column_put_full(column, bytes, size);
    }
    memcpy(column->buffer + column->used, bytes, size);
    column->used += size;
    return true;
}
/* Appends `count` numbers, `stride` of them apart, fewer than a buffer holds; false with errno. */
bool gm_column_put_every(struct gm_column *column, const double *numbers, size_t stride, size_t count);
__attribute__((format(printf, 2, 3))) bool gm_column_print(struct gm_column *column, const char *format, ...);
/* Hands all that was put to the system. False with errno: `place` is behind what was written. */
bool gm_column_flush(struct gm_column *column);

/* A column of lines goes on, or begins, behind the first `lines` of the file; false with errno, EILSEQ where
   there are not so many. */
bool gm_lines_open(struct gm_column *column, int file, uint64_t lines);
/* Cuts off what is not a whole line, after a flush that failed; how many lines there are. */
uint64_t gm_lines_cut(struct gm_column *column);

#endif
