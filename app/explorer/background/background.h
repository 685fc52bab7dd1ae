/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_BACKGROUND_BACKGROUND_H
#define GM_APP_EXPLORER_BACKGROUND_BACKGROUND_H

#include <pthread.h>
#include <stdbool.h>
#include <sys/types.h>

#include "app/tours/tour.h"
#include "core/scheme.h"
#include "render/layout/appearance.h"

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

/* `end`, unless it is NULL, is called in the thread at its end; `wake` is an eventfd that is written to whenever a
   piece of work is done, or -1. False with a sentence (GM_MESSAGE bytes). */
bool gm_job_open(struct gm_job *job, void (*work)(void *self), void (*end)(void *self), void *self, int wake,
                 char *message);
/* What was begun is finished. */
void gm_job_close(struct gm_job *job);

/* Asks for the thing; while it is being done: for once more. */
void gm_job_begin(struct gm_job *job);
/* Whether it is being done, or will be. */
bool gm_job_is_busy(struct gm_job *job);

/* What `geomint certify` measures of a scheme, while the explorer goes on: by a child process, because
   nothing but its end stops certifying when another scheme is asked for. */

struct gm_measure {
    const struct gm_scheme *scheme; /* NULL: none was asked for */
    pid_t child;                    /* 0: none runs */
    int fd;                         /* where it writes; -1: none */
    char *text;                     /* what it has written, line by line */
    size_t length;
};

/* An empty one is {.fd = -1}. Asks for a scheme; another one that still runs is ended. */
void gm_measure_ask(struct gm_measure *measure, const struct gm_scheme *scheme);
/* Reads what has come; true if that was the end. */
bool gm_measure_read(struct gm_measure *measure);
/* The lines about the scheme that was asked for; NULL while they are not complete. */
const char *gm_measure_text(const struct gm_measure *measure);
void gm_measure_close(struct gm_measure *measure);

/* A diagram that is measured in the background: work-precision or stability, in a thread of its own that
   leaves the processor to the one that draws. It alone touches its table; looks at it are handed over. */

struct gm_study_look {
    struct gm_picture *picture;
    char what[64]; /* under way */
    size_t done, all;
    bool finished;            /* by itself, or stopped */
    bool impossible;          /* nothing can be measured, and the message says why */
    char message[GM_MESSAGE]; /* the last news, and how many there were */
    unsigned long message_number;
};

struct gm_study;

/* Starts to measure; `words` are those of the command, the scene first. `wake` is an eventfd that is written
   to when there is a new look. NULL with a sentence (GM_MESSAGE bytes). */
struct gm_study *gm_study_open(enum gm_study_kind kind, const char *words, int wake, char *message);
/* Gives up what is not finished. NULL is ignored. */
void gm_study_close(struct gm_study *study);

const char *gm_study_words(const struct gm_study *study);

/* A new look since the last call, or NULL. It may be read, and its picture laid out, until the next one. */
struct gm_study_look *gm_study_take(struct gm_study *study);

/* The words of the run that panel number `panel` of its picture shows at (x, y), the scene first; malloc'ed,
   NULL: there is none. */
char *gm_study_pick(const struct gm_study *study, size_t panel, double x, double y);

/* Ends the measuring; what is finished stays. */
void gm_study_stop(struct gm_study *study);
/* Writes what there is as PNG and CSV here; the look after it says under what name. */
void gm_study_save(struct gm_study *study, enum gm_theme theme);

#endif
