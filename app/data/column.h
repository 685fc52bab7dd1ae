/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Bytes at places of open files; parts of files that grow, and those that are lines. */
#ifndef GM_APP_DATA_COLUMN_H
#define GM_APP_DATA_COLUMN_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* An open file, and errno of its first failure, or 0; no byte is written after it. */
struct gm_bytes {
    int file; /* -1: closed */
    int why;
};

/* A file as open returned it: a negative one has failed with errno. */
struct gm_bytes gm_bytes_of(int file);
/* Closes the file, if there is one. Returns true if nothing has failed; else false with errno. */
bool gm_bytes_close(struct gm_bytes *bytes);
/* Notes errno if there is no earlier failure and `done` is false. */
void gm_bytes_note(struct gm_bytes *bytes, bool done);

/* Bytes at places; a file that is too short fails with EIO. */
void gm_bytes_write(struct gm_bytes *to, const void *bytes, size_t size, uint64_t place);
void gm_bytes_read(struct gm_bytes *from, void *bytes, size_t size, uint64_t place);

/* Copies bytes to another file, which notes failures, unless `to` is NULL, and updates their checksum (CRC-32). */
void gm_bytes_copy(struct gm_bytes *from, uint64_t place, uint64_t size, struct gm_bytes *to, uint64_t there,
                   uint32_t *crc);

void gm_bytes_sync(struct gm_bytes *bytes);
void gm_bytes_truncate(struct gm_bytes *bytes, uint64_t size);
/* Zeros. */
void gm_bytes_clear(struct gm_bytes *bytes, uint64_t place, uint64_t size);
/* Moves bytes to a later place of their file, which may overlap with theirs, or the first bytes of a file to
   another one, which notes failures. They are moved from their end, and the other file is truncated block by
   block: the move needs no more room. */
void gm_bytes_move(struct gm_bytes *from, uint64_t place, uint64_t size, struct gm_bytes *to, uint64_t there);

/* A part of a file that grows from its offset on, through a buffer. */

struct gm_column {
    struct gm_bytes *file; /* the caller closes it */
    bool failed;           /* true: bytes before the next ones are missing, so these are not written */
    uint64_t place;        /* the offset of the next byte, without the buffer */
    uint32_t crc;          /* the checksum (CRC-32) of the written bytes, continued from the caller's value */
    unsigned char *buffer; /* NULL: closed */
    size_t used;
};

/* The buffer's size: writes of 64 KB took twice the time of these, longer ones no less. */
enum { GM_COLUMN_BUFFER = 1 << 18 };

/* Makes the buffer. */
void gm_column_open(struct gm_column *column);
/* Frees the buffer; bytes that are not flushed are lost. */
void gm_column_close(struct gm_column *column);

/* Appends bytes for which the buffer has no room. */
void gm_column_put_full(struct gm_column *column, const void *bytes, size_t size);
/* Appends. It is inline since it is called for every number of a row. */
static inline void gm_column_put(struct gm_column *column, const void *bytes, size_t size)
{
    if (size > GM_COLUMN_BUFFER - column->used) {
        gm_column_put_full(column, bytes, size);
    } else {
        memcpy(column->buffer + column->used, bytes, size);
        column->used += size;
    }
}
/* Appends `count` numbers, `stride` of them apart, fewer than a buffer holds. */
void gm_column_put_every(struct gm_column *column, const double *numbers, size_t stride, size_t count);
__attribute__((format(printf, 2, 3))) void gm_column_print(struct gm_column *column, const char *format, ...);
/* Writes the buffers of columns that are open; `place` is then after the written bytes. */
void gm_columns_flush(struct gm_column *columns, size_t count);

/* Opens a column of lines after the first `lines` of the file; EILSEQ if it has fewer. */
void gm_lines_open(struct gm_column *column, struct gm_bytes *file, uint64_t lines);
/* Removes an incomplete line, after a flush that failed; returns the number of lines. */
uint64_t gm_lines_cut(struct gm_column *column);

#endif
