/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A session: the common part of lanes that are driven live. It is one file because everything in it keeps
   the same data consistent: the lanes, their snapshots, and the log that reproduces them. */
#include "app/runs/session.h"

#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/native/engine.h"
#include "core/schemes.h"
#include "scenes/common/lane_pack.h"
#include "scenes/common/symbol.h"

/* ---- the way back of a lane: snapshots in bounded memory, thinned when they are full ---- */

enum { MOST_MOMENTS = 4096 };

static void close_past(struct gm_past *past)
{
    for (size_t i = 0; i < past->count; i++) {
        free(past->moments[i].memory);
    }
    free(past->moments);
    *past = (struct gm_past){0};
}

static void thin(struct gm_past *past)
{
    size_t kept = 0;
    for (size_t i = 0; i < past->count; i++) {
        if (i % 2 == 0) {
            past->moments[kept++] = past->moments[i];
        } else {
            free(past->moments[i].memory);
        }
    }
    past->count = kept;
    past->every *= 2;
}

/* A copy for a fork of the lane; an empty one when out of memory. */
static struct gm_past copy_past(const struct gm_past *past)
{
    const struct gm_past empty = {
        .bound = past->bound, .every = past->every, .gone = past->gone, .from = past->from};
    struct gm_past copy = empty;
    copy.moments = past->count > 0 ? malloc(MOST_MOMENTS * sizeof *copy.moments) : NULL;
    for (size_t i = 0; copy.moments && i < past->count; i++) {
        struct gm_moment *moment = &copy.moments[i];
        *moment = past->moments[i];
        moment->memory = malloc(moment->size);
        if (!moment->memory) {
            close_past(&copy);
            return empty;
        }
        memcpy(moment->memory, past->moments[i].memory, moment->size);
        copy.count++;
    }
    return copy;
}

/* Bytes from a moment's start to its snapshot: the parameters, of any size (a system's texts), and the
   padding for the snapshot's alignment. */
static size_t snapshot_at(const struct gm_lane *lane)
{
    const size_t unit = _Alignof(max_align_t);
    return (lane->scene->size + unit - 1) / unit * unit;
}

/* Writes the lane into the moment; its memory stays NULL when out of memory. */
static void save(const struct gm_lane *lane, double gone, struct gm_moment *moment)
{
    size_t size = snapshot_at(lane) + gm_run_snapshot_size(lane->run);
    if (moment->size != size) { /* the size depends on the scheme */
        free(moment->memory);
        moment->memory = malloc(size);
        moment->size = moment->memory ? size : 0;
    }
    if (!moment->memory) {
        return;
    }
    memcpy(moment->memory, lane->parameters, lane->scene->size);
    gm_run_save(lane->run, (char *)moment->memory + snapshot_at(lane));
    moment->steps = lane->run->steps;
    moment->gone = gone;
}

static void forget_after(struct gm_past *past, int64_t steps)
{
    while (past->count > 0 && past->moments[past->count - 1].steps > steps) {
        free(past->moments[--past->count].memory);
    }
}

/* Saves the lane's current state, `gone` after its start, if it is far enough from the last snapshot; with `always` in
   any case, and instead of one at the same step. Drops snapshots of later steps: the lane has stepped back and
   continued from there. */
static void note_moment(struct gm_past *past, const struct gm_lane *lane, double gone, bool always)
{
    int64_t steps = lane->run->steps;
    forget_after(past, steps);
    if (past->count > 0) {
        struct gm_moment *last = &past->moments[past->count - 1];
        if (last->steps == steps) {
            if (always) {
                save(lane, gone, last);
            }
            if (!last->memory) {
                past->count--;
            }
            return;
        }
        if (!always && steps - last->steps < past->every) {
            return;
        }
    }
    if (past->bound < 2) { /* an ensemble so large that its budget holds nothing worth having */
        return;
    }
    if (past->count == past->bound) {
        thin(past);
    }
    if (!past->moments) {
        past->moments = malloc(MOST_MOMENTS * sizeof *past->moments);
    }
    struct gm_moment moment = {0};
    if (past->moments) {
        save(lane, gone, &moment);
    }
    if (moment.memory) {
        past->moments[past->count++] = moment;
    }
}

