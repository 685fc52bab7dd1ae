/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "app/explorer/session.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Snapshots of all lanes together take at most this. */
enum { PAST_BUDGET = 64 << 20 };

static bool refuse(char *message, const char *sentence)
{
    snprintf(message, GM_MESSAGE, "%s", sentence);
    return false;
}

static bool short_of_memory(char *message)
{
    return refuse(message, "There is not enough memory.");
}

/* ---- lanes and their starts ---- */

static void *copy_parameters(const struct gm_scene *scene, const void *parameters)
{
    void *copy = malloc(scene->size);
    if (copy)
        memcpy(copy, parameters, scene->size);
    return copy;
}

/* Room for every lane that may come is there from the beginning, so that only the parameters are allocated.
 */
static bool log_open(struct gm_session *session, const struct gm_request *request)
{
    session->log = (struct gm_request){.scene = session->scene};
    session->log.lanes = calloc(GM_MOST_LANES, sizeof *session->log.lanes);
    session->log.arguments = request->arguments ? strdup(request->arguments) : NULL;
    return session->log.lanes && (session->log.arguments || !request->arguments);
}

static void log_close(struct gm_session *session)
{
    for (size_t i = 0; i < session->count; i++)
        free(session->log.lanes[i].parameters);
    free(session->log.lanes);
    free(session->log.changes);
    free(session->log.arguments);
    session->log = (struct gm_request){0};
}

/* Forgets the changes of a lane after `step`; all of them for step < 0. */
static void log_cut(struct gm_session *session, size_t lane, long step)
{
    size_t kept = 0;
    for (size_t i = 0; i < session->log.change_count; i++) {
        const struct gm_change *change = &session->log.changes[i];
        if (change->lane != lane || (step >= 0 && change->step <= step))
            session->log.changes[kept++] = *change;
    }
    session->log.change_count = kept;
}

static void share_budget(struct gm_session *session)
{
    for (size_t i = 0; i < session->count; i++) {
        struct gm_past *past = &session->pasts[i];
        size_t size = session->scene->size + gm_lane_snapshot_size(session->lanes[i]);
        gm_past_limit(past, PAST_BUDGET / session->count / size);
    }
}

/* A lane at its start, and the copy of its parameters that the log keeps. */
struct fresh {
    struct gm_lane *lane;
    void *start;
};

static struct fresh open_lane(const struct gm_scene *scene, const void *parameters,
                              const struct gm_settings *settings, const struct gm_scheme *scheme,
                              char *message)
{
    char sentence[GM_SENTENCE] = "There is not enough memory.";
    struct fresh fresh = {.start = copy_parameters(scene, parameters)};
    if (fresh.start)
        fresh.lane = gm_lane_open(scene, parameters, settings, scheme, sentence);
    if (!fresh.lane) {
        free(fresh.start);
        refuse(message, sentence);
    }
    return fresh;
}

/* Puts a lane in place i, which is empty. */
static void place_lane(struct gm_session *session, size_t i, struct fresh fresh, const struct gm_shown *shown)
{
    session->lanes[i] = fresh.lane;
    fresh.lane->shown = *shown;
    session->pasts[i] = (struct gm_past){.every = 1};
    session->log.lanes[i] = (struct gm_lane_spec){.shown = *shown,
                                                  .parameters = fresh.start,
                                                  .settings = fresh.lane->settings,
                                                  .scheme = fresh.lane->scheme};
}

/* The lanes no longer start as they were typed. */
static void forget_arguments(struct gm_session *session)
{
    free(session->log.arguments);
    session->log.arguments = NULL;
}

/* A panel and a colour for every lane, in order: what the lanes' arguments give when they are read again. */
static void show_in_order(struct gm_session *session)
{
    forget_arguments(session);
    for (size_t i = 0; i < session->count; i++) {
        struct gm_shown *shown = &session->lanes[i]->shown;
        shown->panel = shown->colour = i;
        if (!shown->panel_name[0])
            memcpy(shown->panel_name, shown->colour_name, sizeof shown->panel_name);
        shown->colour_name[0] = '\0';
        session->log.lanes[i].shown = *shown;
    }
}

static void forget_wanted(struct gm_session *session, size_t i)
{
    free(session->wanted[i].parameters);
    session->wanted[i] = (struct gm_lane_spec){0};
}

