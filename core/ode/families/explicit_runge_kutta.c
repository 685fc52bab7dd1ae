/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Explicit Runge-Kutta methods:
       k_i = f(y0 + h sum_{j<i} a_ij k_j)
       y1  = y0 + h sum_i b_i k_i
   E. Hairer, S.P. Norsett & G. Wanner, Solving Ordinary Differential Equations I (1993), section II.1. The
   rows are in explicit_runge_kutta.def, which the loops over kernels include as well. */
#include "core/ode/families/explicit_runge_kutta.h"

#include <stdlib.h>

#include "core/ode/families/families.h"
#include "core/ode/families/runge_kutta_any.h"
#include "core/ode/kernel/loops.h"
#include "core/theory/coefficients.h"

/* The loop where n is chosen at run time, through the problem's field. */

enum { STAGES = GM_EXPLICIT_STAGES, BLOCK = GM_PASSIVE_BLOCK };

const struct gm_explicit_tableau *gm_explicit_tableau_of(enum gm_explicit_row row)
{
    static const struct gm_explicit_tableau *const tableaus[GM_EXPLICIT_COUNT] = {
#define GM_EXPLICIT(identifier, ...) &gm_explicit_##identifier,
#include "core/ode/families/explicit_runge_kutta.def"
#undef GM_EXPLICIT
    };
    return tableaus[row];
}

struct workspace {
    double *stages, *slopes; /* of the active components, STAGES * active each */
    double *increment;       /* active */
    double room[];
};

static void *workspace_open(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    (void)scheme;
    const size_t active = gm_active_count(problem);
    struct workspace *workspace = malloc(sizeof *workspace + (2 * STAGES + 1) * active * sizeof(double));
    if (workspace) {
        workspace->stages = workspace->room;
        workspace->slopes = workspace->stages + STAGES * active;
        workspace->increment = workspace->slopes + STAGES * active;
    }
    return workspace;
}

/* stage = y + h sum_(j<i) a_ij k_j, for `count` components whose slopes lie `stride` apart */
static void stage_of(const struct gm_explicit_tableau *tableau, int i, double h, const double *y,
                     const double *slopes, size_t stride, double *stage, size_t count)
{
    for (size_t c = 0; c < count; c++) {
        stage[c] = y[c];
    }
    for (int j = 0; j < i; j++) {
        const double a = h * tableau->a[i][j];
        if (a != 0) {
            for (size_t c = 0; c < count; c++) {
                stage[c] += a * slopes[(size_t)j * stride + c];
            }
        }
    }
}

static void increment_of(const struct gm_explicit_tableau *tableau, double h, const double *slopes,
                         size_t stride, double *increment, size_t count)
{
    for (size_t c = 0; c < count; c++) {
        increment[c] = h * tableau->b[0] * slopes[c];
    }
    for (int i = 1; i < tableau->stages; i++) {
        const double b = h * tableau->b[i];
        for (size_t c = 0; c < count; c++) {
            increment[c] += b * slopes[(size_t)i * stride + c];
        }
    }
}

/* The passive particles, a block at a time, through the stages that the active components have gone. */
static void carry_along(const struct gm_task *task, const struct gm_explicit_tableau *tableau,
                        const double *from, const double *carry)
{
    const struct gm_problem *problem = task->problem;
    const struct workspace *workspace = task->workspace;
    const struct gm_loops *loops = gm_ode_of(problem)->loops[gm_isa_best()];
    const size_t active = gm_active_count(problem), passive = problem->passive;
    for (size_t first = 0; first < passive; first += BLOCK) {
        const size_t count = passive - first < BLOCK ? passive - first : BLOCK;
        const size_t at[2] = {active + first, active + passive + first};
        double slopes[2][STAGES][BLOCK], stage[2][BLOCK], increment[BLOCK];
        for (int i = 0; i < tableau->stages; i++) {
            for (int side = 0; side < 2; side++) {
                stage_of(tableau, i, task->dt, from + at[side], slopes[side][0], BLOCK, stage[side], count);
            }
            loops->passive(problem, workspace->stages + (size_t)i * active, stage[0], stage[1], slopes[0][i],
                           slopes[1][i], NULL, count);
        }
        for (int side = 0; side < 2; side++) {
            increment_of(tableau, task->dt, slopes[side][0], BLOCK, increment, count);
            gm_add_increments(from + at[side], increment, carry ? carry + at[side] : NULL,
                              task->out + at[side], carry ? task->carry_out + at[side] : NULL, count);
        }
    }
}

