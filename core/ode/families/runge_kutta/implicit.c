/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Implicit Runge-Kutta methods, for the increments z_i of the stages:
       z_i = h sum_j a_ij f(y0 + z_j)
       y1  = y0 + h sum_i b_i f(y0 + z_i)
   solved to round-off by fixed-point iteration, and if that does not contract, or the problem is stiff, by
   Newton's method; for fields on a ring with a linear part by core/ode/families/runge_kutta/modes.c. A method
   is symplectic if b_i a_ij + b_j a_ji = b_i b_j. E. Hairer, C. Lubich & G. Wanner, Geometric Numerical
   Integration (2006), sections II.1, VI.4, VIII.6. */
#include "core/ode/families/runge_kutta/implicit.h"

#include "core/ode/families/family.h"
#include "core/ode/families/runge_kutta/modes.h"
#include "core/ode/kernel/stage_solver.h"
#include "core/ode/kernel/tiles.h"
#include "core/theory/coefficients.h"

#include "core/implicit_schemes.def" /* the rows, which the build writes by share/schemes */

/* The loop for an n chosen at run time, through the problem's field, by the rules of the loop over kernels: a
   member's bits depend neither on the others nor on the loop. A passive particle whose iteration does not
   contract, because a vortex turns it too fast, is solved by Newton's method. */

enum { STAGES = GM_TABLEAU_STAGES, BLOCK = GM_PASSIVE_BLOCK, FIXED_POINT = 150 };

/* A tile's scratch; in arrays over stages, stage i begins at i * n * members. */
struct stage_scratch {
    double *at, *z, *slopes; /* states, increments, f: stages * n * members */
    double *state;           /* n * members */
    double *change, *part, *previous, *before_previous, *negligible, *norm, *row; /* members */
    double *going, *solved; /* members: 1 or 0; solved is 2 by Newton's method */
};

enum { OVER_MEMBERS = 9 }; /* number of arrays of the length `members` */

static struct stage_scratch stages_of(double *scratch, size_t stages, size_t n, size_t members)
{
    const size_t all = stages * n * members;
    double *rows = scratch + 3 * all + n * members;
    return (struct stage_scratch){
        .at = scratch,
        .z = scratch + all,
        .slopes = scratch + 2 * all,
        .state = scratch + 3 * all,
        .change = rows,
        .part = rows + members,
        .previous = rows + 2 * members,
        .negligible = rows + 3 * members,
        .norm = rows + 4 * members,
        .row = rows + 5 * members,
        .going = rows + 6 * members,
        .solved = rows + 7 * members,
        .before_previous = rows + 8 * members,
    };
}

/* True if waves are solved for, by modes.c. */
static bool is_by_modes(const struct gm_problem *problem)
{
    return gm_ode_of(problem)->semilinear && problem->m == 1;
}

static void *workspace_open(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    const size_t n = gm_tile_components(problem),
                 stages = (size_t)((const struct gm_tableau *)scheme->coefficients)->stages;
    return is_by_modes(problem)
               ? gm_members_workspace(problem, scheme)
               : gm_tiles_open(problem, (3 * stages + 1) * n + OVER_MEMBERS,
                               gm_newton_fits(problem) ? 2 * n + gm_stage_solver_room(problem, stages) : 0);
}

/* Updates components [from, to) of the increments, z := h a f, of the members that still iterate, and the sum
   of the changes: a sum passes a NaN on, a maximum may lose it. */
GM_OF_TILE void update(const struct gm_tableau *row, double h, size_t n, size_t members, size_t from,
                       size_t to, const struct stage_scratch *s, double *change)
{
    memset(change, 0, members * sizeof *change);
    for (size_t i = 0; i < (size_t)row->stages; i++) {
        for (size_t c = from; c < to; c++) {
            double *z = s->z + (i * n + c) * members;
            for (size_t j = 0; j < (size_t)row->stages; j++) {
                const double a = h * row->a[i][j], *slope = s->slopes + (j * n + c) * members;
                for (size_t l = 0; l < members; l++) {
                    s->row[l] = j == 0 ? a * slope[l] : s->row[l] + a * slope[l];
                }
            }
            for (size_t l = 0; l < members; l++) {
                change[l] += fabs(s->row[l] - z[l]);
                z[l] = s->going[l] != 0 ? s->row[l] : z[l];
            }
        }
    }
}

/* Copies components [from, to) of the slope of stage i, of the members that still iterate. */
GM_OF_TILE void take(const struct stage_scratch *s, size_t n, size_t members, size_t i, size_t from,
                     size_t to)
{
    for (size_t c = from; c < to; c++) {
        double *slope = s->slopes + (i * n + c) * members;
        const double *now = s->state + (c - from) * members;
        for (size_t l = 0; l < members; l++) {
            slope[l] = s->going[l] != 0 ? now[l] : slope[l];
        }
    }
}

