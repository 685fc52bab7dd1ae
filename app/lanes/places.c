/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lanes that come and go, and the schemes they may have. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/lanes/course.h"
#include "core/schemes.h"
#include "scenes/frame/lane_pack.h"

static bool has_room(const struct gm_session *session, char *message)
{
    return session->count < GM_LANE_COLOURS ||
           gm_session_refuse(
               message, "Six lanes have a colour of their own; remove one with x before adding another.");
}

/* Lane number `count` was put in its place. */
static void count_lane(struct gm_session *session)
{
    session->log.count = ++session->count;
    gm_session_show_in_order(session);
}

bool gm_session_add(struct gm_session *session, size_t like, const struct gm_scheme *scheme, char *message)
{
    if (!has_room(session, message)) {
        return false;
    }
    if (gm_session_direction(session) < 0) {
        return gm_session_refuse(message,
                                 "A new lane starts forwards: turn time with B first, or fork with f.");
    }
    const struct gm_lane *model = session->lanes[like];
    struct gm_fresh fresh =
        gm_session_open_lane(session->scene, model->parameters, &model->settings, scheme, message);
    if (!fresh.lane) {
        return false;
    }
    gm_session_settle(session);
    double ahead = gm_session_gone(session) - fabs(gm_session_time(session) - fresh.lane->t0);
    gm_session_place_lane(session, session->count, fresh, &(const struct gm_shown){0});
    session->courses[session->count].gone = fmax(ahead, 0); /* where time was turned, all have gone further */
    count_lane(session);
    gm_session_note_all(session);
    return true;
}

/* The log of lane `like` once more, as that of the last lane. */
static bool copy_log(struct gm_session *session, size_t like)
{
    struct gm_lane_spec *spec = &session->log.lanes[session->count];
    *spec = session->log.lanes[like];
    spec->shown = (struct gm_shown){0};
    spec->parameters = gm_session_copy_parameters(session->scene, spec->parameters);
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
    gm_session_settle(session);
    size_t at = session->count;
    session->lanes[at] = gm_lane_copy(session->lanes[like]);
    if (!session->lanes[at]) {
        return gm_session_short_of_memory(message);
    }
    session->pasts[at] = gm_past_copy(&session->pasts[like]);
    session->courses[at] = session->courses[like];
    bool ok = copy_log(session, like) || gm_session_short_of_memory(message);
    count_lane(session);
    gm_session_share_budget(session);
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
        return gm_session_refuse(message, "One lane has a panel of its own; c adds another.");
    }
    session->overlaid = !session->overlaid;
    gm_session_show_in_order(session);
    return true;
}

bool gm_session_remove(struct gm_session *session, size_t lane, char *message)
{
    if (session->count == 1) {
        return gm_session_refuse(message, "The last lane stays.");
    }
    gm_session_forget_wanted(session, lane);
    gm_session_clear_lane(session, lane);
    size_t after = session->count - lane - 1;
    memmove(&session->lanes[lane], &session->lanes[lane + 1], after * sizeof *session->lanes);
    memmove(&session->pasts[lane], &session->pasts[lane + 1], after * sizeof *session->pasts);
    memmove(&session->courses[lane], &session->courses[lane + 1], after * sizeof *session->courses);
    memmove(&session->wanted[lane], &session->wanted[lane + 1], after * sizeof *session->wanted);
    memmove(&session->log.lanes[lane], &session->log.lanes[lane + 1], after * sizeof *session->log.lanes);
    for (size_t k = 0; k < session->log.change_count; k++) {
        if (session->log.changes[k].lane > lane) {
            session->log.changes[k].lane--;
        }
    }
    session->log.count = --session->count;
    session->log.lanes[session->count] = session->wanted[session->count] = (struct gm_lane_spec){0};
    session->overlaid = session->overlaid && session->count > 1;
    gm_session_show_in_order(session);
    gm_session_share_budget(session);
    return true;
}

/* ---- schemes ---- */

static bool is_among(const struct gm_scheme *scheme, const struct gm_scheme *const *schemes, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        if (schemes[i] == scheme) {
            return true;
        }
    }
    return false;
}

size_t gm_session_fits(const struct gm_session *session, const struct gm_scheme **schemes, size_t bound)
{
    const struct gm_problem *problem = &session->lanes[0]->problem;
    size_t count = 0;
    for (size_t i = 0; session->scene->schemes && session->scene->schemes[i] && count < bound; i++) {
        const struct gm_scheme *scheme = gm_scheme_find_for(session->scene->schemes[i], problem);
        if (scheme && gm_scheme_fits(scheme, problem) && !is_among(scheme, schemes, count)) {
            schemes[count++] = scheme;
        }
    }
    for (size_t i = 0; i < gm_scheme_count() && count < bound; i++) {
        const struct gm_scheme *scheme = gm_scheme_at(i);
        if (gm_scheme_fits(scheme, problem) && !is_among(scheme, schemes, count)) {
            schemes[count++] = scheme;
        }
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
        for (size_t k = 0; k < session->count; k++) {
            used = used || session->lanes[k]->scheme == schemes[i];
        }
        if (!used) {
            return schemes[i];
        }
    }
    return NULL;
}
