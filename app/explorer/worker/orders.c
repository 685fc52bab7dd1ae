/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the orders do. */
#include <math.h>
#include <stdio.h>

#include "app/explorer/worker/shared.h"

static void move_parameter(struct gm_worker *worker, const struct gm_order *order)
{
    char text[GM_VALUE_TEXT], message[GM_MESSAGE];
    const struct gm_parameter *row = order->row;
    const void *owner = gm_session_owner(&worker->session, worker->selected, order->of_scheme);
    if (order->kind == GM_ORDER_STANDARD) {
        snprintf(text, sizeof text, "%s", row->standard);
    } else if (order->kind == GM_ORDER_TYPE) {
        snprintf(text, sizeof text, "%s", order->text);
    } else if (order->kind == GM_ORDER_SLIDE) {
        if (!gm_slider_at(row, order->value, text)) {
            return;
        }
    } else if (!gm_slider_next(row, owner, order->amount, order->kind == GM_ORDER_NUDGE, text)) {
        snprintf(message, sizeof message,
                 row->type == GM_TEXT ? "%s is a word of your own: enter types it."
                                      : "%s is at the end of its range.",
                 row->key);
        gm_worker_say(worker, message);
        return;
    }
    if (!gm_session_set(&worker->session, worker->selected, row, order->of_scheme, text, &worker->restart,
                        message)) {
        gm_worker_say(worker, message);
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

static void go_ahead_to(struct gm_worker *worker, double to)
{
    worker->ahead = true;
    worker->ahead_from = gm_session_time(&worker->session);
    worker->ahead_to = to;
    worker->ahead_told = 0;
}

static bool run_ahead(struct gm_worker *worker, const char *text, char *message)
{
    double to;
    if (!gm_number_parse(text, &to) || !isfinite(to)) {
        snprintf(message, GM_MESSAGE, "\"%s\" is not a time.", text);
        return false;
    }
    if (gm_worker_left_until(worker, to) <= 0) {
        snprintf(message, GM_MESSAGE, "t = %g lies behind already.", to);
        return false;
    }
    go_ahead_to(worker, to);
    return true;
}

/* Where in the past an order goes; one up or down is a twentieth, or at least to the next snapshot. */
static double moment_of(const struct gm_session *session, const struct gm_order *order)
{
    double gone = gm_session_gone(session), part = gm_session_reach(session) / 20;
    return order->amount == 0  ? order->value
           : order->amount < 0 ? gone - part
                               : fmax(gone + part, gm_session_after(session, gone));
}

static bool turn(struct gm_worker *worker, char *message)
{
    struct gm_session *session = &worker->session;
    if (!gm_session_turn(session, message)) {
        return false;
    }
    const struct gm_lane *lane = session->lanes[0];
    worker->homewards = gm_worker_left_until(worker, lane->t0) > 0.5 * fabs(lane->run->dt);
    gm_worker_say(worker, worker->homewards ? "Time runs back to the start." : "Time runs the other way.");
    return true;
}

/* Starts all lanes again from a point of the picture. */
static bool start_from(struct gm_worker *worker, double x, double y, char *message)
{
    struct gm_session *session = &worker->session;
    struct gm_choice choices[GM_CHOICES];
    if (!session->scene->point) {
        return true;
    }
    size_t count = session->scene->point(gm_session_owner(session, worker->selected, false), x, y, choices);
    for (size_t i = 0; i < count; i++) {
        const struct gm_parameter *row = gm_scene_parameter(session->scene, choices[i].key);
        if (!gm_session_set(session, worker->selected, row, false, choices[i].value, &worker->restart,
                            message)) {
            return false;
        }
    }
    return true;
}

static void select_lane(struct gm_worker *worker, const struct gm_order *order)
{
    size_t count = worker->session.count;
    if (order->amount == 0) {
        worker->selected = order->value < (double)count ? (size_t)order->value : worker->selected;
    } else {
        worker->selected = (worker->selected + (size_t)((int)count + order->amount)) % count;
    }
}

/* To where a tour's step begins, if it builds on others. */
static void go_to_step(struct gm_worker *worker)
{
    const double begin = gm_tour_begin(worker->agenda.tour, worker->agenda.step);
    if (begin > gm_session_time(&worker->session)) {
        go_ahead_to(worker, begin);
    }
}

static void begin_step(struct gm_worker *worker, const struct gm_order *order)
{
    const struct gm_tour_step *step = &order->tour->steps[order->step];
    const double span = step->until - gm_tour_begin(order->tour, order->step);
    worker->agenda = gm_agenda_of(order->tour, order->step, gm_tour_first(order->tour, order->step));
    worker->paused = order->amount != 0;
    if (span > 0) {
        const int number = (int)round(3 * log10(span / step->seconds));
        worker->speed = number < GM_WORKER_SLOWEST   ? GM_WORKER_SLOWEST
                        : number > GM_WORKER_FASTEST ? GM_WORKER_FASTEST
                                                     : number;
    }
    go_to_step(worker);
}

/* All lanes are back at their start: the step is shown again. */
static void repeat_step(struct gm_worker *worker)
{
    if (worker->agenda.tour) {
        worker->paused = worker->paused && !worker->agenda.over;
        gm_agenda_rewind(&worker->agenda, -INFINITY);
        go_to_step(worker);
    }
}

static void restart(struct gm_worker *worker)
{
    char message[GM_MESSAGE];
    worker->restart = false;
    worker->restarted = gm_worker_wall_time();
    worker->frozen = 0;
    worker->ahead = worker->homewards = false;
    if (!gm_session_restart(&worker->session, message)) {
        gm_worker_say(worker, message);
    }
    gm_worker_set_clock(worker, gm_session_time(&worker->session));
    repeat_step(worker);
    worker->changed = true;
}

void gm_worker_obey(struct gm_worker *worker, const struct gm_order *order)
{
    struct gm_session *session = &worker->session;
    char message[GM_MESSAGE] = "";
    if (worker->restart && order->kind < GM_ORDER_SPEED) {
        restart(worker); /* what was asked for later comes after it */
    }
    double due = gm_worker_due_time(worker);
    /* Other orders leave the part of a step that has gone by. */
    bool jumps = order->kind <= GM_ORDER_RECORD || order->kind == GM_ORDER_RESTART;
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
        worker->speed = worker->speed < GM_WORKER_SLOWEST   ? GM_WORKER_SLOWEST
                        : worker->speed > GM_WORKER_FASTEST ? GM_WORKER_FASTEST
                                                            : worker->speed;
        break;
    case GM_ORDER_TURN:
        ok = turn(worker, message);
        gm_agenda_rewind(&worker->agenda, gm_session_time(session));
        break;
    case GM_ORDER_VISIT:
        worker->paused = true;
        ok = gm_session_visit(session, moment_of(session, order), message);
        gm_agenda_rewind(&worker->agenda, gm_session_time(session));
        break;
    case GM_ORDER_AHEAD:
        ok = run_ahead(worker, order->text, message);
        break;
    case GM_ORDER_HALT:
        worker->ahead = false;
        break;
    case GM_ORDER_SELECT:
        select_lane(worker, order);
        break;
    case GM_ORDER_POINT:
        ok = start_from(worker, order->x, order->y, message);
        break;
    case GM_ORDER_MOVE:
    case GM_ORDER_NUDGE:
    case GM_ORDER_STANDARD:
    case GM_ORDER_TYPE:
    case GM_ORDER_SLIDE:
        move_parameter(worker, order);
        break;
    case GM_ORDER_SWITCH:
        ok = gm_session_switch(session, worker->selected, order->scheme, message);
        break;
    case GM_ORDER_FORK:
        ok = gm_session_fork(session, worker->selected, order->scheme, message);
        worker->selected = ok ? session->count - 1 : worker->selected;
        break;
    case GM_ORDER_OVERLAY:
        ok = gm_session_overlay(session, message);
        break;
    case GM_ORDER_ADD: {
        const struct gm_scheme *scheme = gm_session_unused(session);
        if (!scheme) {
            gm_worker_say(worker, "Every scheme that fits has a lane already.");
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
    case GM_ORDER_RECORD:
        gm_worker_record(worker, (enum gm_theme)order->amount);
        break;
    case GM_ORDER_TELL:
        gm_worker_tell(worker, (enum gm_theme)order->amount);
        break;
    case GM_ORDER_SAVE:
        gm_worker_save(worker, (enum gm_theme)order->amount);
        break;
    case GM_ORDER_TOUR:
        begin_step(worker, order);
        break;
    case GM_ORDER_RUN:
        worker->paused = false;
        break;
    }
    if (!ok) {
        gm_worker_say(worker, message);
    }
    gm_worker_set_clock(worker, jumps ? gm_session_time(session) : due);
    worker->changed = worker->unrecorded = true;
}

/* Changes that came together, and those that come soon after, make one restart. */
void gm_worker_restart_if_due(struct gm_worker *worker)
{
    if (worker->restart && gm_worker_wall_time() - worker->restarted >= GM_WORKER_RESTART_PAUSE) {
        restart(worker);
    }
}
