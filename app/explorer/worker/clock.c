/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Model time against the clock on the wall: how far to step, ahead, back home, and what stands still. */
#include <math.h>
#include <stdio.h>
#include <time.h>

#include "app/explorer/worker/shared.h"

/* A simulation that is later than this lets the clock wait for it. */
static const double LATE = 0.1;
/* While it runs ahead, how it stands is told this often. */
static const double AHEAD_NEWS = 0.25;

double gm_worker_wall_time(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* Model time per second: 1, 2 or 5 times a power of ten. */
double gm_worker_speed_of(int number)
{
    static const double mantissa[] = {1, 2, 5};
    int decade = (int)floor(number / 3.0);
    return mantissa[number - 3 * decade] * pow(10, decade);
}

void gm_worker_say(struct gm_worker *worker, const char *sentence)
{
    snprintf(worker->message, sizeof worker->message, "%s", sentence);
    worker->message_number++;
    worker->changed = true;
}

/* From now on model time goes on from t. */
void gm_worker_set_clock(struct gm_worker *worker, double t)
{
    worker->clock_t = t;
    worker->clock_wall = gm_worker_wall_time();
    worker->behind = false;
}

/* Of two times the one that comes first, as time runs now. */
static double sooner(const struct gm_worker *worker, double a, double b)
{
    return (a - b) * gm_session_direction(&worker->session) < 0 ? a : b;
}

static double later(const struct gm_worker *worker, double a, double b)
{
    return sooner(worker, a, b) == a ? b : a;
}

/* The model time that is due. A lane that lags behind the others, being new, is stepped also when all is
 * paused. */
double gm_worker_due_time(const struct gm_worker *worker)
{
    const struct gm_session *session = &worker->session;
    double together = gm_session_time(session);
    if (worker->paused) {
        return together;
    }
    double elapsed = gm_worker_speed_of(worker->speed) * (gm_worker_wall_time() - worker->clock_wall);
    double due = later(worker, worker->clock_t + gm_session_direction(session) * elapsed, together);
    if (worker->homewards) {
        due = sooner(worker, due, session->lanes[0]->t0);
    }
    if (gm_session_direction(session) > 0) {
        due = fmax(fmin(due, gm_agenda_limit(&worker->agenda)), together);
    }
    if (worker->preview) {
        const struct gm_timing *timing = session->lanes[0]->parameters;
        due = sooner(worker, due, timing->until);
    }
    return due;
}

/* How much model time is left until t. */
double gm_worker_left_until(const struct gm_worker *worker, double t)
{
    return (t - gm_session_time(&worker->session)) * gm_session_direction(&worker->session);
}

/* Makes what the agenda has until now; true if that was something. */
static bool make_changes(struct gm_worker *worker)
{
    char message[GM_MESSAGE] = "";
    const double limit = gm_agenda_limit(&worker->agenda);
    if (gm_session_direction(&worker->session) < 0) {
        return false;
    }
    const bool stop = gm_agenda_keep(&worker->agenda, &worker->session, message);
    if (message[0]) {
        gm_worker_say(worker, message);
    }
    if (stop) {
        worker->paused = true;
        worker->ahead = false;
        worker->changed = true;
        gm_worker_set_clock(worker, gm_session_time(&worker->session));
    }
    return gm_agenda_limit(&worker->agenda) > limit;
}

void gm_worker_keep_agenda(struct gm_worker *worker)
{
    make_changes(worker);
}

static bool step_ahead(struct gm_worker *worker)
{
    double begun = gm_worker_wall_time(), part = (worker->ahead_to - worker->ahead_from) / 1000;
    bool worked = false, on = true;
    while (on && gm_worker_wall_time() - begun < GM_WORKER_SLICE) {
        double next =
            later(worker, gm_session_time(&worker->session) + part, gm_session_next(&worker->session));
        double to = sooner(worker, next, worker->ahead_to);
        if (gm_session_direction(&worker->session) > 0) {
            to = fmin(to, gm_agenda_limit(&worker->agenda));
        }
        on = gm_session_advance(&worker->session, to);
        worked = worked || on;
    }
    if (!on && make_changes(worker)) {
        return true;
    }
    if (!on) {
        worker->ahead = false;
        worker->changed = true;
        gm_worker_set_clock(worker, gm_session_time(&worker->session));
    }
    if (begun - worker->ahead_told > AHEAD_NEWS) {
        worker->ahead_told = begun;
        worker->changed = true;
    }
    return worked;
}

/* Back where all began: whoever returned is seen now. */
static void stop_at_home(struct gm_worker *worker)
{
    const struct gm_lane *lane = worker->session.lanes[0];
    if (worker->homewards && gm_worker_left_until(worker, lane->t0) < 1e-6 * fabs(lane->run->dt)) {
        worker->homewards = false;
        worker->paused = true;
        gm_worker_say(worker,
                      "Back at the start: “from start” tells how near each scheme comes to where it began.");
    }
}

bool gm_worker_step(struct gm_worker *worker)
{
    if (worker->ahead) {
        return step_ahead(worker);
    }
    double begun = gm_worker_wall_time(), due = gm_worker_due_time(worker);
    bool worked = false;
    while (gm_worker_wall_time() - begun < GM_WORKER_SLICE && gm_session_advance(&worker->session, due)) {
        worked = true;
    }
    if (worked) {
        worker->changed = true;
    } else {
        stop_at_home(worker);
    }
    double next = gm_session_next(&worker->session);
    if (!worker->paused && isfinite(next)) {
        double lag = (gm_worker_due_time(worker) - next) * gm_session_direction(&worker->session) /
                     gm_worker_speed_of(worker->speed);
        if (lag > LATE) {
            /* the clock goes on from where the slowest lane is; model time is never skipped */
            gm_worker_set_clock(worker, later(worker, gm_session_time(&worker->session), next));
            worker->behind = true;
        } else if (lag < 0.5 * LATE && !worked) {
            worker->behind = false;
        }
    }
    return worked;
}

/* ---- frozen lanes ---- */

void gm_worker_watch_frozen(struct gm_worker *worker)
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
            [GM_OUT_OF_MEMORY] = "found no memory",
        };
        char sentence[GM_MESSAGE];
        snprintf(sentence, sizeof sentence, "%s %s at t = %.5g and stands still%s.", latest->scheme->title,
                 sentences[latest->run->status], latest->run->t,
                 frozen < worker->session.count ? "; the others go on" : "");
        gm_worker_say(worker, sentence);
    }
    worker->frozen = frozen;
}
