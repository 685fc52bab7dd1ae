/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The worker's thread: its queue of orders, its two shots, and its round. */
#include "app/explorer/worker/session.h"

#include <errno.h>
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/eventfd.h>
#include <time.h>

#include "render/clock.h"
#include "render/files/thread.h"

enum { QUEUE = 256 };

struct gm_worker {
    pthread_t thread;
    int wake;

    /* shared, under the lock */
    pthread_mutex_t lock;
    pthread_cond_t news;
    struct gm_order queue[QUEUE];
    size_t first, count;
    bool wanted; /* a shot is wanted */
    bool ready;  /* shots[filled] is finished and not yet taken */
    bool leave, orphan, failed;
    bool recorded; /* a movie has been requested at some time */
    size_t owed;   /* number of requested files not yet written */
    int filled;    /* index of the shot that the thread fills; the screen has the other one */
    struct gm_shot shots[2];

    /* owned by the thread */
    char *name; /* the scene to open with its first `schemes` schemes; NULL: the session is open */
    size_t schemes;
    bool shown; /* a shot was taken; the first precedes the first step, which may take minutes */
    struct gm_play play;
    struct gm_capture capture;
};

static void announce(struct gm_worker *worker)
{
    if (worker->wake >= 0 && eventfd_write(worker->wake, 1) < 0) {
        worker->leave = errno != EAGAIN; /* the screen is gone */
    }
}

/* Called with the lock held; releases it while the shot is taken. */
static void take_shot(struct gm_worker *worker)
{
    struct gm_play *play = &worker->play;
    const struct gm_capture *capture = &worker->capture;
    worker->wanted = false;
    worker->shown = true;
    play->changed = false;
    struct gm_shot *shot = &worker->shots[worker->filled];
    pthread_mutex_unlock(&worker->lock);
    const double begun = gm_clock_seconds();
    gm_shot_take(shot, &play->session, !play->ahead);
    shot->cost = gm_clock_seconds() - begun;
    shot->running_ahead = play->ahead;
    shot->progress = 1 - gm_play_left_until(play, play->ahead_to) / fabs(play->ahead_to - play->ahead_from);
    shot->paused = play->paused;
    shot->behind = play->behind;
    shot->speed = gm_play_speed(play);
    shot->pace = shot->speed / fabs(play->session.lanes[play->session.selected]->run->dt);
    snprintf(shot->verdict, sizeof shot->verdict, "%s", play->verdict);
    shot->passed = play->passed;
    snprintf(shot->message, sizeof shot->message, "%s", play->message);
    shot->message_number = play->message_number;
    shot->recorded = capture->recorder ? gm_recorder_length(capture->recorder) : -1;
    if (shot->command_number != capture->command_number) {
        for (size_t i = 0; i < GM_COMMANDS; i++) {
            free(shot->commands[i]);
            shot->commands[i] = capture->commands[i] ? strdup(capture->commands[i]) : NULL;
        }
        shot->command_number = capture->command_number;
    }
    pthread_mutex_lock(&worker->lock);
    worker->ready = true;
    announce(worker);
}

/* Called with the lock held: waits for a signal, at most until the next step is due. */
static void rest(struct gm_worker *worker)
{
    const double pause = gm_play_pause(&worker->play);
    if (pause > 1e6) {
        pthread_cond_wait(&worker->news, &worker->lock);
        return;
    }
    struct timespec until;
    clock_gettime(CLOCK_MONOTONIC, &until);
    double nanoseconds = (double)until.tv_nsec + 1e9 * fmod(pause, 1);
    until.tv_sec += (time_t)pause + (nanoseconds >= 1e9);
    until.tv_nsec = (long)(nanoseconds >= 1e9 ? nanoseconds - 1e9 : nanoseconds);
    pthread_cond_timedwait(&worker->news, &worker->lock, &until);
}

