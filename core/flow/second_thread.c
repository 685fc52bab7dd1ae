/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Work on another core, in a thread that leaves signals to the one that began it. */
#include "core/flow/second_thread.h"

#include <sched.h>
#include <signal.h>
#include <stddef.h>

static void *run(void *data)
{
    const struct gm_beside *beside = data;
    beside->work(beside->data);
    return NULL;
}

static bool another_core(void)
{
    cpu_set_t cores;
    return sched_getaffinity(0, sizeof cores, &cores) != 0 || CPU_COUNT(&cores) > 1;
}

void gm_beside_begin(struct gm_beside *beside, bool alone)
{
    beside->running = false;
    if (!alone && another_core()) {
        sigset_t all, before;
        sigfillset(&all);
        sigdelset(&all, SIGSEGV);
        sigdelset(&all, SIGBUS);
        sigdelset(&all, SIGFPE);
        sigdelset(&all, SIGILL);
        pthread_sigmask(SIG_BLOCK, &all, &before);
        beside->running = pthread_create(&beside->thread, NULL, run, beside) == 0;
        pthread_sigmask(SIG_SETMASK, &before, NULL);
    }
    if (!beside->running) {
        beside->work(beside->data);
    }
}

void gm_beside_end(struct gm_beside *beside)
{
    if (beside->running) {
        pthread_join(beside->thread, NULL);
        beside->running = false;
    }
}
