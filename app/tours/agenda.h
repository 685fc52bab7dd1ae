/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_TOURS_AGENDA_H
#define GM_APP_TOURS_AGENDA_H

#include "app/runs/session.h"
#include "app/tours/tour.h"

/* What a step of a tour has arranged for a session: changes in flight, and where to stop. Without a tour
   there is nothing on it. */
struct gm_agenda {
    const struct gm_tour *tour; /* NULL: none; outlives the agenda */
    size_t step;
    size_t at_step, at_change; /* the next change */
    bool over;                 /* the stop was reached; the user goes on at will */
};

/* The agenda of a step for a session that begins where step `from` <= step does. */
struct gm_agenda gm_agenda_of(const struct gm_tour *tour, size_t step, size_t from);

/* The model time that a session must not pass before gm_agenda_keep; infinite if there is none. */
double gm_agenda_limit(const struct gm_agenda *agenda);

/* Makes the changes that are due. True when the stop has just been reached. A change that cannot be made is
   left out, with a sentence in message (GM_MESSAGE bytes, else empty). */
bool gm_agenda_keep(struct gm_agenda *agenda, struct gm_session *session, char *message);

/* The session went back to the time t: what comes later is due again. */
void gm_agenda_rewind(struct gm_agenda *agenda, double t);

#endif