/* Takes the lane to the last snapshot at or before `steps`, and at or before `gone` or the first one; returns it, or
   NULL. Later ones stay. */
static const struct gm_moment *return_to(const struct gm_past *past, struct gm_lane *lane, int64_t steps,
                                         double gone)
{
    size_t count = past->count;
    while (count > 0 && past->moments[count - 1].steps > steps) {
        count--;
    }
    while (count > 1 && past->moments[count - 1].gone > gone) {
        count--;
    }
    const struct gm_moment *moment = count > 0 ? &past->moments[count - 1] : NULL;
    if (!moment || !gm_lane_load(lane, (const char *)moment->memory + snapshot_at(lane))) {
        return NULL;
    }
    memcpy(lane->parameters, moment->memory, lane->scene->size);
    return moment;
}

static const char short_of_memory[] = "There is not enough memory.";

/* ---- the parameters of a lane, as last set ---- */

const void *gm_session_owner(const struct gm_session *session, size_t lane, bool of_scheme)
{
    const struct gm_lane_spec *wanted = &session->wanted[lane];
    if (of_scheme) {
        return wanted->parameters ? &wanted->settings : &session->lanes[lane]->settings;
    }
    return wanted->parameters ? wanted->parameters : session->lanes[lane]->parameters;
}

bool gm_session_differs(const struct gm_session *session, const struct gm_parameter *row)
{
    double first = gm_parameter_get(row, gm_session_owner(session, 0, gm_is_setting(row)));
    for (size_t i = 1; i < session->count; i++) {
        if (gm_parameter_get(row, gm_session_owner(session, i, gm_is_setting(row))) != first) {
            return true;
        }
    }
    return false;
}

/* ---- the lanes in model time ---- */

static bool goes(const struct gm_lane *lane)
{
    return lane->run->status == GM_OK && !lane->run->stopped;
}

double gm_session_direction(const struct gm_session *session)
{
    return session->lanes[0]->run->dt < 0 ? -1 : 1;
}

/* The end of a lane's next step, in the direction of time; a little before the computed one, so that lanes
   with the same step size stay together in spite of round-off. */
static double next_time(const struct gm_session *session, size_t i)
{
    const struct gm_run *run = session->lanes[i]->run;
    return gm_session_direction(session) * (run->t + run->dt * (1 - 1e-9));
}

/* Lanes that have stopped do not count, unless all have. */
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

static double lane_gone(const struct gm_session *session, size_t i)
{
    const struct gm_past *past = &session->pasts[i];
    return past->gone + fabs(session->lanes[i]->run->t - past->from);
}

