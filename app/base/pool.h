/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_BASE_POOL_H
#define GM_APP_BASE_POOL_H

#include <stdbool.h>
#include <stddef.h>

/* Independent pieces of work on all cores; their results are taken in order. */

struct gm_pool {
    size_t count;  /* pieces, numbered from 0 */
    size_t jobs;   /* number of parallel pieces; 0: one per core that this process may use */
    size_t window; /* most pieces that have begun and are not yet taken, at least 1: bounds the memory */
    /* Does piece `index` and leaves its result in place `slot` < window, which is reserved until the
       result is taken. Called in any thread. */
    void (*work)(void *self, size_t index, size_t slot);
    /* Takes the result: in the caller's thread, in order of the pieces. Returns false to end the work. */
    bool (*take)(void *self, size_t index, size_t slot);
    /* Returns true to begin no further piece; NULL: never. Called in any thread. */
    bool (*stopped)(void *self);
    void *self;
};

/* Returns when every piece was taken, or when it was stopped: started pieces are then finished, and taken
   up to the first missing one. Returns the number of taken pieces, without the one for which `take`
   returned false. */
size_t gm_pool_run(const struct gm_pool *pool);

/* The number of cores that this process may use, at least 1. */
size_t gm_pool_cores(void);

#endif
