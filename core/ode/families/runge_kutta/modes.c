/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Implicit Runge-Kutta methods for y' = L y + N(y) on a ring. The slopes K_i solve
       K_i - h L sum_j a_ij K_j = N(y + h sum_j a_ij K_j) + L y,
   the left side wave by wave, the right side by iteration. Slopes are never made of L times a stage, which
   would multiply rounding by h L. Hairer & Wanner, Solving ODEs II, IV.8. */
#include "core/ode/families/runge_kutta/modes.h"

#include <complex.h>

#include "core/linear/complex_matrix.h"
#include "core/linear/fourier.h"
#include "core/ode/families/runge_kutta/row.h"
#include "core/ode/kernel/tiles.h"

enum { LARGEST = GM_COMPLEX_LARGEST, UNKNOWNS = GM_TABLEAU_STAGES * LARGEST };

struct work {
    struct gm_modes modes;
    size_t stages, n;
    double *z, *next, *at, *rest;               /* increments h sum_j a_ij K_j of the stages, twice; n; n */
    double complex *state, *slopes, *increment; /* waves: of y; K, stages * n; n */
    double complex *matrix;                     /* the equations of one mode */
};

static void *open_work(struct gm_members *members, const struct gm_problem *problem,
                       const struct gm_scheme *scheme)
{
    const size_t n = problem->n, fields = gm_ode_of(problem)->semilinear->fields,
                 stages = (size_t)((const struct gm_tableau *)scheme->coefficients)->stages,
                 unknowns = stages * fields;
    struct work *work = gm_arena_take(members->arena, 1, sizeof *work);
    gm_arena_keep(members->arena, &work->modes, gm_modes_close);
    gm_arena_need(members->arena, gm_modes_open(&work->modes, n / fields, fields));
    work->stages = stages;
    work->n = n;
    work->z = gm_arena_take(members->arena, (2 * stages + 2) * n, sizeof *work->z);
    work->next = work->z + stages * n;
    work->at = work->next + stages * n;
    work->rest = work->at + n;
    work->state = gm_arena_take(members->arena, (stages + 2) * n + unknowns * unknowns, sizeof *work->state);
    work->increment = work->state + n;
    work->slopes = work->increment + n;
    work->matrix = work->slopes + stages * n;
    return work;
}

/* Solves for K of one mode, from N and y; K overwrites the waves of N. */
static bool solve_mode(const struct gm_problem *problem, const struct gm_tableau *row, double h,
                       struct work *work, size_t mode)
{
    const size_t fields = work->modes.fields, points = work->modes.points, stages = work->stages,
                 size = stages * fields;
    double complex symbol[LARGEST * LARGEST], y[LARGEST], linear[LARGEST], right[UNKNOWNS];
    gm_ode_of(problem)->semilinear->symbol(problem, mode, symbol);
    for (size_t i = 0; i < fields; i++) {
        y[i] = work->state[i * points + mode];
    }
    gm_complex_multiply(fields, symbol, y, linear);
    for (size_t r = 0; r < size; r++) {
        const size_t i = r / fields, p = r % fields;
        for (size_t c = 0; c < size; c++) {
            const size_t j = c / fields, q = c % fields;
            work->matrix[r * size + c] = (r == c ? 1 : 0) - h * row->a[i][j] * symbol[p * fields + q];
        }
        right[r] = work->slopes[i * work->n + p * points + mode] + linear[p];
    }
    if (!gm_complex_eliminate(size, work->matrix, right)) {
        return false;
    }
    for (size_t r = 0; r < size; r++) {
        work->slopes[r / fields * work->n + r % fields * points + mode] = right[r];
    }
    return true;
}

/* The nodes of h sum_j factors[j] K_j */
static void combine(struct work *work, double h, const double *factors, double *nodes)
{
    const size_t fields = work->modes.fields, points = work->modes.points;
    for (size_t field = 0; field < fields; field++) {
        for (size_t i = field * points; i < field * points + gm_modes_half(points); i++) {
            double complex sum = 0;
            for (size_t j = 0; j < work->stages; j++) {
                sum += h * factors[j] * work->slopes[j * work->n + i];
            }
            work->increment[i] = sum;
        }
    }
    gm_modes_back(&work->modes, work->increment, nodes);
}

/* One step, or one substep of a composition. */
struct substep {
    const struct gm_task *task;
    struct work *work;
    const double *y;
    double h, norm; /* norm: the sum of |y| */
    struct gm_progress *progress;
};

/* K from the stages, and the stages from it. */
static bool sweep(void *data, const double *z, double *next, double *scale)
{
    const struct substep *substep = data;
    const struct gm_problem *problem = substep->task->problem;
    const struct gm_tableau *row = substep->task->scheme->coefficients;
    struct work *work = substep->work;
    const size_t n = work->n;
    for (size_t i = 0; i < work->stages; i++) {
        for (size_t c = 0; c < n; c++) {
            work->at[c] = substep->y[c] + z[i * n + c];
        }
        gm_ode_of(problem)->semilinear->nonlinear(problem, work->at, work->rest);
        gm_modes_forward(&work->modes, work->rest, work->slopes + i * n);
    }
    for (size_t mode = 0; mode < gm_modes_half(work->modes.points); mode++) {
        if (!solve_mode(problem, row, substep->h, work, mode)) {
            return false;
        }
    }
    for (size_t i = 0; i < work->stages; i++) {
        combine(work, substep->h, row->a[i], next + i * n);
    }
    substep->progress->evaluations += work->stages;
    *scale += substep->norm;
    return true;
}

static bool find_slopes(struct substep *substep)
{
    struct work *work = substep->work;
    const size_t size = work->stages * work->n;
    /* transforms round every value by the error of the largest */
    const struct gm_implicit_equations equations = {
        .size = size, .data = substep, .sweep = sweep, .roundoff = 16 * (double)work->stages * GM_EPSILON};
    substep->norm = gm_sum_of(substep->y, work->n);
    gm_modes_forward(&work->modes, substep->y, work->state);
    memset(work->z, 0, size * sizeof *work->z);
    return gm_sweeps_solve(&equations, work->next, work->z, substep->progress);
}

static enum gm_status step(const struct gm_task *task, struct gm_members *members,
                           struct gm_progress *progress)
{
    const struct gm_tableau *row = task->scheme->coefficients;
    struct work *work = members->family;
    for (int i = 0; i < row->composition->steps; i++) {
        const double h = task->dt * gm_composition_fraction(row->composition, i);
        struct substep substep = {.task = task, .work = work, .y = members->y, .h = h, .progress = progress};
        if (!find_slopes(&substep)) {
            return GM_NO_CONVERGENCE;
        }
        combine(work, h, row->b, work->at);
        gm_tile_add(members->y, 1, work->at, members->carry, work->n);
    }
    return GM_OK;
}

const struct gm_member_family gm_implicit_modes = {.step = step, .open = open_work};