double gm_session_gone(const struct gm_session *session)
{
    double gone = 0;
    for (size_t i = 0; i < session->count; i++) {
        gone = fmax(gone, lane_gone(session, i));
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

/* ---- the stored past: snapshots, and the log of changes ---- */

/* Snapshots of all lanes together take at most this. */
enum { PAST_BUDGET = 64 << 20 };

static void share_budget(struct gm_session *session)
{
    for (size_t i = 0; i < session->count; i++) {
        struct gm_past *past = &session->pasts[i];
        size_t size = session->scene->size + gm_run_snapshot_size(session->lanes[i]->run);
        const size_t bound = PAST_BUDGET / session->count / size;
        past->bound = bound < MOST_MOMENTS ? bound : MOST_MOMENTS;
        while (past->count > past->bound && past->count > 1) {
            thin(past);
        }
    }
}

/* Saves a snapshot of a lane, if one is due or with `always`. */
static void note_lane(struct gm_session *session, size_t i, bool always)
{
    note_moment(&session->pasts[i], session->lanes[i], lane_gone(session, i), always);
}

static void note_lanes(struct gm_session *session)
{
    share_budget(session);
    for (size_t i = 0; i < session->count; i++) {
        note_lane(session, i, false);
    }
}

static bool is_later(const struct gm_change *change, const void *data)
{
    const struct gm_change *than = data;
    return change->lane == than->lane && (than->step < 0 || change->step > than->step);
}

/* Forgets the logged changes of a lane after `step`; all of them for step < 0. */
static void cut_log(struct gm_session *session, size_t lane, int64_t step)
{
    gm_changes_drop(&session->log, is_later, &(struct gm_change){.lane = lane, .step = step});
}

/* The lanes continue from the moment that is shown; later changes and snapshots are dropped. */
static void settle(struct gm_session *session)
{
    if (!session->visiting) {
        return;
    }
    session->visiting = false;
    for (size_t i = 0; i < session->count; i++) {
        int64_t steps = session->lanes[i]->run->steps;
        cut_log(session, i, steps);
        forget_after(&session->pasts[i], steps);
    }
}

/* ---- a lane's beginning and end ---- */

/* A lane at its start, and the copy of its parameters that the log keeps. */
struct fresh {
    struct gm_lane *lane;
    void *start;
};

/* a NULL lane comes with a sentence */
static struct fresh open_lane(const struct gm_scene *scene, const void *parameters,
                              const struct gm_settings *settings, const struct gm_scheme *scheme,
                              char *message)
{
    char sentence[GM_MESSAGE] = "There is not enough memory.";
    struct fresh fresh = {.start = gm_parameters_copy(scene, parameters)};
    if (fresh.start) {
        struct gm_timing *timing = fresh.start;
        timing->dt = fabs(timing->dt); /* every lane begins forwards */
        fresh.lane = gm_lane_open(scene, fresh.start, settings, scheme, sentence);
    }
    if (fresh.lane) {
        gm_engine_meet(fresh.lane);
    } else {
        free(fresh.start);
        fresh.start = NULL;
        gm_refuse(message, "%s", sentence);
    }
    return fresh;
}

/* The lane has passed this model time. */
static void follow(struct gm_session *session, size_t i, double gone)
{
    session->pasts[i].gone = gone;
    session->pasts[i].from = session->lanes[i]->run->t;
}

/* The lanes no longer start as they were typed. */
static void forget_arguments(struct gm_session *session)
{
    free(session->log.arguments);
    session->log.arguments = NULL;
}

/* Puts a lane in place i, which is empty. */
static void place_lane(struct gm_session *session, size_t i, struct fresh fresh, const struct gm_shown *shown)
{
    session->lanes[i] = fresh.lane;
    gm_lane_show(fresh.lane, shown);
    session->pasts[i] = (struct gm_past){.every = 1, .from = fresh.lane->t0};
    session->log.lanes[i] = (struct gm_lane_spec){.shown = *shown,
                                                  .parameters = fresh.start,
                                                  .settings = fresh.lane->settings,
                                                  .scheme = fresh.lane->scheme};
}

static void forget_wanted(struct gm_session *session, size_t i)
{
    free(session->wanted[i].parameters);
    session->wanted[i] = (struct gm_lane_spec){0};
}

static void clear_lane(struct gm_session *session, size_t i)
{
    close_past(&session->pasts[i]);
    gm_lane_close(session->lanes[i]);
    session->lanes[i] = NULL;
    free(session->log.lanes[i].parameters);
    session->log.lanes[i] = (struct gm_lane_spec){0};
    cut_log(session, i, -1);
}

/* Panels and colours for the lanes, in order, as the lanes' arguments give when they are read again. */
static void show_in_order(struct gm_session *session)
{
    forget_arguments(session);
    for (size_t i = 0; i < session->count; i++) {
        struct gm_shown *shown = &session->log.lanes[i].shown;
        gm_show_in_order(shown, i, session->lanes[i]->first_scheme, session->log.overlay);
        gm_lane_show(session->lanes[i], shown);
    }
}

/* ---- a session's beginning and end ---- */

bool gm_session_open(struct gm_session *session, const struct gm_request *request, char *message)
{
    *session = (struct gm_session){.scene = request->scene};
    if (request->count == 0 || request->count > GM_MOST_LANES) {
        return gm_refuse(message, "The explorer shows 1 to %d lanes, not %zu.", GM_MOST_LANES,
                         request->count);
    }
    /* the log has room for every lane, so that later only parameters are allocated */
    session->log = (struct gm_request){.scene = session->scene,
                                       .lanes = calloc(GM_MOST_LANES, sizeof *session->log.lanes),
                                       .overlay = request->overlay,
                                       .arguments = request->arguments ? strdup(request->arguments) : NULL};
    if (!session->log.lanes || (request->arguments && !session->log.arguments)) {
        gm_request_close(&session->log);
        return gm_refuse(message, short_of_memory);
    }
    for (size_t i = 0; i < request->count; i++) {
        const struct gm_lane_spec *spec = &request->lanes[i];
        struct fresh fresh =
            open_lane(session->scene, spec->parameters, &spec->settings, spec->scheme, message);
        if (!fresh.lane) {
            gm_session_close(session);
            return false;
        }
        place_lane(session, i, fresh, &spec->shown);
        session->log.count = session->count = i + 1;
    }
    note_lanes(session);
    return true;
}

void gm_session_close(void *self)
{
    struct gm_session *session = self;
    for (size_t i = 0; i < session->count; i++) {
        forget_wanted(session, i);
        close_past(&session->pasts[i]);
        gm_lane_close(session->lanes[i]);
    }
    gm_request_close(&session->log);
    session->count = 0;
}

bool gm_session_restart(struct gm_session *session, char *message)
{
    struct fresh fresh[GM_MOST_LANES] = {0};
    bool ok = true, same = session->log.change_count == 0;
    session->restart = false;
    for (size_t i = 0; ok && i < session->count; i++) {
        const struct gm_lane *lane = session->lanes[i];
        fresh[i] = open_lane(session->scene, gm_session_owner(session, i, false),
                             gm_session_owner(session, i, true), lane->scheme, message);
        ok = fresh[i].lane != NULL;
    }
    for (size_t i = 0; i < session->count; i++) {
        same = same && !session->wanted[i].parameters;
        forget_wanted(session, i);
        if (ok) {
            struct gm_shown shown = session->lanes[i]->named;
            gm_shown_rename(&shown, session->lanes[i]->first_scheme->title, session->lanes[i]->scheme->title,
                            false);
            clear_lane(session, i);
            place_lane(session, i, fresh[i], &shown);
        } else if (fresh[i].lane) {
            gm_lane_close(fresh[i].lane);
            free(fresh[i].start);
        }
    }
    if (ok && !same) {
        forget_arguments(session);
    }
    if (ok) {
        session->visiting = session->turned = false;
        note_lanes(session);
    }
    return ok;
}

/* ---- changes, during the run or for the next start ---- */

/* Sets a parameter that takes effect with the next restart. */
static bool want(struct gm_session *session, size_t i, const struct gm_parameter *row, const char *text,
                 char *message)
{
    struct gm_lane_spec *wanted = &session->wanted[i];
    if (!wanted->parameters) {
        wanted->settings = session->lanes[i]->settings;
        wanted->parameters = gm_parameters_copy(session->scene, session->lanes[i]->parameters);
        if (!wanted->parameters) {
            return gm_refuse(message, short_of_memory);
        }
        struct gm_timing *timing = wanted->parameters;
        timing->dt = fabs(timing->dt); /* a start is forwards */
    }
    gm_parameter_set(row, gm_lane_owner(wanted, row), text);
    return gm_is_setting(row) || !session->scene->settle ||
           session->scene->settle(wanted->parameters, &row->key, 1, message);
}

/* Makes a change on a lane now, and corrects its course if that reverses its time. */
static bool apply_change(struct gm_session *session, size_t i, const char *text, char *message)
{
    const struct gm_lane *lane = session->lanes[i];
    double before = lane->run->dt, gone = lane_gone(session, i);
    if (!gm_change_apply(session->lanes[i], text, message)) {
        return false;
    }
    if (before * lane->run->dt < 0) {
        follow(session, i, gone);
    }
    return true;
}

/* Returns true for another change of the same key at the same step. */
static bool is_overtaken(const struct gm_change *change, const void *data)
{
    const struct gm_change *by = data;
    return change->lane == by->lane && change->step == by->step &&
           strncmp(change->text, by->text, strcspn(by->text, "=") + 1) == 0;
}

/* The same, and logs it. */
static bool make_change(struct gm_session *session, size_t i, const char *text, char *message)
{
    if (!apply_change(session, i, text, message)) {
        return false;
    }
    /* the last change of a key at a step replaces earlier ones */
    const int64_t step = session->lanes[i]->run->steps;
    gm_changes_drop(&session->log, is_overtaken, &(struct gm_change){i, step, (char *)text});
    if (!gm_change_add(&session->log, i, step, text)) {
        return gm_refuse(message, short_of_memory);
    }
    note_lane(session, i, true);
    return true;
}

/* Sets how a lane is looked at, for its whole run: it is as if it had been typed. */
static void look(struct gm_session *session, size_t i, const struct gm_parameter *row, const char *text)
{
    gm_parameter_set(row, session->lanes[i]->parameters, text);
    gm_parameter_set(row, session->log.lanes[i].parameters, text);
    for (size_t k = 0; k < session->pasts[i].count; k++) {
        gm_parameter_set(row, session->pasts[i].moments[k].memory, text);
    }
    forget_arguments(session);
}

/* Renames lanes so that the parameter just changed distinguishes them. */
static void rename_by_parameter(struct gm_session *session, size_t i, const char *key, const char *text)
{
    char before[64], after[GM_MESSAGE];
    snprintf(before, sizeof before, "%.50s = ", gm_key_symbol(key));
    snprintf(after, sizeof after, "%s%s", before, text);
    struct gm_shown *shown = &session->log.lanes[i].shown;
    gm_shown_rename(shown, before, after, true);
    gm_lane_show(session->lanes[i], shown);
}

bool gm_session_set(struct gm_session *session, size_t lane, const struct gm_parameter *row, const char *text,
                    bool *restart, char *message)
{
    const bool of_scheme = gm_is_setting(row);
    bool alone = gm_session_differs(session, row), now = row->live && !of_scheme;
    bool step = !of_scheme && row->offset == offsetof(struct gm_timing, dt);
    char change[GM_MESSAGE];
    if (!gm_value_read(row, NULL, text, message)) {
        return false;
    }
    /* a step is set by its size; which way it goes is another matter */
    snprintf(change, sizeof change, "%s=%s%s%s", row->key,
             step && gm_session_direction(session) < 0 ? "-(" : "", text,
             step && gm_session_direction(session) < 0 ? ")" : "");
    if (now) {
        settle(session);
    }
    for (size_t i = 0; i < session->count; i++) {
        if (alone && i != lane) {
            continue;
        }
        if (now && row->looks) {
            look(session, i, row, text);
        } else if (now && !make_change(session, i, change, message)) {
            return false;
        }
        /* a restart that is already due keeps a live change too */
        if ((!now || session->wanted[i].parameters) && !want(session, i, row, text, message)) {
            return false;
        }
        rename_by_parameter(session, i, row->key, text);
    }
    *restart = *restart || !now;
    return true;
}

/* Logs the settings of a scheme that follows, which the lane was opened with though its first scheme has no use for them. */
static bool log_settings(struct gm_session *session, size_t lane, const struct gm_scheme *scheme,
                         char *message)
{
    const struct gm_lane *own = session->lanes[lane];
    bool made = true;
    for (size_t i = 0; i < gm_settings_parameter_count && made; i++) {
        const struct gm_parameter *row = &gm_settings_parameters[i];
        char text[GM_TEXT_SIZE], change[GM_MESSAGE];
        snprintf(change, sizeof change, "%s=%s", row->key,
                 gm_parameter_format(row, &own->settings, text, sizeof text));
        made = !gm_scheme_takes(scheme, row) || gm_scheme_takes(own->scheme, row) ||
               gm_scheme_takes(session->log.lanes[lane].scheme, row) || strcmp(text, row->standard) == 0 ||
               make_change(session, lane, change, message);
    }
    return made;
}

bool gm_session_switch(struct gm_session *session, size_t lane, const struct gm_scheme *scheme, char *message)
{
    char *change = NULL;
    if (asprintf(&change, "scheme=%s", gm_scheme_word(scheme)) < 0) {
        return gm_refuse(message, short_of_memory);
    }
    settle(session);
    const bool made =
        log_settings(session, lane, scheme, message) && make_change(session, lane, change, message);
    free(change);
    if (!made) {
        return false;
    }
    session->log.lanes[lane].shown =
        session->lanes[lane]->named; /* a change before the first step renames it */
    return true;
}

/* ---- on ---- */

/* Records per call: enough for the graphs, which have the least and greatest of many steps. */
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
    settle(session);
    struct gm_lane *lane = session->lanes[chosen];
    const int64_t before = lane->run->steps;
    const double dt = lane->run->dt, steps = (t - lane->run->t) / dt;
    const int64_t burst = steps > 2 * RECORDS ? (int64_t)fmin(steps / RECORDS, 1e6) : 1;
    /* steps of an adaptive scheme may be longer than dt: they end when a step of dt would lead beyond the time */
    const double end = lane->scheme->family->adaptive && dt > 0 ? t - dt * (1 - 1e-9) : INFINITY;
    gm_lane_to(lane, before + 1, INFINITY);
    if (burst > 1) {
        gm_lane_to(lane, before + burst, end);
    }
    gm_lane_record(lane);
    if (goes(lane)) {
        note_lane(session, chosen, false);
    }
    return true;
}

/* ---- back ---- */

/* Advances a lane to `steps` steps and makes the logged changes. */
static void replay(struct gm_session *session, size_t i, int64_t steps)
{
    char message[GM_MESSAGE];
    struct gm_lane *lane = session->lanes[i];
    size_t change = 0;
    int64_t from = lane->run->steps; /* a snapshot holds the changes made at its step */
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
            apply_change(session, i, next->text, message);
        }
    }
}

