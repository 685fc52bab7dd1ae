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

/* The numbers of a state with its carry and the scheme's memory. */
static size_t whole_count(const struct gm_run *run)
{
    return state_count(run) + carry_count(run) + memory_count(run);
}

static size_t half_size(const struct gm_run *run)
{
    const size_t count = whole_count(run) + gm_events_memory(run->problem);
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
    return gm_scheme_has_memory(run->scheme) ? half(run, run->current) + state_count(run) + carry_count(run)
                                             : NULL;
}

static double *events_of(const struct gm_run *run, int which)
{
    return half(run, which) + whole_count(run);
}

const double *gm_run_events(const struct gm_run *run)
{
    return run->problem->events ? events_of(run, run->current) : NULL;
}

bool gm_scheme_locates_breaks(const struct gm_scheme *scheme)
{
    return gm_scheme_has_one_step(scheme) && scheme->order != 1;
}

bool gm_run_locates(const struct gm_run *run)
{
    return run->problem->events && run->problem->events->breaks > 0 && run->problem->m == 1 && !run->across &&
           gm_scheme_locates_breaks(run->scheme);
}

/* Opens the workspace for the present motion. */
static bool open_workspace(struct gm_run *run)
{
    if (run->workspace) {
        run->scheme->family->workspace_close(run->workspace);
    }
    if (run->problem->kind->prepare) {
        run->problem->kind->prepare(run->scheme, run->motion);
    }
    return gm_scheme_workspace_open(run->scheme, run->motion, &run->workspace);
}

/* gm_event_step.motion: the run makes steps of it from now on */
static const struct gm_problem *take_motion(void *data, const double *modes)
{
    struct gm_run *run = data;
    const struct gm_problem *before = run->motion,
                            *now = gm_run_locates(run)
                                       ? run->problem->events->freeze(run->problem, &run->frozen, modes)
                                       : run->problem;
    if (now && now != before) {
        run->motion = now;
        if (!open_workspace(run)) {
            gm_memory_refused();
            run->workspace = NULL;
            run->motion = run->problem;
            return NULL;
        }
    }
    return now;
}

const struct gm_problem *gm_run_motion(struct gm_run *run)
{
    const double *memory = gm_run_events(run);
    return memory ? take_motion(run, gm_events_modes(run->problem, memory)) : run->problem;
}

/* Sets the task from a state with all that belongs to it, in the run's block or of that layout, to another one. It is set
   in place, since a copy waits for the words that were just written. */
static void set_task(struct gm_task *task, const struct gm_run *run, const double *y, double *out,
                     int64_t steps)
{
    const size_t count = state_count(run), carried = carry_count(run);
    const bool remembers = run->scheme->family->memory != NULL;
    *task = (struct gm_task){
        .problem = run->motion,
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
        .trace = run->trace,
        .t0 = run->t0,
        .n = run->n,
        .workspace = run->workspace,
        .settings = &run->settings,
    };
}

/* The state is not the one after the last step. */
static void reset_workspace(const struct gm_run *run)
{
    if (run->workspace && run->scheme->family->workspace_reset) {
        run->scheme->family->workspace_reset(run->workspace);
    }
}

static void count_progress(struct gm_run *run, const struct gm_progress *progress)
{
    run->evaluations += progress->evaluations;
    run->solves += progress->solves;
    run->factor_solves += progress->factor_solves;
    run->own_steps += progress->own_steps;
    run->rejected += progress->rejected;
    run->iterations += progress->iterations;
}

/* Sets the task of a part of a step. */
static void set_part(struct gm_task *task, const struct gm_run *run, const double *from, double t, double dt,
                     double *to)
{
    set_task(task, run, from, to, 1);
    task->t = task->t0 = t;
    task->n = 0;
    task->dt = dt;
    task->steps_before = run->steps - 1;
}

/* Makes a part of a step, which changes the run only if it is counted; gm_event_step.part */
static double make_part(void *data, const double *from, double t, double dt, double *to, bool counted)
{
    struct gm_run *run = data;
    const unsigned long refusals = gm_memory_refusals();
    if (!gm_run_motion(run)) {
        return NAN;
    }
    struct gm_task task;
    set_part(&task, run, from, t, dt, to);
    reset_workspace(run);
    const struct gm_progress progress = gm_scheme_loop(run->scheme, run->motion)(&task);
    if (counted) {
        count_progress(run, &progress);
        run->status = progress.status;
        run->unsolved = progress.unsolved;
    }
    const bool made = progress.done == 1 && gm_memory_refusals() == refusals;
    return !made ? NAN : run->scheme->family->adaptive ? progress.t : t + dt;
}

