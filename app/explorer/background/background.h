/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_BACKGROUND_BACKGROUND_H
#define GM_APP_EXPLORER_BACKGROUND_BACKGROUND_H

#include <pthread.h>
#include <stdbool.h>
#include <sys/types.h>

/* A thread that does a piece of work on request and sleeps in between. The data belong to the thread while
   it is busy, else to the caller, unless they share a lock. */

struct gm_job {
    pthread_t thread;
    pthread_mutex_t lock;
    pthread_cond_t news;
    bool asked, working, leave;
    int wake;
    void (*work)(void *self), (*end)(void *self);
    void *self;
};

/* Starts the thread, which calls `end` (may be NULL) last. `wake` is -1 or an eventfd, written after each
   piece of work. Returns false on failure and fills message (GM_MESSAGE bytes). */
bool gm_job_open(struct gm_job *job, void (*work)(void *self), void (*end)(void *self), void *self, int wake,
                 char *message);
/* Finishes the requested work and ends the thread. */
void gm_job_close(struct gm_job *job);

/* Requests the work; during the work, requests it again. */
void gm_job_begin(struct gm_job *job);
/* Sets a flag of the work, under the lock, and requests the work. */
void gm_job_tell(struct gm_job *job, bool *flag);
/* Returns true if work is requested or being done. */
bool gm_job_is_busy(struct gm_job *job);
/* Waits until it is not. */
void gm_job_wait(struct gm_job *job);

/* Measures a scheme with `geomint certify`, or finds invariants with `geomint list`, while the explorer runs. It is a
   child process, which can be killed when something else is requested. */

struct gm_measure {
    char *words; /* the command, as gm_arguments_split reads it; NULL before the first request */
    pid_t child; /* process id; 0 if none runs */
    int fd;      /* pipe from the child; -1 if none runs */
    char *text;  /* the child's output, `length` bytes */
    size_t length;
};

/* Requests the output of a command; another one is killed. An empty measure is {.fd = -1}. */
void gm_measure_ask(struct gm_measure *measure, const char *words);
/* Reads the available output; returns true if the child has ended. */
bool gm_measure_read(struct gm_measure *measure);
/* Returns the lines of the requested command, owned by measure; NULL while incomplete. */
const char *gm_measure_text(const struct gm_measure *measure);
void gm_measure_close(struct gm_measure *measure);

#endif
