/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_RUN_H
#define GM_CORE_RUN_H

#include "core/events.h"
#include "core/scheme.h"

/* A run: one problem advanced by one scheme. Everything that influences the next step lies in the
   run's one block of memory, so a snapshot is a copy. Looking at a run takes const. */
struct gm_run {
    const struct gm_problem *problem;
    const struct gm_scheme *scheme;
    struct gm_settings settings;
    double t0, dt;                                 /* the current segment: t = t0 + n dt */
    int64_t n;                                     /* steps in this segment */
    double t;                                      /* the current time */
    double limit;                                  /* blow-up bound on the components */
    int64_t steps;                                 /* steps in all */
    unsigned long evaluations, solves, iterations; /* sums over the members */
    unsigned long factor_solves;                   /* solves with factors that are made once (flows) */
    unsigned long own_steps, rejected;             /* steps of a scheme with a tolerance */
    struct gm_unsolved unsolved;                   /* why a step was not solved */
    enum gm_status status;
    int stopped;      /* 1: an event has ended the run */
    int current;      /* index of the block's half with the state */
    size_t half_size; /* bytes of half the block */
    void *workspace;  /* workspace of the scheme's family, not in snapshots */
    int64_t behind;   /* steps by which the other half is behind; 0: it has no state */
    double t_behind;  /* the time of the other half, of an adaptive scheme */
    bool shortens;    /* set by callers: the last step of an adaptive scheme ends where the run does */
    bool looks_back;  /* set by callers of gm_run_before */
    bool ends;        /* set by callers for whom events that end a run do so; others do not see them */
    struct gm_event_witness witness; /* set by callers who follow events */
    double *event_scratch;           /* NULL: the problem has no events; not in snapshots */
    const struct gm_problem *motion; /* of which steps are made: the problem, or with frozen switches */
    bool across;      /* breaks are not located in this step, which a frozen formula does not make */
    void *frozen;     /* keeps such problems; NULL: none, or breaks are not located */
    double *trace;    /* gm_task.trace of the steps that are being made; else NULL */
    bool traced;      /* the last steps are in it */
    size_t turned;    /* the event or break at which the run has failed; SIZE_MAX: none */
    double turned_at; /* the value of its g; after GM_BLOW_UP and GM_NO_TANGENT its time */
};

/* Opens a run at time t0 in the state y0 (n * m, copied). Returns NULL when out of memory. The problem
   outlives the run; the scheme must fit it. */
struct gm_run *gm_run_open(const struct gm_problem *problem, const struct gm_scheme *scheme,
                           const struct gm_settings *settings, double t0, double dt, const double *y0);
void gm_run_close(void *run);

/* The current state, [component * m + member]; valid until the next step. */
const double *gm_run_state(const struct gm_run *run);

/* The scheme's own memory, as its family lays it out; NULL if it has none. Valid until the next step. */
const double *gm_run_memory(const struct gm_run *run);

/* The memory of events (core/events.h); NULL: the problem has none. Valid until the next step. */
const double *gm_run_events(const struct gm_run *run);

/* Returns true if breaks are located for a scheme: its steps can be made in parts, which keep an order above 1. A scheme of
   order 1 steps across: it keeps that order, maps that are written as its steps have no parts, and those of a symplectic
   one would change its energy in one direction at each break. */
bool gm_scheme_locates_breaks(const struct gm_scheme *scheme);
/* Returns true if the run locates breaks: it has one member, and steps that can be made in parts. */
bool gm_run_locates(const struct gm_run *run);
/* Returns the motion that the next step begins with: the problem, or it with frozen switches. Valid until that step. */
const struct gm_problem *gm_run_motion(struct gm_run *run);

/* A count of the run for one member: the mean over the ensemble. */
double gm_run_per_member(const struct gm_run *run, unsigned long count);

/* Makes up to `steps` steps. After a failure the run stays at its last good step, run->status is the
   reason, and further calls do nothing. GM_OUT_OF_MEMORY leaves the state as before the call. Where events happen
   the step is made in parts, of an adaptive scheme up to the first; one that ends the run sets run->stopped, and begins a
   new segment there. */
enum gm_status gm_run_advance(struct gm_run *run, int64_t steps);

/* Returns true if the last step can be repeated with another length: gm_run_advance was last called for
   one step without events, in this segment (the caller ensures that), and the scheme is neither adaptive nor has a
   memory. An ensemble also needs run->looks_back. */
bool gm_run_repeats(const struct gm_run *run);
/* The state before the last step; valid as gm_run_state is. */
const double *gm_run_before(const struct gm_run *run);
/* Writes the state after this fraction of a step that begins at time t in the state `from`, that of gm_run_before or of
   a trace; the run does not change. y has room for 2 * n * m doubles (the state is the first half), aligned for 128
   bytes. Returns false if the shorter step fails. */
bool gm_run_part(const struct gm_run *run, const double *from, double t, double fraction, double *y);

/* Steps that were made together: row 0 is the state before them, row k the state after the k-th, n numbers each. */
struct gm_trace {
    int64_t room, count; /* the most steps, and those made */
    double *states;      /* [(room + 1) * n] */
    double *times;       /* [room + 1] */
};
/* Returns true if the steps of a run can be traced: they have one length, and follow from the state of one member without
   events. */
bool gm_run_is_traced(const struct gm_run *run);
/* Makes up to `steps` steps, trace->room at most, as gm_run_advance does, and traces them. */
void gm_run_trace(struct gm_run *run, int64_t steps, struct gm_trace *trace);
/* The number of all steps of a run at the time t, rounded; for an adaptive scheme, more than it will ever
   make. */
int64_t gm_run_steps_at(const struct gm_run *run, double t);

/* The number of all steps for a picture at the time t: the last step that ends not after t. For an
   adaptive scheme, one more than so far while the run is before t. */
int64_t gm_run_steps_by(const struct gm_run *run, double t);

/* Returns true if a run has not reached its end: `steps` steps in all or, if its scheme is adaptive, the
   first step not before the time `until`, up to round-off. */
bool gm_run_goes_on(const struct gm_run *run, int64_t steps, double until);

/* Advances to the end of gm_run_goes_on, as gm_run_advance does; gm_run_until only to the time t. */
enum gm_status gm_run_to(struct gm_run *run, int64_t steps, double until);
enum gm_status gm_run_until(struct gm_run *run, double t);

/* Starts a new segment at the current time with another step (its sign may change). */
void gm_run_set_step(struct gm_run *run, double dt);

/* Starts a new segment at the current time in the state y (n * m, copied). The scheme's memory is `memory`
   (as in gm_run_memory), or if that is NULL the one after a change of the step. */
void gm_run_set_state(struct gm_run *run, const double *y, const double *memory);

/* Continues from the current state with another scheme that fits: a new run with the old one's time, step
   and counts. Returns NULL when out of memory; the old run is unchanged. */
struct gm_run *gm_run_switch(const struct gm_run *run, const struct gm_scheme *scheme);

/* Snapshots: bytes needed, save, and load into a run of the same problem, scheme and settings. A snapshot
   may come from a file: load returns false, and leaves the run unchanged, if it is of another run or not
   possible. */
size_t gm_run_snapshot_size(const struct gm_run *run);
void gm_run_save(const struct gm_run *run, void *snapshot);
bool gm_run_load(struct gm_run *run, const void *snapshot);

#endif
