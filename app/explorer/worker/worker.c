/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The thread that steps: orders in, finished looks out, and in between as many steps as the clock asks
   for. */
#include "app/explorer/worker/worker.h"

#include <errno.h>
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "app/explorer/worker/shared.h"
#include "render/files/thread.h"

/* A speed at which the scene's own time span takes some seconds. */
static int first_speed(const struct gm_session *session)
{
    const struct gm_timing *timing = session->lanes[0]->parameters;
    double span = fabs(timing->until - session->lanes[0]->t0);
    int number = span > 0 && isfinite(span) ? (int)round(3 * log10(span / 6)) : 0;
    return number < GM_WORKER_SLOWEST   ? GM_WORKER_SLOWEST
           : number > GM_WORKER_FASTEST ? GM_WORKER_FASTEST
                                        : number;
}

static void announce(struct gm_worker *worker)
{
    const uint64_t one = 1;
    if (write(worker->wake, &one, sizeof one) < 0) {
        worker->leave = errno != EAGAIN; /* without a screen there is nothing to do */
    }
}

/* Called with the lock held; lets go of it while the shot is taken. */
static void take_shot(struct gm_worker *worker)
{
    worker->wanted = false;
    worker->changed = false;
    struct gm_shot *shot = &worker->shots[worker->filled];
    pthread_mutex_unlock(&worker->lock);
    gm_shot_take(shot, &worker->session, worker->selected, !worker->ahead);
    shot->running_ahead = worker->ahead;
    shot->progress =
        1 - gm_worker_left_until(worker, worker->ahead_to) / fabs(worker->ahead_to - worker->ahead_from);
    shot->paused = worker->paused;
    shot->behind = worker->behind;
    shot->speed = gm_worker_speed_of(worker->speed);
    shot->pace = shot->speed / fabs(worker->session.lanes[worker->selected]->run->dt);
    snprintf(shot->message, sizeof shot->message, "%s", worker->message);
    shot->message_number = worker->message_number;
    shot->recorded = worker->recorder ? gm_recorder_length(worker->recorder) : -1;
    if (shot->command_number != worker->command_number) {
        for (size_t i = 0; i < GM_COMMANDS; i++) {
            free(shot->commands[i]);
            shot->commands[i] = worker->commands[i] ? strdup(worker->commands[i]) : NULL;
        }
        shot->command_number = worker->command_number;
    }
    pthread_mutex_lock(&worker->lock);
    worker->ready = true;
    announce(worker);
}

