/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A session in model time: on, back, the other way, and to any moment of the past. */
#include <math.h>
#include <stdio.h>

#include "app/lanes/course.h"

static bool goes(const struct gm_lane *lane)
{
    return lane->run->status == GM_OK;
}

double gm_session_direction(const struct gm_session *session)
{
    return session->lanes[0]->run->dt < 0 ? -1 : 1;
}

/* Where a lane's next step ends, a little earlier than it is computed to be, so that lanes with the same step
   stay together whatever their round-off; times the direction, so that later is more. */
static double next_time(const struct gm_session *session, size_t i)
{
    const struct gm_run *run = session->lanes[i]->run;
    return gm_session_direction(session) * (run->t + run->dt * (1 - 1e-9));
}

/* Lanes that stand still have no say, unless all do. */
double gm_session_time(const struct gm_session *session)
{
    const double direction = gm_session_direction(session);
    double furthest = -INFINITY, still = -INFINITY;
    for (size_t i = 0; i < session->count; i++) {
        double t = direction * session->lanes[i]->run->t;
        if (goes(session->lanes[i])) {
            furthest = fmax(furthest, t);
        }
        still = fmax(still, t);
    }
    return direction * (isfinite(furthest) ? furthest : still);
}

double gm_session_next(const struct gm_session *session)
{
    const double direction = gm_session_direction(session);
    double next = INFINITY;
    for (size_t i = 0; i < session->count; i++) {
        const struct gm_run *run = session->lanes[i]->run;
        if (goes(session->lanes[i])) {
            next = fmin(next, direction * (run->t + run->dt));
        }
    }
    return direction * next;
}

/* ---- the past ---- */

double gm_session_lane_gone(const struct gm_session *session, size_t i)
{
    const struct gm_course *course = &session->courses[i];
    return course->gone + fabs(session->lanes[i]->run->t - course->from);
}

void gm_session_note(struct gm_session *session, size_t i, bool always)
{
    gm_past_note(&session->pasts[i], session->lanes[i], gm_session_lane_gone(session, i), always);
}

void gm_session_note_all(struct gm_session *session)
{
    gm_session_share_budget(session);
    for (size_t i = 0; i < session->count; i++) {
        gm_session_note(session, i, false);
    }
}

void gm_session_settle(struct gm_session *session)
{
    if (!session->visiting) {
        return;
    }
    session->visiting = false;
    for (size_t i = 0; i < session->count; i++) {
        long steps = session->lanes[i]->run->steps;
        gm_session_cut_log(session, i, steps);
        gm_past_forget(&session->pasts[i], steps);
    }
}

/* ---- on ---- */

/* So many records a call: enough for the graphs, which keep the least and greatest of many steps. */
enum { RECORDS = 64 };

bool gm_session_advance(struct gm_session *session, double t)
{
    const double due = gm_session_direction(session) * t;
    size_t chosen = session->count;
    for (size_t i = 0; i < session->count; i++) {
        if (goes(session->lanes[i]) && next_time(session, i) <= due &&
            (chosen == session->count || next_time(session, i) < next_time(session, chosen))) {
            chosen = i;
        }
    }
    if (chosen == session->count) {
        return false;
    }
    gm_session_settle(session);
    struct gm_lane *lane = session->lanes[chosen];
    double steps = (t - lane->run->t) / lane->run->dt;
    gm_lane_advance(lane, steps > 2 * RECORDS ? (long)fmin(steps / RECORDS, 1e6) : 1);
    gm_lane_record(lane);
    if (goes(lane)) {
        gm_session_note(session, chosen, false);
    }
    return true;
}

/* ---- back ---- */

/* Steps a lane up to `steps`, making the logged changes on the way. */
static void replay(struct gm_session *session, size_t i, long steps)
{
    char message[GM_MESSAGE];
    struct gm_lane *lane = session->lanes[i];
    size_t change = 0;
    long from = lane->run->steps; /* a snapshot holds the changes made at its step */
    while (lane->run->steps < steps && goes(lane)) {
        gm_run_advance(lane->run, 1);
        gm_lane_record(lane);
        for (; change < session->log.change_count; change++) {
            const struct gm_change *next = &session->log.changes[change];
            if (next->lane != i || next->step <= from) {
                continue;
            }
            if (next->step > lane->run->steps) {
                break;
            }
            gm_session_apply(session, i, next->text, message);
        }
    }
}

