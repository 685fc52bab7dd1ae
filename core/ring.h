/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_RING_H
#define GM_CORE_RING_H

#include <complex.h>
#include <stdbool.h>
#include <stddef.h>

/* Linear systems that look the same at every point of a ring of `count` points: circulant band matrices,
   solved in a time proportional to count, whatever its factors, by sweeps of recursions that only damp. */

/* (off f_{i-1} + diagonal f_i + off f_{i+1}) = b_i, diagonal > 2 |off|. */
struct gm_ring {
    size_t count;
    double scale, root; /* of the factors scale (1 - root z) (1 - root / z), z the shift by a point */
};
struct gm_ring gm_ring_make(size_t count, double diagonal, double off);
/* Replaces b by the solution. */
void gm_ring_solve(const struct gm_ring *ring, double *b);

/* Replaces b by f with (f_i + f_{i+1})/2 = b_i. On an even number of points the alternating part of b is left
   out, and f has none: where b has one there is no solution. */
void gm_ring_unaverage(double *b, size_t count);

/* scale (z - roots[0]) (z - roots[1]) ... f = b for complex b, (z f)_i = f_{i+1}; no root on the unit circle.
 */
enum { GM_RING_ROOTS = 3 };
struct gm_ring_roots {
    size_t count;
    double complex scale, roots[GM_RING_ROOTS];
    int number;
};
/* The matrix a0 ((1+z)/2)^p + a1 ((z-1)/h)^p, p = 1, 2 or 3; false where it is singular or nearly so. */
bool gm_ring_roots_make(struct gm_ring_roots *ring, size_t count, int power, double complex mean,
                        double complex difference, double h);
/* Replaces b (re and im apart) by the solution; scratch has room for 2 count numbers. */
void gm_ring_roots_solve(const struct gm_ring_roots *ring, double *re, double *im, double *scratch);

#endif
