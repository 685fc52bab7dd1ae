/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Model time against wall time: how far to step, ahead or back, which lanes are frozen; and the orders
   of the user, in the thread that steps. */
#include "app/explorer/worker/session.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "app/native/engine.h"
#include "core/basics.h"
#include "render/clock.h"

/* lag in seconds above which the clock waits for the simulation */
static const double LATE = 0.1;
/* seconds between progress reports while it runs ahead */
static const double AHEAD_NEWS = 0.25;

/* seconds of stepping between two looks for orders; waking more often gains nothing */
static const double SLICE = 0.008;
/* seconds between two restarts, at least */
static const double RESTART_PAUSE = 0.033;
/* initial wall time of the scene's time span, in seconds */
static const double FIRST_SECONDS = 6;

enum { SLOWEST = -21, FASTEST = 15 }; /* range of the speed numbers */

double gm_play_speed(const struct gm_play *play)
{
    static const double mantissa[] = {1, 2, 5};
    int decade = (int)floor(play->speed / 3.0);
    return mantissa[play->speed - 3 * decade] * pow(10, decade);
}

/* Sets the speed by number (three per decade, 0 is 1 per second), limited to the range. */
static void set_speed(struct gm_play *play, int number)
{
    play->speed = number < SLOWEST ? SLOWEST : number > FASTEST ? FASTEST : number;
}

/* Sets the speed at which `span` of model time takes `seconds`. */
static void set_speed_for(struct gm_play *play, double span, double seconds)
{
    set_speed(play, (int)round(3 * log10(span / seconds)));
}

/* Sets the message of the status line. */
__attribute__((format(printf, 2, 3))) static void say(struct gm_play *play, const char *format, ...)
{
    va_list values;
    va_start(values, format);
    vsnprintf(play->message, sizeof play->message, format, values);
    va_end(values);
    play->message_number++;
    play->changed = true;
}

/* Resumes model time from t. */
static void set_clock(struct gm_play *play, double t)
{
    play->clock_t = t;
    play->clock_wall = gm_clock_seconds();
    play->behind = false;
}

/* Returns the earlier of two times in the direction in which time runs. */
static double sooner(const struct gm_play *play, double a, double b)
{
    return (a - b) * gm_session_direction(&play->session) < 0 ? a : b;
}

static double later(const struct gm_play *play, double a, double b)
{
    return sooner(play, a, b) == a ? b : a;
}

/* Returns the model time that is due. A lane behind the others, such as a new one, is stepped even while
   paused. */
static double due_time(const struct gm_play *play)
{
    const struct gm_session *session = &play->session;
    double together = gm_session_time(session);
    if (play->paused) {
        return together;
    }
    double elapsed = gm_play_speed(play) * (gm_clock_seconds() - play->clock_wall);
    double due = later(play, play->clock_t + gm_session_direction(session) * elapsed, together);
    if (play->homewards) {
        due = sooner(play, due, session->lanes[0]->t0);
    }
    if (gm_session_direction(session) > 0) {
        due = fmax(fmin(due, gm_agenda_limit(&play->agenda)), together);
    }
    if (play->preview) {
        const struct gm_timing *timing = session->lanes[0]->parameters;
        due = sooner(play, due, timing->until);
    }
    return due;
}

double gm_play_left_until(const struct gm_play *play, double t)
{
    return (t - gm_session_time(&play->session)) * gm_session_direction(&play->session);
}

/* Grades the lanes as they are now, if the step of the tour is an exercise. */
static void grade(struct gm_play *play)
{
    const struct gm_session *session = &play->session;
    const struct gm_tour_step *step = &play->agenda.tour->steps[play->agenda.step];
    if (step->expectation_count > 0) {
        play->passed = gm_exercise_passed(step, &session->log, (const struct gm_lane *const *)session->lanes,
                                          play->verdict);
    }
}

bool gm_play_keep_agenda(struct gm_play *play)
{
    char message[GM_MESSAGE] = "";
    const double limit = gm_agenda_limit(&play->agenda);
    if (gm_session_direction(&play->session) < 0) {
        return false;
    }
    const bool stop = gm_agenda_keep(&play->agenda, &play->session, message);
    if (message[0]) {
        say(play, "%s", message);
    }
    if (stop) {
        play->paused = true;
        play->ahead = false;
        play->changed = true;
        grade(play);
        set_clock(play, gm_session_time(&play->session));
    }
    return gm_agenda_limit(&play->agenda) > limit;
}

/* Runs ahead to the time `to` without pausing. */
static void start_ahead(struct gm_play *play, double to)
{
    play->ahead = true;
    play->ahead_from = gm_session_time(&play->session);
    play->ahead_to = to;
    play->ahead_told = 0;
}

