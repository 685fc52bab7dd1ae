/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Methods for any differential equation on systems with constraints g(q) = 0, G = dg/dq: a step Phi_h of the
   motion with the multipliers of g'' = 0, and the way back onto the manifold,
       (q, p) = Phi_h(y_0),   q_1 = q + M^-1 G' mu,  g(q_1) = 0,   p_1 = p + G' nu,  G v_1 = 0
   Both constraints are kept, and the order of Phi; that Phi is symplectic or symmetric is lost: a control
   beside the schemes that are made for constraints. Hairer, Lubich & Wanner (2006), section IV.4; E. Hairer &
   G. Wanner, Solving Ordinary Differential Equations II (1996), section VII.2. */
#include <stdlib.h>
#include <string.h>

#include "core/basics.h"
#include "core/kind.h"
#include "core/ode/families/families.h"
#include "core/ode/variational/manifold.h"
#include "core/schemes.h"

struct workspace {
    const struct gm_scheme *base; /* Phi */
    void *base_workspace;         /* workspace of the base's loop; NULL: not needed */
    double *state, *member;       /* n * m before a step, n */
    double storage[];
};

static void workspace_close(void *data)
{
    struct workspace *workspace = data;
    if (workspace && workspace->base_workspace) {
        workspace->base->family->workspace_close(workspace->base_workspace);
    }
    free(workspace);
}

static void *workspace_open(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    const size_t count = problem->n * problem->m;
    struct workspace *workspace = calloc(1, sizeof *workspace + (count + problem->n) * sizeof(double));
    if (!workspace) {
        return NULL;
    }
    workspace->base = gm_scheme_find(scheme->coefficients);
    workspace->state = workspace->storage;
    workspace->member = workspace->storage + count;
    if (!gm_scheme_workspace_open(workspace->base, problem, &workspace->base_workspace)) {
        workspace_close(workspace);
        return NULL;
    }
    return workspace;
}

/* all members of the state */
static bool project(const struct gm_problem *problem, double *member, double *y)
{
    bool good = true;
    for (size_t l = 0; l < problem->m && good; l++) {
        for (size_t c = 0; c < problem->n; c++) {
            member[c] = y[c * problem->m + l];
        }
        good = gm_manifold_project(problem, member);
        for (size_t c = 0; c < problem->n; c++) {
            y[c * problem->m + l] = member[c];
        }
    }
    return good;
}

static struct gm_progress loop(const struct gm_task *task)
{
    const struct workspace *workspace = task->workspace;
    gm_loop *advance = gm_scheme_loop(workspace->base, task->problem);
    struct gm_progress progress = {.status = GM_OK};
    struct gm_task step = *task;
    step.scheme = workspace->base;
    step.workspace = workspace->base_workspace;
    step.steps = 1;
    step.carry = step.carry_out = NULL; /* a projected state is not a sum */
    for (; progress.done < task->steps; progress.done++) {
        const struct gm_progress made = advance(&step);
        progress.evaluations += made.evaluations;
        progress.solves += made.solves;
        progress.iterations += made.iterations;
        progress.unsolved = made.unsolved;
        progress.status = made.done < 1                                          ? made.status
                          : project(task->problem, workspace->member, task->out) ? GM_OK
                                                                                 : GM_NO_CONVERGENCE;
        if (progress.status != GM_OK) {
            return progress;
        }
        memcpy(workspace->state, task->out, task->problem->n * task->problem->m * sizeof(double));
        step.y = workspace->state;
        step.steps_before++;
    }
    return progress;
}

#define PROJECTED(base)                                                                                      \
    .family = &gm_family_projected, .coefficients = base,                                                    \
    .formula = "(q, p) = Φ_h(y₀), Φ is " base ";  q₁ = q + M⁻¹Gᵀμ,  g(q₁) = 0;  p₁ = p + Gᵀν,  G v₁ = 0",    \
    .reference = "Hairer, Lubich & Wanner (2006), IV.4; E. Hairer & G. Wanner, Solving Ordinary "            \
                 "Differential Equations II (1996), VII.2",                                                  \
    .needs = GM_NEEDS_CONSTRAINTS, .claims = GM_KEEPS_CONSTRAINTS | GM_KEEPS_HIDDEN

static const struct gm_scheme schemes[] = {
    {
        .name = "projected-gauss4",
        .title = "projected Gauss 4",
        PROJECTED("gauss4"),
        .order = 4,
    },
    {
        .name = "projected-gauss6",
        .title = "projected Gauss 6",
        PROJECTED("gauss6"),
        .order = 6,
    },
    {
        .name = "projected-rk4",
        .title = "projected RK4",
        PROJECTED("rk4"),
        .order = 4,
    },
};

const struct gm_family gm_family_projected = {
    .kind = &gm_kind_ode,
    .title = "projected onto constraints",
    .schemes = schemes,
    .count = GM_COUNT(schemes),
    .loop = loop,
    .workspace_open = workspace_open,
    .workspace_close = workspace_close,
};
