/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_DATA_COLUMN_H
#define GM_APP_DATA_COLUMN_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* Bytes at places of open files, all or none: return false with errno, EIO for a file that is too short. */

bool gm_bytes_write(int file, const void *bytes, size_t size, uint64_t place);
bool gm_bytes_read(int file, void *bytes, size_t size, uint64_t place);

/* Copies bytes to another file, unless `to` is negative, and updates their checksum (CRC-32). */
bool gm_bytes_copy(int from, uint64_t place, uint64_t size, int to, uint64_t there, uint32_t *crc);

/* Zeros. */
bool gm_bytes_clear(int file, uint64_t place, uint64_t size);
/* Moves bytes to a later place of their file, which may overlap with theirs. */
bool gm_bytes_raise(int file, uint64_t place, uint64_t size, uint64_t there);
/* Moves the first bytes of a file to another one, from their end, and truncates the file block by block:
   the move needs no more room. */
bool gm_bytes_take(int from, uint64_t size, int to, uint64_t there);

/* A part of a file that grows from its offset on, through a buffer. */

struct gm_column {
    int file;              /* the file; the caller closes it */
    uint64_t place;        /* the offset of the next byte, without the buffer */
    uint32_t crc;          /* the checksum (CRC-32) of the written bytes, continued from the caller's value */
    unsigned char *buffer; /* NULL: closed */
    size_t used;
};

/* The buffer's size: writes of 64 KB took twice the time of these, longer ones no less. */
enum { GM_COLUMN_BUFFER = 1 << 18 };

/* Makes the buffer; false with errno. */
bool gm_column_open(struct gm_column *column);
/* Frees the buffer; bytes that are not flushed are lost. */
void gm_column_close(struct gm_column *column);

/* Appends bytes for which the buffer has no room; false with errno. */
bool gm_column_put_full(struct gm_column *column, const void *bytes, size_t size);
/* Appends; false with errno. It is inline since it is called for every number of a row. */
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
/* Writes the buffer. Returns false with errno: `place` is then after the written bytes. */
bool gm_column_flush(struct gm_column *column);

/* Opens a column of lines after the first `lines` of the file; false with errno, EILSEQ if it has fewer. */
bool gm_lines_open(struct gm_column *column, int file, uint64_t lines);
/* Removes an incomplete line, after a flush that failed; returns the number of lines. */
uint64_t gm_lines_cut(struct gm_column *column);

#endif
