/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_LANE_H
#define GM_SCENES_LANE_H

#include "scenes/history.h"
#include "scenes/scene.h"

/* A lane: one run of a scene, with its parameters, its start and its bounded past. */

struct gm_entries { /* the record of one track */
    size_t width, count;
    size_t kept;    /* entries in memory; count is less while an earlier step is looked at */
    long every;     /* of the intervals, this many make one entry (doubled by thinning) */
    double *times;  /* count */
    long *steps;    /* count: after how many steps each was made */
    double *values; /* count * width */
    long skipped;   /* of a section: so many crossings more go unrecorded (after thinning) */
    double before;  /* of a section: its value after the step before; NAN: not known */
};

/* How a lane is shown: lanes of one panel share its axes, each in its own colour. */
struct gm_shown {
    size_t panel, colour;
    char panel_name[96];  /* "": the scheme's title */
    char colour_name[96]; /* "" where the panel's name says all */
};

struct gm_lane {
    struct gm_shown shown; /* set by who opened the lane */
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
    double *behind; /* the active components after the step before, for sections; NULL: no sections */
    double t_behind;
};

/* Opens a lane at its start, with the start recorded. NULL with a sentence (GM_SENTENCE bytes) if the
   parameters contradict, the scheme does not fit or memory is short. */
struct gm_lane *gm_lane_open(const struct gm_scene *scene, const void *parameters,
                             const struct gm_settings *settings, const struct gm_scheme *scheme,
                             char *sentence);
void gm_lane_close(struct gm_lane *lane);

/* How many numbers of the state are active: all but the passive block. */
size_t gm_lane_active(const struct gm_lane *lane);

struct gm_view gm_lane_view(const struct gm_lane *lane);

/* The value of an observable now. */
double gm_lane_observe(const struct gm_lane *lane, size_t observable);

/* Takes the present state into history and tracks: once after every step that is looked at. */
void gm_lane_record(struct gm_lane *lane);

/* Takes it into tracks only, and follows angles: after every scene->follow steps that are not recorded. */
void gm_lane_follow(struct gm_lane *lane);

/* Advances by `steps`, following on the way as the scene asks; records nothing. */
enum gm_status gm_lane_advance(struct gm_lane *lane, long steps);

/* Continues the present state with another scheme; false if it does not fit or memory is short. */
bool gm_lane_switch(struct gm_lane *lane, const struct gm_scheme *scheme, char *sentence);

/* A copy with its own past: a fork. */
struct gm_lane *gm_lane_copy(const struct gm_lane *lane);

/* A change of a live parameter; acts on the present state. */
void gm_lane_set_step(struct gm_lane *lane, double dt);

/* Snapshot and return to it: history and tracks then show what was recorded up to its step; later records
   stay in memory until the lane records again, so that it can also go forward to a later snapshot. The
   snapshot is gm_lane_snapshot_size bytes; it serves this lane and its copies. */
size_t gm_lane_snapshot_size(const struct gm_lane *lane);
void gm_lane_save(const struct gm_lane *lane, void *snapshot);
void gm_lane_load(struct gm_lane *lane, const void *snapshot);

/* Whether this scheme can run this scene with these parameters. */
bool gm_scene_fits(const struct gm_scene *scene, const void *parameters, const struct gm_scheme *scheme);

#endif
