/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_RUNS_PAST_H
#define GM_APP_RUNS_PAST_H

#include "scenes/common/lane.h"

/* Snapshots of one lane in bounded memory. When they are full every other one is dropped, so that the
   whole past stays available: the steps between two snapshots are repeated. */

struct gm_moment {
    int64_t steps;
    double gone; /* model time that the lane has passed, forwards and backwards */
    size_t size;
    void *memory; /* the lane's parameters, then its snapshot */
};

struct gm_past {
    struct gm_moment *moments;
    size_t count;
    size_t bound;  /* the largest count */
    int64_t every; /* steps between snapshots */
};

/* Sets the largest number of snapshots. An empty past is {.every = 1}. */
void gm_past_limit(struct gm_past *past, size_t bound);
void gm_past_close(struct gm_past *past);
/* A copy for a fork of the lane; an empty one when out of memory. */
struct gm_past gm_past_copy(const struct gm_past *past);

/* Saves the lane's current state, `gone` after its start, if it is far enough from the last snapshot; with
   `always` in any case, and instead of one at the same step. Drops snapshots of later steps: the lane has
   stepped back and continued from there. */
void gm_past_note(struct gm_past *past, const struct gm_lane *lane, double gone, bool always);

/* Takes the lane to the last snapshot at or before `steps`, and at or before `gone` or the first one; returns it, or
   NULL. Later ones stay. */
const struct gm_moment *gm_past_return(const struct gm_past *past, struct gm_lane *lane, int64_t steps,
                                       double gone);

/* Sets a parameter in all snapshots: one that is the same at all times (struct gm_parameter, looks). */
void gm_past_set(struct gm_past *past, const struct gm_parameter *row, const char *text);

/* Drops snapshots later than `steps`. */
void gm_past_forget(struct gm_past *past, int64_t steps);

#endif
