/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_LINEAR_RING_RING_H
#define GM_CORE_LINEAR_RING_RING_H

#include <stdbool.h>
#include <stddef.h>

#include "core/linear/banded.h"

/* Linear systems around a ring of `count` points, solved in a time proportional to count whatever its
   factors: circulant band matrices, which look the same at every point, by sweeps of recursions that only
   damp, and others by elimination. */

/* (off f_{i-1} + diagonal f_i + off f_{i+1}) = b_i, diagonal > 2 |off|. */
struct gm_ring {
    size_t count;
    double scale, root; /* factors scale (1 - root z) (1 - root / z), z the shift by a point */
};
struct gm_ring gm_ring_make(size_t count, double diagonal, double off);
/* Replaces b by the solution. */
void gm_ring_solve(const struct gm_ring *ring, double *b);

/* scale (z - roots[0]) (z - roots[1]) ... f = b for complex b, (z f)_i = f_{i+1}; no root on the unit
   circle. */
enum { GM_RING_ROOTS = 3 };
struct gm_ring_roots {
    size_t count;
    double _Complex scale, roots[GM_RING_ROOTS];
    int number;
};
/* The matrix a0 ((1+z)/2)^p + a1 ((z-1)/h)^p, p = 1, 2 or 3. Returns false if it is singular or nearly so. */
bool gm_ring_roots_make(struct gm_ring_roots *ring, size_t count, int power, double _Complex mean,
                        double _Complex difference, double h);
/* Replaces b (re and im apart) by the solution; scratch has room for 2 count numbers. */
void gm_ring_roots_solve(const struct gm_ring_roots *ring, double *re, double *im, double *scratch);

/* A matrix whose entries differ from point to point: `parts` unknowns at each, and no entry between points
   more than `reach` apart. Its memory is touched at the first use. */
struct gm_ring_band {
    size_t count, parts;
    struct gm_banded folded;
    double *right; /* a right side in the folded order */
};
/* Returns false when out of memory; then nothing is allocated. */
bool gm_ring_band_open(struct gm_ring_band *band, size_t count, size_t parts, size_t reach);
void gm_ring_band_close(void *band); /* for arenas too */
/* All entries := 0. */
void gm_ring_band_clear(struct gm_ring_band *band);
/* Adds to the entry of a row at `point` and a column `by` points on. */
void gm_ring_band_add(struct gm_ring_band *band, size_t point, size_t row_part, long by, size_t column_part,
                      double value);
/* Replaces the matrix by its factors. Returns false if it is singular. */
bool gm_ring_band_factor(struct gm_ring_band *band);
/* Replaces b, [part * count + point], by the solution. */
void gm_ring_band_solve(struct gm_ring_band *band, double *b);

#endif
