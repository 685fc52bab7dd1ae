/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A problem's stages as equations: z = h A f(y + z). */
#include "core/ode/kernel/stage_solver.h"

#include "core/ode/kernel/loops.h"
#include "core/ode/kernel/members.h"

size_t gm_stage_solver_room(const struct gm_problem *problem, size_t count)
{
    const size_t size = count * problem->n, square = gm_matrix_size(problem);
    return 2 * size + problem->n + (square > 0 ? square + gm_newton_scratch(size) : size);
}

static bool slope(void *data, size_t j, const double *state, double *f, double *jacobian)
{
    const struct gm_loops *loops = gm_ode_of(data)->loops[GM_ISA_BASELINE];
    (void)j;
    if (jacobian) {
        loops->field(data, state, f, 1);
        loops->jacobian(data, state, jacobian);
    } else {
        gm_field(data, state, f, 1);
    }
    return true;
}

struct gm_stage_solver gm_stage_solver_lay(const struct gm_problem *problem, size_t count, double *scratch)
{
    const size_t n = problem->n, size = count * n, square = gm_matrix_size(problem);
    return (struct gm_stage_solver){
        .stages = {.count = count,
                   .n = n,
                   .slope = slope,
                   .data = (void *)problem,
                   .f = scratch,
                   .state = scratch + 2 * size,
                   .jacobian = scratch + 2 * size + n},
        .equations = {.size = size,
                      .counted = size,
                      .n = n,
                      .sweep = gm_stages_sweep,
                      .linear = square > 0 ? gm_stages_linear : NULL,
                      .roundoff = 8 * GM_EPSILON},
        .z = scratch + size,
        .scratch = scratch + 2 * size + n + square,
    };
}

static void begin(struct gm_stage_solver *solver)
{
    memset(solver->z, 0, solver->equations.size * sizeof *solver->z);
    solver->equations.data = &solver->stages;
    solver->equations.y = solver->stages.y;
}

bool gm_stages_by_sweeps(struct gm_stage_solver *solver)
{
    begin(solver);
    return gm_sweeps_solve(&solver->equations, solver->scratch, solver->z, solver->stages.progress);
}

/* Newton's method with factors that the problem keeps. */
static bool by_kept_factors(struct gm_stage_solver *solver)
{
    const struct gm_problem *problem = solver->stages.data;
    const struct gm_loops *loops = gm_ode_of(problem)->loops[GM_ISA_BASELINE];
    struct gm_progress *progress = solver->stages.progress;
    const size_t size = solver->equations.size;
    double *change = solver->scratch, *z = solver->z, previous = INFINITY;
    for (int iteration = 0; iteration < GM_NEWTON_STEPS; iteration++) {
        double scale = 0, moved = 0;
        gm_stages_sweep(&solver->stages, z, change, &scale);
        for (size_t i = 0; i < size; i++) {
            change[i] -= z[i];
        }
        progress->iterations++;
        progress->solves++;
        if (!loops->correct(problem, &solver->stages, change)) {
            progress->unsolved.obstacle = GM_SINGULAR;
            return false;
        }
        for (size_t i = 0; i < size; i++) {
            moved += fabs(change[i]);
            z[i] += change[i];
        }
        /* the rounding of sums over neighbours is larger than that of one number */
        if (gm_newton_is_settled(size, moved, scale, 0x1p10 * scale, &previous)) {
            return true;
        }
        progress->unsolved = gm_unsolved_by(moved, scale);
        if (!isfinite(moved)) {
            return false;
        }
    }
    return false;
}

bool gm_stages_by_newton(struct gm_stage_solver *solver)
{
    begin(solver);
    if (gm_ode_of(solver->stages.data)->loops[GM_ISA_BASELINE]->correct) {
        return by_kept_factors(solver);
    }
    return solver->equations.linear &&
           gm_newton_solve(&solver->equations, solver->scratch, solver->z, solver->stages.progress);
}
