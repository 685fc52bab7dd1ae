/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Compositions of any schemes,
       y1 = Phi_s(g_s h) o ... o Phi_1(g_1 h) (y0),
   with the loops of these schemes. The family has no rows: they are user-defined. Hairer, Lubich & Wanner (2006), sections II.4, V.3. */
#include "core/ode/families/composition.h"

#include "core/ode/families/base_scheme.h"
#include "core/ode/families/family.h"

/* The states between two substeps go back and forth between the run's and this one. */
struct work {
    struct gm_arena *arena; /* owns all of this */
    int count;
    double *state, *carry;        /* n * m each */
    struct gm_base_scheme *bases; /* of each substep; equal schemes share a workspace */
};

bool gm_scheme_composes(const struct gm_scheme *scheme)
{
    const struct gm_family *family = scheme->family;
    return family->kind == &gm_kind_ode && !gm_scheme_has_memory(scheme) && !family->adaptive &&
           !family->doubled && !family->not_resumable;
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

static void open_work(struct gm_arena *arena, void *data)
{
    struct gm_workspace *opening = data;
    const struct gm_problem *problem = opening->problem;
    const struct gm_substeps *substeps = opening->scheme->coefficients;
    const size_t size = problem->n * problem->m;
    struct work *work = opening->opened = gm_arena_take(arena, 1, sizeof *work);
    *work = (struct work){.arena = arena,
                          .count = substeps->count,
                          .state = gm_arena_take(arena, size, sizeof(double)),
                          .carry = gm_arena_take(arena, size, sizeof(double)),
                          .bases = gm_arena_take(arena, (size_t)substeps->count, sizeof *work->bases)};
    for (int i = 0; i < substeps->count; i++) {
        const struct gm_scheme *part = substeps->at[i].scheme;
        int same = 0;
        while (substeps->at[same].scheme != part) {
            same++;
        }
        work->bases[i] = work->bases[same];
        if (same == i) {
            gm_base_open(arena, &work->bases[i], part, problem, problem->m);
        }
    }
}

static void *workspace_open(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    return gm_workspace_open(problem, scheme, open_work);
}

static void workspace_reset(void *data)
{
    const struct work *work = data;
    for (int i = 0; i < work->count; i++) {
        gm_base_reset(&work->bases[i]);
    }
}

static struct gm_progress loop(const struct gm_task *task)
{
    const struct work *work = task->workspace;
    const struct gm_substeps *substeps = task->scheme->coefficients;
    const size_t bytes = task->problem->n * task->problem->m * sizeof(double);
    struct gm_progress progress = {.status = GM_OK};
    const double *y = task->y, *carry = task->carry;
    for (int i = 0; i < substeps->count; i++) {
        gm_base_begin(&work->bases[i], task);
        work->bases[i].step.steps_before = task->steps_before;
    }
    for (; progress.done < task->steps; progress.done++) {
        for (int i = 0; i < substeps->count; i++) {
            struct gm_base_scheme *base = &work->bases[i];
            const bool there = y == task->out;
            double *out = there ? work->state : task->out;
            base->step.carry = carry;
            base->step.carry_out = there ? work->carry : task->carry_out;
            progress.status = gm_base_step(base, substeps->at[i].fraction * task->dt, y, out, &progress);
            if (progress.status != GM_OK) {
                return progress;
            }
            y = out;
            carry = carry ? base->step.carry_out : NULL;
        }
    }
    if (y != task->out) {
        memcpy(task->out, y, bytes);
        if (carry) {
            memcpy(task->carry_out, carry, bytes);
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
        .carries_passive = passive, .workspace_open = workspace_open, .workspace_close = gm_workspace_close, \
        .workspace_reset = workspace_reset, .lacks = lacks,                                                  \
    }
const struct gm_family gm_family_composition = COMPOSITION(false);
const struct gm_family gm_family_composition_carrying = COMPOSITION(true);
