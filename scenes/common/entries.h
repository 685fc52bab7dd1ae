/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_COMMON_ENTRIES_H
#define GM_SCENES_COMMON_ENTRIES_H

#include "core/arena.h"
#include "scenes/common/scene.h"

/* The entries that a track has recorded during a run. */

struct gm_entries { /* the record of one track */
    size_t width, count;
    size_t kept;     /* entries in memory; count is less while an earlier step is shown */
    int64_t every;   /* intervals per entry; thinning doubles it */
    double *times;   /* [count], model time */
    int64_t *steps;  /* [count], number of steps */
    double *values;  /* [count * width] */
    int64_t skipped; /* crossings still to be left out, after thinning */
    /* values of the section after the last step, one per section; NAN: unknown */
    double *before;
    size_t sections;
};

/* The state before a step: it shows that a section was crossed. */
struct gm_behind {
    double *state; /* active components, then room for 3 times as many; NULL: no sections, no stop */
    double t;
};
/* Takes the memory, if it has none; in a body of the arena. */
void gm_behind_open(struct gm_arena *arena, struct gm_behind *behind, const struct gm_problem *problem);
/* True if the last step of a view's run began in this state. */
bool gm_behind_is_before(const struct gm_behind *behind, const struct gm_view *view);

/* Takes the memory of a record, and of `behind` with the first section; in a body of the arena. */
void gm_entries_open(struct gm_arena *arena, struct gm_entries *entries, const struct gm_track *track,
                     const struct gm_view *view, struct gm_behind *behind);

/* Returns the number of active components of a state, n * m without the passive block. */
size_t gm_active_count(const struct gm_problem *problem);

/* Makes an entry if one is due now. */
void gm_entries_record(struct gm_entries *entries, const struct gm_track *track, const struct gm_view *view,
                       const struct gm_behind *behind);
/* Copies the current state to `behind`, after all tracks. */
void gm_behind_note(struct gm_behind *behind, const struct gm_view *view);

/* Shows the record up to the current step of the run; later entries stay in memory until the next one is
   made. */
void gm_entries_show(struct gm_entries *entries, const struct gm_track *track, const struct gm_run *run);

/* Finds the place in the last step of a view's run at which `value` passes 0. Returns the fraction of the
   step that ends just beyond; `state` (n * m) is the state there. The scheme repeats its step, shorter, so
   the place has the scheme's accuracy. Returns NaN if the step cannot be repeated (gm_run_repeats), `value`
   does not change its sign, or when out of memory. The step must have begun at the caller's last state. */
double gm_crossing_find(const struct gm_view *view, double (*value)(const struct gm_view *view),
                        double *state);

#endif