static void release(struct gm_worker *worker)
{
    pthread_cond_destroy(&worker->news);
    pthread_mutex_destroy(&worker->lock);
    gm_capture_close(&worker->capture);
    gm_session_close(&worker->play.session);
    gm_shot_close(&worker->shots[0]);
    gm_shot_close(&worker->shots[1]);
    free(worker->name);
    free(worker);
}

static bool is_owed(const struct gm_order *order)
{
    return order->kind == GM_ORDER_SAVE || order->kind == GM_ORDER_SYSTEM || order->kind == GM_ORDER_ANSWER;
}

/* Called with the lock held; releases it while the order is carried out. */
static void obey_next(struct gm_worker *worker)
{
    const struct gm_order order = worker->queue[worker->first];
    worker->first = (worker->first + 1) % QUEUE;
    worker->count--;
    pthread_mutex_unlock(&worker->lock);
    gm_order_obey(&order, &worker->play, &worker->capture);
    pthread_mutex_lock(&worker->lock);
    worker->owed -= is_owed(&order);
}

/* Carries out the orders, then makes some steps. Called with the lock held; returns true after a step. */
static bool go_on(struct gm_worker *worker)
{
    struct gm_play *play = &worker->play;
    struct gm_capture *capture = &worker->capture;
    while (worker->count > 0) {
        obey_next(worker);
    }
    pthread_mutex_unlock(&worker->lock);
    gm_play_restart_if_due(play);
    const bool worked = worker->shown && gm_play_step(play);
    capture->unrecorded = capture->unrecorded || worked;
    gm_capture_take_frame(capture, &play->session);
    const bool changed = gm_play_keep_agenda(play);
    gm_play_watch_frozen(play);
    pthread_mutex_lock(&worker->lock);
    return worked || changed;
}

/* Opens the scene that has only a name yet. Returns false with a message in play if that fails. */
static bool begin(struct gm_worker *worker)
{
    char message[GM_MESSAGE] = "";
    struct gm_request request = {0};
    const bool ok =
        !worker->name || (gm_request_parse(&request, 1, &worker->name, worker->schemes, message) &&
                          gm_session_open(&worker->play.session, &request, message));
    gm_request_close(&request);
    if (!ok) {
        return gm_refuse(worker->play.message, "%s", message);
    }
    gm_play_begin(&worker->play);
    return true;
}

static void *work(void *self)
{
    struct gm_worker *worker = self;
    const bool ok = begin(worker);
    pthread_mutex_lock(&worker->lock);
    worker->failed = !ok;
    if (!ok) {
        announce(worker);
    }
    while (!ok && !worker->leave) {
        pthread_cond_wait(&worker->news, &worker->lock);
    }
    while (!worker->leave) {
        const bool worked = go_on(worker);
        if (worker->wanted && worker->play.changed) {
            take_shot(worker);
        } else if (!worked && worker->count == 0 && !worker->leave) {
            rest(worker);
        }
    }
    while (ok && worker->owed > 0) {
        obey_next(worker);
    }
    bool orphan = worker->orphan;
    pthread_mutex_unlock(&worker->lock);
    if (orphan) {
        release(worker);
    }
    return NULL;
}

struct gm_worker *gm_worker_open(const struct gm_worker_plan *plan, int wake, char *message)
{
    struct gm_worker *worker = calloc(1, sizeof *worker);
    if (!worker) {
        gm_refuse(message, "There is not enough memory.");
        return NULL;
    }
    worker->wake = wake;
    worker->wanted = true;
    worker->schemes = plan->schemes;
    worker->play.preview = plan->preview;
    worker->name = plan->request ? NULL : strdup(plan->name);
    pthread_condattr_t attributes;
    pthread_condattr_init(&attributes);
    pthread_condattr_setclock(&attributes, CLOCK_MONOTONIC);
    pthread_cond_init(&worker->news, &attributes);
    pthread_condattr_destroy(&attributes);
    pthread_mutex_init(&worker->lock, NULL);
    if (plan->first) {
        worker->queue[worker->count++] = *plan->first;
    }
    bool ok = (gm_shot_open(&worker->shots[0]) && gm_shot_open(&worker->shots[1]) &&
               (plan->request || worker->name)) ||
              gm_refuse(message, "There is not enough memory.");
    ok = ok && (!plan->request || gm_session_open(&worker->play.session, plan->request, message));
    if (ok && wake < 0) {
        worker->failed = !begin(worker);
    } else if (ok) {
        const int error = gm_thread_start(&worker->thread, work, worker);
        ok = error == 0 || gm_refuse(message, "No thread could be started: %s.", strerror(error));
    }
    if (!ok) {
        release(worker);
        worker = NULL;
    }
    return worker;
}

