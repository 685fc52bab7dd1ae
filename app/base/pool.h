/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_BASE_POOL_H
#define GM_APP_BASE_POOL_H

#include <stdbool.h>
#include <stddef.h>

/* Independent pieces of work on all cores, what they leave taken in order. */

struct gm_pool {
    size_t count;  /* pieces, numbered from 0 */
    size_t jobs;   /* so many at once; 0: one a core that this process may use */
    size_t window; /* so many may be begun and not yet taken, at least 1: memory does not grow with `count` */
    /* Does piece `index` and leaves what came of it in place `slot` < window, which is its own until it is
       taken. In any thread. */
    void (*work)(void *self, size_t index, size_t slot);
    /* Takes what was left: in the caller's thread, in order of the pieces. False: that is enough. */
    bool (*take)(void *self, size_t index, size_t slot);
    /* Whether to begin no further piece; NULL: never. In any thread. */
    bool (*stopped)(void *self);
    void *self;
};

/* Returns when every piece was taken, or when it was stopped: those begun are then finished, and taken as
   far as none is missing before them. Returns how many were taken (where `take` said no: that one not). */
size_t gm_pool_run(const struct gm_pool *pool);

/* How many cores this process may use, at least 1. */
size_t gm_pool_cores(void);

#endif
