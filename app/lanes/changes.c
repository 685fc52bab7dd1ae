/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is changed in flight, or for the next start. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/lanes/course.h"

const void *gm_session_owner(const struct gm_session *session, size_t lane, bool of_scheme)
{
    const struct gm_lane_spec *wanted = &session->wanted[lane];
    if (of_scheme) {
        return wanted->parameters ? &wanted->settings : &session->lanes[lane]->settings;
    }
    return wanted->parameters ? wanted->parameters : session->lanes[lane]->parameters;
}

bool gm_session_differs(const struct gm_session *session, const struct gm_parameter *row, bool of_scheme)
{
    double first = gm_parameter_get(row, gm_session_owner(session, 0, of_scheme));
    for (size_t i = 1; i < session->count; i++) {
        if (gm_parameter_get(row, gm_session_owner(session, i, of_scheme)) != first) {
            return true;
        }
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
        wanted->parameters = gm_session_copy_parameters(session->scene, session->lanes[i]->parameters);
        if (!wanted->parameters) {
            return gm_session_short_of_memory(message);
        }
        struct gm_timing *timing = wanted->parameters;
        timing->dt = fabs(timing->dt); /* a start is forwards */
    }
    void *owner = of_scheme ? (void *)&wanted->settings : wanted->parameters;
    if (gm_parameter_set(row, owner, text) == GM_PARSED) {
        char sentence[GM_SENTENCE];
        if (of_scheme || !session->scene->settle ||
            session->scene->settle(wanted->parameters, &row->key, 1, sentence)) {
            return true;
        }
    }
    snprintf(message, GM_MESSAGE, "%s cannot be %s.", row->key, text);
    return false;
}

bool gm_session_apply(struct gm_session *session, size_t i, const char *text, char *message)
{
    const struct gm_lane *lane = session->lanes[i];
    double before = lane->run->dt, gone = gm_session_lane_gone(session, i);
    if (!gm_change_apply(session->lanes[i], text, message)) {
        return false;
    }
    if (before * lane->run->dt < 0) {
        session->courses[i] = (struct gm_course){.gone = gone, .from = lane->run->t};
    }
    return true;
}

bool gm_session_change(struct gm_session *session, size_t i, const char *text, char *message)
{
    if (!gm_session_apply(session, i, text, message)) {
        return false;
    }
    /* of several changes of one key at one step only the last one counts */
    long step = session->lanes[i]->run->steps;
    size_t key = (size_t)(strchr(text, '=') - text) + 1, kept = 0;
    for (size_t k = 0; k < session->log.change_count; k++) {
        const struct gm_change *change = &session->log.changes[k];
        if (change->lane != i || change->step != step || strncmp(change->text, text, key) != 0) {
            session->log.changes[kept++] = *change;
        }
    }
    session->log.change_count = kept;
    if (!gm_change_add(&session->log, i, step, text)) {
        return gm_session_short_of_memory(message);
    }
    gm_session_note(session, i, true);
    return true;
}

/* A name that tells lanes apart by what has just been changed. */
static void rename_by_parameter(struct gm_session *session, size_t i, const char *key, const char *text)
{
    char before[64], after[GM_MESSAGE];
    snprintf(before, sizeof before, "%.50s = ", strcmp(key, "dt") == 0 ? "Δt" : key);
    snprintf(after, sizeof after, "%s%s", before, text);
    struct gm_shown *shown = &session->log.lanes[i].shown;
    gm_shown_rename(shown, before, after, true);
    gm_lane_show(session->lanes[i], shown);
}

bool gm_session_set(struct gm_session *session, size_t lane, const struct gm_parameter *row, bool of_scheme,
                    const char *text, bool *restart, char *message)
{
    bool alone = gm_session_differs(session, row, of_scheme), now = row->live && !of_scheme;
    bool step = !of_scheme && row->offset == offsetof(struct gm_timing, dt);
    char change[sizeof(struct gm_change){0}.text];
    /* a step is set by its size; which way it goes is another matter */
    snprintf(change, sizeof change, "%s=%s%s%s", row->key,
             step && gm_session_direction(session) < 0 ? "-(" : "", text,
             step && gm_session_direction(session) < 0 ? ")" : "");
    if (now) {
        gm_session_settle(session);
    }
    for (size_t i = 0; i < session->count; i++) {
        if (alone && i != lane) {
            continue;
        }
        if (now && !gm_session_change(session, i, change, message)) {
            return false;
        }
        /* a restart that is already due keeps a live change too */
        if ((!now || session->wanted[i].parameters) && !want(session, i, row, of_scheme, text, message)) {
            return false;
        }
        rename_by_parameter(session, i, row->key, text);
    }
    *restart = *restart || !now;
    return true;
}

bool gm_session_switch(struct gm_session *session, size_t lane, const struct gm_scheme *scheme, char *message)
{
    char change[sizeof(struct gm_change){0}.text];
    snprintf(change, sizeof change, "scheme=%s", scheme->name);
    gm_session_settle(session);
    if (!gm_session_change(session, lane, change, message)) {
        return false;
    }
    session->log.lanes[lane].shown = session->lanes[lane]->named; /* another one where nothing is made yet */
    return true;
}