static void note_all(struct gm_session *session)
{
    share_budget(session);
    for (size_t i = 0; i < session->count; i++)
        gm_past_note(&session->pasts[i], session->lanes[i], false);
}

static void clear_lane(struct gm_session *session, size_t i)
{
    gm_past_close(&session->pasts[i]);
    gm_lane_close(session->lanes[i]);
    session->lanes[i] = NULL;
    free(session->log.lanes[i].parameters);
    session->log.lanes[i] = (struct gm_lane_spec){0};
    log_cut(session, i, -1);
}

bool gm_session_open(struct gm_session *session, const struct gm_request *request, char *message)
{
    *session = (struct gm_session){.scene = request->scene};
    if (request->count == 0 || request->count > GM_MOST_LANES) {
        snprintf(message, GM_MESSAGE, "The explorer shows 1 to %d lanes, not %zu.", GM_MOST_LANES,
                 request->count);
        return false;
    }
    if (!log_open(session, request)) {
        log_close(session);
        return short_of_memory(message);
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
    note_all(session);
    return true;
}

void gm_session_close(struct gm_session *session)
{
    for (size_t i = 0; i < session->count; i++) {
        forget_wanted(session, i);
        gm_past_close(&session->pasts[i]);
        gm_lane_close(session->lanes[i]);
    }
    log_close(session);
    session->count = 0;
}

/* ---- time ---- */

static bool goes(const struct gm_lane *lane)
{
    return lane->run->status == GM_OK;
}

/* Where a lane's next step ends, a little earlier than it is computed to be, so that lanes with the same step
   stay together whatever their round-off. */
static double next_time(const struct gm_lane *lane)
{
    return lane->run->t + lane->run->dt * (1 - 1e-9);
}

double gm_session_time(const struct gm_session *session)
{
    double latest = session->lanes[0]->run->t;
    for (size_t i = 1; i < session->count; i++)
        latest = fmax(latest, session->lanes[i]->run->t);
    return latest;
}

double gm_session_next(const struct gm_session *session)
{
    double next = INFINITY;
    for (size_t i = 0; i < session->count; i++) {
        if (goes(session->lanes[i]))
            next = fmin(next, session->lanes[i]->run->t + session->lanes[i]->run->dt);
    }
    return next;
}

/* So many records a call: enough for the graphs, which keep the least and greatest of many steps. */
enum { RECORDS = 64 };

bool gm_session_advance(struct gm_session *session, double t)
{
    size_t chosen = session->count;
    for (size_t i = 0; i < session->count; i++) {
        const struct gm_lane *lane = session->lanes[i];
        if (goes(lane) && next_time(lane) <= t &&
            (chosen == session->count || next_time(lane) < next_time(session->lanes[chosen])))
            chosen = i;
    }
    if (chosen == session->count)
        return false;
    struct gm_lane *lane = session->lanes[chosen];
    double due = (t - lane->run->t) / lane->run->dt;
    long steps = due > 2 * RECORDS ? (long)fmin(due / RECORDS, 1e6) : 1;
    gm_lane_advance(lane, steps);
    gm_lane_record(lane);
    if (goes(lane))
        gm_past_note(&session->pasts[chosen], lane, false);
    return true;
}

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
            if (next->lane != i || next->step <= from)
                continue;
            if (next->step > lane->run->steps)
                break;
            gm_change_apply(lane, next->text, message);
        }
    }
}

bool gm_session_back(struct gm_session *session, char *message)
{
    double latest = gm_session_time(session);
    bool moved = false;
    for (size_t i = 0; i < session->count; i++) {
        struct gm_lane *lane = session->lanes[i];
        long steps = lane->run->steps;
        if (lane->run->t < latest - 1e-9 * fabs(lane->run->dt) || steps == 0)
            continue;
        log_cut(session, i, steps - 1);
        if (!gm_past_return(&session->pasts[i], lane, steps - 1))
            return refuse(
                message, "There is no snapshot left to step back to: the ensemble is too large to keep any.");
        replay(session, i, steps - 1);
        moved = true;
    }
    return moved || refuse(message, "This is the start.");
}

