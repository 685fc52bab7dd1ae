/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_DATA_PART_H
#define GM_APP_DATA_PART_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

/* What a file is made of while it is made: a folder FILE.part beside it, which one process holds at a time,
   with files that only grow, the columns of the lanes. */

struct gm_part;

/* Makes the folder, or with go_on takes it as an earlier process left it. NULL with a sentence (GM_MESSAGE
   bytes): it cannot be made, is not there to go on with, or another process holds it. */
struct gm_part *gm_part_open(const char *path, bool go_on, char *message);
/* Leaves the folder to be gone on with, or removes it. */
void gm_part_close(struct gm_part *part, bool remove);

struct gm_column {
    int file;
    unsigned char *buffer; /* NULL: closed */
    size_t used;
};

/* Opens the column with its first `rows` rows, of row_size bytes each or, with 0, lines; what follows is cut
   off. False with errno; a column that is shorter has EILSEQ. */
bool gm_column_open(const struct gm_part *part, size_t lane, size_t index, uint64_t rows, size_t row_size,
                    struct gm_column *column);
/* Of every column; writes of 64 KB took twice the time of these, longer ones no less. */
enum { GM_COLUMN_BUFFER = 1 << 18 };

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
__attribute__((format(printf, 2, 3))) bool gm_column_print(struct gm_column *column, const char *format, ...);
/* Hands all that was put to the system, with `sync` to the disk. */
bool gm_column_flush(struct gm_column *column, bool sync);
/* Flushes and closes. */
bool gm_column_close(struct gm_column *column);
/* A finished column, open for reading; -1 with errno. */
int gm_column_read(const struct gm_part *part, size_t lane, size_t index);
/* Copies one to `file` at its present place. False with errno. */
bool gm_column_copy(const struct gm_part *part, size_t lane, size_t index, FILE *file);

#endif