static bool step_ahead(struct gm_play *play)
{
    double begun = gm_clock_seconds(), part = (play->ahead_to - play->ahead_from) / 1000;
    bool worked = false, on = true;
    while (on && gm_clock_seconds() - begun < SLICE) {
        double next = later(play, gm_session_time(&play->session) + part, gm_session_next(&play->session));
        double to = sooner(play, next, play->ahead_to);
        if (gm_session_direction(&play->session) > 0) {
            to = fmin(to, gm_agenda_limit(&play->agenda));
        }
        on = gm_session_advance(&play->session, to);
        worked = worked || on;
    }
    if (!on && gm_play_keep_agenda(play)) {
        return true;
    }
    if (!on) {
        play->ahead = false;
        play->changed = true;
        set_clock(play, gm_session_time(&play->session));
    }
    if (begun - play->ahead_told > AHEAD_NEWS) {
        play->ahead_told = begun;
        play->changed = true;
    }
    return worked;
}

static bool step_along(struct gm_play *play)
{
    const double begun = gm_clock_seconds(), from = gm_session_time(&play->session);
    const struct gm_lane *first = play->session.lanes[0];
    /* at most one second's worth of steps, so that orders are heard */
    const double a_second = from + gm_session_direction(&play->session) * play->rate;
    const double due = sooner(play, due_time(play), later(play, a_second, gm_session_next(&play->session)));
    bool worked = false;
    while (gm_clock_seconds() - begun < SLICE && gm_session_advance(&play->session, due)) {
        worked = true;
    }
    if (worked) {
        const double covered = fabs(gm_session_time(&play->session) - from);
        play->rate = covered > 0 ? covered / fmax(gm_clock_seconds() - begun, 1e-9) : play->rate;
        play->changed = true;
    } else if (play->homewards && gm_play_left_until(play, first->t0) < 1e-6 * fabs(first->run->dt)) {
        play->homewards = false;
        play->paused = true; /* so that the returned states can be seen */
        say(play, "Back at the start: “from start” shows how near each scheme comes to where it began.");
    }
    double next = gm_session_next(&play->session);
    if (!play->paused && isfinite(next)) {
        double lag = (due_time(play) - next) * gm_session_direction(&play->session) / gm_play_speed(play);
        if (lag > LATE) {
            /* the clock resumes at the slowest lane's time: model time is never skipped */
            set_clock(play, later(play, gm_session_time(&play->session), next));
            play->behind = true;
        } else if (lag < 0.5 * LATE && !worked) {
            play->behind = false;
        }
    }
    return worked;
}

bool gm_play_step(struct gm_play *play)
{
    static const double often = 0.25; /* seconds of steps after which compiling may be worthwhile */
    const double begun = gm_clock_seconds();
    const bool worked = play->ahead ? step_ahead(play) : step_along(play);
    play->stepped += worked ? gm_clock_seconds() - begun : 0;
    for (size_t i = 0; play->stepped > often && i < play->session.count; i++) {
        gm_engine_look(play->session.lanes[i], play->stepped / (double)play->session.count, 0);
    }
    play->stepped = play->stepped > often ? 0 : play->stepped;
    return worked;
}

double gm_play_pause(const struct gm_play *play)
{
    const double next = gm_session_next(&play->session);
    double pause = INFINITY;
    if (!play->paused && isfinite(next)) {
        pause = fmax(fabs(next - due_time(play)) / gm_play_speed(play), SLICE);
    }
    return play->session.restart ? fmin(pause, RESTART_PAUSE) : pause;
}

/* ---- restarts, and the steps of a tour ---- */

/* Runs ahead to the start of a tour's step that builds on earlier ones. */
static void go_to_step(struct gm_play *play)
{
    const double begin = gm_tour_begin(play->agenda.tour, play->agenda.step);
    if (begin > gm_session_time(&play->session)) {
        start_ahead(play, begin);
    }
}

/* Plays a step of a tour. The session must be at the start of step gm_tour_first(tour, step). If `waits`,
   it pauses there. */
static void play_tour_step(struct gm_play *play, const struct gm_tour *tour, size_t step, bool waits)
{
    const double span = tour->steps[step].until - gm_tour_begin(tour, step);
    play->agenda = gm_agenda_of(tour, step, gm_tour_first(tour, step));
    play->paused = waits;
    if (span > 0) {
        set_speed_for(play, span, tour->steps[step].seconds);
    }
    go_to_step(play);
}

/* Restarts all lanes at once. */
static void restart(struct gm_play *play)
{
    char message[GM_MESSAGE];
    play->restarted = gm_clock_seconds();
    play->frozen = 0;
    play->ahead = play->homewards = false;
    if (!gm_session_restart(&play->session, message)) {
        say(play, "%s", message);
    }
    set_clock(play, gm_session_time(&play->session));
    if (play->agenda.tour) { /* its step is shown again */
        play->paused = play->paused && !play->agenda.over;
        gm_agenda_rewind(&play->agenda, -INFINITY);
        go_to_step(play);
    }
    play->changed = true;
}

void gm_play_restart_if_due(struct gm_play *play)
{
    if (play->session.restart && gm_clock_seconds() - play->restarted >= RESTART_PAUSE) {
        restart(play);
    }
}

void gm_play_begin(struct gm_play *play)
{
    const struct gm_lane *lane = play->session.lanes[0];
    const struct gm_timing *timing = lane->parameters;
    const double span = fabs(timing->until - lane->t0);
    play->changed = true;
    play->restarted = -1e9;
    if (span > 0 && isfinite(span)) {
        set_speed_for(play, span, FIRST_SECONDS);
    }
    set_clock(play, gm_session_time(&play->session));
}

