/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_COMMON_ENTRIES_H
#define GM_SCENES_COMMON_ENTRIES_H

#include "scenes/common/scene.h"

/* What a track has recorded of a run. */

struct gm_entries { /* the record of one track */
    size_t width, count;
    size_t kept;     /* entries in memory; count is less while an earlier step is looked at */
    int64_t every;   /* of the intervals, this many make one entry (doubled by thinning) */
    double *times;   /* count */
    int64_t *steps;  /* count: after how many steps each was made */
    double *values;  /* count * width */
    int64_t skipped; /* of a section: so many crossings more go unrecorded (after thinning) */
    /* of a section: its value after the step before, for each of so many members that have their own; NAN: not
       known */
    double *before;
    size_t sections;
};

/* Where a run was a step before: what tells that a section was passed. */
struct gm_behind {
    double
        *state; /* the active components, and room for what is made of them; NULL: no sections, and no stop */
    double t;
};
bool gm_behind_open(struct gm_behind *behind, const struct gm_problem *problem);
/* Whether the last step of a view's run began there. */
bool gm_behind_is_before(const struct gm_behind *behind, const struct gm_view *view);

/* False if memory is short; gm_entries_close releases what is there. `behind` gets its memory with the first
   section. */
bool gm_entries_open(struct gm_entries *entries, const struct gm_track *track, const struct gm_view *view,
                     struct gm_behind *behind);
void gm_entries_close(struct gm_entries *entries);

/* How many numbers of a problem's state are active: all but the passive block. */
size_t gm_active_count(const struct gm_problem *problem);

/* Makes the entry that is due now, if one is. */
void gm_entries_record(struct gm_entries *entries, const struct gm_track *track, const struct gm_view *view,
                       const struct gm_behind *behind);
/* After all tracks: the present state is the one behind. */
void gm_behind_note(struct gm_behind *behind, const struct gm_view *view);

/* Shows what was recorded up to a step of the run; later entries stay in memory until the next is made. */
void gm_entries_show(struct gm_entries *entries, const struct gm_track *track, const struct gm_run *run);

#endif
