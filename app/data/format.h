/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_DATA_FORMAT_H
#define GM_APP_DATA_FORMAT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "core/quantity.h"
#include "scenes/common/lane.h"

/* Bytes at places of open files, all of them or none: false with errno, of a file that is too short EIO. */

bool gm_bytes_write(int file, const void *bytes, size_t size, uint64_t place);
bool gm_bytes_read(int file, void *bytes, size_t size, uint64_t place);

/* Copies bytes to another file, none where `to` is below 0, and goes on with their checksum (CRC-32). */
bool gm_bytes_copy(int from, uint64_t place, uint64_t size, int to, uint64_t there, uint32_t *crc);

/* Zeros. */
bool gm_bytes_clear(int file, uint64_t place, uint64_t size);
/* Moves bytes to a later place of their file, which may overlap with theirs. */
bool gm_bytes_raise(int file, uint64_t place, uint64_t size, uint64_t there);
/* Moves the first bytes of a file to another one, from their end on, which the file loses as they go: no more
   room is needed on the way than before. */
bool gm_bytes_take(int from, uint64_t size, int to, uint64_t there);

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

/* NumPy's .npz: a ZIP archive of .npy files of version 1.0, not compressed, with the 64-bit records of ZIP.
   Arrays stand one behind the other in an open file; their numbers come at once, or later, into their places.
   Memory is constant but for the table of contents. All functions but one are false with errno, and then all
   that follow are. */

struct gm_npz;

enum gm_npz_type { GM_NPZ_REAL, GM_NPZ_WHOLE /* 64 bits */ };

enum { GM_NPZ_AXES = 4 };

/* Begins an archive at the start of `file`, which stays the caller's; NULL when memory is short. */
struct gm_npz *gm_npz_open(int file);
void gm_npz_close(struct gm_npz *npz);

/* The array NAME.npy with this shape. */
bool gm_npz_array(struct gm_npz *npz, const char *name, enum gm_npz_type type, const uint64_t *shape,
                  size_t axes, const void *values);

/* A text, as an array without axes. */
bool gm_npz_text(struct gm_npz *npz, const char *name, const char *text);

/* The place of an array whose numbers are the caller's to write, from *place of the file on. *crc: the checksum
   (CRC-32) of what stands before them. Nothing is written. */
bool gm_npz_reserve(struct gm_npz *npz, const char *name, enum gm_npz_type type, const uint64_t *shape,
                    size_t axes, uint64_t *place, uint32_t *crc);
/* Writes what stands before the numbers of array `index`, in the order of the archive; crc: the checksum that
   includes them. */
bool gm_npz_settle(struct gm_npz *npz, size_t index, uint32_t crc);
/* The same for an array of which only the first `length` along its first axis are there: what is missing stays
   a gap behind it. */
bool gm_npz_shorten(struct gm_npz *npz, size_t index, uint64_t length);

/* Where the next array would begin: the bytes of the archive without its table of contents. */
uint64_t gm_npz_size(const struct gm_npz *npz);

/* Takes the arrays of another archive, whose bytes the caller put behind those of this one. */
bool gm_npz_include(struct gm_npz *npz, const struct gm_npz *other);

/* Writes the table of contents, and cuts the file off behind it. */
bool gm_npz_finish(struct gm_npz *npz);

/* How long the first array of a file is along its first axis; 0: it does not begin with an array. */
uint64_t gm_npz_length(int file);

/* What a file is made of while it is made: a folder FILE.part beside it, which one process holds at a time,
   with a file a lane. */

struct gm_part;

/* Makes the folder, or with go_on takes it as an earlier process left it. NULL with a sentence (GM_MESSAGE
   bytes): it cannot be made, is not there to go on with, or another process holds it. */
struct gm_part *gm_part_open(const char *path, bool go_on, char *message);
/* Leaves the folder to be gone on with, or removes it. */
void gm_part_close(struct gm_part *part, bool remove);

/* Gives a folder that was just made a number of its own, on the disk when this returns: by it a checkpoint knows
   later that its rows are here, and not those of another run to the same file. False with errno. */
bool gm_part_sign(struct gm_part *part);
/* That number; 0: it has none. */
uint64_t gm_part_identity(const struct gm_part *part);