bool gm_session_restart(struct gm_session *session, char *message)
{
    struct fresh fresh[GM_MOST_LANES] = {0};
    bool ok = true;
    for (size_t i = 0; ok && i < session->count; i++) {
        const struct gm_lane *lane = session->lanes[i];
        fresh[i] = open_lane(session->scene, gm_session_owner(session, i, false),
                             gm_session_owner(session, i, true), lane->scheme, message);
        ok = fresh[i].lane != NULL;
    }
    for (size_t i = 0; i < session->count; i++) {
        forget_wanted(session, i);
        if (ok) {
            const struct gm_shown shown = session->lanes[i]->shown;
            clear_lane(session, i);
            place_lane(session, i, fresh[i], &shown);
        } else if (fresh[i].lane) {
            gm_lane_close(fresh[i].lane);
            free(fresh[i].start);
        }
    }
    if (ok) {
        forget_arguments(session);
        note_all(session);
    }
    return ok;
}

/* ---- changes ---- */

const void *gm_session_owner(const struct gm_session *session, size_t lane, bool of_scheme)
{
    const struct gm_lane_spec *wanted = &session->wanted[lane];
    if (of_scheme)
        return wanted->parameters ? &wanted->settings : &session->lanes[lane]->settings;
    return wanted->parameters ? wanted->parameters : session->lanes[lane]->parameters;
}

bool gm_session_differs(const struct gm_session *session, const struct gm_parameter *row, bool of_scheme)
{
    double first = gm_parameter_get(row, gm_session_owner(session, 0, of_scheme));
    for (size_t i = 1; i < session->count; i++) {
        if (gm_parameter_get(row, gm_session_owner(session, i, of_scheme)) != first)
            return true;
    }
    return false;
}

/* Sets a parameter that takes effect with the next restart. */
static bool want(struct gm_session *session, size_t i, const struct gm_parameter *row, bool of_scheme,
                 const char *text, char *message)
{
    struct gm_lane_spec *wanted = &session->wanted[i];
    if (!wanted->parameters) {
        wanted->settings = session->lanes[i]->settings;
        wanted->parameters = copy_parameters(session->scene, session->lanes[i]->parameters);
        if (!wanted->parameters)
            return short_of_memory(message);
    }
    void *owner = of_scheme ? (void *)&wanted->settings : wanted->parameters;
    if (gm_parameter_set(row, owner, text) == GM_PARSED)
        return true;
    snprintf(message, GM_MESSAGE, "%s cannot be %s.", row->key, text);
    return false;
}

static bool change_now(struct gm_session *session, size_t i, const char *text, char *message)
{
    struct gm_lane *lane = session->lanes[i];
    if (!gm_change_apply(lane, text, message))
        return false;
    /* of several changes of one key at one step only the last one counts */
    size_t key = (size_t)(strchr(text, '=') - text) + 1, kept = 0;
    for (size_t k = 0; k < session->log.change_count; k++) {
        const struct gm_change *change = &session->log.changes[k];
        if (change->lane != i || change->step != lane->run->steps || strncmp(change->text, text, key) != 0)
            session->log.changes[kept++] = *change;
    }
    session->log.change_count = kept;
    if (!gm_change_add(&session->log, i, lane->run->steps, text))
        return short_of_memory(message);
    gm_past_note(&session->pasts[i], lane, true);
    return true;
}

/* Names that tell lanes apart by what has just been changed. */
static void rename_lane(struct gm_session *session, size_t i, const char *before, const char *after,
                        size_t length)
{
    struct gm_shown *shown = &session->lanes[i]->shown;
    char *names[] = {shown->panel_name, shown->colour_name};
    for (size_t k = 0; k < 2; k++) {
        if (names[k][0] && strncmp(names[k], before, length) == 0)
            snprintf(names[k], sizeof shown->panel_name, "%s", after);
    }
    session->log.lanes[i].shown = *shown;
}

static void rename_by_parameter(struct gm_session *session, size_t i, const char *key, const char *text)
{
    char before[64], after[GM_MESSAGE];
    snprintf(before, sizeof before, "%.50s =", strcmp(key, "dt") == 0 ? "Δt" : key);
    snprintf(after, sizeof after, "%s %s", before, text);
    rename_lane(session, i, before, after, strlen(before));
}

