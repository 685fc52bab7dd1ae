/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Problems of any kind, and the tasks of a family's loop. No equation is known here. */
#ifndef GM_CORE_PROBLEM_H
#define GM_CORE_PROBLEM_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "core/status.h"

struct gm_kind; /* core/kind.h */
struct gm_scheme;
struct gm_settings;
struct gm_problem;
struct gm_events; /* core/events.h */

/* A grid of equal spacing; node i lies at first + i dx. A periodic field obeys u(x + points dx) = u(x) +
   jump. Between walls, nodes 0 and points / 2, the field is one half of a ring, whose other half is its
   mirror image: node points - i is at the place of node i. */
struct gm_grid1 {
    size_t points;
    double dx, first, jump;
    bool walls;
};

/* The number of nodes between walls, both included, or around the ring. */
static inline size_t gm_grid1_seen(const struct gm_grid1 *grid)
{
    return grid->walls ? grid->points / 2 + 1 : grid->points;
}

/* Node i; nodes on both sides of x = 0 are exact opposites where the grid is symmetric. */
static inline double gm_grid1_node(const struct gm_grid1 *grid, size_t i)
{
    return ((double)(i < gm_grid1_seen(grid) ? i : grid->points - i) + grid->first / grid->dx) * grid->dx;
}

/* The part of dx that belongs to a visible node: a half at walls. */
static inline double gm_grid1_share(const struct gm_grid1 *grid, size_t i)
{
    return grid->walls && (i == 0 || 2 * i == grid->points) ? 0.5 : 1;
}

/* The task of a family's loop: `steps` steps of length dt for every member, reading `y` and writing `out`
   (both n * m, component-major). They do not overlap, but loops over kernels also make steps in place, and
   leave no state if one fails. Problems are autonomous. */
struct gm_task {
    const struct gm_problem *problem;
    const struct gm_scheme *scheme;
    double dt;
    int64_t steps;
    int64_t steps_before; /* steps that the run has already made */
    double limit;         /* a component above this is a blow-up */
    bool watches;         /* loops that can (gm_events.watches) end before a step that reaches a break */
    const double *y;
    double *out;
    const double *carry; /* carry of compensated summation, n * m; NULL: plain summation */
    double *carry_out;
    const double *memory; /* memory of the scheme, laid out by its family; NULL: none */
    double *memory_out;
    /* Loops that can (gm_progress.traced) write the state after each step, n numbers of one member; NULL: none does. */
    double *trace;
    double t;     /* the current time, t0 + n dt of this segment */
    double until; /* end of an adaptive scheme, which stops at the first step to reach it */
    double t0;
    int64_t n;
    void *workspace; /* the family's workspace for this run */
    const struct gm_settings *settings;
};

/* The result of a task. `done` steps succeeded for every member; if that is less than task.steps and
   `until` was not reached, `out` is void and `status` is the reason why step done + 1 failed. Counts are
   sums over the members. */
struct gm_progress {
    int64_t done;
    enum gm_status status;
    /* The counts of a substep are kept apart, since compilers read neighbours at once, and that waits for both to be
       written. */
    unsigned long evaluations;
    unsigned long factor_solves; /* solves with factors that are made once, in iterations of flows */
    unsigned long solves;
    unsigned long own_steps, rejected; /* accepted and rejected steps of step size control by a tolerance */
    unsigned long iterations;
    struct gm_unsolved unsolved; /* reason of a step without convergence, if the family has one */
    double t;                    /* the time reached by adaptive schemes */
    bool traced;                 /* the states of `done` steps are in task.trace */
};

typedef struct gm_progress gm_loop(const struct gm_task *task);

/* The exact, or a trusted, solution from y0 after the time t. All arrays are component-major,
   [component * m + member], for the m members passed. */
struct gm_exact {
    void (*solution)(const struct gm_problem *problem, double t, const double *y0, double *y, size_t m);
};

/* A problem: n components for m members (an ensemble; m = 1 is an ordinary run). The struct is plain data: a
   scene copies a problem of a kind and sets m and parameters.

   A problem is of one kind, and has facets: the structure that schemes need. Each kind defines its own
   (core/ode/ode.h and the like); a facet that is missing is a structure that the problem does not have.

   The last 2 * passive components are a passive block, x of all then y of all: particles in the plane that
   the others, the active components, carry and that act on nothing. A scheme advances the active ones alone
   and then the passive ones with the active states of its stages, so looking at tracers changes no
   trajectory. */
struct gm_problem {
    const char *name;
    const struct gm_kind *kind;
    const void *facets; /* facets, laid out by the kind; they outlive every run */
    size_t n, m;
    size_t passive;                 /* 0, or m is 1 */
    const void *parameters;         /* constants of the problem; they outlive every run */
    const struct gm_exact *exact;   /* NULL: not known */
    const struct gm_events *events; /* NULL: none (core/events.h) */
    double bound;                   /* a component above this is a blow-up; 0: the default of core/run.c */
    struct gm_grid1 line;           /* the grid of a field */
};

#endif
