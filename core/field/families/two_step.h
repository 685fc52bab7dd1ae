/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loop of schemes that lead from two levels of a field to the next, and what their files share. */
#ifndef GM_CORE_FIELD_FAMILIES_TWO_STEP_H
#define GM_CORE_FIELD_FAMILIES_TWO_STEP_H

#include "core/field/field.h"
#include "core/linear/ring/newton.h"

/* Arrays have GM_LEVEL_PAD more points than the grid at both ends, of which the loop sets level[-1] and level[points]. */
enum { GM_LEVEL_PAD = 3 };
struct gm_two_step_work {
    size_t points;
    const struct gm_scheme *scheme;
    bool first;       /* a step without a level of its own before: its row has no `start` */
    double *level[3]; /* past, present, next */
    double *force;
    double *right, *guess, *cells; /* arrays of implicit schemes */
    double *change;                /* from the past to the current level, of schemes that store it */
    double *rate[3];               /* rates of the levels */
    struct gm_ring ring;
    struct gm_ring_newton newton;  /* opened by schemes that use it */
    double factored_k, factored_h; /* step and dx that newton.band is factored for; 0: none */
};

/* One step of length dt: the next level from the past and the current one, both with their end points;
   status GM_OK. */
typedef enum gm_status gm_two_step(struct gm_two_step_work *work, const struct gm_problem *problem, double dt,
                                   struct gm_progress *progress);

/* The next level, at t + dt, from the current one and the past one, which is at t + gap here; gap is
   neither dt nor -dt. */
typedef void gm_two_step_start(struct gm_two_step_work *work, const struct gm_problem *problem, double dt,
                               double gap);
gm_two_step_start gm_wave_start;

/* The discrete conservation laws of a scheme: laws of nodes, of nodes at twice the distance in time and
   space, of cells, or others. */
enum gm_wave_law { GM_LAW_NODES, GM_LAW_CENTRED, GM_LAW_CELLS, GM_LAW_NONE };

/* The coefficients of a two-step scheme. */
struct gm_two_step_row {
    gm_two_step *step;
    gm_two_step_start *start; /* NULL: the step has work->first */
    enum gm_wave_law law;
    bool average;      /* the force is the quotient of V, not V' at the current level */
    bool keeps_change; /* work->change is the scheme's memory */
    bool keeps_rates; /* work->rate of the present and the past level is, and steps and starts set the next */
    bool keeps_origin; /* the memory is a number, 1 when the scheme has made the other level of the state */
    bool single;       /* the step needs no past */
};

/* Returns true if no value is farther from `from` than this. */
bool gm_level_is_within(const double *level, size_t points, double from, double limit);

/* Advances a wave problem by a scheme of two steps. */
struct gm_progress gm_two_step_advance(const struct gm_task *task);
void *gm_two_step_open(const struct gm_problem *problem, const struct gm_scheme *scheme);
void gm_two_step_close(void *workspace);
/* The fields of a family that advances so. */
#define GM_TWO_STEP_LOOP                                                                                     \
    .loop = gm_two_step_advance, .workspace_open = gm_two_step_open, .workspace_close = gm_two_step_close

/* Sets all end points of a level that is periodic. */
void gm_level_close_ring(double *level, size_t points);
/* next_j = base_j + [drift - convection (u_{j-1} + u_j + u_{j+1})] (u_{j+1} - u_{j-1})
                   - dispersion (u_{j+2} - 2 u_{j+1} + 2 u_{j-1} - u_{j-2}),   of u around the ring, whose ends it sets */
void gm_kdv_add_terms(double *u, const double *base, double *next, size_t points, double drift,
                      double convection, double dispersion);

/* Sets the two end points of a level, or of anything that is periodic up to `jump`. */
static inline void gm_grid1_close(double *level, size_t points, double jump)
{
    level[-1] = level[points - 1] - jump;
    level[points] = level[0] + jump;
}

/* The node that lies `by` nodes from node i; it may be beyond an end. */
static inline double gm_grid1_value(const struct gm_grid1 *grid, const double *level, size_t i, long by)
{
    const long points = (long)grid->points, place = (long)i + by;
    const long turns = (place >= points) - (place < 0);
    return level[place - turns * points] + (double)turns * grid->jump;
}

#endif
