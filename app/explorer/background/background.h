/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_BACKGROUND_BACKGROUND_H
#define GM_APP_EXPLORER_BACKGROUND_BACKGROUND_H

#include <pthread.h>
#include <stdbool.h>
#include <sys/types.h>

#include "app/tours/tour.h"
#include "core/scheme.h"
#include "render/layout/appearance.h"

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

/* Measures a scheme with `geomint certify` while the explorer runs. It is a child process, which can be
   killed when another scheme is requested. */

struct gm_measure {
    const struct gm_scheme *scheme; /* NULL before the first request */
    pid_t child;                    /* process id; 0 if none runs */
    int fd;                         /* pipe from the child; -1 if none runs */
    char *text;                     /* the child's output, `length` bytes */
    size_t length;
};

/* Requests a scheme; the measurement of another one is killed. An empty measure is {.fd = -1}. */
void gm_measure_ask(struct gm_measure *measure, const struct gm_scheme *scheme);
/* Reads the available output; returns true if the child has ended. */
bool gm_measure_read(struct gm_measure *measure);
/* Returns the lines about the requested scheme, owned by measure; NULL while incomplete. */
const char *gm_measure_text(const struct gm_measure *measure);
void gm_measure_close(struct gm_measure *measure);

/* A diagram measured in the background, by a thread of low priority. Only the thread touches its table;
   the screen receives looks. */

struct gm_study_look {
    struct gm_picture *picture;
    char what[64]; /* the run being measured */
    size_t done, all;
    bool finished;            /* measuring is complete or was stopped */
    bool impossible;          /* nothing can be measured, for the reason in message */
    char message[GM_MESSAGE]; /* the last message; its number counts messages */
    unsigned long message_number;
};

struct gm_study;

/* Starts to measure; gm_study_close frees the study. `words` are the command's, the scene first. `wake` is
   an eventfd, written when there is a new look. Returns NULL on failure and fills message (GM_MESSAGE
   bytes). */
struct gm_study *gm_study_open(enum gm_study_kind kind, const char *words, int wake, char *message);
/* Abandons unfinished runs and frees the study; ignores NULL. */
void gm_study_close(struct gm_study *study);

const char *gm_study_words(const struct gm_study *study);

/* Returns true while it measures or carries out an order. */
bool gm_study_is_busy(struct gm_study *study);

/* Returns a look that is new since the last call, or NULL. The caller may read it and lay out its picture
   until the next call. */
struct gm_study_look *gm_study_take(struct gm_study *study);

/* Returns the words of the run at (x, y) of the picture's panel number `panel`, the scene first. The
   caller frees them; NULL if there is no run. */
char *gm_study_pick(const struct gm_study *study, size_t panel, double x, double y);

/* Stops measuring; finished results remain. */
void gm_study_stop(struct gm_study *study);
/* Writes the results as PNG and CSV to the working directory; the next look's message gives the name. */
void gm_study_save(struct gm_study *study, enum gm_theme theme);

#endif
