/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_RUN_H
#define GM_CORE_RUN_H

#include "core/scheme.h"

/* A run: one problem advanced by one scheme. Everything that influences the next step lies in the
   run's one block of memory, so a snapshot is a copy. Looking at a run takes const. */
struct gm_run {
    const struct gm_problem *problem;
    const struct gm_scheme *scheme;
    struct gm_settings settings;
    double t0, dt;                                 /* the present segment: t = t0 + n dt */
    int64_t n;                                     /* steps in this segment */
    double t;                                      /* the present time */
    double limit;                                  /* blow-up bound on the components */
    int64_t steps;                                 /* steps in all */
    unsigned long evaluations, solves, iterations; /* sums over the members */
    unsigned long factor_solves;                   /* the same, with factors that are made once (flows) */
    struct gm_unsolved unsolved;                   /* why a step was not solved */
    enum gm_status status;
    int current;      /* which half of the block holds the state */
    size_t half_size; /* in bytes */
    void *workspace;  /* of the scheme's family; no part of a snapshot */
    int64_t behind;   /* so many steps before it the other half holds the state; 0: it holds none */
    bool looks_back;  /* set by who asks where the last step began: gm_run_before */
};

/* Opens a run at time t0 in the state y0 (n * m, copied). NULL when memory is short.
   The problem outlives the run; the scheme must fit it. */
struct gm_run *gm_run_open(const struct gm_problem *problem, const struct gm_scheme *scheme,
                           const struct gm_settings *settings, double t0, double dt, const double *y0);
void gm_run_close(struct gm_run *run);

/* The present state, [component * m + member]; valid until the next step. */
const double *gm_run_state(const struct gm_run *run);

/* The scheme's own memory, as its family lays it out; NULL if it has none. Valid until the next step. */
const double *gm_run_memory(const struct gm_run *run);

/* A count of the run for one member: the mean over the ensemble. */
double gm_run_per_member(const struct gm_run *run, unsigned long count);

/* Makes up to `steps` steps. After a failure the run stays at its last good step, run->status says why,
   and further calls do nothing. GM_OUT_OF_MEMORY leaves the state where it was before the call. */
enum gm_status gm_run_advance(struct gm_run *run, int64_t steps);

/* Whether the last step can be made again with another length: gm_run_advance was last called for one step,
   in this segment (that is up to the caller), and the scheme neither chooses its steps nor remembers any. Of an
   ensemble, if run->looks_back is set. */
bool gm_run_repeats(const struct gm_run *run);
/* Where that step began; valid as gm_run_state is. */
const double *gm_run_before(const struct gm_run *run);
/* Where it would end if only this fraction of it were made: the run stays as it is. y has room for 2 * n * m
   doubles (the state is the first half), aligned for 128 bytes. False where that led to no state. */
bool gm_run_part(const struct gm_run *run, double fraction, double *y);
/* Puts that in the place of the step, and begins a new segment there; a fraction that gm_run_part could
   make. */
void gm_run_shorten(struct gm_run *run, double fraction);

/* How many steps in all a run has made when it is at the time t, to the nearest; of a scheme that chooses its
   steps, more than it will ever make. */
int64_t gm_run_steps_at(const struct gm_run *run, double t);

/* The same for a picture of the time t: the last step that ends not after it; where the scheme chooses its
   steps, one more than so far as long as the run is before it. */
int64_t gm_run_steps_by(const struct gm_run *run, double t);

/* Whether a run is still on its way to an end: `steps` steps in all, or, if its scheme chooses them, the
   first that is not before the time `until`; one that misses it by round-off has reached it. */
bool gm_run_goes_on(const struct gm_run *run, int64_t steps, double until);

/* Advances to that end, as gm_run_advance does; gm_run_until to the time t alone. */
enum gm_status gm_run_to(struct gm_run *run, int64_t steps, double until);
enum gm_status gm_run_until(struct gm_run *run, double t);

/* Starts a new segment at the present time with another step (its sign may change). */
void gm_run_set_step(struct gm_run *run, double dt);

/* Starts a new segment at the present time in the state y (n * m, copied). The scheme remembers what it
   remembers when the step is changed or, with `memory` not NULL, that (as gm_run_memory lays it out). */
void gm_run_set_state(struct gm_run *run, const double *y, const double *memory);

/* Continues from the present state with another scheme that fits: a new run with the old one's time,
   step and counts. NULL when memory is short; the old run is untouched. */
struct gm_run *gm_run_switch(const struct gm_run *run, const struct gm_scheme *scheme);

/* Snapshots: bytes needed, save, and load into a run of the same problem, scheme and settings. A snapshot may
   come from a file: load returns false, and leaves the run alone, if it is not of such a run or if a run
   cannot be as it says. */
size_t gm_run_snapshot_size(const struct gm_run *run);
void gm_run_save(const struct gm_run *run, void *snapshot);
bool gm_run_load(struct gm_run *run, const void *snapshot);

#endif
