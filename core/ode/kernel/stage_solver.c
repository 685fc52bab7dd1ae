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

bool gm_stages_by_newton(struct gm_stage_solver *solver)
{
    begin(solver);
    return solver->equations.linear &&
           gm_newton_solve(&solver->equations, solver->scratch, solver->z, solver->stages.progress);
}