/* Called with the lock held: waits for news, at most until the next step is due. */
static void rest(struct gm_worker *worker)
{
    double next = gm_session_next(&worker->session), pause = INFINITY;
    if (!worker->paused && isfinite(next)) {
        pause = fmax(fabs(next - gm_worker_due_time(worker)) / gm_worker_speed_of(worker->speed),
                     GM_WORKER_SLICE);
    }
    if (worker->restart) {
        pause = fmin(pause, GM_WORKER_RESTART_PAUSE);
    }
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

static bool open_named(struct gm_worker *worker, char *message)
{
    struct gm_request request;
    char *words[] = {(char *)worker->scene->name};
    if (!gm_request_parse(&request, 1, words, worker->schemes, message)) {
        return false;
    }
    bool ok = gm_session_open(&worker->session, &request, message);
    gm_request_close(&request);
    return ok;
}

/* The session is there: from now on there is something to step. */
static void begin(struct gm_worker *worker)
{
    worker->changed = true;
    worker->speed = first_speed(&worker->session);
    worker->restarted = -1e9;
    gm_worker_set_clock(worker, gm_session_time(&worker->session));
}

static void release(struct gm_worker *worker)
{
    pthread_cond_destroy(&worker->news);
    pthread_mutex_destroy(&worker->lock);
    for (size_t i = 0; i < GM_COMMANDS; i++) {
        free(worker->commands[i]);
    }
    gm_session_close(&worker->session);
    gm_shot_close(&worker->shots[0]);
    gm_shot_close(&worker->shots[1]);
    free(worker);
}

/* One round: the orders, then some steps, then a shot or a rest. Called with the lock held. */
static void go_round(struct gm_worker *worker)
{
    while (worker->count > 0) {
        struct gm_order order = worker->queue[worker->first];
        worker->first = (worker->first + 1) % GM_WORKER_QUEUE;
        worker->count--;
        pthread_mutex_unlock(&worker->lock);
        gm_worker_obey(worker, &order);
        pthread_mutex_lock(&worker->lock);
    }
    pthread_mutex_unlock(&worker->lock);
    gm_worker_restart_if_due(worker);
    bool worked = gm_worker_step(worker);
    worker->unrecorded = worker->unrecorded || worked;
    gm_worker_take_frame(worker);
    gm_worker_keep_agenda(worker);
    gm_worker_watch_frozen(worker);
    pthread_mutex_lock(&worker->lock);
    if (worker->wanted && worker->changed) {
        take_shot(worker);
    } else if (!worked && worker->count == 0 && !worker->leave) {
        rest(worker);
    }
}

static void *work(void *self)
{
    struct gm_worker *worker = self;
    bool ok = true;
    if (worker->scene) {
        char message[GM_MESSAGE] = "";
        ok = open_named(worker, message);
        if (ok) {
            begin(worker);
        } else {
            snprintf(worker->message, sizeof worker->message, "%s", message);
        }
    }
    pthread_mutex_lock(&worker->lock);
    worker->failed = !ok;
    if (!ok) {
        announce(worker);
    }
    while (!worker->leave) {
        if (ok) {
            go_round(worker);
        } else {
            pthread_cond_wait(&worker->news, &worker->lock);
        }
    }
    bool orphan = worker->orphan;
    pthread_mutex_unlock(&worker->lock);
    if (orphan) {
        release(worker);
    }
    return NULL;
}

/* A worker without a session or a thread; NULL with a sentence. */
static struct gm_worker *make(enum gm_theme theme, int wake, char *message)
{
    struct gm_worker *worker = calloc(1, sizeof *worker);
    if (!worker || !gm_shot_open(&worker->shots[0]) || !gm_shot_open(&worker->shots[1])) {
        snprintf(message, GM_MESSAGE, "There is not enough memory.");
        if (worker) {
            gm_shot_close(&worker->shots[0]);
        }
        free(worker);
        return NULL;
    }
    worker->theme = theme;
    worker->wake = wake;
    worker->wanted = true;
    pthread_condattr_t attributes;
    pthread_condattr_init(&attributes);
    pthread_condattr_setclock(&attributes, CLOCK_MONOTONIC);
    pthread_cond_init(&worker->news, &attributes);
    pthread_condattr_destroy(&attributes);
    pthread_mutex_init(&worker->lock, NULL);
    return worker;
}

/* Starts the thread; the worker is released if there is none to be had. */
static struct gm_worker *start(struct gm_worker *worker, char *message)
{
    const int error = gm_thread_start(&worker->thread, work, worker);
    if (error == 0) {
        return worker;
    }
    snprintf(message, GM_MESSAGE, "No thread could be started: %s.", strerror(error));
    release(worker);
    return NULL;
}

struct gm_worker *gm_worker_open(const struct gm_request *request, enum gm_theme theme, int wake,
                                 const struct gm_order *first, char *message)
{
    struct gm_worker *worker = make(theme, wake, message);
    if (!worker) {
        return NULL;
    }
    if (!gm_session_open(&worker->session, request, message)) {
        release(worker);
        return NULL;
    }
    begin(worker);
    if (first) {
        worker->queue[worker->count++] = *first;
    }
    return start(worker, message);
}

struct gm_worker *gm_worker_open_scene(const struct gm_scene *scene, size_t schemes, bool preview,
                                       enum gm_theme theme, int wake, char *message)
{
    struct gm_worker *worker = make(theme, wake, message);
    if (!worker) {
        return NULL;
    }
    worker->scene = scene;
    worker->schemes = schemes;
    worker->preview = preview;
    return start(worker, message);
}

bool gm_worker_failed(struct gm_worker *worker, char *message)
{
    pthread_mutex_lock(&worker->lock);
    bool failed = worker->failed;
    if (failed) {
        snprintf(message, GM_MESSAGE, "%s", worker->message);
    }
    pthread_mutex_unlock(&worker->lock);
    return failed;
}

void gm_worker_close(struct gm_worker *worker, char *parting)
{
    parting[0] = '\0';
    if (!worker) {
        return;
    }
    pthread_mutex_lock(&worker->lock);
    worker->leave = true;
    pthread_cond_signal(&worker->news);
    pthread_mutex_unlock(&worker->lock);
    pthread_join(worker->thread, NULL);
    gm_worker_stop_recording(worker, parting);
    release(worker);
}

void gm_worker_abandon(struct gm_worker *worker, char *parting)
{
    parting[0] = '\0';
    pthread_mutex_lock(&worker->lock);
    if (worker->recorded) {
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
    if (worker->count < GM_WORKER_QUEUE) {
        worker->queue[(worker->first + worker->count++) % GM_WORKER_QUEUE] = order;
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
