/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_DATA_NPZ_H
#define GM_APP_DATA_NPZ_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

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

#endif
