/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_WORDS_DRIVE_H
#define GM_APP_WORDS_DRIVE_H

#include "app/words/request.h"

/* Drives lanes from outside any scene: steps, changes in flight, processor time. */

struct gm_drive {
    struct gm_lane *lane;
    const struct gm_request *request; /* for its changes */
    size_t index;                     /* of the lane */
    size_t next_change;
    double seconds;     /* processor time of its steps */
    double each;        /* ... of one, when it was last measured */
    int64_t unmeasured; /* so many more steps are taken for as long */
    double looked;      /* of the seconds, when another engine was last looked for */
    /* Where the steps that are not recorded leave their rows, t and the state's n m numbers, and moves on; or
       NULL. gm_drive_to makes no more steps, whether fixed or of the scheme's own choice, than up to its
       `step`: there has to be room for a row of each. */
    double *trace;
    /* Where a scheme that chooses its steps ends; NULL: at the lane's until, which pictures also take for the
       length of the run. */
    const double *stop;
};

/* Advances to `step` steps in all, recording after every one if `record`; makes the changes that are due.
   Stops early on a numerical failure, an interruption, or where a scheme that chooses its steps has come to
   the lane's end. False with a sentence if a change cannot be made. */
bool gm_drive_to(struct gm_drive *drive, int64_t step, bool record, char *message);

/* Whether the lane is still on its way to `step` steps in all, or its end (gm_run_goes_on). */
bool gm_drive_goes_on(const struct gm_drive *drive, int64_t step);

/* The step of its end, `step` or the lane's own, if nothing comes between; of a scheme that chooses its steps
   more than it may make. */
int64_t gm_drive_end(const struct gm_drive *drive, int64_t step);

/* Advances to where the lane is looked at for the time t (gm_run_steps_by), but not beyond its own end. */
bool gm_drive_until(struct gm_drive *drive, double t, bool record, char *message);

/* Writes one sentence on how a failed lane stands; empty for GM_OK. */
void gm_failure_sentence(const struct gm_lane *lane, char *text, size_t size);

/* Writes one sentence on how a run ended: gm_failure_sentence, or where a scheme that chooses its steps came
   to its end, which is after the until asked for; empty if there is nothing to say. */
void gm_drive_message(const struct gm_drive *drive, char *text, size_t size);

/* Writes that a run at its end is not at the until asked for, which is no whole number of steps or, where the
   scheme chooses them, lies far behind; empty if it is. */
void gm_drive_other_end(const struct gm_drive *drive, char *text, size_t size);

/* Writes what is wrong with a run that is not failed: gm_lane_warning and gm_drive_other_end; empty if there
   is nothing. */
void gm_drive_warning(const struct gm_drive *drive, char *text, size_t size);

/* Makes as many steps of a lane towards an end (gm_lane_to) as take about a fiftieth of a second, so that whoever makes
   many can answer an interruption. `*each`, at first 0, is the time of one. Returns the processor time. */
double gm_lane_burst(struct gm_lane *lane, int64_t steps, double until, double *each);

/* What a lane of a request will take by the clock, judged by its first steps; 0: it cannot be opened. */
double gm_drive_seconds(const struct gm_request *request, size_t index);

#endif
