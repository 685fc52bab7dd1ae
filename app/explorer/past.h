/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_PAST_H
#define GM_APP_EXPLORER_PAST_H

#include "scenes/lane.h"

/* Snapshots of one lane in bounded memory. When they are full every other one is dropped, so that the whole
   past stays within reach: what lies between two snapshots is stepped again. */

struct gm_moment {
    long steps;
    const struct gm_scheme *scheme;
    size_t size;
    void *memory; /* the lane's parameters, then its snapshot */
};

struct gm_past {
    struct gm_moment *moments;
    size_t count;
    size_t bound; /* on count */
    long every;   /* steps between snapshots */
};

/* An empty past is {.every = 1}. This sets how many snapshots it may hold. */
void gm_past_limit(struct gm_past *past, size_t bound);
void gm_past_close(struct gm_past *past);

/* Keeps the lane as it is now, if it is far enough from the last snapshot; with `always` in any case, and in
   place of one at the same step. */
void gm_past_note(struct gm_past *past, const struct gm_lane *lane, bool always);

/* Takes the lane back to the last snapshot at or before `steps`, and forgets all later ones. False if there
   is none. */
bool gm_past_return(struct gm_past *past, struct gm_lane *lane, long steps);

#endif
