/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/ode/families/base_scheme.h"

#include <string.h>

#include "core/kind.h"

void gm_base_open(struct gm_arena *arena, struct gm_base_scheme *base, const struct gm_scheme *scheme,
                  const struct gm_problem *problem, size_t members)
{
    *base = (struct gm_base_scheme){.scheme = scheme, .problem = *problem};
    base->problem.m = members;
    gm_arena_need(arena, gm_scheme_workspace_open(scheme, &base->problem, &base->workspace));
    if (base->workspace) {
        gm_arena_keep(arena, base->workspace, scheme->family->workspace_close);
    }
}

void gm_base_reset(const struct gm_base_scheme *base)
{
    if (base->workspace && base->scheme->family->workspace_reset) {
        base->scheme->family->workspace_reset(base->workspace);
    }
}

enum gm_status gm_base_step(const struct gm_base_scheme *base, const struct gm_task *task, double h,
                            const double *y, double *out, struct gm_progress *progress)
{
    struct gm_task step = *task; /* fewer instructions than to set what is not used */
    step.problem = &base->problem;
    step.scheme = base->scheme;
    step.dt = h;
    step.steps = 1;
    step.steps_before = base->steps_before;
    step.y = y;
    step.out = out;
    step.carry = base->carry;
    step.carry_out = base->carry_out;
    step.memory = step.memory_out = step.trace = NULL;
    step.workspace = base->workspace;
    if (base->carry) { /* a scheme without compensation leaves it unchanged */
        memcpy(base->carry_out, base->carry, base->problem.n * base->problem.m * sizeof *y);
    }
    gm_loop *advance = base->advance ? base->advance : gm_scheme_loop(base->scheme, &base->problem);
    const struct gm_progress made =
        advance ? advance(&step) : (struct gm_progress){.status = GM_NO_CONVERGENCE};
    progress->evaluations += made.evaluations;
    progress->solves += made.solves;
    progress->iterations += made.iterations;
    if (made.done == 1) { /* what another member lacks stays known */
        return GM_OK;
    }
    progress->unsolved = made.unsolved;
    return made.status;
}