bool gm_session_set(struct gm_session *session, size_t lane, const struct gm_parameter *row, bool of_scheme,
                    const char *text, bool *restart, char *message)
{
    bool alone = gm_session_differs(session, row, of_scheme);
    char change[sizeof(struct gm_change){0}.text];
    snprintf(change, sizeof change, "%s=%s", row->key, text);
    bool now = row->live && !of_scheme;
    for (size_t i = 0; i < session->count; i++) {
        if (alone && i != lane)
            continue;
        if (now && !change_now(session, i, change, message))
            return false;
        /* a restart that is already due keeps a live change too */
        if ((!now || session->wanted[i].parameters) && !want(session, i, row, of_scheme, text, message))
            return false;
        rename_by_parameter(session, i, row->key, text);
    }
    *restart = *restart || !now;
    return true;
}

bool gm_session_switch(struct gm_session *session, size_t lane, const struct gm_scheme *scheme, char *message)
{
    char change[sizeof(struct gm_change){0}.text];
    snprintf(change, sizeof change, "scheme=%s", scheme->name);
    const char *before = session->lanes[lane]->scheme->title;
    if (!change_now(session, lane, change, message))
        return false;
    rename_lane(session, lane, before, scheme->title, strlen(before) + 1);
    return true;
}

bool gm_session_add(struct gm_session *session, size_t like, const struct gm_scheme *scheme, char *message)
{
    if (session->count >= GM_LANE_COLOURS)
        return refuse(message,
                      "Six lanes have a colour of their own; remove one with x before adding another.");
    const struct gm_lane *model = session->lanes[like];
    struct fresh fresh = open_lane(session->scene, model->parameters, &model->settings, scheme, message);
    if (!fresh.lane)
        return false;
    place_lane(session, session->count, fresh, &(const struct gm_shown){0});
    session->log.count = ++session->count;
    show_in_order(session);
    note_all(session);
    return true;
}

bool gm_session_remove(struct gm_session *session, size_t lane, char *message)
{
    if (session->count == 1)
        return refuse(message, "The last lane stays.");
    forget_wanted(session, lane);
    clear_lane(session, lane);
    size_t after = session->count - lane - 1;
    memmove(&session->lanes[lane], &session->lanes[lane + 1], after * sizeof *session->lanes);
    memmove(&session->pasts[lane], &session->pasts[lane + 1], after * sizeof *session->pasts);
    memmove(&session->wanted[lane], &session->wanted[lane + 1], after * sizeof *session->wanted);
    memmove(&session->log.lanes[lane], &session->log.lanes[lane + 1], after * sizeof *session->log.lanes);
    for (size_t k = 0; k < session->log.change_count; k++) {
        if (session->log.changes[k].lane > lane)
            session->log.changes[k].lane--;
    }
    session->log.count = --session->count;
    session->log.lanes[session->count] = session->wanted[session->count] = (struct gm_lane_spec){0};
    show_in_order(session);
    share_budget(session);
    return true;
}

/* ---- schemes ---- */

static bool is_among(const struct gm_scheme *scheme, const struct gm_scheme *const *schemes, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        if (schemes[i] == scheme)
            return true;
    }
    return false;
}

size_t gm_session_fits(const struct gm_session *session, const struct gm_scheme **schemes, size_t bound)
{
    const struct gm_problem *problem = &session->lanes[0]->problem;
    size_t count = 0;
    for (size_t i = 0; session->scene->schemes && session->scene->schemes[i] && count < bound; i++) {
        const struct gm_scheme *scheme = gm_scheme_find_for(session->scene->schemes[i], problem);
        if (scheme && gm_scheme_fits(scheme, problem) && !is_among(scheme, schemes, count))
            schemes[count++] = scheme;
    }
    for (size_t i = 0; i < gm_scheme_count() && count < bound; i++) {
        const struct gm_scheme *scheme = gm_scheme_at(i);
        if (gm_scheme_fits(scheme, problem) && !is_among(scheme, schemes, count))
            schemes[count++] = scheme;
    }
    return count;
}

const struct gm_scheme *gm_session_unused(const struct gm_session *session)
{
    enum { MOST = 256 };
    const struct gm_scheme *schemes[MOST];
    size_t count = gm_session_fits(session, schemes, MOST);
    for (size_t i = 0; i < count; i++) {
        bool used = false;
        for (size_t k = 0; k < session->count; k++)
            used = used || session->lanes[k]->scheme == schemes[i];
        if (!used)
            return schemes[i];
    }
    return NULL;
}
