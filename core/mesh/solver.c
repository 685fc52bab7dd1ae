/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Newton's method for the equations of one step on a mesh: with factors that are kept, then, where that
   fails, with new ones and shortened steps, from one first guess after the other. */
#include "core/mesh/solver.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MANY = 3, PAST = 6, SIMPLIFIED = 15, FULL = 40, HALVINGS = 12 };

static const double tolerance = 1e-11; /* of a change of the unknowns */
static const double contracts = 0.2;   /* a ratio of changes at which the rest may be told from them */

/* Of a change that solves the equations: what round-off makes need not be smaller. */
static double enough(const struct gm_step_equations *equations)
{
    return fmax(tolerance, 4 * equations->noise);
}

/* Of a change that no longer shrinks: multipliers carry noise, velocities the round-off of places over dt. */
static double stagnation(const struct gm_step_equations *equations)
{
    return fmax(1e-9, 10 * equations->noise);
}

size_t gm_solver_memory(size_t nodes, size_t per_node, size_t state)
{
    return GM_MEMORY_HEAD + (PAST + 1) * nodes * per_node + state;
}

bool gm_solver_open(struct gm_solver *solver, size_t nodes, size_t per_node, size_t band)
{
    *solver = (struct gm_solver){0};
    const size_t n = nodes * per_node;
    solver->unknowns = calloc(3 * n, sizeof *solver->unknowns);
    if (!solver->unknowns || !gm_banded_open(&solver->matrix, n, band)) {
        gm_solver_close(solver);
        return false;
    }
    solver->residual = solver->unknowns + n;
    solver->trial = solver->residual + n;
    return true;
}

void gm_solver_close(struct gm_solver *solver)
{
    free(solver->unknowns);
    gm_banded_close(&solver->matrix);
    *solver = (struct gm_solver){0};
}

void gm_solver_start(struct gm_solver *solver, double *memory)
{
    memset(memory, 0, GM_MEMORY_HEAD * sizeof *memory);
    solver->stamp = 0;
}

static double *past(double *memory, size_t n, size_t back)
{
    return memory + GM_MEMORY_HEAD + back * n;
}

/* Extrapolates from the last `order` steps: 1 repeats the last one, 4 is cubic, 6 quintic. */
static void extrapolate(const struct gm_step_equations *equations, double *memory, size_t n, size_t order,
                        double *out)
{
    const double *p1 = past(memory, n, 0), *p2 = past(memory, n, 1), *p3 = past(memory, n, 2);
    const double *p4 = past(memory, n, 3), *p5 = past(memory, n, 4), *p6 = past(memory, n, 5);
    switch (order) {
    case 0:
        equations->guess(equations->self, out);
        break;
    case 1:
        memcpy(out, p1, n * sizeof *out);
        break;
    case 2:
        for (size_t i = 0; i < n; i++) {
            out[i] = 2 * p1[i] - p2[i];
        }
        break;
    case 3:
        for (size_t i = 0; i < n; i++) {
            out[i] = 3 * (p1[i] - p2[i]) + p3[i];
        }
        break;
    case 4:
        for (size_t i = 0; i < n; i++) {
            out[i] = 4 * (p1[i] + p3[i]) - 6 * p2[i] - p4[i];
        }
        break;
    case 5:
        for (size_t i = 0; i < n; i++) {
            out[i] = 5 * (p1[i] - p4[i]) + 10 * (p3[i] - p2[i]) + p5[i];
        }
        break;
    default:
        for (size_t i = 0; i < n; i++) {
            out[i] = 6 * (p1[i] + p5[i]) - 15 * (p2[i] + p4[i]) + 20 * p3[i] - p6[i];
        }
    }
}

/* Factors the derivative at these unknowns, where the residual has just been evaluated. */
static bool factor(struct gm_solver *solver, const struct gm_step_equations *equations,
                   const double *unknowns)
{
    gm_banded_clear(&solver->matrix);
    equations->jacobian(equations->self, unknowns, &solver->matrix);
    return gm_banded_factor(&solver->matrix);
}

static bool refresh(struct gm_solver *solver, const struct gm_step_equations *equations, double *memory,
                    const double *state, const double *unknowns)
{
    const size_t n = solver->matrix.n;
    double *made_from = past(memory, n, PAST);
    memcpy(made_from, unknowns, n * sizeof *made_from);
    memcpy(made_from + n, state, equations->state * sizeof *made_from);
    memory[GM_MEMORY_STEP] = equations->step;
    memory[GM_MEMORY_STAMP]++;
    solver->stamp = memory[GM_MEMORY_STAMP];
    return factor(solver, equations, unknowns);
}

/* Makes the factors that the memory names, if others or none are at hand. */
static void restore(struct gm_solver *solver, const struct gm_step_equations *equations, double *memory)
{
    const size_t n = solver->matrix.n;
    if (memory[GM_MEMORY_STAMP] == solver->stamp) {
        return;
    }
    const double *made_from = past(memory, n, PAST);
    equations->place(equations->self, made_from + n, memory[GM_MEMORY_STEP]);
    equations->residual(equations->self, made_from, solver->residual);
    factor(solver, equations, made_from);
    solver->stamp = memory[GM_MEMORY_STAMP];
}

