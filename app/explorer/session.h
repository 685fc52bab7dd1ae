/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_SESSION_H
#define GM_APP_EXPLORER_SESSION_H

#include "app/explorer/past.h"
#include "app/request.h"

/* What is explored: lanes of one scene that go through model time together, what was changed in flight, and
   the snapshots to step back to. No threads, no clock, no terminal. */

enum { GM_MOST_LANES = 24 };

struct gm_session {
    const struct gm_scene *scene;
    size_t count; /* of lanes, at least 1 */
    struct gm_lane *lanes[GM_MOST_LANES];
    struct gm_past pasts[GM_MOST_LANES];
    /* Parameters that wait for gm_session_restart; NULL where nothing was changed. Until then a lane keeps
       its own: its problem was made for them. */
    struct gm_lane_spec wanted[GM_MOST_LANES];
    struct gm_request log; /* the lanes' starts, and the changes since */
};

/* Opens the lanes of a request, which is copied. False with a sentence (GM_MESSAGE bytes). */
bool gm_session_open(struct gm_session *session, const struct gm_request *request, char *message);
void gm_session_close(struct gm_session *session);

/* The latest time of a lane, and the earliest time at which a lane that still goes makes its next step
   (infinite if none does). */
double gm_session_time(const struct gm_session *session);
double gm_session_next(const struct gm_session *session);

/* Lets the lane that is furthest behind make steps that end no later than t: one, or a share of many. False
   if no lane has such a step to make. */
bool gm_session_advance(struct gm_session *session, double t);

/* One step back for the lanes that are ahead; false with a sentence. */
bool gm_session_back(struct gm_session *session, char *message);

/* All lanes at their start again, with the schemes they have now and the parameters as last set. If those
   contradict, false with a sentence; the lanes then go on as they were. */
bool gm_session_restart(struct gm_session *session, char *message);

/* Sets a parameter of the scene or of the schemes. Every lane takes it, but where lanes differ in it, only
   `lane`. A live one acts at once; otherwise *restart is set, and the change takes effect with
   gm_session_restart. */
bool gm_session_set(struct gm_session *session, size_t lane, const struct gm_parameter *row, bool of_scheme,
                    const char *text, bool *restart, char *message);
/* Whether the lanes differ in a parameter. */
bool gm_session_differs(const struct gm_session *session, const struct gm_parameter *row, bool of_scheme);
/* The struct that holds a lane's parameters of the scene or of the schemes, as last set. */
const void *gm_session_owner(const struct gm_session *session, size_t lane, bool of_scheme);

/* The first scheme, in the scene's order, that fits and that no lane has; NULL if there is none. */
const struct gm_scheme *gm_session_unused(const struct gm_session *session);

/* Another scheme for a lane, from its present state on. */
bool gm_session_switch(struct gm_session *session, size_t lane, const struct gm_scheme *scheme,
                       char *message);

/* A further lane with the parameters of `like`, at its start. */
bool gm_session_add(struct gm_session *session, size_t like, const struct gm_scheme *scheme, char *message);
bool gm_session_remove(struct gm_session *session, size_t lane, char *message);

/* The schemes that fit, those the scene prefers first; at most `bound`. */
size_t gm_session_fits(const struct gm_session *session, const struct gm_scheme **schemes, size_t bound);

#endif
