/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Implicit Runge-Kutta methods for a number of components that is known at run time only:
       z_i = h sum_j a_ij f(y0 + z_j)
       y1  = y0 + h sum_i b_i f(y0 + z_i)
   solved to round-off by fixed-point iteration; a passive particle for which that does not contract, because
   a vortex turns it too fast, by Newton's method. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/ode/families/implicit_runge_kutta.h"
#include "core/ode/families/members.h"
#include "core/ode/families/runge_kutta_any.h"
#include "core/ode/kernel/loops.h"

enum { STAGES = GM_IMPLICIT_STAGES, BLOCK = GM_PASSIVE_BLOCK, FIXED_POINT = 150, NEWTON = 50 };

#define EPSILON 2.220446049250313e-16

struct workspace {
    double *stages, *z, *slopes; /* of the active components, STAGES * active each */
    double *increment;           /* active */
    double room[];
};

void *gm_implicit_any_open(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    (void)scheme;
    const size_t active = gm_active_count(problem);
    struct workspace *workspace = malloc(sizeof *workspace + (3 * STAGES + 1) * active * sizeof(double));
    if (workspace) {
        workspace->stages = workspace->room;
        workspace->z = workspace->stages + STAGES * active;
        workspace->slopes = workspace->z + STAGES * active;
        workspace->increment = workspace->slopes + STAGES * active;
    }
    return workspace;
}

/* Solves for the stages of the active components; false if the iteration does not contract. */
static bool solve(const struct gm_task *task, const struct gm_implicit_row *row, double h, const double *y,
                  struct gm_progress *progress)
{
    const struct gm_problem *problem = task->problem;
    const struct workspace *workspace = task->workspace;
    const struct gm_loops *loops = gm_ode_of(problem)->loops[gm_isa_best()];
    const size_t active = gm_active_count(problem), stages = (size_t)row->stages;
    double size = 0, previous = INFINITY;
    for (size_t c = 0; c < active; c++) {
        size += fabs(y[c]);
    }
    const double roundoff = 8 * (double)stages * EPSILON * size;
    memset(workspace->z, 0, stages * active * sizeof(double));
    for (int iteration = 0; iteration < FIXED_POINT; iteration++) {
        for (size_t i = 0; i < stages; i++) {
            double *stage = workspace->stages + i * active;
            const double *z = workspace->z + i * active;
            for (size_t c = 0; c < active; c++) {
                stage[c] = y[c] + z[c];
            }
            loops->field(problem, stage, workspace->slopes + i * active, problem->m);
        }
        progress->evaluations += stages * problem->m;
        progress->iterations += problem->m;
        double change = 0;
        for (size_t i = 0; i < stages; i++) {
            double *z = workspace->z + i * active;
            for (size_t c = 0; c < active; c++) {
                double next = h * row->a[i][0] * workspace->slopes[c];
                for (size_t j = 1; j < stages; j++) {
                    next += h * row->a[i][j] * workspace->slopes[j * active + c];
                }
                change += fabs(next - z[c]);
                z[c] = next;
            }
        }
        if (change == 0 || (change >= previous && change <= roundoff)) {
            return true;
        }
        if (!(change < 1e100)) {
            return false;
        }
        previous = change;
    }
    return false;
}

/* A block of passive particles in one sub-step. */
struct block {
    size_t count;
    double start[2][BLOCK];
    double z[STAGES][2][BLOCK], slopes[STAGES][2][BLOCK];
};

static void block_slopes(const struct gm_task *task, size_t stages, struct block *block)
{
    const struct gm_problem *problem = task->problem;
    const struct workspace *workspace = task->workspace;
    for (size_t i = 0; i < stages; i++) {
        double stage[2][BLOCK];
        for (int side = 0; side < 2; side++) {
            for (size_t k = 0; k < block->count; k++) {
                stage[side][k] = block->start[side][k] + block->z[i][side][k];
            }
        }
        gm_ode_of(problem)->loops[gm_isa_best()]->passive(
            problem, workspace->stages + i * gm_active_count(problem), stage[0], stage[1],
            block->slopes[i][0], block->slopes[i][1], NULL, block->count);
    }
}

/* One particle by Newton's method, from z = 0; leaves its slopes in the block. */
static bool solve_one(const struct gm_task *task, const struct gm_implicit_row *row, double h,
                      struct block *block, size_t k)
{
    const struct gm_problem *problem = task->problem;
    const struct workspace *workspace = task->workspace;
    const size_t stages = (size_t)row->stages, size = 2 * stages;
    double z[2 * STAGES] = {0}, previous = INFINITY;
    for (int iteration = 0; iteration < NEWTON; iteration++) {
        double matrix[4 * STAGES * STAGES], right[2 * STAGES], scale = 0;
        for (size_t j = 0; j < stages; j++) {
            const double x = block->start[0][k] + z[2 * j], y = block->start[1][k] + z[2 * j + 1];
            double strain[2];
            scale += fabs(x) + fabs(y);
            gm_ode_of(problem)->loops[gm_isa_best()]->passive(
                problem, workspace->stages + j * gm_active_count(problem), &x, &y, &block->slopes[j][0][k],
                &block->slopes[j][1][k], strain, 1);
            for (size_t i = 0; i < stages; i++) {
                const double a = h * row->a[i][j], unit = i == j ? 1 : 0;
                double *corner = matrix + 2 * i * size + 2 * j;
                corner[0] = unit - a * strain[0];
                corner[1] = -(a * strain[1]);
                corner[size] = -(a * strain[1]);
                corner[size + 1] = unit + a * strain[0];
            }
        }
        for (size_t i = 0; i < size; i++) {
            right[i] = -z[i];
            for (size_t j = 0; j < stages; j++) {
                right[i] += h * row->a[i / 2][j] * block->slopes[j][i % 2][k];
            }
        }
        if (!gm_eliminate(size, matrix, right)) {
            return false;
        }
        double change = 0;
        for (size_t i = 0; i < size; i++) {
            z[i] += right[i];
            change += fabs(right[i]);
        }
        if (!isfinite(change)) {
            return false;
        }
        if (change == 0 || (change >= previous && change <= 64 * EPSILON * scale)) {
            return true;
        }
        previous = change;
    }
    return false;
}

