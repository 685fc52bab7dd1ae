/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Splitting methods for H(q, p) = T(p) + V(q): compositions of the exact flows
       drift   q := q + c h dT/dp(p)
       kick    p := p - c h dV/dq(q)
   Each flow is symplectic, so is every composition. An invariant q' A p of H has
       {q' A p, T} + {q' A p, V} = 0,
   of which the first depends on p alone and the second on q alone: both vanish, and each flow keeps it.
   R.I. McLachlan & G.R.W. Quispel, Acta Numerica 11 (2002) 341; Hairer, Lubich & Wanner (2006), section
   II.5. */
#include "core/ode/families/splitting/splitting.h"

#include "core/ode/families/family.h"
#include "core/ode/kernel/tiles.h"
#include "core/theory/coefficients.h"

#include "core/splitting_schemes.def" /* the rows, which the build writes by share/schemes */

/* Writes each piece as a stage that depends on those before it. A first kick uses the last force of the step
   before. */
static void coefficients_open(struct gm_arena *arena, const struct gm_scheme *scheme,
                              struct gm_coefficients *coefficients)
{
    const struct gm_splitting *splitting = scheme->coefficients;
    const int stages = splitting->count;
    gm_coefficients_open(arena, coefficients,
                         scheme->needs & GM_NEEDS_NYSTROM ? GM_EQUATIONS_NYSTROM : GM_EQUATIONS_SEPARABLE,
                         stages);
    coefficients->evaluations = 0;
    for (int j = 0; j < stages; j++) {
        const bool kick = splitting->pieces[j].piece == GM_KICK;
        const int side = kick ? GM_SIDE_P : GM_SIDE_Q;
        const struct gm_ball fraction = gm_ball_written(splitting->pieces[j].fraction);
        const bool reused = kick && j == stages - 1 && splitting->pieces[0].piece == GM_KICK;
        coefficients->evaluations += kick && !reused ? 1 : 0;
        coefficients->b[side][j] = fraction;
        for (int i = j + 1; i < stages; i++) {
            coefficients->a[side][i * stages + j] = fraction;
        }
    }
}

/* The loop for an n chosen at run time, like the loop over kernels: the force is stored from the last kick of
   a step to the first of the next. A last component that is the time moves with q. */
GM_OF_TILE enum gm_status step_of(const struct gm_task *task, struct gm_tile *tile,
                                  struct gm_progress *progress, size_t members)
{
    const struct gm_problem *problem = task->problem;
    const struct gm_splitting *table = tile->row;
    const size_t half = problem->n / 2 * members;
    const bool ends_with_kick = table->pieces[table->count - 1].piece == GM_KICK;
    const double *velocity = gm_ode_of(problem)->split->unit_mass ? tile->y + half : tile->scratch;
    double *force = tile->scratch + half;
    for (int i = 0; i < table->count; i++) {
        const double c = table->pieces[i].fraction * task->dt;
        if (table->pieces[i].piece == GM_DRIFT) {
            if (velocity == tile->scratch) {
                tile->loops->velocity(problem, tile->y, tile->scratch, members);
            }
            gm_tile_add(tile->y, c, velocity, tile->carry, half);
            if (problem->n % 2 != 0) {
                static const double one = 1;
                for (size_t l = 2 * half; l < 2 * half + members; l++) {
                    gm_tile_add(tile->y + l, c, &one, tile->carry ? tile->carry + l : NULL, 1);
                }
            }
            tile->known = false;
            continue;
        }
        if (!tile->known) {
            tile->loops->force(problem, tile->y, force, members);
            tile->known = true;
            const bool counted = i == 0 && ends_with_kick && task->steps_before > 0;
            progress->evaluations += counted ? 0 : members;
        }
        gm_tile_add(tile->y + half, c, force, tile->carry ? tile->carry + half : NULL, half);
    }
    return GM_OK;
}

GM_STEPS_OF_TILE(step_of)

static struct gm_progress advance(const struct gm_task *task)
{
    return gm_tiles_advance(task, task->scheme->coefficients, task->problem->m == 1 ? step_one : step_many);
}

static void *workspace_open(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    (void)scheme;
    return gm_tiles_open(problem, problem->n, 0);
}

bool gm_part_is_given(const struct gm_problem *problem, const char *name)
{
    const struct gm_parts *parts = gm_ode_of(problem)->parts;
    bool given = false;
    for (size_t i = 0; parts && i < parts->given; i++) {
        given = given || strcmp(parts->names[i], name) == 0;
    }
    return given;
}

const struct gm_family gm_family_splitting = {
    .over_kernels = GM_OVER_SPLITTING,
    .coefficients_open = coefficients_open,
    .title = "splitting",
    GM_ROWS(splitting),
    .parameters = gm_settings_of_sums,
    .loop = advance,
    .workspace_open = workspace_open,
    .workspace_close = gm_workspace_close,
};
