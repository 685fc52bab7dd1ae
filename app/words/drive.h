/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_WORDS_DRIVE_H
#define GM_APP_WORDS_DRIVE_H

#include "app/words/request.h"

/* Drives lanes from outside any scene: steps, changes during a run, CPU time. */

struct gm_drive {
    struct gm_lane *lane;
    const struct gm_request *request; /* the request that has the changes */
    size_t index;                     /* index of the lane in the request */
    size_t next_change;
    double seconds;     /* CPU time of the steps, in seconds */
    double each;        /* CPU time of one step, in seconds, when it was last measured */
    int64_t unmeasured; /* number of further steps to which `each` applies */
    double looked;      /* value of `seconds` at the last search for an engine */
    /* Rows of the steps that are not recorded, t and the state's n m numbers each; advances with them; or
       NULL. gm_drive_to makes no step beyond its `step`, of fixed size or adaptive, so that number of rows
       must have room. */
    double *trace;
    /* The end of an adaptive run, in model time; NULL: the lane's until, which pictures also use as the
       run's length. */
    const double *stop;
    bool whole_steps; /* the last step of a request is not shortened to end at its until */
};

/* Advances to `step` steps in all, recording after every one if `record`; makes the changes that are due.
   Stops early on a numerical failure, an interruption, or at the lane's end if the scheme is adaptive.
   Returns false with a sentence if a change cannot be made. */
bool gm_drive_to(struct gm_drive *drive, int64_t step, bool record, char *message);

/* Returns true if the lane has reached neither `step` steps in all nor its end (gm_run_goes_on). */
bool gm_drive_goes_on(const struct gm_drive *drive, int64_t step);

/* The last step if nothing interferes: `step`, or the lane's end if it is earlier; for an adaptive scheme
   an upper bound. */
int64_t gm_drive_end(const struct gm_drive *drive, int64_t step);

/* Advances to the lane's last step for the time t (gm_run_steps_by), at most to the lane's end. */
bool gm_drive_until(struct gm_drive *drive, double t, bool record, char *message);

/* Returns the length of the last step, which is shortened to end at the requested until, if it is the next
   one; else 0. A checkpoint must be written before it, so that a later end is reached by whole steps. An adaptive
   scheme ends there by itself, if its last step becomes shorter with dt. */
double gm_drive_rest(const struct gm_drive *drive);

/* Writes one sentence on the failure of a lane; empty for GM_OK. */
void gm_failure_sentence(const struct gm_lane *lane, char *text, size_t size);

/* Writes one sentence on the end of a run: gm_failure_sentence, or an end that is not the requested until;
   empty if there is nothing to report. */
void gm_drive_message(const struct gm_drive *drive, char *text, size_t size);

/* Writes that a run did not end at the requested until: it is not a whole number of steps, or an adaptive
   scheme ends far beyond it. Empty if it did. */
void gm_drive_other_end(const struct gm_drive *drive, char *text, size_t size);

/* Writes the warning on a run that is not failed: gm_lane_warning, and that an adaptive scheme ends far
   beyond the requested until; empty if there is nothing. */
void gm_drive_warning(const struct gm_drive *drive, char *text, size_t size);

/* Makes steps of a lane towards an end (gm_lane_to) for about a fiftieth of a second, so that the caller
   can answer an interruption. `*each`, at first 0, is the time of one, in seconds. Returns the CPU time,
   in seconds. */
double gm_lane_burst(struct gm_lane *lane, int64_t steps, double until, double *each);

/* The estimated time of a lane of a request, in seconds, from its first steps; 0: it cannot be opened. */
double gm_drive_seconds(const struct gm_request *request, size_t index);

#endif
