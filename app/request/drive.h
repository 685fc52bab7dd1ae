/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_REQUEST_DRIVE_H
#define GM_APP_REQUEST_DRIVE_H

#include <signal.h>

#include "app/request/request.h"

/* Drives lanes from outside any scene: steps, changes in flight, processor time, interruption. */

/* How often SIGINT or SIGTERM came; long work looks at it between steps. */
extern volatile sig_atomic_t gm_interrupted;
void gm_catch_interrupts(void);

struct gm_drive {
    struct gm_lane *lane;
    const struct gm_request *request; /* for its changes */
    size_t index;                     /* of the lane */
    size_t next_change;
    double seconds;  /* processor time of its steps */
    double each;     /* ... of one, when it was last measured */
    long unmeasured; /* so many more steps are taken for as long */
};

/* Advances to `step` steps in all, recording after every one if `record`; makes the changes that are due.
   Stops early on a numerical failure, an interruption, or where a scheme that chooses its steps has come to
   the lane's end. False with a sentence if a change cannot be made. */
bool gm_drive_to(struct gm_drive *drive, long step, bool record, char *message);

/* Whether the lane is still on its way to `step` steps in all, or its end (gm_run_goes_on). */
bool gm_drive_goes_on(const struct gm_drive *drive, long step);

/* The last step not after the time t: how many steps in all the lane has made then. Where the
   scheme chooses its step: one step more, as long as t is not reached. */
long gm_drive_step_at(const struct gm_drive *drive, double t);

/* Prints "geomint: sentence" to standard error. What a terminal would obey instead of showing it is replaced:
   sentences quote files and arguments. */
__attribute__((format(printf, 1, 2))) void gm_complain(const char *format, ...);
/* The same for a line of standard output, without a front. */
__attribute__((format(printf, 1, 2))) void gm_say(const char *format, ...);

/* Writes one sentence on how a failed lane stands; empty for GM_OK. */
void gm_failure_sentence(const struct gm_lane *lane, char *text, size_t size);

/* Writes one sentence on how a run ended: gm_failure_sentence, or where a scheme that chooses its steps came
   to its end, which is after the until asked for; empty if there is nothing to say. */
void gm_drive_message(const struct gm_drive *drive, char *text, size_t size);

/* Writes what is wrong with a run that is not failed: gm_lane_warning, an end that steps of the length asked
   for cannot make the until asked for; empty if there is nothing. */
void gm_drive_warning(const struct gm_drive *drive, char *text, size_t size);

/* Flushes standard output. The status to exit with: `status`, or 3 with a complaint if it could not be
 * written. */
int gm_finish(int status);

#endif