/* The particles of a block, each frozen where it is solved, so that its bits do not depend on its neighbours.
   Those without a solution get NaN for slopes. */
static void solve_block(const struct gm_task *task, const struct gm_implicit_row *row, double h,
                        struct block *block)
{
    const size_t stages = (size_t)row->stages;
    double previous[BLOCK];
    double kept[STAGES][2][BLOCK];
    bool solved[BLOCK] = {false}, diverged[BLOCK] = {false};
    size_t left = block->count;
    memset(block->z, 0, sizeof block->z);
    for (size_t k = 0; k < block->count; k++) {
        previous[k] = INFINITY;
        diverged[k] = !isfinite(block->start[0][k] + block->start[1][k]);
        left -= diverged[k];
    }
    for (int iteration = 0; iteration < FIXED_POINT && left > 0; iteration++) {
        block_slopes(task, stages, block);
        for (size_t k = 0; k < block->count; k++) {
            if (solved[k] || diverged[k]) {
                continue;
            }
            double change = 0;
            for (size_t i = 0; i < stages; i++) {
                for (int side = 0; side < 2; side++) {
                    double next = 0;
                    for (size_t j = 0; j < stages; j++) {
                        next += h * row->a[i][j] * block->slopes[j][side][k];
                    }
                    change += fabs(next - block->z[i][side][k]);
                    block->z[i][side][k] = next;
                }
            }
            const double roundoff =
                8 * (double)stages * EPSILON * (fabs(block->start[0][k]) + fabs(block->start[1][k]));
            solved[k] = change == 0 || (change >= previous[k] && change <= roundoff);
            diverged[k] = !solved[k] && !(change < 1e100);
            previous[k] = change;
            left -= solved[k] || diverged[k];
            for (size_t i = 0; solved[k] && i < stages; i++) {
                kept[i][0][k] = block->slopes[i][0][k];
                kept[i][1][k] = block->slopes[i][1][k];
            }
        }
    }
    for (size_t k = 0; k < block->count; k++) {
        const bool by_newton =
            !solved[k] && isfinite(block->start[0][k]) && solve_one(task, row, h, block, k);
        for (size_t i = 0; i < stages && !by_newton; i++) {
            block->slopes[i][0][k] = solved[k] ? kept[i][0][k] : NAN;
            block->slopes[i][1][k] = solved[k] ? kept[i][1][k] : NAN;
        }
    }
}

static void carry_along(const struct gm_task *task, const struct gm_implicit_row *row, double h,
                        const double *from, const double *carry)
{
    const struct gm_problem *problem = task->problem;
    const size_t active = gm_active_count(problem), passive = problem->passive;
    for (size_t first = 0; first < passive; first += BLOCK) {
        struct block block = {.count = passive - first < BLOCK ? passive - first : BLOCK};
        const size_t at[2] = {active + first, active + passive + first};
        for (int side = 0; side < 2; side++) {
            memcpy(block.start[side], from + at[side], block.count * sizeof(double));
        }
        solve_block(task, row, h, &block);
        for (int side = 0; side < 2; side++) {
            double increment[BLOCK];
            for (size_t k = 0; k < block.count; k++) {
                increment[k] = 0;
                for (int i = 0; i < row->stages; i++) {
                    increment[k] += h * row->b[i] * block.slopes[i][side][k];
                }
            }
            gm_add_increments(from + at[side], increment, carry ? carry + at[side] : NULL,
                              task->out + at[side], carry ? task->carry_out + at[side] : NULL, block.count);
        }
    }
}

struct gm_progress gm_implicit_any_loop(const struct gm_task *task)
{
    const struct gm_problem *problem = task->problem;
    const struct gm_implicit_row *row = task->scheme->coefficients;
    const struct workspace *workspace = task->workspace;
    const size_t active = gm_active_count(problem);
    struct gm_progress progress = {.status = GM_OK};
    const double *from = task->y, *carry = task->carry;
    for (; progress.done < task->steps; progress.done++) {
        for (int substep = 0; substep < row->substeps; substep++) {
            const double h = task->dt * row->fractions[substep];
            if (!solve(task, row, h, from, &progress)) {
                progress.status = GM_NO_CONVERGENCE;
                return progress;
            }
            carry_along(task, row, h, from, carry);
            for (size_t c = 0; c < active; c++) {
                workspace->increment[c] = 0;
                for (int i = 0; i < row->stages; i++) {
                    workspace->increment[c] += h * row->b[i] * workspace->slopes[(size_t)i * active + c];
                }
            }
            gm_add_increments(from, workspace->increment, carry, task->out, task->carry_out, active);
            from = task->out;
            carry = task->carry_out;
        }
        if (!gm_all_within(task->out, active, task->limit)) {
            progress.status = GM_BLOW_UP;
            return progress;
        }
    }
    return progress;
}
