/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How a session begins, starts again and ends. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/lanes/course.h"

/* Snapshots of all lanes together take at most this. */
enum { PAST_BUDGET = 64 << 20 };

bool gm_session_refuse(char *message, const char *sentence)
{
    snprintf(message, GM_MESSAGE, "%s", sentence);
    return false;
}

bool gm_session_short_of_memory(char *message)
{
    return gm_session_refuse(message, "There is not enough memory.");
}

/* ---- lanes and their starts ---- */

void *gm_session_copy_parameters(const struct gm_scene *scene, const void *parameters)
{
    void *copy = malloc(scene->size);
    if (copy) {
        memcpy(copy, parameters, scene->size);
    }
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
    for (size_t i = 0; i < session->count; i++) {
        free(session->log.lanes[i].parameters);
    }
    free(session->log.lanes);
    free(session->log.changes);
    free(session->log.arguments);
    session->log = (struct gm_request){0};
}

void gm_session_cut_log(struct gm_session *session, size_t lane, long step)
{
    size_t kept = 0;
    for (size_t i = 0; i < session->log.change_count; i++) {
        const struct gm_change *change = &session->log.changes[i];
        if (change->lane != lane || (step >= 0 && change->step <= step)) {
            session->log.changes[kept++] = *change;
        }
    }
    session->log.change_count = kept;
}

void gm_session_share_budget(struct gm_session *session)
{
    for (size_t i = 0; i < session->count; i++) {
        struct gm_past *past = &session->pasts[i];
        size_t size = session->scene->size + gm_lane_snapshot_size(session->lanes[i]);
        gm_past_limit(past, PAST_BUDGET / session->count / size);
    }
}

struct gm_fresh gm_session_open_lane(const struct gm_scene *scene, const void *parameters,
                                     const struct gm_settings *settings, const struct gm_scheme *scheme,
                                     char *message)
{
    char sentence[GM_SENTENCE] = "There is not enough memory.";
    struct gm_fresh fresh = {.start = gm_session_copy_parameters(scene, parameters)};
    if (fresh.start) {
        struct gm_timing *timing = fresh.start;
        timing->dt = fabs(timing->dt); /* every lane begins forwards */
        fresh.lane = gm_lane_open(scene, fresh.start, settings, scheme, sentence);
    }
    if (!fresh.lane) {
        free(fresh.start);
        fresh.start = NULL;
        gm_session_refuse(message, sentence);
    }
    return fresh;
}

void gm_session_place_lane(struct gm_session *session, size_t i, struct gm_fresh fresh,
                           const struct gm_shown *shown)
{
    session->lanes[i] = fresh.lane;
    gm_lane_show(fresh.lane, shown);
    session->pasts[i] = (struct gm_past){.every = 1};
    session->courses[i] = (struct gm_course){.from = fresh.lane->t0};
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

void gm_session_show_in_order(struct gm_session *session)
{
    forget_arguments(session);
    for (size_t i = 0; i < session->count; i++) {
        struct gm_shown *shown = &session->log.lanes[i].shown;
        gm_show_in_order(shown, i, session->lanes[i]->first_scheme, session->overlaid);
        gm_lane_show(session->lanes[i], shown);
    }
    session->log.overlay = session->overlaid;
}

void gm_session_forget_wanted(struct gm_session *session, size_t i)
{
    free(session->wanted[i].parameters);
    session->wanted[i] = (struct gm_lane_spec){0};
}

void gm_session_clear_lane(struct gm_session *session, size_t i)
{
    gm_past_close(&session->pasts[i]);
    gm_lane_close(session->lanes[i]);
    session->lanes[i] = NULL;
    free(session->log.lanes[i].parameters);
    session->log.lanes[i] = (struct gm_lane_spec){0};
    gm_session_cut_log(session, i, -1);
}

bool gm_session_open(struct gm_session *session, const struct gm_request *request, char *message)
{
    *session = (struct gm_session){.scene = request->scene, .overlaid = request->overlay};
    if (request->count == 0 || request->count > GM_MOST_LANES) {
        snprintf(message, GM_MESSAGE, "The explorer shows 1 to %d lanes, not %zu.", GM_MOST_LANES,
                 request->count);
        return false;
    }
    if (!log_open(session, request)) {
        log_close(session);
        return gm_session_short_of_memory(message);
    }
    for (size_t i = 0; i < request->count; i++) {
        const struct gm_lane_spec *spec = &request->lanes[i];
        struct gm_fresh fresh =
            gm_session_open_lane(session->scene, spec->parameters, &spec->settings, spec->scheme, message);
        if (!fresh.lane) {
            gm_session_close(session);
            return false;
        }
        gm_session_place_lane(session, i, fresh, &spec->shown);
        session->log.count = session->count = i + 1;
    }
    gm_session_note_all(session);
    return true;
}

void gm_session_close(struct gm_session *session)
{
    for (size_t i = 0; i < session->count; i++) {
        gm_session_forget_wanted(session, i);
        gm_past_close(&session->pasts[i]);
        gm_lane_close(session->lanes[i]);
    }
    log_close(session);
    session->count = 0;
}

bool gm_session_restart(struct gm_session *session, char *message)
{
    struct gm_fresh fresh[GM_MOST_LANES] = {0};
    bool ok = true, same = session->log.change_count == 0;
    for (size_t i = 0; ok && i < session->count; i++) {
        const struct gm_lane *lane = session->lanes[i];
        fresh[i] = gm_session_open_lane(session->scene, gm_session_owner(session, i, false),
                                        gm_session_owner(session, i, true), lane->scheme, message);
        ok = fresh[i].lane != NULL;
    }
    for (size_t i = 0; i < session->count; i++) {
        same = same && !session->wanted[i].parameters;
        gm_session_forget_wanted(session, i);
        if (ok) {
            struct gm_shown shown = session->lanes[i]->named;
            gm_shown_rename(&shown, session->lanes[i]->first_scheme->title, session->lanes[i]->scheme->title,
                            false);
            gm_session_clear_lane(session, i);
            gm_session_place_lane(session, i, fresh[i], &shown);
        } else if (fresh[i].lane) {
            gm_lane_close(fresh[i].lane);
            free(fresh[i].start);
        }
    }
    if (ok && !same) {
        forget_arguments(session);
    }
    if (ok) {
        session->log.overlay = session->overlaid;
        session->visiting = session->turned = false;
        gm_session_note_all(session);
    }
    return ok;
}
