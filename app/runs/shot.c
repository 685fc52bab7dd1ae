/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A finished look at a session: everything that the screen shows, copied. */
#include "app/runs/session.h"

#include <math.h>
#include <stdlib.h>

#include "app/words/names.h"
#include "core/schemes.h"

bool gm_shot_open(struct gm_shot *shot)
{
    *shot = (struct gm_shot){.picture = gm_picture_open()};
    return shot->picture != NULL;
}

void gm_shot_close(void *self)
{
    struct gm_shot *shot = self;
    gm_picture_close(shot->picture);
    shot->picture = NULL;
    for (size_t i = 0; i < GM_COMMANDS; i++) {
        free(shot->commands[i]);
        shot->commands[i] = NULL;
    }
}

static void take_sparks(struct gm_shot_lane *shot, const struct gm_lane *lane, size_t observables)
{
    const struct gm_history *history = &lane->history;
    for (size_t k = 0; k < observables; k++) {
        for (size_t i = 0; i < GM_SPARK; i++) {
            shot->sparks[k].low[i] = INFINITY;
            shot->sparks[k].high[i] = -INFINITY;
        }
    }
    double length = lane->run->t - lane->t0;
    for (size_t bin = 0; bin < history->count; bin++) {
        const struct gm_bin *bins = &history->bins[bin * history->series];
        double place = length != 0 ? (bins[0].t - lane->t0) / length * GM_SPARK : 0;
        size_t at = place > 0 ? (size_t)place : 0;
        at = at < GM_SPARK ? at : GM_SPARK - 1;
        for (size_t k = 0; k < observables; k++) {
            shot->sparks[k].low[at] = fmin(shot->sparks[k].low[at], bins[k].low);
            shot->sparks[k].high[at] = fmax(shot->sparks[k].high[at], bins[k].high);
        }
    }
}

static void take_parameter(struct gm_shot *shot, const struct gm_session *session,
                           const struct gm_parameter *row, bool of_scheme)
{
    if (shot->parameter_count == GM_SHOT_PARAMETERS) {
        return;
    }
    struct gm_shot_parameter *parameter = &shot->parameters[shot->parameter_count++];
    const void *owner = gm_session_owner(session, shot->selected, of_scheme);
    *parameter = (struct gm_shot_parameter){.row = row,
                                            .of_scheme = of_scheme,
                                            .differs = gm_session_differs(session, row),
                                            .position = gm_slider_position(row, owner)};
    gm_parameter_format(row, owner, parameter->value, sizeof parameter->value);
}

static bool is_idle(const struct gm_session *session, const char *key)
{
    bool idle = true;
    for (size_t i = 0; idle && i < session->count; i++) {
        idle = gm_scene_idle(session->scene, session->lanes[i]->parameters, key) != NULL;
    }
    return idle;
}

/* The scene's default end, or, after it, twice the time that has passed. */
static double suggested_end(const struct gm_session *session)
{
    const struct gm_lane *lane = session->lanes[0];
    const struct gm_timing *timing = lane->parameters;
    double t = gm_session_time(session), end = timing->until;
    return end > t + fabs(lane->run->dt) && end < GM_NEVER ? end : t + fabs(t - lane->t0);
}

bool gm_shot_uses(const struct gm_shot *shot, const struct gm_scheme *scheme)
{
    for (size_t i = 0; i < shot->lane_count; i++) {
        if (shot->lanes[i].scheme == scheme) {
            return true;
        }
    }
    return false;
}

void gm_shot_take(struct gm_shot *shot, const struct gm_session *session, bool draw)
{
    shot->scene = session->scene;
    shot->lane_count = session->count;
    shot->selected = session->selected;
    shot->ahead = suggested_end(session);
    shot->gone = gm_session_gone(session);
    shot->reach = gm_session_reach(session);
    shot->backwards = gm_session_direction(session) < 0;
    shot->turned = session->turned;
    shot->overlaid = session->log.overlay;
    shot->in_space = gm_scene_parameter(session->scene, "azimuth") && !is_idle(session, "azimuth");
    shot->drawn = draw;
    shot->observable_count = session->scene->observable_count;
    if (shot->observable_count > GM_SHOT_OBSERVABLES) {
        shot->observable_count = GM_SHOT_OBSERVABLES;
    }
    shot->measured_count = 0;
    for (size_t k = 0; k < shot->observable_count; k++) {
        shot->measured[k] = session->count > 0 && gm_lane_measures(session->lanes[0], k);
        shot->measured_count += shot->measured[k];
    }
    for (size_t i = 0; i < session->count; i++) {
        const struct gm_lane *lane = session->lanes[i];
        struct gm_shot_lane *copy = &shot->lanes[i];
        copy->shown = lane->named;
        copy->first_scheme = lane->first_scheme;
        copy->scheme = lane->scheme;
        copy->status = lane->run->status;
        copy->t = lane->run->t;
        copy->from_start = session->turned ? gm_session_from_start(session, i) : 0;
        for (size_t k = 0; k < shot->observable_count; k++) {
            copy->values[k] = gm_lane_observe(lane, k);
        }
        copy->lost = gm_lane_lost(lane);
        take_sparks(copy, lane, shot->observable_count);
    }
    shot->parameter_count = 0;
    for (size_t i = 0; i < session->scene->parameter_count; i++) {
        const struct gm_parameter *row = &session->scene->parameters[i];
        /* the explorer has no end, so `until` would move nothing */
        if (row->offset != offsetof(struct gm_timing, until) && gm_row_is_offered(row) &&
            !is_idle(session, row->key)) {
            take_parameter(shot, session, row, false);
        }
    }
    for (size_t i = 0; i < gm_settings_parameter_count; i++) {
        bool used = false;
        for (size_t k = 0; k < session->count; k++) {
            used = used || gm_scheme_takes(session->lanes[k]->scheme, &gm_settings_parameters[i]);
        }
        if (used) {
            take_parameter(shot, session, &gm_settings_parameters[i], true);
        }
    }
    shot->scheme_count = gm_session_fits(session, shot->schemes);
    for (size_t i = 0; i < shot->scheme_count; i++) {
        shot->same[i] = gm_scheme_same_as(shot->schemes[i], &session->lanes[0]->problem);
    }
    if (draw) {
        gm_picture_clear(shot->picture);
        gm_lanes_draw((const struct gm_lane *const *)session->lanes, session->count, shot->picture);
    }
}
