/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_DATA_NPZ_H
#define GM_APP_DATA_NPZ_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* NumPy's .npz: a ZIP archive of .npy files of version 1.0, not compressed, with the 64-bit records of ZIP
   where a size or a place needs them. Written in one pass over a file that can be sought in, in constant
   memory but for the table of contents. */

struct gm_npz;

enum gm_npz_type { GM_NPZ_REAL, GM_NPZ_WHOLE /* 64 bits */ };

enum { GM_NPZ_AXES = 4 };

/* Begins an archive at the start of `file`, which stays the caller's; NULL when memory is short. */
struct gm_npz *gm_npz_open(FILE *file);

/* The array NAME.npy with this shape, its numbers from memory or, where values is NULL, from the start of the
   open file `source`. False with errno. */
bool gm_npz_array(struct gm_npz *npz, const char *name, enum gm_npz_type type, const uint64_t *shape,
                  size_t axes, const void *values, int source);

/* A text, as an array without axes. */
bool gm_npz_text(struct gm_npz *npz, const char *name, const char *text);

/* Writes the table of contents, if all went well, and frees. False with errno. */
bool gm_npz_close(struct gm_npz *npz);

#endif