/* A lane's file, for reading and writing; or an empty one that is begun to be it, which it is once it is taken: the one
   before stays until then. -1 with errno. */
int gm_part_file(const struct gm_part *part, size_t lane, bool begun);
bool gm_part_take(const struct gm_part *part, size_t lane);
/* Removes what was begun, or the lane's file. */
void gm_part_drop(const struct gm_part *part, size_t lane, bool begun);
/* Renames a lane's file: it is now the file that was to be made. False with errno. */
bool gm_part_publish(const struct gm_part *part, size_t lane, const char *path);

/* How many bytes a file in the folder may have that has `own` bytes of the disk already: as the disk and the
   limits of the process are now. */
uint64_t gm_part_capacity(const struct gm_part *part, uint64_t own);

/* What a format does with the states of lanes: rows to the lanes' files, and these to the file. */

enum { GM_COLUMNS = GM_QUANTITIES + 1 };

/* A lane of the file: what there is of it, and its columns while it runs. */
struct gm_saved {
    size_t index; /* of the lane */
    struct gm_quantity quantities[GM_QUANTITIES];
    size_t sizes[GM_QUANTITIES]; /* how many numbers each has (gm_quantity_size) */
    size_t count, members;
    uint64_t rows;
    int file; /* in the part; -1: closed */
    struct gm_column columns[GM_COLUMNS];
    double *scratch;  /* room for the longest quantity that is derived; NULL once the lane has ended */
    char *meta;       /* JSON: what was run; of a lane that has ended */
    size_t meta_size; /* bytes that it will have, about */
    uint64_t size;    /* bytes of its file that belong to it; of a lane that has ended */
    uint64_t heads;   /* of .csv: lines before the rows */
    /* of .npz */
    bool plain; /* every row is the numbers of the state, one a column */
    struct gm_npz *npz;
    uint64_t capacity, starts[GM_COLUMNS]; /* rows that there is room for; where the columns begin */
};

struct gm_saving {
    const char *path;   /* of the file */
    const char *folder; /* the path without its ending: of the files beside it */
    const struct gm_part *part;
    struct gm_saved *lanes; /* `begun` of them are there */
    size_t begun, count;
    bool kept; /* there is a checkpoint: what it counts of the parts is to stay as it is */
};

/* A format's functions are false with errno. */
struct gm_data_format {
    const char *ending;
    /* Opens the lane's file, with as many rows as it has already; `expected`: how many there will be, 0 where
       that is not known. */
    bool (*begin)(const struct gm_saving *saving, struct gm_saved *lane, const struct gm_run *run,
                  uint64_t expected);
    bool (*row)(const struct gm_saving *saving, struct gm_saved *lane, const struct gm_run *run);
    /* Many rows at once, of a lane that is plain, which it counts itself (gm_save_rows). NULL: never. */
    bool (*rows)(const struct gm_saving *saving, struct gm_saved *lane, const struct gm_run *run,
                 const double *rows, size_t count);
    /* After a write that failed, and a flush of all columns: lane->rows is how many there are. */
    void (*cut)(const struct gm_saving *saving, struct gm_saved *lane);
    /* The lane is over, and has its meta; what was put was flushed. */
    bool (*end)(const struct gm_saving *saving, struct gm_saved *lane);
    /* Makes the file of the lanes, now and then while rows come, too. NULL: it is their files one behind the
       other, and then what `finish`, if there is one, writes behind those of the first `lanes`. */
    bool (*list)(const struct gm_saving *saving, FILE *file);
    /* ... and gives back the room of the last rows of a lane that has ended; false: of all but the first. */
    bool (*drop)(const struct gm_saving *saving, struct gm_saved *lane);
    bool (*finish)(const struct gm_saving *saving, size_t lanes, int file);
    /* A sentence why these two lanes cannot be in one file of this format, or NULL; NULL: all can, always. */
    const char *(*refuse)(const struct gm_run *one, const struct gm_run *other);
};

extern const struct gm_data_format gm_data_format_npz, gm_data_format_csv, gm_data_format_pvd,
    gm_data_format_xdmf;

#endif
