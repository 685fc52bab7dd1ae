/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_COMMON_LANE_H
#define GM_SCENES_COMMON_LANE_H

#include "scenes/common/entries.h"

/* A lane: one run of a scene, with its parameters, its start and its bounded past. */

/* The display of a lane: lanes of one panel share its axes, each in its own colour. */
struct gm_shown {
    size_t panel, colour;
    size_t dash;          /* number of the colour, or of the panel if panels share colours */
    char panel_name[96];  /* "": the scheme's title */
    char colour_name[96]; /* "" if the panel's name is sufficient */
};

/* A scheme that continued a run after `step` steps. */
struct gm_switch {
    const struct gm_scheme *scheme;
    int64_t step;
    double t;
};

/* Sees every step that is followed: the steps of lane->behind.trace if lane->behind.traced, else the step of the view. */
struct gm_lane_watch {
    void (*see)(void *data, const struct gm_view *view);
    void *data;
};

struct gm_lane {
    struct gm_arena *arena; /* holds all of this */
    struct gm_shown shown;  /* `named`, with the schemes of now and before: "Verlet, after RK4" */
    struct gm_shown named;  /* set by gm_lane_show */
    char schemes[96];       /* titles of the schemes: "Verlet, after RK4" */
    const struct gm_scheme *first_scheme;
    struct gm_switch *switches; /* [switch_count], in the order of steps */
    size_t switch_count;
    size_t switches_kept; /* all in memory; switch_count is less while an earlier step is shown */
    const struct gm_scene *scene;
    void *parameters; /* copy of the scene's own struct */
    struct gm_settings settings;
    const struct gm_scheme *scheme;
    struct gm_problem problem;
    double t0;
    double *start; /* [n * m] */
    struct gm_run *run;
    struct gm_history history;    /* one series per observable */
    struct gm_entries *entries;   /* one per track */
    double *angles;               /* last value of each observable, to unwrap angles */
    struct gm_worked *worked;     /* [GM_WORKED] */
    double *initials, *cancelled; /* per observable, as in struct gm_view; one block of memory */
    struct gm_lane_watch watch;   /* set by callers who follow a section of their own */
    struct gm_behind behind;      /* state for sections */
    int64_t followed;             /* number of steps when it was last followed */
    bool unfollowed; /* tracks need no intermediate steps: without a watch gm_lane_to makes all at once */
};

/* Opens a lane at its start, with the start recorded. Returns NULL with a sentence (GM_MESSAGE bytes) if
   parameters contradict, the scheme does not fit, or when out of memory. */
struct gm_lane *gm_lane_open(const struct gm_scene *scene, const void *parameters,
                             const struct gm_settings *settings, const struct gm_scheme *scheme,
                             char *sentence);
void gm_lane_close(void *lane);

struct gm_view gm_lane_view(const struct gm_lane *lane);

/* The value of an observable in a view of a lane, of an error over its divisor; an angle is taken nearest to `near`. */
double gm_view_observe(const struct gm_observable *observable, const struct gm_view *view, double near);
/* The current value of an observable; NAN when out of memory. */
double gm_lane_observe(const struct gm_lane *lane, size_t observable);

/* The reason why a computed observable is not finite; NULL without one, as for what the motion conserves. */
const char *gm_lane_missing(const struct gm_lane *lane, size_t observable);
/* Ends a good run as a blow-up if this value of an observable that the motion conserves is not finite, and has no reason
   for that. */
void gm_lane_judge(struct gm_lane *lane, size_t observable, double value);

/* The number of the first observables on request that the lane's picture shows: they follow steps of one size. */
size_t gm_lane_asked_shown(const struct gm_lane *lane);

/* Returns true if an observable has a meaning in this lane. */
bool gm_lane_measures(const struct gm_lane *lane, size_t observable);

/* The divisor of an error in this lane. */
double gm_lane_divisor(const struct gm_lane *lane, size_t observable);

/* A conserved quantity is lost if its error exceeds 10, or 1 or less with a symplectic scheme, or if the divisor of the
   error is the start value and less than a tenth of that is left: a change of sign leaves nothing. */
/* The observable with the greatest loss in this lane now; -1 without one, or after a failure of the run. */
long gm_lane_lost(const struct gm_lane *lane);
/* Writes one sentence on the greatest loss, or "". */
void gm_lane_warning(const struct gm_lane *lane, char *text, size_t size);
/* Writes a note on how the lane's files were read, "" or a sentence (GM_MESSAGE bytes). */
void gm_lane_note(const struct gm_lane *lane, char *sentence);

/* Takes the current state into history and tracks: call it once after every observed step. */
void gm_lane_record(struct gm_lane *lane);

/* Draws the picture of lanes of one scene. */
void gm_lanes_draw(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture);

/* Advances to an end (gm_run_to), or to an event that ends the run, and follows the steps as the scene requires; records
   nothing. */
enum gm_status gm_lane_to(struct gm_lane *lane, int64_t steps, double until);

/* Sets the names of the lane, its panel and colour. */
void gm_lane_show(struct gm_lane *lane, const struct gm_shown *named);

/* Replaces the part `before` of both names by `after`; for a parameter together with its value. */
void gm_shown_rename(struct gm_shown *shown, const char *before, const char *after, bool parameter);

/* Returns the scheme that was at work after a number of switches. */
const struct gm_scheme *gm_lane_scheme_after(const struct gm_lane *lane, size_t switches);

/* Continues from the current state with another scheme. Returns false with a sentence if it does not fit or
   when out of memory. */
bool gm_lane_switch(struct gm_lane *lane, const struct gm_scheme *scheme, char *sentence);

/* Returns a lane of the same scene, parameters, start, names and switches, at its start; NULL when out of
   memory. */
struct gm_lane *gm_lane_reopen(const struct gm_lane *lane);

/* Changes the time step from the current state on. */
void gm_lane_set_step(struct gm_lane *lane, double dt);

/* Loads a snapshot of the lane's run (gm_run_save). Afterwards history and tracks show the
   record up to its step; later records stay in memory until the lane records again, so a later snapshot can
   be loaded too. A snapshot serves this lane and its copies. A load from another scheme takes memory: it
   returns false without it, and leaves the lane unchanged. */
bool gm_lane_load(struct gm_lane *lane, const void *snapshot);

#endif
