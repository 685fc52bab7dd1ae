/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Compositions of any schemes,
       y1 = Phi_s(g_s h) o ... o Phi_1(g_1 h) (y0),
   with the loops of these schemes. The family has no rows: they are user-defined. Hairer, Lubich & Wanner (2006), sections II.4, V.3. */
#include "core/ode/families/composition.h"

#include "core/ode/families/family.h"

/* The states between two substeps go back and forth between the run's and this one. */
struct workspace {
    const struct gm_substeps *substeps;
    double *state, *carry; /* n * m each */
    int count;
    const struct gm_family **families; /* the substeps' families; NULL: shares an earlier workspace */
    void **workspaces;
};

bool gm_scheme_composes(const struct gm_scheme *scheme)
{
    const struct gm_family *family = scheme->family;
    return family->kind == &gm_kind_ode && !family->memory && !family->adaptive && !family->doubled &&
           !family->not_resumable;
}

bool gm_scheme_is_composition(const struct gm_scheme *scheme)
{
    return scheme->family == &gm_family_composition || scheme->family == &gm_family_composition_carrying;
}

int gm_scheme_over_kernels(const struct gm_scheme *scheme)
{
    if (scheme->base) {
        return gm_scheme_over_kernels(scheme->base);
    }
    if (!gm_scheme_is_composition(scheme)) {
        return scheme->family->over_kernels;
    }
    const struct gm_substeps *substeps = scheme->coefficients;
    const int over = gm_scheme_over_kernels(substeps->at[0].scheme);
    for (int i = 1; i < substeps->count; i++) {
        if (gm_scheme_over_kernels(substeps->at[i].scheme) != over) {
            return GM_OVER_ALL;
        }
    }
    return over;
}

static void workspace_close(void *data)
{
    struct workspace *workspace = data;
    if (!workspace) {
        return;
    }
    for (int i = 0; i < workspace->count; i++) {
        if (workspace->families[i]) {
            workspace->families[i]->workspace_close(workspace->workspaces[i]);
        }
    }
    free(workspace->families);
    free(workspace->workspaces);
    free(workspace->state);
    free(workspace);
}

static void *workspace_open(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    const struct gm_substeps *substeps = scheme->coefficients;
    const size_t count = problem->n * problem->m, parts = (size_t)substeps->count;
    struct workspace *workspace = calloc(1, sizeof *workspace);
    if (!workspace) {
        return NULL;
    }
    workspace->substeps = substeps;
    workspace->state = malloc(2 * count * sizeof(double));
    workspace->families = calloc(parts, sizeof(*workspace->families));
    workspace->workspaces = calloc(parts, sizeof *workspace->workspaces);
    bool good = workspace->state && workspace->families && workspace->workspaces;
    for (int i = 0; good && i < substeps->count; i++) {
        const struct gm_scheme *part = substeps->at[i].scheme;
        int same = 0;
        while (substeps->at[same].scheme != part) {
            same++;
        }
        workspace->count = i + 1;
        workspace->workspaces[i] = workspace->workspaces[same];
        if (same == i) {
            good = gm_scheme_workspace_open(part, problem, &workspace->workspaces[i]);
            workspace->families[i] = workspace->workspaces[i] ? part->family : NULL;
        }
    }
    if (!good) {
        workspace_close(workspace);
        return NULL;
    }
    workspace->carry = workspace->state + count;
    return workspace;
}

static void workspace_reset(void *data)
{
    struct workspace *workspace = data;
    for (int i = 0; i < workspace->count; i++) {
        if (workspace->families[i] && workspace->families[i]->workspace_reset) {
            workspace->families[i]->workspace_reset(workspace->workspaces[i]);
        }
    }
}

static struct gm_progress loop(const struct gm_task *task)
{
    const struct workspace *workspace = task->workspace;
    const struct gm_substeps *substeps = workspace->substeps;
    const size_t bytes = task->problem->n * task->problem->m * sizeof(double);
    struct gm_progress progress = {.status = GM_OK};
    struct gm_task substep = *task;
    substep.steps = 1;
    for (; progress.done < task->steps; progress.done++) {
        for (int i = 0; i < substeps->count; i++) {
            const struct gm_scheme *scheme = substeps->at[i].scheme;
            gm_loop *advance = gm_scheme_loop(scheme, task->problem);
            const bool there = substep.y == task->out;
            substep.scheme = scheme;
            substep.dt = substeps->at[i].fraction * task->dt;
            substep.workspace = workspace->workspaces[i];
            substep.out = there ? workspace->state : task->out;
            substep.carry_out = !substep.carry ? NULL : there ? workspace->carry : task->carry_out;
            if (substep.carry) { /* a scheme without compensation leaves it unchanged */
                memcpy(substep.carry_out, substep.carry, bytes);
            }
            const struct gm_progress made =
                advance ? advance(&substep) : (struct gm_progress){.status = GM_NO_CONVERGENCE};
            progress.evaluations += made.evaluations;
            progress.solves += made.solves;
            progress.iterations += made.iterations;
            progress.unsolved = made.unsolved;
            if (made.done < 1) {
                progress.status = made.status;
                return progress;
            }
            substep.y = substep.out;
            substep.carry = substep.carry_out;
        }
    }
    if (substep.y != task->out) {
        memcpy(task->out, substep.y, bytes);
        if (substep.carry) {
            memcpy(task->carry_out, substep.carry, bytes);
        }
    }
    return progress;
}

/* Returns the first thing that a problem lacks for a part of the steps. */
static const char *lacks(const struct gm_scheme *scheme, const struct gm_problem *problem)
{
    const struct gm_substeps *substeps = scheme->coefficients;
    const char *lack = NULL;
    for (int i = 0; i < substeps->count && !lack; i++) {
        const struct gm_scheme *part = substeps->at[i].scheme;
        lack = part->family->lacks ? part->family->lacks(part, problem) : NULL;
    }
    return lack;
}

#define COMPOSITION(passive)                                                                                 \
    {                                                                                                        \
        .kind = &gm_kind_ode, .title = "composition", .parameters = gm_settings_of_sums, .loop = loop,       \
        .carries_passive = passive, .workspace_open = workspace_open, .workspace_close = workspace_close,    \
        .workspace_reset = workspace_reset, .lacks = lacks,                                                  \
    }
const struct gm_family gm_family_composition = COMPOSITION(false);
const struct gm_family gm_family_composition_carrying = COMPOSITION(true);
