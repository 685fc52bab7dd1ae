/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The common part of schemes that correct the steps of another scheme: they hold invariants at their values at the start. */
#ifndef GM_CORE_ODE_FAMILIES_INVARIANTS_HELD_H
#define GM_CORE_ODE_FAMILIES_INVARIANTS_HELD_H

#include "core/ode/families/base_scheme.h"
#include "core/ode/kernel/conserved.h"
#include "core/ode/kernel/members.h"

/* The coefficients of such a scheme; its base, in struct gm_scheme or by name, makes the steps. */
struct gm_holding {
    const char *base; /* of a row of the program; else NULL */
    bool symmetric;
    bool constraints; /* they are held instead */
    size_t count;
    const char *names[GM_MOST_CONSERVED];
    size_t columns[GM_MOST_CONSERVED]; /* of the names in a typed word, from 1; 0: a file has them */
};

/* Returns what a scheme holds; NULL if it is of no such family. */
const struct gm_holding *gm_holding_of(const struct gm_scheme *scheme);
const struct gm_scheme *gm_holding_base(const struct gm_scheme *scheme);
/* Returns the column of the first name that a problem has no such invariant for, or 0. */
size_t gm_held_column(const struct gm_scheme *scheme, const struct gm_problem *problem);

/* A member's memory: HELD is 1 once the values, from VALUES on, are noted; CORRECTION is that of the last step. */
enum { GM_HELD_IS_SET, GM_HELD_CORRECTION, GM_HELD_TIME_CARRY, GM_HELD_VALUES };

/* The family's data of a struct gm_members, whose y is one member's state. */
struct gm_held {
    const struct gm_holding *holding;
    struct gm_base_scheme base;
    struct gm_conserved conserved;
    size_t n, count;
    double *z, *next, *move;                /* n */
    double *start_slopes, *slopes, *turned; /* count * n, by rows */
    double values[GM_MOST_CONSERVED], scale[GM_MOST_CONSERVED], length[GM_MOST_CONSERVED];
    double turn[GM_MOST_CONSERVED][GM_MOST_CONSERVED];
};

/* Fills slopes, values and scale at y, and turns the rows, turned = turn' slopes, until they are orthogonal. */
void gm_held_turn(struct gm_held *held, const double *y);
/* Returns the largest distance of the invariants at y from `values`, relative to their scale, after writing these
   distances. */
double gm_held_miss(struct gm_held *held, const double *values, const double *y, double *off);
/* The same of held->values, which are those at some state. */
double gm_held_distance(const struct gm_held *held, const double *values, double *off);
/* multipliers := (D D')^+ off, D the turned slopes, without singular values below 1e-12 of the largest and distances
   that are round-off. */
void gm_held_solve(const struct gm_held *held, const double *off, double *multipliers);
/* Notes the invariant that held->values have farthest off; returns GM_NO_CONVERGENCE. */
enum gm_status gm_held_fails(const struct gm_held *held, const double *values, struct gm_progress *progress);
/* y := from + D' multipliers, returns the sum of |y - its old value|. */
double gm_held_move(const double *from, const double *slopes, const double *multipliers, size_t count,
                    size_t n, double *y);

/* The hooks of these families. */
void *gm_held_open(struct gm_members *members, const struct gm_problem *problem,
                   const struct gm_scheme *scheme);
void gm_held_reset(void *members);
size_t gm_held_memory(const struct gm_problem *problem, const struct gm_scheme *scheme);
enum gm_status gm_held_start(const struct gm_task *task);
const char *gm_held_lacks(const struct gm_scheme *scheme, const struct gm_problem *problem);

#define GM_HELD_FAMILY(make)                                                                                 \
    GM_MEMBERS_OF_NO_ROWS(.step = make, .open = gm_held_open),                                               \
        .workspace_reset = gm_held_reset, .memory = gm_held_memory, .start = gm_held_start,                  \
        .lacks = gm_held_lacks

/* An invariant is met at this part of its scale, an iteration ends after this number of corrections. */
#define GM_HELD_MET 1e-12
enum { GM_HELD_MOST = 50 };

/* Returns true if this miss is round-off, or is met and no longer falls. The one before starts as infinity. */
static inline bool gm_held_is_met(double miss, double *before)
{
    const bool met = miss <= 4 * GM_EPSILON || (miss <= GM_HELD_MET && miss >= *before);
    *before = miss;
    return met;
}

/* Returns true if the miss after this one will be round-off: by the last factor it falls as far. */
static inline bool gm_held_is_next_met(double miss, double previous)
{
    const double near = 1e-8;
    return miss <= near && miss * miss <= GM_EPSILON * previous;
}

#endif