GM_OF_TILE void find_state(const struct stage_scratch *s, size_t n, size_t members, size_t i, const double *y)
{
    for (size_t c = 0; c < n * members; c++) {
        s->at[i * n * members + c] = y[c] + s->z[i * n * members + c];
    }
}

/* The equations of a step for the components of a tile, or for those of passive particles. */
struct equations {
    const struct gm_problem *problem;
    const struct gm_loops *loops;
    const struct gm_tableau *row;
    double h;
    const double *y;        /* n * members */
    size_t n;               /* 2: of passive particles */
    const double *carriers; /* the states of the active components at the stages; NULL: not of particles */
};

GM_OF_TILE void find_slope(const struct equations *equations, const struct stage_scratch *s, size_t members,
                           size_t i)
{
    const struct gm_problem *problem = equations->problem;
    double *at = s->at + i * equations->n * members, *slope = s->state;
    if (equations->carriers) {
        const double *active = equations->carriers + i * gm_tile_components(problem);
        equations->loops->passive(problem, active, at, at + members, slope, slope + members, NULL, members);
    } else {
        equations->loops->field(problem, at, slope, members);
    }
}

/* One iteration: new slopes at y + z, and new z from them. If q' depends on p alone and p' on q alone, p' is
   taken at the new q, which doubles the order in h that an iteration gains. */
GM_OF_TILE void iterate(const struct equations *equations, size_t members, const struct stage_scratch *s)
{
    const struct gm_problem *problem = equations->problem;
    const struct gm_loops *loops = equations->loops;
    const struct gm_tableau *row = equations->row;
    const double h = equations->h, *y = equations->y;
    const size_t n = equations->n, half = n / 2, stages = (size_t)row->stages;
    if (!loops->force || n % 2 != 0) {
        for (size_t i = 0; i < stages; i++) {
            find_state(s, n, members, i, y);
            find_slope(equations, s, members, i);
            take(s, n, members, i, 0, n);
        }
        update(row, h, n, members, 0, n, s, s->change);
        return;
    }
    for (size_t i = 0; i < stages; i++) {
        find_state(s, n, members, i, y);
        loops->velocity(problem, s->at + i * n * members, s->state, members);
        take(s, n, members, i, 0, half);
    }
    update(row, h, n, members, 0, half, s, s->change);
    for (size_t i = 0; i < stages; i++) {
        find_state(s, n, members, i, y);
        loops->force(problem, s->at + i * n * members, s->state, members);
        take(s, n, members, i, half, n);
    }
    update(row, h, n, members, half, n, s, s->part);
    for (size_t l = 0; l < members; l++) {
        s->change[l] += s->part[l];
    }
}

/* Solves for the slopes of all members by fixed-point iteration, from z = 0; if Newton's method is available,
   it must contract well. */
GM_OF_TILE void by_fixed_point(const struct equations *equations, size_t members,
                               const struct stage_scratch *s, struct gm_progress *progress)
{
    const double *y = equations->y;
    const size_t n = equations->n, stages = (size_t)equations->row->stages;
    const double least = GM_LEAST_CHANGE(stages * n);
    const bool newton = gm_newton_fits(equations->problem);
    memset(s->z, 0, stages * n * members * sizeof *s->z);
    memset(s->norm, 0, members * sizeof *s->norm);
    for (size_t l = 0; l < members; l++) {
        s->going[l] = 1;
        s->solved[l] = 0;
    }
    for (size_t c = 0; c < n; c++) {
        for (size_t l = 0; l < members; l++) {
            s->norm[l] += fabs(y[c * members + l]);
        }
    }
    for (size_t l = 0; l < members; l++) {
        s->previous[l] = s->before_previous[l] = 1e300;
    }
    size_t left = members;
    for (int iteration = 0; iteration < FIXED_POINT && left > 0; iteration++) {
        progress->evaluations += stages * left;
        progress->iterations += left;
        iterate(equations, members, s);
        left = 0;
        for (size_t l = 0; l < members; l++) {
            const double change = s->change[l], roundoff = 8 * (double)stages * GM_EPSILON * s->norm[l];
            s->negligible[l] = iteration == 0 ? 8.673617379884035e-19 * change : s->negligible[l];
            const bool settled =
                GM_SWEEPS_ARE_SETTLED(change, s->previous[l], s->negligible[l], roundoff, least);
            const bool contracts = GM_SWEEPS_CONTRACT(change, s->before_previous[l], roundoff);
            const bool done = s->going[l] != 0 && settled;
            s->solved[l] = done ? 1 : s->solved[l];
            s->going[l] = s->going[l] != 0 && !done && (newton ? contracts : change < 1e100) ? 1 : 0;
            s->before_previous[l] = s->previous[l];
            s->previous[l] = change;
            left += s->going[l] != 0 ? 1 : 0;
        }
    }
}

