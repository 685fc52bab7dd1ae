/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_DATA_FORMAT_H
#define GM_APP_DATA_FORMAT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "app/data/column.h"
#include "core/quantity.h"
#include "scenes/common/lane.h"

/* NumPy's .npz: a ZIP archive of .npy files of version 1.0, not compressed, with the 64-bit records of
   ZIP. Arrays follow each other in an open file; their numbers are written at once or later. Memory is
   constant except for the table of contents. The file notes failures. */

struct gm_npz_entry;

struct gm_npz { /* {.file = ...} begins an archive at the start of the file, which the caller closes */
    struct gm_bytes *file;
    struct gm_npz_entry *entries;
    size_t count, capacity;
    uint64_t place; /* the offset of the next array: the bytes without the table of contents */
};

/* Frees the table of contents. */
void gm_npz_close(struct gm_npz *npz);

enum gm_npz_type { GM_NPZ_REAL, GM_NPZ_WHOLE /* 64 bits */, GM_NPZ_LETTER /* gm_npz_text */ };

enum { GM_NPZ_AXES = 4 };

/* The numbers of an array: their type, and its length along each axis. */
struct gm_npz_shape {
    enum gm_npz_type type;
    size_t axes;
    uint64_t lengths[GM_NPZ_AXES];
};

/* The array NAME.npy with this shape. */
void gm_npz_array(struct gm_npz *npz, const char *name, const struct gm_npz_shape *shape, const void *values);

/* A text, as an array without axes. */
void gm_npz_text(struct gm_npz *npz, const char *name, const char *text);

/* Reserves an array, and returns the offset from which on the caller writes its numbers. *crc: the checksum
   (CRC-32) of the bytes before them. Writes nothing. */
uint64_t gm_npz_reserve(struct gm_npz *npz, const char *name, const struct gm_npz_shape *shape,
                        uint32_t *crc);
/* Writes the head of array `index`, in the order of the archive; crc: the checksum including the numbers. */
void gm_npz_settle(struct gm_npz *npz, size_t index, uint32_t crc);
/* The same for an array with only its first `length` entries along its first axis; the rest stays a gap
   after it. */
void gm_npz_shorten(struct gm_npz *npz, size_t index, uint64_t length);

/* Takes the arrays of another archive, whose bytes the caller has put after its own. */
void gm_npz_include(struct gm_npz *npz, const struct gm_npz *other);

/* Writes the table of contents, and cuts the file off after it. */
void gm_npz_finish(struct gm_npz *npz);

/* The length of a file's first array along its first axis; 0: it does not begin with an array. */
uint64_t gm_npz_length(int file);

/* The parts of an incomplete file: a folder FILE.part beside it with one file per lane, locked by one
   process. */

struct gm_part;

/* Makes the folder, or with go_on opens the one of an earlier process. Returns NULL with a sentence
   (GM_MESSAGE bytes) if it cannot be made, is missing, or another process has locked it. */
struct gm_part *gm_part_open(const char *path, bool go_on, char *message);
/* Closes the folder, and removes it if `remove`; else a later process can resume it. */
void gm_part_close(struct gm_part *part, bool remove);

/* Gives a new folder an identity, on the disk when this returns: with it a checkpoint recognises its rows,
   and not those of another run to the same file. Returns false with errno. */
bool gm_part_sign(struct gm_part *part);
/* The folder's identity; 0: it has none. */
uint64_t gm_part_identity(const struct gm_part *part);

/* A lane's file, for reading and writing; or, with `begun`, an empty file that replaces it in
   gm_part_take. Returns -1 with errno. */
int gm_part_file(const struct gm_part *part, size_t lane, bool begun);
bool gm_part_take(const struct gm_part *part, size_t lane);
/* Removes the lane's file or, with `begun`, its replacement. */
void gm_part_drop(const struct gm_part *part, size_t lane, bool begun);
/* Renames a lane's file to the path of the complete file. Returns false with errno. */
bool gm_part_publish(const struct gm_part *part, size_t lane, const char *path);

