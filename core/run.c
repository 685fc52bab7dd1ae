/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/run.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/kernel/loops.h"

/* The block: the struct, then two halves, each the state and (compensated) its carry. A step reads one half and
   writes the other, so the last good step is always whole. */

enum { ALIGNMENT = 128 };

static size_t head_size(void) { return (sizeof(struct gm_run) + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT; }

static size_t state_count(const struct gm_run *run) { return run->problem->n * run->problem->m; }

static size_t half_count(const struct gm_run *run)
{
    return state_count(run) * (run->settings.compensated ? 2 : 1);
}

static size_t half_size(const struct gm_run *run)
{
    return (half_count(run) * sizeof(double) + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT;
}

static double *half(const struct gm_run *run, int which)
{
    return (double *)(void *)((char *)run + head_size() + (size_t)which * half_size(run));
}

const double *gm_run_state(const struct gm_run *run) { return half(run, run->current); }

struct gm_run *gm_run_open(const struct gm_problem *problem, const struct gm_scheme *scheme,
                           const struct gm_settings *settings, double t0, double dt, const double *y0)
{
    struct gm_run head = {
        .problem = problem, .scheme = scheme, .settings = *settings, .t0 = t0, .dt = dt, .t = t0};
    struct gm_run *run = aligned_alloc(ALIGNMENT, head_size() + 2 * half_size(&head));
    if (!run) {
        return NULL;
    }
    double largest = 1;
    for (size_t i = 0; i < state_count(&head); i++) {
        largest = fabs(y0[i]) > largest ? fabs(y0[i]) : largest;
    }
    head.limit = 1e10 * largest;
    *run = head;
    memset(half(run, 0), 0, 2 * half_size(run));
    memcpy(half(run, 0), y0, state_count(run) * sizeof(double));
    return run;
}

void gm_run_close(struct gm_run *run) { free(run); }

double gm_run_per_member(const struct gm_run *run, unsigned long count)
{
    return (double)count / (double)run->problem->m;
}

enum gm_status gm_run_advance(struct gm_run *run, long steps)
{
    if (run->status != GM_OK || steps <= 0) {
        return run->status;
    }
    const double *from = half(run, run->current);
    double *to = half(run, 1 - run->current);
    const size_t count = state_count(run);
    struct gm_task task = {
        .problem = run->problem,
        .scheme = run->scheme,
        .dt = run->dt,
        .steps = steps,
        .steps_before = run->steps,
        .limit = run->limit,
        .y = from,
        .out = to,
        .carry = run->settings.compensated ? from + count : NULL,
        .carry_out = run->settings.compensated ? to + count : NULL,
    };
    gm_loop *loop = run->problem->loops[gm_isa_best()]->family[run->scheme->family->id];
    struct gm_progress progress = loop(&task);
    if (progress.done < steps) {
        run->status = progress.status;
        if (progress.done == 0) {
            return run->status;
        }
        /* some members went further than the one that failed: stop all at the last step that all made */
        task.steps = progress.done;
        progress = loop(&task);
    }
    run->evaluations += progress.evaluations;
    run->solves += progress.solves;
    run->iterations += progress.iterations;
    run->current = 1 - run->current;
    run->n += progress.done;
    run->steps += progress.done;
    run->t = run->t0 + (double)run->n * run->dt;
    return run->status;
}

void gm_run_set_step(struct gm_run *run, double dt)
{
    run->t0 = run->t;
    run->n = 0;
    run->dt = dt;
}

struct gm_run *gm_run_switch(const struct gm_run *run, const struct gm_scheme *scheme)
{
    struct gm_run *next =
        gm_run_open(run->problem, scheme, &run->settings, run->t, run->dt, gm_run_state(run));
    if (next) {
        next->limit = run->limit;
        next->steps = run->steps;
        next->evaluations = run->evaluations;
        next->solves = run->solves;
        next->iterations = run->iterations;
    }
    return next;
}

size_t gm_run_snapshot_size(const struct gm_run *run) { return head_size() + half_size(run); }

void gm_run_save(const struct gm_run *run, void *snapshot)
{
    memcpy(snapshot, run, sizeof *run);
    memcpy((char *)snapshot + head_size(), half(run, run->current), half_size(run));
}

void gm_run_load(struct gm_run *run, const void *snapshot)
{
    memcpy(run, snapshot, sizeof *run);
    memcpy(half(run, run->current), (const char *)snapshot + head_size(), half_size(run));
}
