/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_LINEAR_RING_BLOCKS_H
#define GM_CORE_LINEAR_RING_BLOCKS_H

#include <stdbool.h>
#include <stddef.h>

/* B y_i + C y_{i+1} = g_i around a ring, n unknowns at each of `count` points and the same small matrices
   everywhere, by sweeps of recursions that only damp. */
enum { GM_RING_BLOCKS_MOST = 12 };
struct gm_ring_blocks {
    size_t count, n, roots;
    /* root[k] is a real root or one of a pair: its value, the number of terms of a sweep, its weights in g
       (left) and in y (right). */
    struct gm_ring_block_root {
        double _Complex value, closed;
        bool real;
        size_t reach;
        double _Complex left[GM_RING_BLOCKS_MOST], right[GM_RING_BLOCKS_MOST];
    } root[GM_RING_BLOCKS_MOST];
};

/* b and c are n * n, row by row. Returns false if their pencil has no well-conditioned vectors, or a root
   that the ring does not damp; other methods are better then. */
bool gm_ring_blocks_make(struct gm_ring_blocks *blocks, size_t count, size_t n, const double *b,
                         const double *c);
/* Replaces g, [part * count + point], by y; scratch has room for (n + 2) count numbers. */
void gm_ring_blocks_solve(const struct gm_ring_blocks *blocks, double *g, double *scratch);

#endif
