/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "app/explorer/worker.h"

#include <errno.h>
#include <math.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "app/explorer/agenda.h"
#include "app/still.h"

enum { QUEUE = 256 };

/* Stepping is interrupted after this long to look for orders; and nothing is gained by waking more often. */
static const double SLICE = 0.008;
/* A simulation that is later than this lets the clock wait for it. */
static const double LATE = 0.1;
/* A change that starts everything again is made at most this often. */
static const double RESTART_PAUSE = 1.0 / 30;

struct gm_worker {
    pthread_t thread;
    enum gm_theme theme;
    int wake;

    /* shared, under the lock */
    pthread_mutex_t lock;
    pthread_cond_t news;
    struct gm_order queue[QUEUE];
    size_t first, count;
    bool wanted; /* a shot */
    bool ready;  /* shots[filled] is finished and not yet taken */
    bool leave;
    int filled; /* the shot that the thread fills; the screen has the other one */
    struct gm_shot shots[2];

    /* the thread's own */
    struct gm_session session;
    size_t selected;
    bool paused, behind, changed;
    bool restart; /* is due */
    double restarted;
    int speed;                  /* number of the speed */
    double clock_t, clock_wall; /* model time and wall time at the last change of pace */
    size_t frozen;              /* lanes that are */
    struct gm_agenda agenda;    /* of a tour's step */
    double ahead;               /* model time that is hurried to; -infinity: none */
    char message[GM_MESSAGE];
    unsigned long message_number;
};