/* unknowns -= share * change; the largest weighted relative change */
static double move(const struct gm_step_equations *equations, const double *change, double share,
                   double *unknowns)
{
    double largest = 0, sum = 0;
    const size_t width = equations->per_node;
    for (size_t k = 0; k < equations->nodes; k++) {
        for (size_t j = 0; j < width; j++) {
            const size_t i = k * width + j;
            unknowns[i] -= share * change[i];
            const double size = equations->weights[j] * fabs(change[i]) / (1 + fabs(unknowns[i]));
            largest = size > largest ? size : largest;
            sum += size;
        }
    }
    return isfinite(sum) ? largest : INFINITY;
}

enum outcome { SOLVED, TANGLED, DIVERGED };

/* Newton's iteration with the factors at hand, from solver->unknowns. */
static enum outcome iterate(struct gm_solver *solver, const struct gm_step_equations *equations,
                            double *memory, const double *state, struct gm_progress *progress)
{
    bool fresh = memory[GM_MEMORY_STAMP] == 0 || memory[GM_MEMORY_SLOW] != 0, refreshed = false;
    double before = INFINITY;
    for (int iteration = 1; iteration <= SIMPLIFIED; iteration++) {
        progress->evaluations++;
        if (!equations->residual(equations->self, solver->unknowns, solver->residual)) {
            return TANGLED;
        }
        if (fresh) {
            if (!refresh(solver, equations, memory, state, solver->unknowns)) {
                return DIVERGED;
            }
            fresh = false;
            refreshed = true;
            before = INFINITY;
        }
        gm_banded_solve(&solver->matrix, solver->residual);
        progress->solves++;
        progress->iterations++;
        const double change = move(equations, solver->residual, 1, solver->unknowns);
        const double ratio = change / before;
        /* what is left after this change is about ratio / (1 - ratio) of it */
        const bool stands = iteration > 3 && ratio > 0.5 && change < stagnation(equations);
        if (stands || change < enough(equations) ||
            (ratio > 0 && ratio < contracts && change * ratio < 0.1 * tolerance)) {
            memory[GM_MEMORY_SLOW] = iteration > MANY && !stands;
            return SOLVED;
        }
        if (!(change < INFINITY)) {
            return DIVERGED;
        }
        if (ratio > (iteration == 2 ? 2 : 0.5) || iteration == 7) {
            if (refreshed && ratio > 1) {
                return DIVERGED;
            }
            fresh = !refreshed;
        }
        before = change;
    }
    return DIVERGED;
}

/* Newton's iteration with a new matrix every time; a step is shortened until every cell is positive. */
static enum outcome iterate_fully(struct gm_solver *solver, const struct gm_step_equations *equations,
                                  double *memory, const double *state, struct gm_progress *progress)
{
    const size_t n = solver->matrix.n;
    enum outcome failure = DIVERGED;
    progress->evaluations++;
    if (!equations->residual(equations->self, solver->unknowns, solver->residual)) {
        return TANGLED;
    }
    double before = INFINITY;
    for (int iteration = 1; iteration <= FULL; iteration++) {
        if (!refresh(solver, equations, memory, state, solver->unknowns)) {
            return failure;
        }
        gm_banded_solve(&solver->matrix, solver->residual);
        progress->solves++;
        progress->iterations++;
        memcpy(solver->trial, solver->residual, n * sizeof *solver->trial);
        double share = 1;
        for (int halving = 0;; halving++) {
            const double change = move(equations, solver->trial, share, solver->unknowns);
            if (!(change < INFINITY)) {
                return failure;
            }
            progress->evaluations++;
            if (equations->residual(equations->self, solver->unknowns, solver->residual)) {
                if (share == 1 &&
                    (change < enough(equations) || (change > before / 2 && change < stagnation(equations)))) {
                    memory[GM_MEMORY_SLOW] = 0;
                    return SOLVED;
                }
                before = change;
                break;
            }
            failure = TANGLED;
            if (halving == HALVINGS) {
                return failure;
            }
            /* back, and half as far */
            move(equations, solver->trial, -share, solver->unknowns);
            share /= 2;
        }
    }
    return failure;
}

static void remember(struct gm_solver *solver, double *memory)
{
    const size_t n = solver->matrix.n;
    memmove(past(memory, n, 1), past(memory, n, 0), (PAST - 1) * n * sizeof *memory);
    memcpy(past(memory, n, 0), solver->unknowns, n * sizeof *memory);
    memory[GM_MEMORY_PAST] = fmin(PAST, memory[GM_MEMORY_PAST] + 1);
}

enum gm_status gm_solver_solve(struct gm_solver *solver, const struct gm_step_equations *equations,
                               double *memory, const double *state, struct gm_progress *progress)
{
    const size_t n = solver->matrix.n;
    const size_t known = (size_t)memory[GM_MEMORY_PAST];
    restore(solver, equations, memory);
    equations->place(equations->self, state, equations->step);
    extrapolate(equations, memory, n, known, solver->unknowns);
    enum outcome outcome = iterate(solver, equations, memory, state, progress);
    bool tangled = false;
    for (size_t order = known; outcome != SOLVED; order--) {
        extrapolate(equations, memory, n, order, solver->unknowns);
        outcome = iterate_fully(solver, equations, memory, state, progress);
        tangled |= outcome == TANGLED;
        if (order <= 1) {
            break;
        }
    }
    if (outcome != SOLVED) {
        return tangled ? GM_MESH_CROSSING : GM_NO_CONVERGENCE;
    }
    remember(solver, memory);
    progress->evaluations++;
    return equations->residual(equations->self, solver->unknowns, solver->residual) ? GM_OK
                                                                                    : GM_MESH_CROSSING;
}
