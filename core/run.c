/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A run's one block of memory, its steps, and its snapshots. */
#include "core/run.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/kind.h"
#include "core/memory.h"

/* The block: the struct, then two halves, each the state, its carry (compensated) and the scheme's memory.
   Steps read one half and write the other, so the last good step is always whole. An ensemble makes the
   next ones in place, with half the memory to move: if one of them fails, they are repeated from the other
   half, which is at most this number of steps behind. */
enum { FARTHEST_BEHIND = 64 };

enum { ALIGNMENT = 128 };

static size_t head_size(void)
{
    return (sizeof(struct gm_run) + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT;
}

static size_t state_count(const struct gm_run *run)
{
    return run->problem->n * run->problem->m;
}

static size_t carry_count(const struct gm_run *run)
{
    return run->settings.compensated ? state_count(run) : 0;
}

static size_t memory_count(const struct gm_run *run)
{
    const struct gm_family *family = run->scheme->family;
    return family->memory ? family->memory(run->problem, run->scheme) : 0;
}

static size_t half_size(const struct gm_run *run)
{
    const size_t count = state_count(run) + carry_count(run) + memory_count(run);
    return (count * sizeof(double) + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT;
}

static double *half(const struct gm_run *run, int which)
{
    return (double *)(void *)((char *)run + head_size() + (size_t)which * run->half_size);
}

const double *gm_run_state(const struct gm_run *run)
{
    return half(run, run->current);
}

const double *gm_run_memory(const struct gm_run *run)
{
    return run->scheme->family->memory ? half(run, run->current) + state_count(run) + carry_count(run) : NULL;
}

/* The task that reads half `from` and writes half `to`. */
static struct gm_task task_of(const struct gm_run *run, int from, int to, int64_t steps)
{
    const size_t count = state_count(run), carried = carry_count(run);
    const bool remembers = run->scheme->family->memory != NULL;
    const double *y = half(run, from);
    double *out = half(run, to);
    return (struct gm_task){
        .problem = run->problem,
        .scheme = run->scheme,
        .dt = run->dt,
        .steps = steps,
        .steps_before = run->steps,
        .limit = run->limit,
        .y = y,
        .out = out,
        .carry = carried ? y + count : NULL,
        .carry_out = carried ? out + count : NULL,
        .memory = remembers ? y + count + carried : NULL,
        .memory_out = remembers ? out + count + carried : NULL,
        .t = run->t,
        .until = INFINITY,
        .t0 = run->t0,
        .n = run->n,
        .workspace = run->workspace,
        .settings = &run->settings,
    };
}

/* Lets the scheme fill its memory from the current state. */
static void start(struct gm_run *run)
{
    if (run->scheme->family->start && run->status == GM_OK) {
        const struct gm_task task = task_of(run, run->current, run->current, 0);
        const unsigned long refusals = gm_memory_refusals();
        run->status = run->scheme->family->start(&task);
        if (gm_memory_refusals() != refusals) {
            run->status = GM_OUT_OF_MEMORY;
        }
    }
}

struct gm_run *gm_run_open(const struct gm_problem *problem, const struct gm_scheme *scheme,
                           const struct gm_settings *settings, double t0, double dt, const double *y0)
{
    struct gm_run head = {
        .problem = problem, .scheme = scheme, .settings = *settings, .t0 = t0, .dt = dt, .t = t0};
    head.half_size = half_size(&head);
    const unsigned long refusals = gm_memory_refusals();
    struct gm_run *run = aligned_alloc(ALIGNMENT, head_size() + 2 * head.half_size);
    if (!run) {
        return NULL;
    }
    if (problem->kind->prepare) {
        problem->kind->prepare(scheme, problem);
    }
    if (!gm_scheme_workspace_open(scheme, problem, &head.workspace)) {
        gm_memory_refused(); /* refused by a library, if not noted before */
        free(run);
        return NULL;
    }
    double largest = 1;
    for (size_t i = 0; i < state_count(&head); i++) {
        largest = fabs(y0[i]) > largest ? fabs(y0[i]) : largest;
    }
    head.limit = problem->bound > 0 ? problem->bound : 1e10 * largest;
    *run = head;
    memset(half(run, 0), 0, 2 * run->half_size);
    memcpy(half(run, 0), y0, state_count(run) * sizeof(double));
    start(run);
    if (gm_memory_refusals() != refusals) {
        gm_run_close(run);
        return NULL;
    }
    return run;
}

void gm_run_close(struct gm_run *run)
{
    if (run && run->workspace) {
        run->scheme->family->workspace_close(run->workspace);
    }
    free(run);
}

double gm_run_per_member(const struct gm_run *run, unsigned long count)
{
    return (double)count / (double)run->problem->m;
}

/* The steps since the other half, into the current one. */
static struct gm_task task_again(const struct gm_run *run)
{
    struct gm_task task = task_of(run, 1 - run->current, run->current, run->behind);
    task.n -= run->behind;
    task.steps_before -= run->behind;
    task.t = run->t0 + (double)task.n * run->dt;
    return task;
}

/* Returns true if these steps may be made in place: loops over kernels can, and allocate no memory. */
static bool is_in_place(const struct gm_run *run, gm_loop *loop, int64_t steps)
{
    return run->problem->m > 1 && loop != run->scheme->family->loop && !run->looks_back && run->behind > 0 &&
           steps <= FARTHEST_BEHIND - run->behind;
}

static enum gm_status advance(struct gm_run *run, int64_t steps, double until)
{
    if (run->status != GM_OK || steps <= 0) {
        return run->status;
    }
    const struct gm_family *family = run->scheme->family;
    gm_loop *loop = gm_scheme_loop(run->scheme, run->problem);
    const bool in_place = is_in_place(run, loop, steps);
    struct gm_task task = task_of(run, run->current, in_place ? run->current : 1 - run->current, steps);
    task.until = until;
    run->behind = in_place ? run->behind : 0;
    const unsigned long refusals = gm_memory_refusals();
    struct gm_progress progress = loop(&task);
    if (in_place && progress.done < steps) {
        task = task_again(run);
        loop(&task);
        run->behind = 0;
        return advance(run, steps, until);
    }
    if (gm_memory_refusals() != refusals) {
        /* a result without enough memory, in factors or in a solution, is not valid */
        return run->status = GM_OUT_OF_MEMORY;
    }
    if (progress.done < steps && !(family->adaptive && progress.status == GM_OK)) {
        const int64_t done = progress.done;
        run->status = progress.status;
        run->unsolved = progress.unsolved;
        progress = (struct gm_progress){.status = progress.status};
        if (done > 0) {
            /* some members went further than the one that failed: stop all at the last step that all made */
            task.steps = done;
            progress = loop(&task);
        }
        if (done == 0) {
            return run->status;
        }
    }
    run->evaluations += progress.evaluations;
    run->solves += progress.solves;
    run->factor_solves += progress.factor_solves;
    run->own_steps += progress.own_steps;
    run->rejected += progress.rejected;
    run->iterations += progress.iterations;
    run->current = in_place ? run->current : 1 - run->current;
    run->behind += progress.done;
    run->n += progress.done;
    run->steps += progress.done;
    run->t = family->adaptive ? progress.t : run->t0 + (double)run->n * run->dt;
    return run->status;
}

enum gm_status gm_run_advance(struct gm_run *run, int64_t steps)
{
    return advance(run, steps, INFINITY);
}

bool gm_run_repeats(const struct gm_run *run)
{
    const struct gm_family *family = run->scheme->family;
    return run->status == GM_OK && run->n > 0 && run->behind == 1 && !family->adaptive && !family->memory &&
           !family->workspace_reset;
}

const double *gm_run_before(const struct gm_run *run)
{
    return half(run, 1 - run->current);
}

/* The last step again, of another length. */
static struct gm_task part_of(const struct gm_run *run, double fraction)
{
    struct gm_task task = task_again(run);
    task.dt = fraction * run->dt;
    return task;
}

bool gm_run_part(const struct gm_run *run, double fraction, double *y)
{
    struct gm_task task = part_of(run, fraction);
    const unsigned long refusals = gm_memory_refusals();
    task.out = y;
    task.carry_out = task.carry ? y + state_count(run) : NULL;
    const struct gm_progress progress = gm_scheme_loop(run->scheme, run->problem)(&task);
    return progress.done == 1 && gm_memory_refusals() == refusals;
}

void gm_run_shorten(struct gm_run *run, double fraction)
{
    const struct gm_task task = part_of(run, fraction);
    const struct gm_progress progress = gm_scheme_loop(run->scheme, run->problem)(&task);
    run->evaluations += progress.evaluations;
    run->solves += progress.solves;
    run->factor_solves += progress.factor_solves;
    run->iterations += progress.iterations;
    run->t = run->t0 = task.t + task.dt;
    run->n = run->behind = 0;
}

int64_t gm_run_steps_at(const struct gm_run *run, double t)
{
    const double most = (double)(INT64_MAX / 4);
    const double steps = round((t - run->t0) / run->dt);
    return run->scheme->family->adaptive || !(steps < most) ? INT64_MAX / 4
                                                            : run->steps - run->n + (int64_t)steps;
}

int64_t gm_run_steps_by(const struct gm_run *run, double t)
{
    if (run->scheme->family->adaptive) {
        return run->steps + (run->t < t ? 1 : 0);
    }
    const double ahead = (t - run->t) / run->dt;
    return run->steps + (int64_t)floor(fmin(ahead * (1 + 1e-12) + 1e-6, 1e15));
}

/* An end that is missed by round-off is reached. */
static double reached_from(double until)
{
    return isfinite(until) ? until - 1e-12 * fabs(until) : until;
}

bool gm_run_goes_on(const struct gm_run *run, int64_t steps, double until)
{
    const bool there = run->scheme->family->adaptive && run->t >= reached_from(until);
    return run->status == GM_OK && run->steps < steps && !there;
}

enum gm_status gm_run_to(struct gm_run *run, int64_t steps, double until)
{
    while (gm_run_goes_on(run, steps, until)) {
        advance(run, steps - run->steps, reached_from(until));
    }
    return run->status;
}

enum gm_status gm_run_until(struct gm_run *run, double t)
{
    return gm_run_to(run, gm_run_steps_at(run, t), t);
}

void gm_run_set_step(struct gm_run *run, double dt)
{
    run->t0 = run->t;
    run->n = run->behind = 0;
    run->dt = dt;
    start(run);
}

void gm_run_set_state(struct gm_run *run, const double *y, const double *memory)
{
    memcpy(half(run, run->current), y, state_count(run) * sizeof(double));
    memset(half(run, run->current) + state_count(run), 0, carry_count(run) * sizeof(double));
    gm_run_set_step(run, run->dt);
    if (memory) {
        memcpy(half(run, run->current) + state_count(run) + carry_count(run), memory,
               memory_count(run) * sizeof(double));
    }
}

struct gm_run *gm_run_switch(const struct gm_run *run, const struct gm_scheme *scheme)
{
    struct gm_run *next =
        gm_run_open(run->problem, scheme, &run->settings, run->t, run->dt, gm_run_state(run));
    if (next) {
        next->limit = run->limit;
        next->looks_back = run->looks_back;
        next->steps = run->steps;
        next->evaluations = run->evaluations;
        next->solves = run->solves;
        next->factor_solves = run->factor_solves;
        next->own_steps = run->own_steps;
        next->rejected = run->rejected;
        next->iterations = run->iterations;
    }
    return next;
}

size_t gm_run_snapshot_size(const struct gm_run *run)
{
    return head_size() + run->half_size;
}

void gm_run_save(const struct gm_run *run, void *snapshot)
{
    memset(snapshot, 0, head_size()); /* no byte is left to chance: snapshots are written to files */
    memcpy(snapshot, run, sizeof *run);
    memcpy((char *)snapshot + head_size(), half(run, run->current), run->half_size);
}

static bool is_finite(const double *values, size_t count)
{
    bool finite = true;
    for (size_t i = 0; i < count; i++) {
        finite &= isfinite(values[i]) != 0;
    }
    return finite;
}

/* Returns true if the head of a snapshot is possible for a run with the start of this one. */
static bool is_possible(const struct gm_run *run, const struct gm_run *then)
{
    const struct gm_settings *settings = &run->settings, *other = &then->settings;
    const bool same = settings->compensated == other->compensated && settings->binding == other->binding &&
                      settings->tau0 == other->tau0 && settings->tolerance == other->tolerance;
    return same && then->half_size == run->half_size && (then->current == 0 || then->current == 1) &&
           then->n >= 0 && then->steps >= then->n && then->steps <= INT64_MAX / 4 &&
           strcmp(gm_status_name(then->status), gm_status_name((enum gm_status) - 1)) != 0 &&
           then->unsolved.obstacle <= GM_STILL_LARGE && isfinite(then->t0) && isfinite(then->dt) &&
           then->dt != 0 && isfinite(then->t) && then->limit > 0 &&
           (run->scheme->family->adaptive || then->t == then->t0 + (double)then->n * then->dt);
}

bool gm_run_load(struct gm_run *run, const void *snapshot)
{
    struct gm_run then;
    memcpy(&then, snapshot, sizeof then);
    if (!is_possible(run, &then)) {
        return false;
    }
    /* its pointers may belong to another run, or to an ended process */
    then.problem = run->problem;
    then.scheme = run->scheme;
    then.workspace = run->workspace;
    then.looks_back = run->looks_back;
    then.behind = run->behind = 0;
    /* into the half that is not in use, until it is known to be a state; tracers may be lost */
    const size_t active = (run->problem->n - 2 * run->problem->passive) * run->problem->m;
    double *state = half(run, 1 - run->current), *carry = state + state_count(run);
    memcpy(state, (const char *)snapshot + head_size(), run->half_size);
    if (!is_finite(state, active) || (carry_count(run) > 0 && !is_finite(carry, active)) ||
        !is_finite(carry + carry_count(run), memory_count(run))) {
        return false;
    }
    then.current = 1 - run->current;
    *run = then;
    if (run->workspace && run->scheme->family->workspace_reset) {
        run->scheme->family->workspace_reset(run->workspace);
    }
    return true;
}