bool gm_worker_failed(struct gm_worker *worker, char *message)
{
    pthread_mutex_lock(&worker->lock);
    bool failed = worker->failed;
    if (failed) {
        snprintf(message, GM_MESSAGE, "%s", worker->play.message);
    }
    pthread_mutex_unlock(&worker->lock);
    return failed;
}

void gm_worker_close(struct gm_worker *worker, char *parting)
{
    parting[0] = '\0';
    pthread_mutex_lock(&worker->lock);
    const bool owed = worker->owed > 0;
    worker->leave = true;
    pthread_cond_signal(&worker->news);
    pthread_mutex_unlock(&worker->lock);
    if (worker->wake >= 0) {
        pthread_join(worker->thread, NULL);
    }
    if (owed) {
        snprintf(parting, GM_MESSAGE, "%s", worker->play.message);
    }
    char movie[GM_MESSAGE];
    if (gm_capture_stop_recording(&worker->capture, movie)) {
        gm_append(parting, GM_MESSAGE, "%s%s", parting[0] ? " " : "", movie);
    }
    release(worker);
}

void gm_worker_abandon(struct gm_worker *worker, char *parting)
{
    parting[0] = '\0';
    pthread_mutex_lock(&worker->lock);
    if (worker->wake < 0 || worker->recorded || worker->owed > 0) {
        pthread_mutex_unlock(&worker->lock);
        gm_worker_close(worker, parting);
        return;
    }
    pthread_detach(worker->thread);
    worker->leave = worker->orphan = true;
    pthread_cond_signal(&worker->news);
    pthread_mutex_unlock(&worker->lock);
}

void gm_worker_order(struct gm_worker *worker, struct gm_order order)
{
    pthread_mutex_lock(&worker->lock);
    worker->recorded = worker->recorded || order.kind == GM_ORDER_RECORD;
    if (worker->count < QUEUE) {
        worker->owed += is_owed(&order);
        worker->queue[(worker->first + worker->count++) % QUEUE] = order;
    }
    pthread_cond_signal(&worker->news);
    pthread_mutex_unlock(&worker->lock);
}

void gm_worker_want(struct gm_worker *worker)
{
    pthread_mutex_lock(&worker->lock);
    if (!worker->wanted && !worker->ready) {
        worker->wanted = true;
        pthread_cond_signal(&worker->news);
    }
    pthread_mutex_unlock(&worker->lock);
}

struct gm_shot *gm_worker_take(struct gm_worker *worker)
{
    struct gm_shot *shot = NULL;
    pthread_mutex_lock(&worker->lock);
    if (worker->ready) {
        shot = &worker->shots[worker->filled];
        worker->filled = 1 - worker->filled;
        worker->ready = false;
    }
    pthread_mutex_unlock(&worker->lock);
    return shot;
}

struct gm_shot *gm_worker_play(struct gm_worker *worker, bool wanted)
{
    pthread_mutex_lock(&worker->lock);
    while (!worker->failed && go_on(worker)) {
    }
    gm_capture_wait(&worker->capture); /* a movie does not depend on the time that its frames take */
    if (!worker->failed && worker->play.changed && (wanted || !worker->shown)) {
        take_shot(worker);
    }
    pthread_mutex_unlock(&worker->lock);
    return gm_worker_take(worker);
}