static struct gm_progress advance(const struct gm_task *task)
{
    const struct gm_problem *problem = task->problem;
    const enum gm_explicit_row *row = task->scheme->coefficients;
    const struct gm_explicit_tableau *tableau = gm_explicit_tableau_of(*row);
    const struct gm_loops *loops = gm_ode_of(problem)->loops[gm_isa_best()];
    struct workspace *workspace = task->workspace;
    const size_t active = gm_active_count(problem);
    struct gm_progress progress = {.status = GM_OK};
    const double *from = task->y, *carry = task->carry;
    for (; progress.done < task->steps; progress.done++) {
        for (int i = 0; i < tableau->stages; i++) {
            double *stage = workspace->stages + (size_t)i * active;
            stage_of(tableau, i, task->dt, from, workspace->slopes, active, stage, active);
            loops->field(problem, stage, workspace->slopes + (size_t)i * active, problem->m);
        }
        carry_along(task, tableau, from, carry);
        increment_of(tableau, task->dt, workspace->slopes, active, workspace->increment, active);
        gm_add_increments(from, workspace->increment, carry, task->out, task->carry_out, active);
        if (!gm_all_within(task->out, active, task->limit)) {
            progress.status = GM_BLOW_UP;
            break;
        }
        progress.evaluations += (unsigned long)tableau->stages * problem->m;
        from = task->out;
        carry = task->carry_out;
    }
    return progress;
}

static bool coefficients_open(const struct gm_scheme *scheme, struct gm_coefficients *coefficients)
{
    const enum gm_explicit_row *row = scheme->coefficients;
    const struct gm_explicit_tableau *tableau = gm_explicit_tableau_of(*row);
    const int stages = tableau->stages;
    if (!gm_coefficients_open(coefficients, GM_EQUATIONS_PLAIN, stages)) {
        return false;
    }
    for (int i = 0; i < stages; i++) {
        for (int j = 0; j < i; j++) {
            coefficients->a[0][i * stages + j] = gm_ball_written(tableau->a[i][j]);
        }
        coefficients->b[0][i] = gm_ball_written(tableau->b[i]);
    }
    return true;
}

static const enum gm_explicit_row rows[GM_EXPLICIT_COUNT] = {
#define GM_EXPLICIT(identifier, ...) GM_EXPLICIT_##identifier,
#include "core/ode/families/explicit_runge_kutta.def"
#undef GM_EXPLICIT
};

static const struct gm_scheme schemes[] = {
#define GM_EXPLICIT(identifier, order_, claims_, tableau_, name_, title_, formula_, reference_)              \
    {                                                                                                        \
        .name = name_,                                                                                       \
        .title = title_,                                                                                     \
        .formula = formula_,                                                                                 \
        .reference = reference_,                                                                             \
        .family = &gm_family_explicit_runge_kutta,                                                           \
        .coefficients = &rows[GM_EXPLICIT_##identifier],                                                     \
        .order = order_,                                                                                     \
        .claims = claims_,                                                                                   \
    },
#include "core/ode/families/explicit_runge_kutta.def"
#undef GM_EXPLICIT
};

const struct gm_family gm_family_explicit_runge_kutta = {
    .kind = &gm_kind_ode,
    .over_kernels = GM_OVER_EXPLICIT,
    .coefficients_open = coefficients_open,
    .title = "explicit Runge-Kutta",
    .schemes = schemes,
    .count = GM_EXPLICIT_COUNT,
    .parameters = gm_settings_of_sums,
    .loop = advance,
    .carries_passive = true,
    .workspace_open = workspace_open,
    .workspace_close = free,
};
