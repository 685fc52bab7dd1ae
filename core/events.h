/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Events: changes of a motion where a function g of its state and the time passes 0. A stop is the change that
   ends the run; at a break the rates change, from one smooth formula to another. The g of an event is smooth, too, between
   the switches in it: where one passes, g may jump. */
#ifndef GM_CORE_EVENTS_H
#define GM_CORE_EVENTS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "core/problem.h"

struct gm_event_part;

/* The places where an event happens: at a 0 of g, which g passes, or to which it jumps; of a switch, also at each whole
   number of g; or, of a g that changes only by jumps, at the jump to 0 or past it. */
enum gm_event_form { GM_AT_ZERO, GM_AT_WHOLE, GM_AT_JUMP };

/* The events of a problem, for one member. `look` is a state with its time: n components, then t. */
struct gm_events {
    /* First the written ones, then switches; the first switches are breaks, in runs that locate them. */
    size_t count, written, breaks;
    const char *const *names;        /* [count]; "": none */
    const char *const *surfaces;     /* [count - written], the text of a switch's g */
    const bool *inner;               /* [count - written]: the g of an event holds the switch */
    const enum gm_event_form *forms; /* [count]; of switches no jump */
    const bool *ends;                /* [count]: the event ends the run, and changes no state */
    bool changes, ends_runs;         /* some event changes the state; some ends the run */
    /* Writes g of all in `count` looks, with switches in these modes: number i of look k is at [i * count + k], of looks
       and of g. NaN when out of memory. */
    void (*values)(const struct gm_problem *problem, const double *modes, const double *looks, size_t count,
                   double *values);
    /* Returns true if the conditions of an event hold. Writes the n components after it, unless y is NULL. */
    bool (*change)(const struct gm_problem *problem, size_t event, const double *look, double *y);
    /* Returns dg/dt along a motion, of the problem or with frozen switches; a short `time` after the look, where the rates
       of the look lead. */
    double (*rate)(const struct gm_problem *problem, const double *modes, const struct gm_problem *motion,
                   size_t event, const double *look, double time);
    /* v := S v, n numbers, for a small error v of the state before the event,
           S = DR + (f+ - DR f- - dR/dt) grad g' / (grad g . f- + dg/dt)
       with the change y+ = R(y-, t), the fields f- and f+ before and after it, and the g whose passage lets it happen.
       Returns false where the motion only touches g = 0, or there is no such g. M. A. Aizerman & F. R. Gantmacher,
       Quart. J. Mech. Appl. Math. 11 (1958) 225. */
    bool (*carry)(const struct gm_problem *problem, const struct gm_event_part *part, double *v);
    /* The same for all tangents that the state y after an event holds, if any. */
    bool (*carry_within)(const struct gm_problem *problem, const struct gm_event_part *part, double *y);
    /* Returns the problem whose breaks are frozen in the first of these modes. It and the one that was returned before
       stay valid until the next call; *frozen, NULL at first, keeps them until `melt`. NULL when out of memory. */
    const struct gm_problem *(*freeze)(const struct gm_problem *problem, void **frozen, const double *modes);
    void (*melt)(void *frozen);
    /* Returns true if the loops of a motion end before a step that reaches a break (gm_task.watches). */
    bool (*watches)(const struct gm_problem *motion);
    /* Conserved quantities, whose jumps are added up; the last is the energy, if there is one. */
    size_t quantities;
    bool has_energy;
    void (*conserved)(const struct gm_problem *problem, const double *look, double *values);
};

/* A part of a step that ends with an event. */
struct gm_event_part {
    size_t event;
    size_t
        cause; /* the number of the g that passes, of the event or a switch in its g; count: another event causes it */
    const double *modes;                     /* before it */
    const double *before, *after;            /* looks before and after the change */
    const struct gm_problem *ahead, *beyond; /* the motions before and after it */
};
/* Sees every event, in order. */
struct gm_event_witness {
    void (*see)(void *data, const struct gm_event_part *part);
    void *data;
};

