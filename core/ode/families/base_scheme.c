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

void gm_base_begin(struct gm_base_scheme *base, const struct gm_task *task)
{
    struct gm_task *step = &base->step;
    *step = *task;
    step->problem = &base->problem;
    step->scheme = base->scheme;
    step->steps = 1;
    step->steps_before = 0;
    step->carry = step->memory = NULL;
    step->carry_out = step->memory_out = step->trace = NULL;
    step->workspace = base->workspace;
    base->advance = gm_scheme_loop(base->scheme, &base->problem);
}

enum gm_status gm_base_step(struct gm_base_scheme *base, double h, const double *y, double *out,
                            struct gm_progress *progress)
{
    struct gm_task *step = &base->step;
    step->dt = h;
    step->y = y;
    step->out = out;
    if (step->carry) { /* a scheme without compensation leaves it unchanged */
        memcpy(step->carry_out, step->carry, base->problem.n * base->problem.m * sizeof *y);
    }
    const struct gm_progress made =
        base->advance ? base->advance(step) : (struct gm_progress){.status = GM_NO_CONVERGENCE};
    progress->evaluations += made.evaluations;
    progress->solves += made.solves;
    progress->iterations += made.iterations;
    if (made.done == 1) { /* what another member lacks stays known */
        return GM_OK;
    }
    progress->unsolved = made.unsolved;
    return made.status;
}