static const char too_large[] = "There is no snapshot to go back to: the ensemble is too large to keep any.";

bool gm_session_back(struct gm_session *session, char *message)
{
    const double direction = gm_session_direction(session);
    double latest = direction * gm_session_time(session);
    bool moved = false;
    settle(session);
    for (size_t i = 0; i < session->count; i++) {
        struct gm_lane *lane = session->lanes[i];
        int64_t steps = lane->run->steps;
        if (direction * lane->run->t < latest - 1e-9 * fabs(lane->run->dt) || steps == 0) {
            continue;
        }
        const struct gm_moment *moment = return_to(&session->pasts[i], lane, steps - 1, INFINITY);
        if (!moment) {
            return gm_refuse(message, "%s", too_large);
        }
        follow(session, i, moment->gone);
        cut_log(session, i, steps - 1);
        forget_after(&session->pasts[i], steps - 1);
        replay(session, i, steps - 1);
        moved = true;
    }
    return moved || gm_refuse(message, "This is the start.");
}

/* ---- the other way ---- */

bool gm_session_turn(struct gm_session *session, char *message)
{
    for (size_t i = 0; i < session->count; i++) {
        const struct gm_scheme *scheme = session->lanes[i]->scheme;
        if (scheme->family->adaptive || scheme->family->not_resumable) {
            return gm_refuse(message, "%s has step size control, and its steps only go forwards.",
                             scheme->title);
        }
        const struct gm_events *events = session->lanes[i]->problem.events;
        if (events && events->changes) {
            return gm_refuse(message,
                             "An event is not undone by running back: go to an earlier moment instead.");
        }
    }
    settle(session);
    for (size_t i = 0; i < session->count; i++) {
        char text[80], number[64];
        snprintf(text, sizeof text, "dt=%s",
                 gm_number_format(-session->lanes[i]->run->dt, number, sizeof number));
        if (!make_change(session, i, text, message)) {
            return false;
        }
    }
    session->turned = true;
    return true;
}

