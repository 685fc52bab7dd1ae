/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_FLOW_SECOND_THREAD_H
#define GM_CORE_FLOW_SECOND_THREAD_H

#include <pthread.h>
#include <stdbool.h>

/* A piece of work that shares nothing it writes with what is done in the meantime, so that no bit depends on
   where it is done: on another core, where there is one, else where it is begun. */
struct gm_beside {
    void (*work)(void *data);
    void *data;
    pthread_t thread;
    bool running;
};

/* alone: do it at once, as it is too short for a thread of its own. The struct must stay where it is. */
void gm_beside_begin(struct gm_beside *beside, bool alone);
/* Returns when it is done. */
void gm_beside_end(struct gm_beside *beside);

#endif