/* The largest size, in bytes, of a file in the folder that already has `own` bytes of the disk; by the
   disk and the limits of the process at this moment. */
uint64_t gm_part_capacity(const struct gm_part *part, uint64_t own);

/* A format's functions for the states of lanes: from rows to the lanes' files, and from these to the file. */

enum { GM_COLUMNS = GM_QUANTITIES + 1 };

/* The archive of an .npz file of one lane. */
struct gm_npz_layout {
    struct gm_npz npz;
    uint64_t capacity, starts[GM_COLUMNS]; /* rows that have room; offsets of the columns */
    uint32_t crcs[GM_COLUMNS];             /* checksums of the bytes before the columns' numbers */
};

/* A lane of the file: its rows so far, and its columns while it runs. */
struct gm_saved {
    size_t index;
    struct gm_quantity quantities[GM_QUANTITIES];
    size_t sizes[GM_QUANTITIES]; /* numbers per row of each quantity (gm_quantity_size) */
    size_t count, members;
    uint64_t rows;
    struct gm_bytes file; /* the lane's file in the part, which notes all failures */
    struct gm_column columns[GM_COLUMNS];
    double *scratch;  /* room for the longest derived quantity; NULL once the lane has ended */
    char *meta;       /* the run as JSON, once the lane has ended */
    size_t meta_size; /* approximate size of meta, in bytes */
    uint64_t size;    /* the lane's bytes of its file, once the lane has ended */
    uint64_t heads;   /* lines before the rows of .csv */
    /* the fields of .npz */
    bool plain; /* every row is the numbers of the state, one per column */
    struct gm_npz_layout layout;
};

struct gm_saving {
    const char *path;
    char *folder; /* the path without its ending, for the files beside it */
    const struct gm_part *part;
    struct gm_saved *lanes; /* the first `begun` have begun */
    size_t begun, count;
    bool kept; /* there is a checkpoint: rows that it counts must not change */
};

/* The lane's file notes failures, which are reported. Functions that return a bool are false with errno. */
struct gm_data_format {
    const char *ending;
    bool pictures; /* for VTK: forms as values at points and cells */
    /* Opens the lane's file with its existing rows; `expected`: the expected number of rows, 0 if it is not
       known. */
    void (*begin)(const struct gm_saving *saving, struct gm_saved *lane, const struct gm_run *run,
                  uint64_t expected);
    void (*row)(const struct gm_saving *saving, struct gm_saved *lane, const struct gm_run *run);
    /* Adds and counts many rows of a plain lane (gm_save_rows). NULL: never. */
    void (*rows)(const struct gm_saving *saving, struct gm_saved *lane, const struct gm_run *run,
                 const double *rows, size_t count);
    /* Sets lane->rows to the number of whole rows, after a failed write and a flush of all columns. */
    void (*cut)(const struct gm_saving *saving, struct gm_saved *lane);
    /* Ends the lane, which has its meta; all columns have been flushed. NULL: the first column is all of it. */
    void (*end)(const struct gm_saving *saving, struct gm_saved *lane);
    /* Makes the file of the lanes, also from time to time during the run. NULL: the file is the lanes' files
       one after the other, and then the text of `finish`, if there is one, for the first `lanes`. */
    bool (*list)(const struct gm_saving *saving, FILE *file);
    /* Frees the room of the last rows of a lane that has ended; false if only its first row is left. */
    bool (*drop)(const struct gm_saving *saving, struct gm_saved *lane);
    void (*finish)(const struct gm_saving *saving, size_t lanes, struct gm_bytes *file);
    /* The reason why these two lanes cannot be in one file of this format, or NULL; NULL: all can, always. */
    const char *(*refuse)(const struct gm_run *one, const struct gm_run *other);
};

extern const struct gm_data_format gm_data_format_npz, gm_data_format_csv, gm_data_format_pvd,
    gm_data_format_xdmf;

#endif