/* ---- to any moment ---- */

bool gm_session_visit(struct gm_session *session, double gone, char *message)
{
    for (size_t i = 0; i < session->count && !session->visiting; i++) {
        note_lane(session, i, true); /* so that the end is within reach */
    }
    for (size_t i = 0; i < session->count; i++) {
        const struct gm_moment *moment =
            return_to(&session->pasts[i], session->lanes[i], INT64_MAX, gone + 1e-9 * fabs(gone));
        if (!moment) {
            return gm_refuse(message, "%s", too_large);
        }
        follow(session, i, moment->gone);
    }
    session->visiting = true;
    return true;
}

/* ---- lanes that come and go ---- */

static bool has_room(const struct gm_session *session, char *message)
{
    return session->count < GM_LANE_COLOURS ||
           gm_refuse(message,
                     "Six lanes have a colour of their own; remove one with x before adding another.");
}

/* Lane number `count` was put in its place. */
static void count_lane(struct gm_session *session)
{
    session->log.count = ++session->count;
    show_in_order(session);
}

bool gm_session_add(struct gm_session *session, size_t like, const struct gm_scheme *scheme, char *message)
{
    if (!has_room(session, message)) {
        return false;
    }
    if (gm_session_direction(session) < 0) {
        return gm_refuse(message, "A new lane starts forwards: turn time with B first, or fork with f.");
    }
    const struct gm_lane *model = session->lanes[like];
    struct fresh fresh = open_lane(session->scene, model->parameters, &model->settings, scheme, message);
    if (!fresh.lane) {
        return false;
    }
    settle(session);
    double ahead = gm_session_gone(session) - fabs(gm_session_time(session) - fresh.lane->t0);
    place_lane(session, session->count, fresh, &(const struct gm_shown){0});
    session->pasts[session->count].gone = fmax(ahead, 0); /* after time was reversed, all have gone further */
    count_lane(session);
    note_lanes(session);
    return true;
}

