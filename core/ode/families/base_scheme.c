/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/ode/families/base_scheme.h"

#include <math.h>
#include <string.h>

#include "core/kind.h"

bool gm_base_open(struct gm_base_scheme *base, const struct gm_scheme *scheme,
                  const struct gm_problem *problem)
{
    *base = (struct gm_base_scheme){.scheme = scheme, .problem = *problem};
    base->problem.m = 1;
    return gm_scheme_workspace_open(scheme, &base->problem, &base->workspace);
}

void gm_base_close(struct gm_base_scheme *base)
{
    if (base->workspace) {
        base->scheme->family->workspace_close(base->workspace);
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
    const struct gm_task step = {.problem = &base->problem,
                                 .scheme = base->scheme,
                                 .dt = h,
                                 .steps = 1,
                                 .limit = task->limit,
                                 .y = y,
                                 .out = out,
                                 .carry = base->carry,
                                 .carry_out = base->carry_out,
                                 .until = INFINITY,
                                 .workspace = base->workspace,
                                 .settings = task->settings};
    if (base->carry) { /* a scheme without compensation leaves it unchanged */
        memcpy(base->carry_out, base->carry, base->problem.n * sizeof *y);
    }
    const struct gm_progress made = gm_scheme_loop(base->scheme, &base->problem)(&step);
    progress->evaluations += made.evaluations;
    progress->solves += made.solves;
    progress->iterations += made.iterations;
    progress->unsolved = made.unsolved;
    return made.done == 1 ? GM_OK : made.status;
}
