/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loop of the families whose step is a system of equations on the nodes, and what they tell of a run. */
#include "core/mesh/families/advance.h"

#include <math.h>
#include <string.h>

static enum gm_status check(const double *state, size_t count, double limit)
{
    for (size_t i = 0; i < count; i++) {
        if (!(fabs(state[i]) <= limit)) {
            return GM_BLOW_UP;
        }
    }
    return GM_OK;
}

struct gm_progress gm_mesh_advance(const struct gm_task *task, struct gm_solver *solver,
                                   const struct gm_step_equations *equations,
                                   enum gm_status (*finish)(void *self, double *state, double *multiplier))
{
    const size_t count = equations->state;
    const size_t remembered = gm_solver_memory(equations->nodes, equations->per_node, count);
    double *memory = task->memory_out, *state = task->out;
    struct gm_progress progress = {.status = GM_OK};
    if (state != task->y) {
        memcpy(state, task->y, count * sizeof *state);
        memcpy(memory, task->memory, remembered * sizeof *memory);
    }
    while (progress.done < task->steps) {
        progress.status = gm_solver_solve(solver, equations, memory, state, &progress);
        if (progress.status == GM_OK) {
            progress.status = finish(equations->self, state, &memory[GM_MEMORY_MULTIPLIER]);
        }
        if (progress.status == GM_OK) {
            progress.status = check(state, count, task->limit);
        }
        if (progress.status != GM_OK) {
            break;
        }
        progress.done++;
    }
    return progress;
}

double gm_mesh_multiplier_norm(const struct gm_run *run)
{
    return gm_run_memory(run)[GM_MEMORY_MULTIPLIER];
}

double gm_mesh_factorisations(const struct gm_run *run)
{
    return gm_run_memory(run)[GM_MEMORY_STAMP];
}