/* Copies the log of lane `like` for the last lane. */
static bool copy_log(struct gm_session *session, size_t like)
{
    struct gm_lane_spec *spec = &session->log.lanes[session->count];
    *spec = session->log.lanes[like];
    spec->shown = (struct gm_shown){0};
    spec->parameters = gm_parameters_copy(session->scene, spec->parameters);
    bool ok = spec->parameters != NULL;
    size_t count = session->log.change_count;
    for (size_t k = 0; ok && k < count; k++) {
        const struct gm_change change = session->log.changes[k];
        ok = change.lane != like || gm_change_add(&session->log, session->count, change.step, change.text);
    }
    return ok;
}

bool gm_session_fork(struct gm_session *session, size_t like, const struct gm_scheme *scheme, char *message)
{
    if (!has_room(session, message)) {
        return false;
    }
    settle(session);
    size_t at = session->count;
    session->lanes[at] = gm_lane_copy(session->lanes[like]);
    if (!session->lanes[at]) {
        return gm_refuse(message, short_of_memory);
    }
    session->pasts[at] = copy_past(&session->pasts[like]);
    bool ok = copy_log(session, like) || gm_refuse(message, short_of_memory);
    count_lane(session);
    share_budget(session);
    ok = ok && gm_session_switch(session, at, scheme, message);
    if (!ok) {
        char ignored[GM_MESSAGE];
        gm_session_remove(session, at, ignored);
    }
    return ok;
}

