/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Changes that a tour has arranged for a session, made at their time. */
#include "app/tours/tour.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/schemes.h"

struct gm_agenda gm_agenda_of(const struct gm_tour *tour, size_t step, size_t from)
{
    return (struct gm_agenda){.tour = tour, .step = step, .at_step = from};
}

/* The next change, in this step or in one on which it builds, or NULL. */
static const struct gm_tour_change *next_change(struct gm_agenda *agenda)
{
    for (; agenda->at_step <= agenda->step; agenda->at_step++, agenda->at_change = 0) {
        const struct gm_tour_step *step = &agenda->tour->steps[agenda->at_step];
        if (agenda->at_change < step->change_count) {
            return &step->changes[agenda->at_change];
        }
    }
    return NULL;
}

double gm_agenda_limit(const struct gm_agenda *agenda)
{
    if (!agenda->tour || agenda->over) {
        return INFINITY;
    }
    struct gm_agenda ahead = *agenda;
    const struct gm_tour_change *change = next_change(&ahead);
    return change ? change->t : agenda->tour->steps[agenda->step].until;
}

static bool has_reached(const struct gm_session *session, double t)
{
    for (size_t i = 0; i < session->count; i++) {
        const struct gm_run *run = session->lanes[i]->run;
        /* the limit of a session's advance to t, with round-off */
        if (run->status == GM_OK && run->t + run->dt * (1 - 1e-9) <= t) {
            return false;
        }
    }
    return true;
}

static void make_change(struct gm_session *session, const struct gm_tour_change *change, char *message)
{
    static const char scheme[] = "scheme=";
    const size_t length = sizeof scheme - 1;
    for (size_t i = 0; i < session->count; i++) {
        if (change->lane != GM_EVERY_LANE && (size_t)change->lane != i) {
            continue;
        }
        if (strncmp(change->text, scheme, length) == 0) {
            const struct gm_scheme *other =
                gm_scheme_find_for(change->text + length, &session->lanes[i]->problem);
            if (other) {
                gm_session_switch(session, i, other, message);
            }
            continue;
        }
        char key[96];
        snprintf(key, sizeof key, "%.*s", (int)strcspn(change->text, "="), change->text);
        const struct gm_parameter *row = gm_scene_parameter(session->scene, key);
        bool restart = false;
        if (row) {
            gm_session_set(session, i, row, change->text + strlen(key) + 1, &restart, message);
        }
    }
}

bool gm_agenda_keep(struct gm_agenda *agenda, struct gm_session *session, char *message)
{
    message[0] = '\0';
    while (agenda->tour && !agenda->over && has_reached(session, gm_agenda_limit(agenda))) {
        const struct gm_tour_change *change = next_change(agenda);
        if (!change) {
            agenda->over = true;
            return true;
        }
        make_change(session, change, message);
        agenda->at_change++;
    }
    return false;
}

void gm_agenda_rewind(struct gm_agenda *agenda, double t)
{
    if (!agenda->tour) {
        return;
    }
    agenda->at_step = gm_tour_first(agenda->tour, agenda->step);
    agenda->at_change = 0;
    for (const struct gm_tour_change *change; (change = next_change(agenda)) && change->t < t;) {
        agenda->at_change++;
    }
    agenda->over = t > agenda->tour->steps[agenda->step].until;
}
