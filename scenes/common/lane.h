/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_COMMON_LANE_H
#define GM_SCENES_COMMON_LANE_H

#include "scenes/common/entries.h"
#include "scenes/common/history.h"

/* A lane: one run of a scene, with its parameters, its start and its bounded past. */

/* How a lane is shown: lanes of one panel share its axes, each in its own colour. */
struct gm_shown {
    size_t panel, colour;
    size_t dash;          /* the colour's number, or the panel's where panels share colours */
    char panel_name[96];  /* "": the scheme's title */
    char colour_name[96]; /* "" where the panel's name says all */
};

/* A scheme that took over in flight, after so many steps. */
struct gm_switch {
    const struct gm_scheme *scheme;
    int64_t step;
    double t;
};

struct gm_lane {
    struct gm_shown shown; /* `named`, and behind it the schemes that took over: "RK4, then Verlet" */
    struct gm_shown named; /* by gm_lane_show */
    char schemes[96];      /* the titles of the schemes alone, likewise */
    const struct gm_scheme *first_scheme;
    struct gm_switch *switches; /* switch_count, in the order of their steps */
    size_t switch_count;
    size_t switches_kept; /* in memory; switch_count is less while an earlier step is looked at */
    const struct gm_scene *scene;
    void *parameters; /* the scene's own struct, a copy */
    struct gm_settings settings;
    const struct gm_scheme *scheme;
    struct gm_problem problem;
    double t0;
    double *start; /* n * m */
    struct gm_run *run;
    struct gm_history history;  /* one series per observable */
    struct gm_entries *entries; /* one per track */
    double *angles;             /* per observable, where it was when last looked at: what unwraps an angle */
    struct gm_worked *worked;   /* GM_WORKED */
    double *initials, *cancelled; /* per observable: struct gm_view; of one piece of memory */
    struct gm_behind behind;      /* of sections, and of the stop */
    int side; /* of the scene's stop at the start: -1 below 0, 1; 0: on it, until the first step leaves it */
    int64_t followed; /* after how many steps it was looked at last */
    bool unfollowed;  /* nobody asks what lies on the way: gm_lane_to makes its steps at once */
};

/* Opens a lane at its start, with the start recorded. NULL with a sentence (GM_MESSAGE bytes) if the
   parameters contradict, the scheme does not fit or memory is short. */
struct gm_lane *gm_lane_open(const struct gm_scene *scene, const void *parameters,
                             const struct gm_settings *settings, const struct gm_scheme *scheme,
                             char *sentence);
void gm_lane_close(struct gm_lane *lane);

struct gm_view gm_lane_view(const struct gm_lane *lane);

/* The value of an observable now. */
double gm_lane_observe(const struct gm_lane *lane, size_t observable);

/* Why an observable that was looked at is no number; NULL: there is nothing to be told. */
const char *gm_lane_missing(const struct gm_lane *lane, size_t observable);

/* What an error is divided by in this lane. */
double gm_lane_divisor(const struct gm_lane *lane, size_t observable);

/* What the exact motion keeps is lost if its error is above the one, or if less than the other is left of its
   start, where that is what the error is divided by: a change of sign leaves nothing. */
#define GM_LOST_ABOVE 10.
#define GM_LOST_BELOW 0.1
/* The observable that tells of the greatest loss in this lane now; -1: none, or the run has failed, which
   says more. */
long gm_lane_lost(const struct gm_lane *lane);
/* One sentence on it; "" where there is none. */
void gm_lane_warning(const struct gm_lane *lane, char *text, size_t size);
/* What is to be known of how the lane's files were read, "" or a sentence (GM_MESSAGE). */
void gm_lane_note(const struct gm_lane *lane, char *sentence);

/* Takes the present state into history and tracks: once after every step that is looked at. */
void gm_lane_record(struct gm_lane *lane);

/* Draws the picture of lanes of one scene: what is asked for, or the scene's own. */
void gm_lanes_draw(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture);

/* Whether the run has ended where its scene says so (gm_scene.stop). */
bool gm_lane_stopped(const struct gm_lane *lane);

/* Advances to an end (gm_run_to), or to where it is stopped, following on the way as the scene asks; records
   nothing. */
enum gm_status gm_lane_to(struct gm_lane *lane, int64_t steps, double until);

/* How the lane is called, and its panel and colour. */
void gm_lane_show(struct gm_lane *lane, const struct gm_shown *named);

/* In both names replaces the part `before` by `after`; a parameter's with the value that follows. */
void gm_shown_rename(struct gm_shown *shown, const char *before, const char *after, bool parameter);

/* Continues the present state with another scheme; false if it does not fit or memory is short. */
bool gm_lane_switch(struct gm_lane *lane, const struct gm_scheme *scheme, char *sentence);

/* A lane of the same scene, parameters, start, names and switches, at its start. NULL if memory is short. */
struct gm_lane *gm_lane_reopen(const struct gm_lane *lane);

/* A change of a live parameter; acts on the present state. */
void gm_lane_set_step(struct gm_lane *lane, double dt);

/* Snapshot and return to it: history and tracks then show what was recorded up to its step; later records
   stay in memory until the lane records again, so that it can also go forward to a later snapshot. The
   snapshot is gm_lane_snapshot_size bytes; it serves this lane and its copies. Returning to one with another
   scheme takes memory: false if there is none, the lane is then where it was. */
size_t gm_lane_snapshot_size(const struct gm_lane *lane);
void gm_lane_save(const struct gm_lane *lane, void *snapshot);
bool gm_lane_load(struct gm_lane *lane, const void *snapshot);

#endif
