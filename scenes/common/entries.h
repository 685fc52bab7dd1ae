/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_COMMON_ENTRIES_H
#define GM_SCENES_COMMON_ENTRIES_H

#include <stdint.h>

#include "core/arena.h"
#include "core/run.h"
#include "scenes/common/scene.h"

/* The entries that a track has recorded during a run. */

struct gm_entries { /* the record of one track */
    size_t width, count;
    size_t kept;                /* entries in memory; count is less while an earlier step is shown */
    int64_t every;              /* intervals per entry; thinning doubles it */
    double *times;              /* [count], model time */
    int64_t *steps;             /* [count], number of steps */
    double *values;             /* [count * width] */
    double interval, intervals; /* the number of whole intervals up to the last entry, and their length */
    double counted;             /* the time of the entry of which that is known */
    int64_t skipped;            /* crossings still to be left out, after thinning */
    /* values of the section after the last step, one per section; NAN: unknown */
    double *before;
    size_t sections;
};

/* The state before a step: it shows that a section was crossed. */
struct gm_behind {
    double *state; /* active components, then room for 3 times as many; NULL: no sections */
    double t;
    struct gm_trace trace; /* steps that were made together */
    bool traced;           /* they are not recorded yet; the state is that before them */
};

/* Returns the view after step k of a trace, whose last step is that of `view`. */
struct gm_view gm_view_along(const struct gm_view *view, const struct gm_trace *trace, int64_t k);

/* Takes the memory of a record, and of `behind` with the first section; in a body of the arena. */
void gm_entries_open(struct gm_arena *arena, struct gm_entries *entries, const struct gm_track *track,
                     const struct gm_view *view, struct gm_behind *behind);

/* Returns the number of active components of a state, n * m without the passive block. */
size_t gm_active_count(const struct gm_problem *problem);

/* Makes an entry if one is due now; if behind->traced, all entries that are due in the steps of behind->trace, the last of
   which ended in `view`. */
void gm_entries_record(struct gm_entries *entries, const struct gm_track *track, const struct gm_view *view,
                       struct gm_behind *behind);
/* Makes the entries of an event, which changed the state `before` to `after`. */
void gm_entries_event(struct gm_entries *entries, const struct gm_track *track, size_t event,
                      const struct gm_view *before, const struct gm_view *after, struct gm_behind *behind);
/* Copies the current state to `behind`, after all tracks. */
void gm_behind_note(struct gm_behind *behind, const struct gm_view *view);

/* Shows the record up to the current step of the run; later entries stay in memory until the next one is
   made. */
void gm_entries_show(struct gm_entries *entries, const struct gm_track *track, const struct gm_run *run);

/* The past of a few observables in bounded memory: bins with equal numbers of steps hold the least and the
   greatest value of each. When all bins are full, pairs are merged. A history can be shown as it was at an
   earlier step: later bins stay until the next sample. */

struct gm_bin {
    double t;     /* time of the bin's last sample */
    int64_t step; /* step of the bin's last sample */
    double low, high, last;
};

struct gm_history {
    size_t series;       /* number of observables */
    size_t count;        /* bins in use; the last one may still be filling */
    int64_t per_bin;     /* samples a full bin holds */
    int64_t in_last;     /* samples in the last bin */
    size_t kept;         /* bins in memory; count is less while an earlier step is shown */
    int64_t in_kept;     /* samples in the last bin in memory */
    struct gm_bin *bins; /* [bin * series + observable] */
};

enum { GM_HISTORY_BINS = 1024 };

/* Takes the bins from the arena, in a body of it. */
void gm_history_open(struct gm_arena *arena, struct gm_history *history, size_t series);
/* Adds one value per observable at time t, after `step` steps; the record of later steps is dropped. */
void gm_history_add(struct gm_history *history, double t, int64_t step, const double *values);
/* Shows the record up to `step`, which may be earlier or later than the step shown now. */
void gm_history_show(struct gm_history *history, int64_t step);

#endif
