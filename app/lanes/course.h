/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_LANES_COURSE_H
#define GM_APP_LANES_COURSE_H

#include "app/lanes/session.h"

/* What the files of a session share: session.c its beginning and end, session_time.c, session_changes.c,
   session_lanes.c. */

/* Says a sentence; false. */
bool gm_session_refuse(char *message, const char *sentence);
bool gm_session_short_of_memory(char *message);

/* ---- a lane's beginning and end ---- */

/* A lane at its start, and the copy of its parameters that the log keeps. */
struct gm_fresh {
    struct gm_lane *lane;
    void *start;
};

void *gm_session_copy_parameters(const struct gm_scene *scene, const void *parameters);
/* NULL lane with a sentence */
struct gm_fresh gm_session_open_lane(const struct gm_scene *scene, const void *parameters,
                                     const struct gm_settings *settings, const struct gm_scheme *scheme,
                                     char *message);
/* Puts a lane in place i, which is empty. */
void gm_session_place_lane(struct gm_session *session, size_t i, struct gm_fresh fresh,
                           const struct gm_shown *shown);
/* Empties place i. */
void gm_session_clear_lane(struct gm_session *session, size_t i);
void gm_session_forget_wanted(struct gm_session *session, size_t i);

/* Panels and colours for the lanes, in order: what the lanes' arguments give when they are read again. */
void gm_session_show_in_order(struct gm_session *session);

/* ---- the past ---- */

double gm_session_lane_gone(const struct gm_session *session, size_t i);
/* Shares the memory for snapshots out. */
void gm_session_share_budget(struct gm_session *session);
void gm_session_note(struct gm_session *session, size_t i, bool always);
void gm_session_note_all(struct gm_session *session);
/* Forgets the logged changes of a lane after `step`; all of them for step < 0. */
void gm_session_cut_log(struct gm_session *session, size_t lane, long step);
/* The lanes go on from the moment that is looked at: what came later is gone. */
void gm_session_settle(struct gm_session *session);
/* Makes a change on a lane now, and keeps its course right where that turns its time. */
bool gm_session_apply(struct gm_session *session, size_t i, const char *text, char *message);
/* The same, and logs it. */
bool gm_session_change(struct gm_session *session, size_t i, const char *text, char *message);

#endif