/* gm_event_step.restart */
static bool restart(void *data, double t, double *state)
{
    struct gm_run *run = data;
    struct gm_task task;
    set_part(&task, run, state, t, run->dt, state);
    run->status = run->scheme->family->start ? run->scheme->family->start(&task) : GM_OK;
    return run->status == GM_OK;
}

/* The current state, as a step without length that events may be in. */
static struct gm_event_step event_step(struct gm_run *run)
{
    const size_t apart = run->half_size / sizeof(double);
    double *state = half(run, run->current);
    return (struct gm_event_step){.problem = run->problem,
                                  .t = run->t,
                                  .dt = run->dt,
                                  .end_time = run->t,
                                  .varies = run->scheme->family->adaptive,
                                  .ends = run->ends,
                                  .locates = gm_run_locates(run),
                                  .size = whole_count(run),
                                  .state = state_count(run),
                                  .begin = state,
                                  .end = state,
                                  .memory = events_of(run, run->current),
                                  .from = run->event_scratch,
                                  .to = run->event_scratch + apart,
                                  .scratch = run->event_scratch + 2 * apart,
                                  .part = make_part,
                                  .restart = restart,
                                  .motion = take_motion,
                                  .data = run,
                                  .witness = run->witness,
                                  .turned = SIZE_MAX};
}

/* Lets breaks wait in the current state; `first`: all events. */
static void arm(struct gm_run *run, bool first)
{
    if (run->problem->events) {
        struct gm_event_step step = event_step(run);
        step.first = first;
        gm_events_arm(&step);
    }
}

/* Lets the scheme fill its memory from the current state. */
static void start(struct gm_run *run)
{
    if (run->scheme->family->start && run->status == GM_OK) {
        struct gm_task task;
        set_task(&task, run, half(run, run->current), half(run, run->current), 0);
        const unsigned long refusals = gm_memory_refusals();
        run->status = run->scheme->family->start(&task);
        if (gm_memory_refusals() != refusals) {
            run->status = GM_OUT_OF_MEMORY;
        }
    }
}