/* The memory of events in a run's block, all doubles: for each event its mode, the sign of g that it waits with (0: not
   known, or none before g leaves 0), or the whole number below g; how often each event happened; the jumps of the
   quantities; the time of the last event, and the number of successive intervals that were too short. */
size_t gm_events_memory(const struct gm_problem *problem);
/* The number of times that an event or break happened; for number `count`, all events that change the state. */
double gm_events_happened(const struct gm_problem *problem, const double *memory, size_t event);
/* The sum of the jumps of a quantity. */
double gm_events_booked(const struct gm_problem *problem, const double *memory, size_t quantity);

/* A step that is made in parts if events happen in it. */
struct gm_event_step {
    const struct gm_problem *problem;
    double t, dt, end_time; /* parts are those of dt */
    bool varies;            /* parts have times of their own, so the step ends at the first event */
    bool first;   /* of the run: a start on g = 0, up to round-off, does not pass it; all events are armed */
    bool ends;    /* events that end the run do so */
    bool locates; /* breaks are located */
    size_t size, state;  /* numbers of a state with its carry and the scheme's memory, and without */
    const double *begin; /* the state before */
    double *end;         /* the state after the whole step; then the one after the events */
    double *memory;
    double *from, *to; /* room for two states with all that belongs to them */
    double *scratch;   /* gm_events_scratch */
    /* Writes the state after a part of a step, of length dt from `from` at t. `counted` if it is one that the
       run takes. Returns its time, NAN if it fails. */
    double (*part)(void *data, const double *from, double t, double dt, double *to, bool counted);
    /* Fills the scheme's memory of a changed state, which is zero. Returns false if that fails. */
    bool (*restart)(void *data, double t, double *state);
    /* Returns the motion with these modes, which is valid until the next call but one; NULL when out of memory. */
    const struct gm_problem *(*motion)(void *data, const double *modes);
    void *data;
    struct gm_event_witness witness;
    bool parts;       /* some were made */
    double reached;   /* the time of the end */
    size_t turned;    /* the event or switch at which it ends; SIZE_MAX: none */
    double turned_at; /* the value of g there; the time of an event without a value */
};
enum gm_event_outcome {
    GM_EVENTS_NONE,
    GM_EVENTS_HAPPENED,
    GM_EVENTS_ENDED,
    GM_EVENTS_FAILED,
    GM_EVENTS_NO_VALUE,
    GM_EVENTS_NO_TANGENT,
    GM_EVENTS_MANY,
    GM_EVENTS_SLIDE
};

enum { GM_EVENTS_TOGETHER = 32 };
size_t gm_events_scratch(const struct gm_problem *problem);
/* Begins the waiting of switches, and if step->first of all events, in the state `begin` at t, of the last member; counts
   and jumps stay. */
void gm_events_arm(struct gm_event_step *step);
/* Returns the first of `count` states, GM_EVENTS_TOGETHER at most, at which some event has not the sign that it waits with,
   or waits with none; `count`: at no state. */
int64_t gm_events_near(const struct gm_event_step *step, const double *states, const double *times,
                       int64_t count);
/* The modes of switches. */
const double *gm_events_modes(const struct gm_problem *problem, const double *memory);
/* Finds the events of a step, in order, with the changes that they make. GM_EVENTS_ENDED: an event ends the run at
   `reached`, in the state `end`; GM_EVENTS_MANY: events accumulate there, or if `turned` is given a step has too many;
   GM_EVENTS_NO_VALUE: an event changes the state to one that is not finite; GM_EVENTS_NO_TANGENT: it leaves no tangents; GM_EVENTS_SLIDE: after a break the rate
   points back. */
enum gm_event_outcome gm_events_pass(struct gm_event_step *step);

/* The zero of a function along a step, from `low` to 1, between values of different sign there: the place just
   beyond it, to 2e-16. NaN if a value is NaN. T. R. Chandrupatla, Adv. Eng. Software 28 (1997) 145: inverse
   quadratic interpolation if it is safe, else bisection. */
double gm_zero_beyond(double (*value)(void *data, double s), void *data, double low, double at_low,
                      double at_end);

#endif