/* The lane was taken to a moment. */
static void follow(struct gm_session *session, size_t i, const struct gm_moment *moment)
{
    session->courses[i] = (struct gm_course){.gone = moment->gone, .from = session->lanes[i]->run->t};
}

static const char too_large[] = "There is no snapshot to go back to: the ensemble is too large to keep any.";

bool gm_session_back(struct gm_session *session, char *message)
{
    const double direction = gm_session_direction(session);
    double latest = direction * gm_session_time(session);
    bool moved = false;
    gm_session_settle(session);
    for (size_t i = 0; i < session->count; i++) {
        struct gm_lane *lane = session->lanes[i];
        long steps = lane->run->steps;
        if (direction * lane->run->t < latest - 1e-9 * fabs(lane->run->dt) || steps == 0) {
            continue;
        }
        const struct gm_moment *moment = gm_past_return(&session->pasts[i], lane, steps - 1);
        if (!moment) {
            return gm_session_refuse(message, too_large);
        }
        follow(session, i, moment);
        gm_session_cut_log(session, i, steps - 1);
        gm_past_forget(&session->pasts[i], steps - 1);
        replay(session, i, steps - 1);
        moved = true;
    }
    return moved || gm_session_refuse(message, "This is the start.");
}

/* ---- the other way ---- */

bool gm_session_turn(struct gm_session *session, char *message)
{
    for (size_t i = 0; i < session->count; i++) {
        const struct gm_scheme *scheme = session->lanes[i]->scheme;
        if (scheme->family->own_time || scheme->family->not_resumable) {
            snprintf(message, GM_MESSAGE, "%s chooses its own steps, and they only go forwards.",
                     scheme->title);
            return false;
        }
    }
    gm_session_settle(session);
    for (size_t i = 0; i < session->count; i++) {
        char text[sizeof(struct gm_change){0}.text], number[64];
        snprintf(text, sizeof text, "dt=%s",
                 gm_number_format(-session->lanes[i]->run->dt, number, sizeof number));
        if (!gm_session_change(session, i, text, message)) {
            return false;
        }
    }
    session->turned = true;
    return true;
}

double gm_session_from_start(const struct gm_session *session, size_t i)
{
    const struct gm_lane *lane = session->lanes[i];
    const double *state = gm_run_state(lane->run);
    double largest = 0;
    for (size_t k = 0; k < lane->problem.n * lane->problem.m; k++) {
        largest = fmax(largest, fabs(state[k] - lane->start[k]));
    }
    return largest;
}

/* ---- to any moment ---- */

double gm_session_gone(const struct gm_session *session)
{
    double gone = 0;
    for (size_t i = 0; i < session->count; i++) {
        gone = fmax(gone, gm_session_lane_gone(session, i));
    }
    return gone;
}

double gm_session_reach(const struct gm_session *session)
{
    double reach = gm_session_gone(session);
    for (size_t i = 0; i < session->count; i++) {
        const struct gm_past *past = &session->pasts[i];
        reach = fmax(reach, past->count > 0 ? past->moments[past->count - 1].gone : 0);
    }
    return reach;
}

double gm_session_after(const struct gm_session *session, double gone)
{
    double after = INFINITY;
    for (size_t i = 0; i < session->count; i++) {
        const struct gm_past *past = &session->pasts[i];
        for (size_t k = past->count; k-- > 0 && past->moments[k].gone > gone * (1 + 1e-9);) {
            after = fmin(after, past->moments[k].gone);
        }
    }
    return isfinite(after) ? after : gone;
}

bool gm_session_visit(struct gm_session *session, double gone, char *message)
{
    for (size_t i = 0; i < session->count && !session->visiting; i++) {
        gm_session_note(session, i, true); /* so that the end is within reach */
    }
    for (size_t i = 0; i < session->count; i++) {
        const struct gm_moment *moment =
            gm_past_visit(&session->pasts[i], session->lanes[i], gone + 1e-9 * fabs(gone));
        if (!moment) {
            return gm_session_refuse(message, too_large);
        }
        follow(session, i, moment);
    }
    session->visiting = true;
    return true;
}
