/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_FLOW_SECOND_THREAD_H
#define GM_CORE_FLOW_SECOND_THREAD_H

#include <pthread.h>
#include <stdbool.h>

/* Work on another core, if there is one, else on the caller's. It writes nothing that the caller uses in
   the meantime, so no bit depends on the core. */
struct gm_beside {
    void (*work)(void *data);
    void *data;
    pthread_t thread;
    bool running;
};

/* Starts the work; `alone`: does it at once, as it is too short for a thread. The struct must not be
   moved. */
void gm_beside_begin(struct gm_beside *beside, bool alone);
/* Waits for the end of the work. */
void gm_beside_end(struct gm_beside *beside);

#endif