bool gm_session_overlay(struct gm_session *session, char *message)
{
    if (session->count == 1) {
        return gm_refuse(message, "One lane has a panel of its own; c adds another.");
    }
    session->log.overlay = !session->log.overlay;
    show_in_order(session);
    return true;
}

bool gm_session_remove(struct gm_session *session, size_t lane, char *message)
{
    if (session->count == 1) {
        return gm_refuse(message, "The last lane stays.");
    }
    forget_wanted(session, lane);
    clear_lane(session, lane);
    size_t after = session->count - lane - 1;
    memmove(&session->lanes[lane], &session->lanes[lane + 1], after * sizeof *session->lanes);
    memmove(&session->pasts[lane], &session->pasts[lane + 1], after * sizeof *session->pasts);
    memmove(&session->wanted[lane], &session->wanted[lane + 1], after * sizeof *session->wanted);
    memmove(&session->log.lanes[lane], &session->log.lanes[lane + 1], after * sizeof *session->log.lanes);
    for (size_t k = 0; k < session->log.change_count; k++) {
        if (session->log.changes[k].lane > lane) {
            session->log.changes[k].lane--;
        }
    }
    session->log.count = --session->count;
    session->log.lanes[session->count] = session->wanted[session->count] = (struct gm_lane_spec){0};
    session->log.overlay = session->log.overlay && session->count > 1;
    show_in_order(session);
    share_budget(session);
    return true;
}

/* ---- schemes ---- */

size_t gm_session_fits(const struct gm_session *session, const struct gm_scheme **schemes)
{
    const struct gm_problem *problem = &session->lanes[0]->problem;
    size_t count = 0;
    for (size_t i = 0; session->scene->schemes && session->scene->schemes[i]; i++) {
        gm_fitting_add(gm_scheme_find_for(session->scene->schemes[i], problem), problem, schemes, &count);
    }
    for (size_t i = 0; i < gm_scheme_count(); i++) {
        gm_fitting_add(gm_scheme_at(i), problem, schemes, &count);
    }
    return count;
}