/* Takes the scratch of events. */
static bool open_events(struct gm_run *run)
{
    const size_t trace = GM_EVENTS_TOGETHER * (state_count(run) + 1),
                 size = 2 * run->half_size + (gm_events_scratch(run->problem) + trace) * sizeof(double);
    run->looks_back = true;
    run->event_scratch = aligned_alloc(ALIGNMENT, (size + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT);
    return run->event_scratch != NULL;
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
    head.motion = problem;
    head.turned = SIZE_MAX;
    if (!open_workspace(&head)) {
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
    if (problem->events && open_events(run)) {
        arm(run, true);
    }
    start(run);
    if (gm_memory_refusals() != refusals) {
        gm_run_close(run);
        return NULL;
    }
    return run;
}

void gm_run_close(void *data)
{
    struct gm_run *run = data;
    if (run && run->workspace) {
        run->scheme->family->workspace_close(run->workspace);
    }
    if (run) {
        free(run->event_scratch);
    }
    if (run && run->frozen) {
        run->problem->events->melt(run->frozen);
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
    struct gm_task task;
    set_task(&task, run, half(run, 1 - run->current), half(run, run->current), run->behind);
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

/* Takes steps that a loop has made, from one half of the block to the other or in place. */
static void take_steps(struct gm_run *run, const struct gm_progress *progress, bool in_place)
{
    count_progress(run, progress);
    run->t_behind = run->t;
    if (run->problem->events && !in_place) {
        memcpy(events_of(run, 1 - run->current), events_of(run, run->current),
               gm_events_memory(run->problem) * sizeof(double));
    }
    run->current = in_place ? run->current : 1 - run->current;
    run->behind += progress->done;
    run->n += progress->done;
    run->steps += progress->done;
    run->t = run->scheme->family->adaptive ? progress->t : run->t0 + (double)run->n * run->dt;
}

/* Makes steps, whatever happens in them; if it watches, only those before the first that reaches a break or fails. */
static enum gm_status make_steps(struct gm_run *run, int64_t steps, double until, bool watches)
{
    if (run->status != GM_OK || steps <= 0) {
        return run->status;
    }
    const struct gm_family *family = run->scheme->family;
    if (!gm_run_motion(run)) {
        return run->status = GM_OUT_OF_MEMORY;
    }
    gm_loop *loop = gm_scheme_loop(run->scheme, run->motion);
    const bool in_place = is_in_place(run, loop, steps);
    struct gm_task task;
    set_task(&task, run, half(run, run->current), half(run, in_place ? run->current : 1 - run->current),
             steps);
    task.until = until;
    task.watches = watches;
    run->behind = in_place ? run->behind : 0;
    const unsigned long refusals = gm_memory_refusals();
    struct gm_progress progress = loop(&task);
    if (in_place && progress.done < steps) {
        task = task_again(run);
        loop(&task);
        run->behind = 0;
        return make_steps(run, steps, until, false);
    }
    if (gm_memory_refusals() != refusals) {
        /* a result without enough memory, in factors or in a solution, is not valid */
        return run->status = GM_OUT_OF_MEMORY;
    }
    if (watches && progress.done == 0) {
        return GM_OK;
    }
    if (progress.done < steps && !watches && !(family->adaptive && progress.status == GM_OK)) {
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
    take_steps(run, &progress, in_place);
    run->traced = progress.traced;
    return run->status;
}

/* ---- events ---- */

/* Looks for events in the step that was just made, of length dt. */
static void pass_events(struct gm_run *run, double dt)
{
    const int before = 1 - run->current;
    struct gm_event_step step = event_step(run);
    step.t = step.varies ? run->t_behind : run->t0 + (double)(run->n - 1) * run->dt;
    step.dt = dt;
    step.begin = half(run, before);
    step.first = run->steps == 1;
    run->behind = 0; /* a step in parts is not repeated */
    const unsigned long refusals = gm_memory_refusals();
    enum gm_event_outcome outcome = gm_events_pass(&step);
    const bool refused = gm_memory_refusals() != refusals;
    outcome = refused ? GM_EVENTS_FAILED : outcome;
    run->turned = outcome > GM_EVENTS_FAILED ? step.turned : run->turned;
    run->turned_at = step.turned_at;
    if (step.parts) {
        reset_workspace(run);
    }
    if (outcome >= GM_EVENTS_FAILED && outcome <= GM_EVENTS_NO_TANGENT) {
        run->status = refused                           ? GM_OUT_OF_MEMORY
                      : outcome == GM_EVENTS_NO_VALUE   ? GM_BLOW_UP
                      : outcome == GM_EVENTS_NO_TANGENT ? GM_NO_TANGENT
                      : run->status == GM_OK            ? GM_NO_CONVERGENCE
                                                        : run->status;
        run->current = before;
        run->n--;
        run->steps--;
        run->t = step.t;
    } else if (outcome == GM_EVENTS_NONE) {
        run->behind = 1;
    } else if (outcome == GM_EVENTS_HAPPENED) {
        run->t = step.varies ? step.reached : run->t;
    } else {
        run->stopped = outcome == GM_EVENTS_ENDED;
        run->status = outcome == GM_EVENTS_MANY    ? GM_EVENTS_ACCUMULATE
                      : outcome == GM_EVENTS_SLIDE ? GM_SLIDING
                                                   : run->status;
        run->t = run->t0 = step.reached;
        run->n = 0;
    }
}

/* Makes up to `steps` steps of a scheme that repeats steps, before the first in which an event may happen, or that fails:
   some together, if the scheme's loop traces them, and those up to it again. */
static void make_steps_before_events(struct gm_run *run, int64_t steps)
{
    const unsigned long refusals = gm_memory_refusals();
    if (!gm_run_motion(run)) {
        return;
    }
    gm_loop *loop = gm_scheme_loop(run->scheme, run->motion);
    double *trace = event_step(run).scratch + gm_events_scratch(run->problem),
           *times = trace + GM_EVENTS_TOGETHER * state_count(run);
    int64_t made = 0, together = 1; /* the first step shows if the loop traces */
    while (made < steps) {
        const int64_t left = steps - made;
        struct gm_task task;
        set_task(&task, run, half(run, run->current), half(run, 1 - run->current),
                 left < together ? left : together);
        task.trace = run->problem->m == 1 && run->problem->passive == 0 ? trace : NULL;
        const struct gm_progress progress = loop(&task);
        for (int64_t k = 0; k < progress.done; k++) {
            times[k] = run->t0 + (double)(run->n + k + 1) * run->dt;
        }
        const struct gm_event_step step = event_step(run);
        const int64_t done = gm_events_near(&step, progress.traced ? trace : task.out, times, progress.done);
        const bool refused = gm_memory_refusals() != refusals;
        run->behind = 0;
        if (done < task.steps || refused) {
            reset_workspace(run);
            make_steps(run, refused ? 0 : done, INFINITY, false);
            return;
        }
        take_steps(run, &progress, false);
        made += done;
        /* at most a third of the steps are made in vain where events are close */
        together = progress.traced ? (int64_t)fmin(1 + (double)made / 2, GM_EVENTS_TOGETHER) : 1;
    }
}

/* Returns true if the scheme's loop ends before a step that reaches a break. */
static bool loop_watches(struct gm_run *run)
{
    const struct gm_problem *motion = gm_run_motion(run);
    return motion && gm_scheme_loop(run->scheme, motion) != run->scheme->family->loop &&
           run->problem->events->watches(motion);
}

/* Makes a step across its breaks: beyond a switch a frozen formula may have no value, as sqrt(x) of if(x > 0, sqrt(x), 0).
   Returns false if that fails too, with the status of the frozen one. */
static bool step_across(struct gm_run *run)
{
    const enum gm_status failed = run->status;
    run->status = GM_OK;
    run->across = true;
    const bool made = make_steps(run, 1, INFINITY, false) == GM_OK;
    if (made) {
        pass_events(run, run->dt);
    }
    run->across = false;
    run->status = made || run->status == GM_OUT_OF_MEMORY ? run->status : failed;
    if (made && run->status == GM_OK) {
        arm(run, false);
    }
    return made;
}

/* An end that is missed by round-off is reached. */
static double reached_from(double until)
{
    return isfinite(until) ? until - 1e-12 * fabs(until) : until;
}

/* The last step of an adaptive scheme, from one half of the block to the other. */
struct last_step {
    struct gm_run *run;
    int from;
    double until, t; /* t: of the end */
};

/* Makes the step with a fraction of dt; returns the time from `until` to its end, NaN if it fails. */
static double time_beyond(void *data, double fraction)
{
    struct last_step *last = data;
    struct gm_run *run = last->run;
    last->t = make_part(run, half(run, last->from), run->t_behind, fraction * run->dt,
                        half(run, 1 - last->from), false);
    return last->t - last->until;
}

/* Ends a run at `until`, which its last step has passed, if that step becomes shorter with dt. Returns the dt of that
   step. */
static double end_at(struct gm_run *run, double until)
{
    /* times that the scheme itself computes have its rounding errors */
    const double reach = 1e-12 * fmax(fabs(until), fabs(run->dt));
    struct last_step last = {.run = run, .from = 1 - run->current, .until = until};
    if (run->behind < 1 || run->problem->m > 1 || run->status != GM_OK || !(run->t > until + reach)) {
        return run->dt;
    }
    const unsigned long refusals = gm_memory_refusals();
    if (run->behind > 1) { /* the other half is more than one step behind */
        struct gm_task task = task_again(run);
        task.steps--;
        task.t = run->t_behind;
        run->t_behind = gm_scheme_loop(run->scheme, run->motion)(&task).t;
        last.from = run->current;
    }
    double s = gm_zero_beyond(time_beyond, &last, 0, run->t_behind - until, run->t - until);
    if (isnan(s) || !(fabs(time_beyond(&last, s)) <= reach)) {
        time_beyond(&last, s = 1); /* the whole step, as before */
    } else {
        last.t = until;
    }
    run->current = 1 - last.from;
    run->behind = 1;
    run->t = last.t;
    reset_workspace(run);
    if (gm_memory_refusals() != refusals) { /* no step of these trials is valid */
        run->status = GM_OUT_OF_MEMORY;
        run->current = last.from;
        run->t = run->t_behind;
        run->n--;
        run->steps--;
        run->behind = 0;
    }
    return s * run->dt;
}

static enum gm_status advance(struct gm_run *run, int64_t steps, double until)
{
    const struct gm_events *events = run->problem->events;
    const bool watched = events && (events->changes || (run->ends && events->ends_runs)),
               locates = gm_run_locates(run), adaptive = run->scheme->family->adaptive;
    const double reached = reached_from(until);
    if (!watched && !locates) {
        return make_steps(run, steps, reached, false);
    }
    const bool repeats = gm_scheme_repeats_steps(run->scheme);
    while (steps > 0 && run->status == GM_OK && !run->stopped && !(adaptive && run->t >= reached)) {
        const int64_t first = run->steps;
        if (!watched && loop_watches(run)) {
            make_steps(run, steps, reached, true);
        } else if (repeats) {
            make_steps_before_events(run, steps);
        }
        steps -= run->steps - first;
        if (steps == 0 || run->status != GM_OK) {
            break;
        }
        const int64_t before = run->steps;
        if (make_steps(run, 1, reached, false) == GM_OK && run->steps > before) {
            pass_events(run, adaptive && run->shortens ? end_at(run, until) : run->dt);
        } else if (!locates || run->status == GM_OUT_OF_MEMORY || !step_across(run)) {
            break;
        }
        steps--;
    }
    return run->status;
}

enum gm_status gm_run_advance(struct gm_run *run, int64_t steps)
{
    return advance(run, steps, INFINITY);
}

bool gm_run_repeats(const struct gm_run *run)
{
    return run->status == GM_OK && run->n > 0 && run->behind == 1 && gm_scheme_repeats_steps(run->scheme);
}

const double *gm_run_before(const struct gm_run *run)
{
    return half(run, 1 - run->current);
}

bool gm_run_part(const struct gm_run *run, const double *from, double t, double fraction, double *y)
{
    return !isnan(make_part((void *)run, from, t, fraction * run->dt, y, false));
}

bool gm_run_is_traced(const struct gm_run *run)
{
    return run->problem->m == 1 && run->problem->passive == 0 && !run->problem->events &&
           carry_count(run) == 0 && gm_scheme_has_one_step(run->scheme);
}

void gm_run_trace(struct gm_run *run, int64_t steps, struct gm_trace *trace)
{
    const size_t n = run->problem->n;
    const int64_t most = steps < trace->room ? steps : trace->room, before = run->steps;
    memcpy(trace->states, gm_run_state(run), n * sizeof(double));
    trace->times[0] = run->t;
    trace->count = 0;
    run->traced = false;
    /* the first step shows if the scheme's loop traces */
    while (trace->count < most && run->status == GM_OK) {
        run->trace = trace->states + (size_t)(trace->count + 1) * n;
        make_steps(run, run->traced ? most - trace->count : 1, INFINITY, false);
        if (!run->traced && run->steps - before > trace->count) {
            memcpy(run->trace, gm_run_state(run), n * sizeof(double));
        }
        trace->count = run->steps - before;
    }
    run->trace = NULL;
    run->traced = false; /* snapshots do not show how steps were made */
    for (int64_t k = 1; k <= trace->count; k++) {
        trace->times[k] = run->t0 + (double)(run->n - trace->count + k) * run->dt;
    }
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

bool gm_run_goes_on(const struct gm_run *run, int64_t steps, double until)
{
    const bool there = run->scheme->family->adaptive && run->t >= reached_from(until);
    return run->status == GM_OK && !run->stopped && run->steps < steps && !there;
}

enum gm_status gm_run_to(struct gm_run *run, int64_t steps, double until)
{
    while (gm_run_goes_on(run, steps, until)) {
        advance(run, steps - run->steps, until);
    }
    if (run->shortens && run->scheme->family->adaptive) {
        end_at(run, until);
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
    run->stopped = 0;
    arm(run, true);
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
        next->ends = run->ends;
        next->shortens = run->shortens;
        next->witness = run->witness;
        next->stopped = run->stopped;
        memcpy(events_of(next, 0), events_of(run, run->current),
               gm_events_memory(run->problem) * sizeof(double));
        if (gm_run_locates(next) && !gm_run_locates(run)) {
            arm(next, true); /* sides of breaks were not followed */
        }
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
           then->unsolved.obstacle <= GM_STAYS_OFF && then->unsolved.invariant >= 0 && isfinite(then->t0) &&
           isfinite(then->dt) && then->dt != 0 && isfinite(then->t) && then->limit > 0 &&
           (then->stopped & ~1) == 0 &&
           (then->status != GM_SLIDING ||
            (run->problem->events && then->turned < run->problem->events->count &&
             then->turned >= run->problem->events->written)) &&
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
    then.ends = run->ends;
    then.shortens = run->shortens;
    then.witness = run->witness;
    then.trace = run->trace;
    then.across = false;
    then.event_scratch = run->event_scratch;
    then.motion = run->motion;
    then.frozen = run->frozen;
    then.behind = run->behind = 0;
    /* into the half that is not in use, until it is known to be a state; tracers may be lost */
    const size_t active = (run->problem->n - 2 * run->problem->passive) * run->problem->m;
    double *state = half(run, 1 - run->current), *carry = state + state_count(run);
    memcpy(state, (const char *)snapshot + head_size(), run->half_size);
    if (!is_finite(state, active) || (carry_count(run) > 0 && !is_finite(carry, active)) ||
        !is_finite(carry + carry_count(run), memory_count(run) + gm_events_memory(run->problem))) {
        return false;
    }
    then.current = 1 - run->current;
    *run = then;
    reset_workspace(run);
    return true;
}