static double wall_time(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* Model time per second: 1, 2 or 5 times a power of ten. */
static double speed_of(int number)
{
    static const double mantissa[] = {1, 2, 5};
    int decade = (int)floor(number / 3.0);
    return mantissa[number - 3 * decade] * pow(10, decade);
}

enum { SLOWEST = -12, FASTEST = 15 };

/* A speed at which the scene's own time span takes some seconds. */
static int first_speed(const struct gm_session *session)
{
    const struct gm_timing *timing = session->lanes[0]->parameters;
    double span = fabs(timing->until - session->lanes[0]->t0);
    int number = span > 0 && isfinite(span) ? (int)round(3 * log10(span / 6)) : 0;
    return number < SLOWEST ? SLOWEST : number > FASTEST ? FASTEST : number;
}

static void say(struct gm_worker *worker, const char *sentence)
{
    snprintf(worker->message, sizeof worker->message, "%s", sentence);
    worker->message_number++;
    worker->changed = true;
}

/* ---- the clock ---- */

/* From now on model time goes on from t. */
static void set_clock(struct gm_worker *worker, double t)
{
    worker->clock_t = t;
    worker->clock_wall = wall_time();
    worker->behind = false;
}

/* The model time that is due. A lane that lags behind the others, being new, is stepped also when all is
 * paused. */
static double due_time(const struct gm_worker *worker)
{
    double together = gm_session_time(&worker->session), limit = gm_agenda_limit(&worker->agenda);
    if (together < worker->ahead) {
        /* in pieces, so that graphs have points enough */
        const double span = worker->ahead - worker->session.lanes[0]->t0;
        return fmin(fmin(worker->ahead, limit), together + span / 300);
    }
    if (worker->paused) {
        return together;
    }
    double due = worker->clock_t + speed_of(worker->speed) * (wall_time() - worker->clock_wall);
    return fmax(fmin(due, limit), together);
}

static bool hurries(const struct gm_worker *worker)
{
    return isfinite(worker->ahead);
}

static bool step(struct gm_worker *worker)
{
    double begun = wall_time(), due = due_time(worker);
    bool worked = false;
    while (wall_time() - begun < SLICE && gm_session_advance(&worker->session, due)) {
        worked = true;
    }
    if (worked) {
        worker->changed = true;
    }
    double next = gm_session_next(&worker->session);
    if (!worker->paused && isfinite(next) && !hurries(worker)) {
        double lag = (due_time(worker) - next) / speed_of(worker->speed);
        if (lag > LATE) {
            /* the clock goes on from where the slowest lane is; model time is never skipped */
            set_clock(worker, fmax(gm_session_time(&worker->session), next));
            worker->behind = true;
        } else if (lag < 0.5 * LATE && !worked) {
            worker->behind = false;
        }
    }
    return worked;
}

/* ---- a tour's step ---- */

/* Makes the changes that are due, and stops where the step does. */
static void keep_agenda(struct gm_worker *worker)
{
    char message[GM_MESSAGE] = "";
    const bool stop = gm_agenda_keep(&worker->agenda, &worker->session, message);
    if (message[0]) {
        say(worker, message);
    }
    if (hurries(worker) && (stop || !(gm_session_next(&worker->session) <= worker->ahead * (1 + 1e-9)))) {
        worker->ahead = -INFINITY;
        set_clock(worker, gm_session_time(&worker->session));
        worker->changed = true;
    }
    if (stop) {
        worker->paused = true;
        worker->changed = true;
        set_clock(worker, gm_session_time(&worker->session));
    }
}

static void begin_step(struct gm_worker *worker, const struct gm_order *order)
{
    const struct gm_tour_step *step = &order->tour->steps[order->step];
    const double begin = gm_tour_begin(order->tour, order->step), span = step->until - begin;
    worker->agenda = gm_agenda_of(order->tour, order->step, gm_tour_first(order->tour, order->step));
    worker->ahead = step->show ? -INFINITY : begin;
    worker->paused = order->amount != 0;
    if (span > 0) {
        const int number = (int)round(3 * log10(span / step->seconds));
        worker->speed = number < SLOWEST ? SLOWEST : number > FASTEST ? FASTEST : number;
    }
}

/* ---- frozen lanes ---- */

static void watch_frozen(struct gm_worker *worker)
{
    const struct gm_lane *latest = NULL;
    size_t frozen = 0;
    for (size_t i = 0; i < worker->session.count; i++) {
        const struct gm_lane *lane = worker->session.lanes[i];
        if (lane->run->status == GM_OK) {
            continue;
        }
        frozen++;
        if (!latest || lane->run->t >= latest->run->t) {
            latest = lane;
        }
    }
    if (frozen > worker->frozen && latest) {
        static const char *const sentences[] = {
            [GM_OK] = "",
            [GM_BLOW_UP] = "left all bounds",
            [GM_NO_CONVERGENCE] = "found no solution of its equations",
            [GM_MESH_CROSSING] = "tangled its mesh",
            [GM_STEP_COLLAPSE] = "found no time step",
        };
        char sentence[GM_MESSAGE];
        snprintf(sentence, sizeof sentence, "%s %s at t = %.5g and stands still%s.", latest->scheme->title,
                 sentences[latest->run->status], latest->run->t,
                 frozen < worker->session.count ? "; the others go on" : "");
        say(worker, sentence);
    }
    worker->frozen = frozen;
}

/* ---- orders ---- */

static void save_picture(struct gm_worker *worker)
{
    char path[128], message[GM_MESSAGE] = "", sentence[GM_MESSAGE];
    int number = 1;
    do {
        snprintf(path, sizeof path, "%.80s-%04d.png", worker->session.scene->name, number);
    } while (access(path, F_OK) == 0 && number++ < 9999);
    for (size_t i = 0; i < worker->session.count; i++) {
        worker->session.log.lanes[i].steps = worker->session.lanes[i]->run->steps;
    }
    bool ok = gm_still_write(path, 1920, 1080, worker->theme, &worker->session.log,
                             (const struct gm_lane *const *)worker->session.lanes, message);
    snprintf(sentence, sizeof sentence, ok ? "Saved %.400s." : "Not saved: %.400s", ok ? path : message);
    say(worker, sentence);
    set_clock(worker, gm_session_time(&worker->session));
}

static void move_parameter(struct gm_worker *worker, const struct gm_order *order)
{
    char text[GM_VALUE_TEXT], message[GM_MESSAGE];
    const struct gm_parameter *row = order->row;
    const void *owner = gm_session_owner(&worker->session, worker->selected, order->of_scheme);
    if (order->kind == GM_ORDER_STANDARD) {
        snprintf(text, sizeof text, "%s", row->standard);
    } else if (!gm_slider_next(row, owner, order->amount, text)) {
        snprintf(message, sizeof message, "%s is at the end of its range.", row->key);
        say(worker, message);
        return;
    }
    if (!gm_session_set(&worker->session, worker->selected, row, order->of_scheme, text, &worker->restart,
                        message)) {
        say(worker, message);
    }
}

static void step_forward(struct gm_worker *worker)
{
    double next = gm_session_next(&worker->session);
    if (isfinite(next)) {
        while (gm_session_advance(&worker->session, next)) {
            ;
        }
    }
}

static void obey(struct gm_worker *worker, const struct gm_order *order)
{
    struct gm_session *session = &worker->session;
    char message[GM_MESSAGE] = "";
    double due = due_time(worker);
    /* Other orders leave the part of a step that has gone by. */
    bool jumps = order->kind <= GM_ORDER_RESTART || order->kind == GM_ORDER_SAVE;
    bool ok = true;
    switch (order->kind) {
    case GM_ORDER_PAUSE:
        worker->paused = !worker->paused;
        break;
    case GM_ORDER_FORWARD:
        worker->paused = true;
        step_forward(worker);
        break;
    case GM_ORDER_BACK:
        worker->paused = true;
        ok = gm_session_back(session, message);
        gm_agenda_rewind(&worker->agenda, gm_session_time(session));
        break;
    case GM_ORDER_RESTART:
        worker->restart = true;
        break;
    case GM_ORDER_SPEED:
        worker->speed += order->amount;
        worker->speed = worker->speed < SLOWEST ? SLOWEST : worker->speed > FASTEST ? FASTEST : worker->speed;
        break;
    case GM_ORDER_SELECT:
        worker->selected =
            (worker->selected + session->count + (size_t)(order->amount + (int)session->count)) %
            session->count;
        break;
    case GM_ORDER_MOVE:
    case GM_ORDER_STANDARD:
        move_parameter(worker, order);
        break;
    case GM_ORDER_SWITCH:
        ok = gm_session_switch(session, worker->selected, order->scheme, message);
        break;
    case GM_ORDER_ADD: {
        const struct gm_scheme *scheme = gm_session_unused(session);
        if (!scheme) {
            say(worker, "Every scheme that fits has a lane already.");
        } else if ((ok = gm_session_add(session, worker->selected, scheme, message))) {
            worker->selected = session->count - 1;
        }
        break;
    }
    case GM_ORDER_REMOVE:
        ok = gm_session_remove(session, worker->selected, message);
        if (worker->selected >= session->count) {
            worker->selected = session->count - 1;
        }
        break;
    case GM_ORDER_SAVE:
        save_picture(worker);
        break;
    case GM_ORDER_TOUR:
        begin_step(worker, order);
        break;
    case GM_ORDER_RUN:
        worker->paused = false;
        break;
    }
    if (!ok) {
        say(worker, message);
    }
    set_clock(worker, jumps ? gm_session_time(session) : due);
    worker->changed = true;
}

/* Changes that came together, and those that come soon after, make one restart. */
static bool restart_if_due(struct gm_worker *worker)
{
    char message[GM_MESSAGE];
    double now = wall_time();
    if (!worker->restart || now - worker->restarted < RESTART_PAUSE) {
        return false;
    }
    worker->restart = false;
    worker->restarted = now;
    worker->frozen = 0;
    if (worker->agenda.tour) { /* the step is shown again */
        worker->paused = worker->paused && !worker->agenda.over;
        worker->ahead = gm_tour_begin(worker->agenda.tour, worker->agenda.step);
        gm_agenda_rewind(&worker->agenda, -INFINITY);
    }
    if (!gm_session_restart(&worker->session, message)) {
        say(worker, message);
    }
    set_clock(worker, gm_session_time(&worker->session));
    worker->changed = true;
    return true;
}

/* ---- the thread ---- */

/* Called with the lock held; lets go of it while the shot is taken. */
static void take_shot(struct gm_worker *worker)
{
    worker->wanted = false;
    worker->changed = false;
    struct gm_shot *shot = &worker->shots[worker->filled];
    pthread_mutex_unlock(&worker->lock);
    gm_shot_take(shot, &worker->session, worker->selected);
    shot->paused = worker->paused;
    shot->behind = worker->behind;
    shot->speed = speed_of(worker->speed);
    snprintf(shot->message, sizeof shot->message, "%s", worker->message);
    shot->message_number = worker->message_number;
    pthread_mutex_lock(&worker->lock);
    worker->ready = true;
    const uint64_t one = 1;
    if (write(worker->wake, &one, sizeof one) < 0) {
        worker->leave = errno != EAGAIN; /* without a screen there is nothing to do */
    }
}

/* Called with the lock held: waits for news, at most until the next step is due. */
static void rest(struct gm_worker *worker)
{
    double next = gm_session_next(&worker->session), pause = INFINITY;
    if (!worker->paused && isfinite(next)) {
        pause = fmax((next - due_time(worker)) / speed_of(worker->speed), SLICE);
    }
    if (worker->restart) {
        pause = fmin(pause, RESTART_PAUSE);
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

static void *work(void *self)
{
    struct gm_worker *worker = self;
    pthread_mutex_lock(&worker->lock);
    while (!worker->leave) {
        while (worker->count > 0) {
            struct gm_order order = worker->queue[worker->first];
            worker->first = (worker->first + 1) % QUEUE;
            worker->count--;
            pthread_mutex_unlock(&worker->lock);
            obey(worker, &order);
            pthread_mutex_lock(&worker->lock);
        }
        pthread_mutex_unlock(&worker->lock);
        restart_if_due(worker);
        bool worked = step(worker);
        keep_agenda(worker);
        watch_frozen(worker);
        pthread_mutex_lock(&worker->lock);
        if (worker->wanted && worker->changed) {
            take_shot(worker);
        } else if (!worked && worker->count == 0 && !worker->leave) {
            rest(worker);
        }
    }
    pthread_mutex_unlock(&worker->lock);
    return NULL;
}

struct gm_worker *gm_worker_open(const struct gm_request *request, enum gm_theme theme, int wake,
                                 const struct gm_order *first, char *message)
{
    struct gm_worker *worker = calloc(1, sizeof *worker);
    if (!worker || !gm_shot_open(&worker->shots[0]) || !gm_shot_open(&worker->shots[1])) {
        snprintf(message, GM_MESSAGE, "There is not enough memory.");
        goto failed;
    }
    if (!gm_session_open(&worker->session, request, message)) {
        goto failed;
    }
    worker->theme = theme;
    worker->wake = wake;
    worker->changed = worker->wanted = true;
    worker->speed = first_speed(&worker->session);
    worker->restarted = -1e9;
    worker->ahead = -INFINITY;
    if (first) {
        worker->queue[worker->count++] = *first;
    }
    set_clock(worker, gm_session_time(&worker->session));
    pthread_condattr_t attributes;
    pthread_condattr_init(&attributes);
    pthread_condattr_setclock(&attributes, CLOCK_MONOTONIC);
    pthread_cond_init(&worker->news, &attributes);
    pthread_condattr_destroy(&attributes);
    pthread_mutex_init(&worker->lock, NULL);
    /* Signals are for the thread that has the terminal. */
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    int error = pthread_create(&worker->thread, NULL, work, worker);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    if (error == 0) {
        return worker;
    }
    snprintf(message, GM_MESSAGE, "No thread could be started: %s.", strerror(error));
    gm_session_close(&worker->session);
failed:
    if (worker) {
        gm_shot_close(&worker->shots[0]);
        gm_shot_close(&worker->shots[1]);
    }
    free(worker);
    return NULL;
}

void gm_worker_close(struct gm_worker *worker)
{
    if (!worker) {
        return;
    }
    pthread_mutex_lock(&worker->lock);
    worker->leave = true;
    pthread_cond_signal(&worker->news);
    pthread_mutex_unlock(&worker->lock);
    pthread_join(worker->thread, NULL);
    pthread_cond_destroy(&worker->news);
    pthread_mutex_destroy(&worker->lock);
    gm_session_close(&worker->session);
    gm_shot_close(&worker->shots[0]);
    gm_shot_close(&worker->shots[1]);
    free(worker);
}

void gm_worker_order(struct gm_worker *worker, struct gm_order order)
{
    pthread_mutex_lock(&worker->lock);
    if (worker->count < QUEUE) {
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
