/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_ODE_KERNEL_TILES_H
#define GM_CORE_ODE_KERNEL_TILES_H

#include "core/basics.h"
#include "core/ode/ode.h"

/* The loop of families over a problem whose n is chosen at run time, through its field: a tile of members,
   few enough to lie in the cache, makes all its steps before the next one starts.

   The state of a single run may end with a passive block. A passive particle whose implicit equations have no
   solution (a vortex turns it by more than a radian per step) is lost: NaN from then on; the run continues.
   Scratch is for the stages of the active components, and those of a few passive particles at a time, so a
   million of them need no more than a hundred. */

struct gm_tile {
    const struct gm_loops *loops; /* the problem's loops */
    const void *row;              /* the scheme's row, which the family made for this call */
    size_t members;               /* number of members in the tile */
    double *y;                    /* n * members, [component * members + member] */
    double *carry;                /* n * members compensations of the sums; NULL: plain */
    double *scratch;              /* scratch per member, of the requested size */
    double *shared;               /* scratch for all members together */
    bool known;                   /* true: scratch holds the last step's results of this tile */
};

enum { GM_PASSIVE_BLOCK = 64 };

/* Returns the number of active components. */
static inline size_t gm_tile_components(const struct gm_problem *problem)
{
    return problem->n - 2 * problem->passive;
}

/* Returns room for tiles with `scratch` doubles per member and `shared` doubles for all of them; the caller
   frees. NULL when out of memory. */
void *gm_tiles_open(const struct gm_problem *problem, size_t scratch, size_t shared);

/* Makes one step of all members of a tile, in place. Returns the reason of a failure. */
typedef enum gm_status gm_tile_step(const struct gm_task *task, struct gm_tile *tile,
                                    struct gm_progress *progress);

/* Makes all steps of all members; the workspace is gm_tiles_open's. */
struct gm_progress gm_tiles_advance(const struct gm_task *task, const void *row, gm_tile_step *step);

/* y[i] += factor x[i], with compensation (Kahan) if carry is not NULL */
static inline void gm_tile_add(double *y, double factor, const double *x, double *carry, size_t count)
{
    for (size_t i = 0; i < count && !carry; i++) {
        y[i] += factor * x[i];
    }
    for (size_t i = 0; i < count && carry; i++) {
        const double old = y[i], whole = carry[i] + factor * x[i];
        y[i] = old + whole;
        carry[i] = whole + (old - y[i]);
    }
}

/* Inlined with `members` known to be 1, loops over members vanish: a single run takes half the time. */
#define GM_OF_TILE static inline __attribute__((always_inline))

/* step_one and step_many of a GM_OF_TILE step_of(task, tile, progress, members) */
#define GM_STEPS_OF_TILE(step_of)                                                                            \
    static enum gm_status step_one(const struct gm_task *task, struct gm_tile *tile,                         \
                                   struct gm_progress *progress)                                             \
    {                                                                                                        \
        return step_of(task, tile, progress, 1);                                                             \
    }                                                                                                        \
    GM_CLONES static enum gm_status step_many(const struct gm_task *task, struct gm_tile *tile,              \
                                              struct gm_progress *progress)                                  \
    {                                                                                                        \
        return step_of(task, tile, progress, tile->members);                                                 \
    }

#endif