/* ---- frozen lanes ---- */

void gm_play_watch_frozen(struct gm_play *play)
{
    const struct gm_lane *latest = NULL;
    size_t frozen = 0;
    for (size_t i = 0; i < play->session.count; i++) {
        const struct gm_lane *lane = play->session.lanes[i];
        if (lane->run->status == GM_OK) {
            continue;
        }
        frozen++;
        if (!latest || lane->run->t >= latest->run->t) {
            latest = lane;
        }
    }
    if (frozen > play->frozen && latest) {
        static const char *const sentences[] = {
            [GM_OK] = "",
            [GM_BLOW_UP] = "left all bounds",
            [GM_NO_CONVERGENCE] = "found no solution of its equations",
            [GM_MESH_CROSSING] = "tangled its mesh",
            [GM_STEP_COLLAPSE] = "found no time step",
            [GM_OUT_OF_MEMORY] = "found no memory",
            [GM_STEP_TOO_SMALL] = "needs steps that are too small",
            [GM_EVENTS_ACCUMULATE] = "has events without end",
            [GM_SLIDING] = "slides along a switch",
            [GM_NO_TANGENT] = "has an event without tangents",
        };
        say(play, "%s %s at t = %.5g and stands still%s.", latest->scheme->title,
            sentences[latest->run->status], latest->run->t,
            frozen < play->session.count ? "; the others continue" : "");
    }
    play->frozen = frozen;
}

/* ---- orders: what failed is in the next shot ---- */

static void run_ahead(struct gm_play *play, const char *text, char *message)
{
    double to;
    if (!gm_number_parse(text, &to) || !isfinite(to)) {
        gm_refuse(message, "\"%s\" is not a time.", text);
    } else if (gm_play_left_until(play, to) <= 0) {
        gm_refuse(message, "t = %g has already passed.", to);
    } else {
        start_ahead(play, to);
    }
}

static void turn(struct gm_play *play, char *message)
{
    const struct gm_lane *lane = play->session.lanes[0];
    if (gm_session_turn(&play->session, message)) {
        play->homewards = gm_play_left_until(play, lane->t0) > 0.5 * fabs(lane->run->dt);
        gm_refuse(message, play->homewards ? "Time runs back to the start." : "Time runs the other way.");
    }
}

void gm_order_obey(const struct gm_order *order, struct gm_play *play, struct gm_capture *capture)
{
    struct gm_session *session = &play->session;
    char message[GM_MESSAGE] = "";
    if (play->session.restart && order->kind < GM_ORDER_SPEED) {
        restart(play); /* a later order acts on the restarted lanes */
    }
    double due = due_time(play);
    /* The other orders preserve the elapsed part of a step. */
    bool jumps = order->kind <= GM_ORDER_RECORD || order->kind == GM_ORDER_RESTART;
    switch (order->kind) {
    case GM_ORDER_PAUSE:
        play->paused = !play->paused;
        break;
    case GM_ORDER_RUN:
        play->paused = false;
        break;
    case GM_ORDER_SPEED:
        set_speed(play, play->speed + order->amount);
        break;
    case GM_ORDER_TURN:
        turn(play, message);
        break;
    case GM_ORDER_AHEAD:
        run_ahead(play, order->text, message);
        break;
    case GM_ORDER_HALT:
        play->ahead = false;
        break;
    case GM_ORDER_RECORD:
        gm_capture_record(capture, session, (enum gm_theme)order->amount, message);
        break;
    case GM_ORDER_TELL:
        gm_capture_tell(capture, session, (enum gm_theme)order->amount);
        break;
    case GM_ORDER_SAVE:
        gm_capture_save(play, (enum gm_theme)order->amount, message);
        break;
    case GM_ORDER_SYSTEM:
        gm_capture_save_system(play, message);
        break;
    case GM_ORDER_ANSWER:
        grade(play);
        gm_capture_save_answer(play, message);
        break;
    case GM_ORDER_TOUR:
        play_tour_step(play, order->tour, order->step, order->amount != 0);
        break;
    default:
        play->paused = play->paused || order->kind == GM_ORDER_FORWARD || order->kind == GM_ORDER_BACK ||
                       order->kind == GM_ORDER_VISIT;
        if (order->kind != GM_ORDER_SELECT && order->kind != GM_ORDER_OVERLAY &&
            order->kind != GM_ORDER_LOOK) {
            play->verdict[0] = '\0';
            play->passed = false;
        }
        gm_session_obey(session, order, message);
    }
    if (message[0]) {
        say(play, "%s", message);
    }
    if (order->kind == GM_ORDER_BACK || order->kind == GM_ORDER_TURN || order->kind == GM_ORDER_VISIT) {
        gm_agenda_rewind(&play->agenda, gm_session_time(session));
    }
    set_clock(play, jumps ? gm_session_time(session) : due);
    play->changed = capture->unrecorded = true;
}