static void set_stages(struct gm_stages *stages, const struct gm_tableau *row, double h, const double *y,
                       struct gm_progress *progress)
{
    stages->h = h;
    stages->y = y;
    stages->a = stages->c = row->a;
    stages->b = stages->d = row->b;
    stages->progress = progress;
}

/* Solves the equations by Newton's method for member l, and leaves its increment in the first z. */
static bool by_newton(const struct gm_problem *problem, const struct gm_tile *tile, double h, size_t l,
                      const struct stage_scratch *s, struct gm_progress *progress)
{
    const struct gm_tableau *row = tile->row;
    const size_t n = problem->n, members = tile->members;
    double *y = tile->shared, *increment = y + n;
    struct gm_stage_solver solver = gm_stage_solver_lay(problem, (size_t)row->stages, increment + n);
    for (size_t c = 0; c < n; c++) {
        y[c] = tile->y[c * members + l];
    }
    set_stages(&solver.stages, row, h, y, progress);
    if (!gm_stages_by_newton(&solver)) {
        return false;
    }
    gm_stages_increment(&solver.stages, solver.z, increment);
    for (size_t c = 0; c < n; c++) {
        s->z[c * members + l] = increment[c];
    }
    return true;
}

/* gm_stages.slope of one particle */
static bool carried_slope(void *data, size_t j, const double *state, double *f, double *jacobian)
{
    const struct equations *equations = data;
    double strain[2];
    equations->loops->passive(equations->problem,
                              equations->carriers + j * gm_tile_components(equations->problem), &state[0],
                              &state[1], &f[0], &f[1], strain, 1);
    jacobian[0] = strain[0];
    jacobian[1] = jacobian[2] = strain[1];
    jacobian[3] = -strain[0];
    return true;
}

/* Solves for particle k of `count` by Newton's method, from z = 0, and writes its slopes; NaN if there is no
   solution. */
static void solve_one(const struct equations *equations, const struct stage_scratch *s, size_t k,
                      size_t count)
{
    enum { MOST = 2 * STAGES };
    const double start[2] = {equations->y[k], equations->y[count + k]};
    double z[MOST] = {0}, f[MOST], state[2], jacobian[4], scratch[MOST * (MOST + 3)];
    struct gm_progress ignored = {0};
    struct gm_stages stages = {.count = (size_t)equations->row->stages,
                               .n = 2,
                               .slope = carried_slope,
                               .data = (void *)equations,
                               .f = f,
                               .state = state,
                               .jacobian = jacobian};
    set_stages(&stages, equations->row, equations->h, start, &ignored);
    const struct gm_implicit_equations newton = {.size = 2 * stages.count,
                                                 .data = &stages,
                                                 .linear = gm_stages_linear,
                                                 .counted = 2 * stages.count,
                                                 .y = start,
                                                 .n = 2};
    const bool solved = isfinite(start[0]) && gm_newton_solve(&newton, scratch, z, &ignored);
    for (size_t j = 0; j < 2 * stages.count; j++) {
        s->slopes[j * count + k] = solved ? f[j] : NAN;
    }
}

/* s->state := h sum_i b_i f_i of n * members numbers */
GM_OF_TILE void increment(const struct gm_tableau *row, double h, size_t count, const struct stage_scratch *s)
{
    for (int i = 0; i < row->stages; i++) {
        const double b = h * row->b[i], *slope = s->slopes + (size_t)i * count;
        for (size_t c = 0; c < count; c++) {
            s->state[c] = i == 0 ? b * slope[c] : s->state[c] + b * slope[c];
        }
    }
}

/* Moves the passive particles, a block at a time. Each freezes once it is solved, so that its bits do not
   depend on its neighbours. */
static void carry_along(const struct gm_problem *problem, double h, const double *states,
                        struct gm_tile *tile)
{
    const struct gm_tableau *row = tile->row;
    const size_t active = gm_tile_components(problem), passive = problem->passive,
                 stages = (size_t)row->stages;
    for (size_t first = 0; first < passive; first += BLOCK) {
        const size_t count = passive - first < BLOCK ? passive - first : BLOCK;
        const size_t at[2] = {active + first, active + passive + first};
        double y[2 * BLOCK], scratch[(6 * STAGES + 2 + OVER_MEMBERS) * BLOCK]; /* filled as far as needed */
        const struct stage_scratch s = stages_of(scratch, stages, 2, count);
        const struct equations equations = {
            .problem = problem, .loops = tile->loops, .row = row, .h = h, .y = y, .n = 2, .carriers = states};
        struct gm_progress ignored = {0};
        for (size_t side = 0; side < 2; side++) {
            memcpy(y + side * count, tile->y + at[side], count * sizeof *y);
        }
        by_fixed_point(&equations, count, &s, &ignored);
        for (size_t k = 0; k < count; k++) {
            if (s.solved[k] == 0) {
                solve_one(&equations, &s, k, count);
            }
        }
        increment(row, h, 2 * count, &s);
        for (size_t side = 0; side < 2; side++) {
            gm_tile_add(tile->y + at[side], 1, s.state + side * count,
                        tile->carry ? tile->carry + at[side] : NULL, count);
        }
    }
}

