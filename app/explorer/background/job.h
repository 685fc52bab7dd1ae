/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_BACKGROUND_JOB_H
#define GM_APP_EXPLORER_BACKGROUND_JOB_H

#include <pthread.h>
#include <stdbool.h>

/* A thread that does one thing each time it is asked to, and sleeps in between. What the thing is done to
   belongs to the thread while it is busy, and to the caller otherwise, unless they share a lock. */

struct gm_job {
    pthread_t thread;
    pthread_mutex_t lock;
    pthread_cond_t news;
    bool asked, working, leave;
    int wake;
    void (*work)(void *self), (*end)(void *self);
    void *self;
};

/* `end` is called in the thread at its end; `wake` is an eventfd that is written to whenever a piece of work
   is done, or -1. False with a sentence (GM_MESSAGE bytes). */
bool gm_job_open(struct gm_job *job, void (*work)(void *self), void (*end)(void *self), void *self, int wake,
                 char *message);
/* What was begun is finished. */
void gm_job_close(struct gm_job *job);

/* Asks for the thing; while it is being done: for once more. */
void gm_job_begin(struct gm_job *job);
/* Whether it is being done, or will be. */
bool gm_job_is_busy(struct gm_job *job);

#endif
