/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_LINEAR_RING_NEWTON_H
#define GM_CORE_LINEAR_RING_NEWTON_H

#include "core/linear/ring/ring.h"
#include "core/scheme.h"

/* Newton's method for equations F(u) = 0 around a ring, each of which knows its neighbours only. u is
   [part * count + point]. */
struct gm_ring_equations {
    void *context;
    /* residual := -F(u), n numbers */
    void (*residual)(void *context, const double *u, double *residual);
    /* Adds F' at the u that `residual` was last called with. */
    void (*jacobian)(void *context, struct gm_ring_band *matrix);
};

/* The memory of the method. Its pages are touched at the first use, which is rare. */
struct gm_ring_newton {
    size_t n;
    struct gm_ring_band band;
    double *trial, *residual, *change; /* n */
};
/* Returns false when out of memory; then nothing is allocated. */
bool gm_ring_newton_open(struct gm_ring_newton *newton, size_t count, size_t parts, size_t reach);
void gm_ring_newton_close(struct gm_ring_newton *newton);

/* Solves from the guess u to round-off, halving steps until the residual falls. Returns GM_NO_CONVERGENCE if
   it does not fall, or if F' is singular. */
enum gm_status gm_ring_newton_solve(struct gm_ring_newton *newton, const struct gm_ring_equations *equations,
                                    double *u, struct gm_progress *progress);

#endif
