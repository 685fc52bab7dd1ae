/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Explicit Runge-Kutta methods:
       k_i = f(y0 + h sum_{j<i} a_ij k_j)
       y1  = y0 + h sum_i b_i k_i
   E. Hairer, S.P. Norsett & G. Wanner, Solving Ordinary Differential Equations I (1993), section II.1. The
   rows are in explicit.def, which the loops over kernels include as well. */
#include "core/ode/families/runge_kutta/explicit.h"

#include "core/ode/families/family.h"
#include "core/ode/families/runge_kutta/implicit.h"
#include "core/ode/kernel/tiles.h"

/* The loop for an n chosen at run time, through the problem's field. */

enum { STAGES = GM_TABLEAU_STAGES, BLOCK = GM_PASSIVE_BLOCK };

static void *workspace_open(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    const size_t stages = (size_t)((const struct gm_tableau *)scheme->coefficients)->stages;
    /* stages, slopes, increment */
    return gm_tiles_open(problem, (2 * stages + 1) * gm_tile_components(problem), 0);
}

/* stage = y + h sum_(j<i) a_ij k_j, for `count` components whose slopes lie `stride` apart */
GM_OF_TILE void stage_of(const struct gm_tableau *tableau, int i, double h, const double *y,
                         const double *slopes, size_t stride, double *stage, size_t count)
{
    for (size_t c = 0; c < count; c++) {
        stage[c] = y[c];
    }
    for (int j = 0; j < i; j++) {
        if (tableau->a[i][j] != 0) {
            gm_tile_add(stage, h * tableau->a[i][j], slopes + (size_t)j * stride, NULL, count);
        }
    }
}

GM_OF_TILE void increment_of(const struct gm_tableau *tableau, double h, const double *slopes, size_t stride,
                             double *increment, size_t count)
{
    for (size_t c = 0; c < count; c++) {
        increment[c] = h * tableau->b[0] * slopes[c];
    }
    for (int i = 1; i < tableau->stages; i++) {
        gm_tile_add(increment, h * tableau->b[i], slopes + (size_t)i * stride, NULL, count);
    }
}

/* The passive particles, a block at a time, through the stages that the active components have gone. */
static void carry_along(const struct gm_task *task, const struct gm_tableau *tableau, struct gm_tile *tile)
{
    const struct gm_problem *problem = task->problem;
    const size_t active = gm_tile_components(problem), passive = problem->passive;
    for (size_t first = 0; first < passive; first += BLOCK) {
        const size_t count = passive - first < BLOCK ? passive - first : BLOCK;
        const size_t at[2] = {active + first, active + passive + first};
        double slopes[2][STAGES][BLOCK], stage[2][BLOCK], increment[BLOCK];
        for (int i = 0; i < tableau->stages; i++) {
            for (int side = 0; side < 2; side++) {
                stage_of(tableau, i, task->dt, tile->y + at[side], slopes[side][0], BLOCK, stage[side],
                         count);
            }
            tile->loops->passive(problem, tile->scratch + (size_t)i * active, stage[0], stage[1],
                                 slopes[0][i], slopes[1][i], NULL, count);
        }
        for (int side = 0; side < 2; side++) {
            increment_of(tableau, task->dt, slopes[side][0], BLOCK, increment, count);
            gm_tile_add(tile->y + at[side], 1, increment, tile->carry ? tile->carry + at[side] : NULL, count);
        }
    }
}

GM_OF_TILE enum gm_status step_of(const struct gm_task *task, struct gm_tile *tile,
                                  struct gm_progress *progress, size_t members)
{
    const struct gm_tableau *tableau = tile->row;
    const size_t active = gm_tile_components(task->problem) * members;
    const size_t all = (size_t)tableau->stages * active;
    double *stages = tile->scratch, *slopes = stages + all, *increment = slopes + all;
    for (int i = 0; i < tableau->stages; i++) {
        double *stage = stages + (size_t)i * active;
        stage_of(tableau, i, task->dt, tile->y, slopes, active, stage, active);
        tile->loops->field(task->problem, stage, slopes + (size_t)i * active, members);
    }
    carry_along(task, tableau, tile);
    increment_of(tableau, task->dt, slopes, active, increment, active);
    gm_tile_add(tile->y, 1, increment, tile->carry, active);
    progress->evaluations += (unsigned long)tableau->stages * members;
    return GM_OK;
}

GM_STEPS_OF_TILE(step_of)

static struct gm_progress advance(const struct gm_task *task)
{
    return gm_tiles_advance(task, task->scheme->coefficients, task->problem->m == 1 ? step_one : step_many);
}

static const struct gm_scheme schemes[] = {
#define GM_EXPLICIT(identifier, ...)                                                                         \
    {GM_TEXTS_##identifier, .family = &gm_family_explicit, .coefficients = &gm_explicit_##identifier},
#include "core/ode/families/runge_kutta/explicit.def"
#undef GM_EXPLICIT
};

const struct gm_family gm_family_explicit = {
    .over_kernels = GM_OVER_EXPLICIT,
    .coefficients_open = gm_tableau_coefficients_open,
    .title = "explicit Runge-Kutta",
    GM_ROWS_LISTED,
    .parameters = gm_settings_of_sums,
    .loop = advance,
    .carries_passive = true,
    .workspace_open = workspace_open,
    .workspace_close = gm_workspace_close,
};