GM_OF_TILE bool solve(const struct gm_problem *problem, const struct gm_tile *tile, double h, size_t members,
                      const struct stage_scratch *s, struct gm_progress *progress)
{
    const struct equations equations = {.problem = problem,
                                        .loops = tile->loops,
                                        .row = tile->row,
                                        .h = h,
                                        .y = tile->y,
                                        .n = gm_tile_components(problem)};
    bool all = true;
    if (!gm_ode_of(problem)->stiff) {
        by_fixed_point(&equations, members, s, progress);
    } else {
        memset(s->solved, 0, members * sizeof *s->solved);
        memset(s->slopes, 0,
               (size_t)((const struct gm_tableau *)tile->row)->stages * gm_tile_components(problem) *
                   members * sizeof *s->slopes);
    }
    for (size_t l = 0; l < members && all; l++) {
        if (s->solved[l] == 0 && gm_newton_fits(problem)) {
            s->solved[l] = by_newton(problem, tile, h, l, s, progress) ? 2 : 0;
        } else if (s->solved[l] == 0) {
            progress->unsolved = gm_unsolved_by(s->previous[l], s->norm[l]);
        }
        all = s->solved[l] != 0;
    }
    return all;
}

GM_OF_TILE enum gm_status step_of(const struct gm_task *task, struct gm_tile *tile,
                                  struct gm_progress *progress, size_t members)
{
    const struct gm_problem *problem = task->problem;
    const struct gm_tableau *row = tile->row;
    const size_t n = gm_tile_components(problem), count = n * members;
    const struct stage_scratch s = stages_of(tile->scratch, (size_t)row->stages, n, members);
    for (int substep = 0; substep < row->composition->steps; substep++) {
        const double h = task->dt * gm_composition_fraction(row->composition, substep);
        if (!solve(problem, tile, h, members, &s, progress)) {
            return GM_NO_CONVERGENCE;
        }
        carry_along(problem, h, s.at, tile);
        increment(row, h, count, &s);
        for (size_t l = 0; l < members; l++) {
            for (size_t c = l; s.solved[l] == 2 && c < count; c += members) {
                s.state[c] = s.z[c];
            }
        }
        gm_tile_add(tile->y, 1, s.state, tile->carry, count);
    }
    return GM_OK;
}

GM_STEPS_OF_TILE(step_of)

static struct gm_progress advance(const struct gm_task *task)
{
    return is_by_modes(task->problem) ? gm_members_loop(task)
                                      : gm_tiles_advance(task, task->scheme->coefficients,
                                                         task->problem->m == 1 ? step_one : step_many);
}

/* A composition of steps g_k h is a method too, with the stages of all steps: a_ij of a step is g_k a_ij, and
   g_l b_j of each earlier one. */
void gm_tableau_coefficients_open(struct gm_arena *arena, const struct gm_scheme *scheme,
                                  struct gm_coefficients *coefficients)
{
    const struct gm_tableau *row = scheme->coefficients;
    const int steps = row->composition ? row->composition->steps : 1, stages = steps * row->stages;
    gm_coefficients_open(arena, coefficients, GM_EQUATIONS_PLAIN, stages);
    for (int j = 0; j < stages; j++) {
        const int step = j / row->stages, own = j % row->stages;
        const struct gm_ball fraction =
            gm_ball_written(row->composition ? gm_composition_fraction(row->composition, step) : 1);
        const struct gm_ball b = gm_ball_multiply(fraction, gm_ball_written(row->b[own]));
        coefficients->b[0][j] = b;
        for (int i = step * row->stages; i < stages; i++) {
            coefficients->a[0][i * stages + j] =
                i / row->stages == step
                    ? gm_ball_multiply(fraction, gm_ball_written(row->a[i % row->stages][own]))
                    : b;
        }
    }
}

const struct gm_family gm_family_implicit = {
    .over_kernels = GM_OVER_IMPLICIT,
    .coefficients_open = gm_tableau_coefficients_open,
    .title = "implicit Runge-Kutta",
    GM_ROWS(implicit),
    .parameters = gm_settings_of_sums,
    .loop = advance,
    .members = &gm_implicit_modes,
    .carries_passive = true,
    .workspace_open = workspace_open,
    .workspace_close = gm_workspace_close,
};
