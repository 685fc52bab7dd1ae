/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_WORKER_SHARED_H
#define GM_APP_EXPLORER_WORKER_SHARED_H

#include <pthread.h>

#include "app/explorer/worker/recorder.h"
#include "app/explorer/worker/worker.h"
#include "app/tours/agenda.h"

/* What the files of the worker share: worker.c its thread, worker_clock.c the time, worker_orders.c the
 * orders.
 */

enum { GM_WORKER_QUEUE = 256 };

/* Stepping is interrupted after this many seconds to look for orders; and nothing is gained by waking more
   often. */
#define GM_WORKER_SLICE 0.008

/* A change that starts everything again is made at most this often, in seconds. */
#define GM_WORKER_RESTART_PAUSE (1.0 / 30)

enum { GM_WORKER_SLOWEST = -21, GM_WORKER_FASTEST = 15 }; /* numbers of speeds */

struct gm_worker {
    pthread_t thread;
    enum gm_theme theme;
    int wake;

    /* shared, under the lock */
    pthread_mutex_t lock;
    pthread_cond_t news;
    struct gm_order queue[GM_WORKER_QUEUE];
    size_t first, count;
    bool wanted; /* a shot */
    bool ready;  /* shots[filled] is finished and not yet taken */
    bool leave, orphan, failed;
    bool recorded; /* a movie was asked for, at some time */
    int filled;    /* the shot that the thread fills; the screen has the other one */
    struct gm_shot shots[2];

    /* the thread's own */
    const struct gm_scene *scene; /* to be opened with so many schemes; NULL: the session was */
    size_t schemes;
    struct gm_session session;
    size_t selected;
    bool paused, behind, changed;
    bool preview;   /* stops at the scene's own end */
    bool homewards; /* time was turned; it stops at the start */
    bool ahead;     /* runs ahead from `ahead_from` to `ahead_to` */
    double ahead_from, ahead_to, ahead_told;
    bool restart; /* is due */
    double restarted;
    int speed;                  /* number of the speed */
    double clock_t, clock_wall; /* model time and wall time at the last change of pace */
    size_t frozen;              /* lanes that are */
    struct gm_agenda agenda;    /* of a tour's step */
    char message[GM_MESSAGE];
    unsigned long message_number;
    struct gm_recorder *recorder; /* NULL: no movie is made */
    bool unrecorded;              /* something changed since its last frame */
    char *commands[GM_COMMANDS];  /* of the view at the time they were asked for; NULL: they were not */
    unsigned long command_number; /* changes with every one */
};

double gm_worker_wall_time(void);
/* Model time per second of a speed: 1, 2 or 5 times a power of ten. */
double gm_worker_speed_of(int number);

/* A sentence for the status line. */
void gm_worker_say(struct gm_worker *worker, const char *sentence);

/* From now on model time goes on from t. */
void gm_worker_set_clock(struct gm_worker *worker, double t);
/* The model time that is due. */
double gm_worker_due_time(const struct gm_worker *worker);
/* How much model time is left until t, as time runs now. */
double gm_worker_left_until(const struct gm_worker *worker, double t);
/* Steps for a while; false if there was nothing to do. */
bool gm_worker_step(struct gm_worker *worker);
/* The session's agenda: makes the changes that are due, and stops where a tour's step does. */
void gm_worker_keep_agenda(struct gm_worker *worker);
/* Tells of lanes that have failed. */
void gm_worker_watch_frozen(struct gm_worker *worker);

/* Saves the picture, begins or ends the movie, ends it, takes a frame of it if one is due, tells the command
   lines of the view. */
void gm_worker_save(struct gm_worker *worker, enum gm_theme theme);
void gm_worker_record(struct gm_worker *worker, enum gm_theme theme);
/* True with a sentence if there was a movie. */
bool gm_worker_stop_recording(struct gm_worker *worker, char *sentence);
void gm_worker_take_frame(struct gm_worker *worker);
void gm_worker_tell(struct gm_worker *worker, enum gm_theme theme);

void gm_worker_obey(struct gm_worker *worker, const struct gm_order *order);
/* Starts all lanes again if that was asked for and the last time was long enough ago. */
void gm_worker_restart_if_due(struct gm_worker *worker);

#endif
