/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Measures error and cost of every scheme with every step. */
#include "app/grid/work.h"

#include <math.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/base/pool.h"
#include "app/native/engine.h"
#include "app/words/drive.h"
#include "core/basics.h"
#include "core/schemes.h"
#include "render/clock.h"

enum { REPEATS = 5 };

/* A measurement is repeated until it has taken so long, and given up when one run takes longer. */
static const double enough_seconds = 0.1, most_seconds = 4;

static struct gm_timing *timing_of(const struct gm_work_table *table)
{
    return table->request.lanes[0].parameters;
}

/* A lane of this scheme and step at its start. */
static struct gm_lane *open_lane(const struct gm_work_table *table, const struct gm_scheme *scheme, double dt,
                                 char *message)
{
    struct gm_timing *timing = timing_of(table);
    const double usual = timing->dt;
    timing->dt = dt; /* the lane takes a copy */
    struct gm_lane *lane =
        gm_lane_open(table->request.scene, timing, &table->request.lanes[0].settings, scheme, message);
    timing->dt = usual;
    if (lane) {
        gm_engine_meet(lane);
    }
    return lane;
}

static bool stopped(const struct gm_work_table *table)
{
    return gm_listener_stops(table->listener);
}

static bool goes_on(const struct gm_work_table *table, const struct gm_lane *lane, int64_t steps)
{
    return gm_run_goes_on(lane->run, steps, timing_of(table)->until) && !gm_lane_stopped(lane);
}

/* To the end, in bursts that answer an interruption; gives up after `most` seconds. Returns the processor
   time. A run that its scene may stop is followed in any case. */
static double run_through(const struct gm_work_table *table, struct gm_lane *lane, int64_t steps, bool follow,
                          double most)
{
    double spent = 0, each = 0;
    lane->unfollowed = !follow && !lane->scene->stop;
    while (goes_on(table, lane, steps) && spent < most && !stopped(table)) {
        spent += gm_lane_burst(lane, steps, timing_of(table)->until, &each);
    }
    return spent;
}

/* A run to the end that is not timed, which tells how far it is. */
static void run_reference(const struct gm_work_table *table, struct gm_lane *lane)
{
    const size_t all = table->scheme_count * table->step_count * table->resolution_count;
    const int64_t steps = gm_run_steps_at(lane->run, timing_of(table)->until);
    for (int percent = 0; percent < 100 && !stopped(table); percent++) {
        char what[32];
        snprintf(what, sizeof what, percent ? "reference, %d %%" : "reference", percent);
        gm_listener_hears(table->listener, what, 0, all);
        const double share = (percent + 1) / 100.;
        run_through(table, lane, percent < 99 ? (int64_t)(share * (double)steps) : steps, false, INFINITY);
    }
}

/* The state that solutions are measured against: the exact one, or that of a trusted run, for all steps of
   the ladder. NULL if there is none. */
static double *reference_state(struct gm_work_table *table, char *message)
{
    const struct gm_work *work = table->request.scene->work;
    const struct gm_scheme *trusted = work && work->reference ? gm_scheme_find(work->reference) : NULL;
    struct gm_lane *lane = open_lane(table, table->request.lanes[0].scheme, timing_of(table)->dt, message);
    if (!lane) {
        return NULL;
    }
    const size_t count = lane->problem.n * lane->problem.m;
    double *state = malloc(count * sizeof *state);
    const bool named = trusted != NULL;
    for (size_t i = 0; !named && i < gm_scheme_count(); i++) {
        const struct gm_scheme *scheme = gm_scheme_at(i);
        if (gm_scheme_fits(scheme, &lane->problem) && !scheme->family->adaptive && scheme->order >= 4) {
            trusted = trusted && trusted->order >= scheme->order ? trusted : scheme;
        }
    }
    if (state && lane->problem.exact) {
        snprintf(table->reference, sizeof table->reference, "the exact solution");
        lane->problem.exact->solution(&lane->problem, timing_of(table)->until, lane->start, state,
                                      lane->problem.m);
    } else if (state && trusted) {
        /* a quarter of the shortest step that halving the ladder a few times less gives: beyond, rounding
         * rules */
        const size_t middle = table->step_count > 3 ? table->step_count - 3 : table->step_count - 1;
        const double dt = table->steps[middle] / 4;
        snprintf(table->reference, sizeof table->reference, "a run of %s with a step of %.3g", trusted->name,
                 dt);
        table->trusted = trusted;
        table->reference_step = dt;
        gm_lane_close(lane);
        lane = open_lane(table, trusted, dt, message);
        if (lane) {
            /* the carried rounding errors are worth their price here */
            run_reference(table, lane);
        }
        if (!lane || lane->run->status != GM_OK || stopped(table)) {
            if (lane) {
                gm_refuse(message, "the reference, %s, failed: %s", table->reference,
                          gm_status_name(lane->run->status));
            }
            free(state);
            state = NULL;
        } else {
            memcpy(state, gm_run_state(lane->run), count * sizeof *state);
        }
    } else {
        free(state);
        state = NULL;
        gm_refuse(
            message,
            "there is nothing to compare with: neither an exact solution nor a scheme of order 4 or more to "
            "make a reference with; --measure KEY compares an observable of the scene instead");
    }
    gm_lane_close(lane);
    return state;
}

/* The run that errors are distances from, of a scene that measures these: at twice the finest resolution, with half the
   shortest step. False with a sentence. */
static bool run_finer(struct gm_work_table *table, char *message)
{
    const struct gm_work *work = table->request.scene->work;
    const struct gm_parameter *row = gm_scene_parameter(table->request.scene, work->resolution);
    const struct gm_scheme *trusted = gm_scheme_find(work->reference);
    void *self = timing_of(table);
    const double usual = gm_parameter_get(row, self),
                 finest = table->resolution ? table->resolutions[table->resolution_count - 1] : usual,
                 finer = table->smaller_is_finer ? finest / 2 : 2 * finest,
                 dt = table->steps[table->step_count - 1] / 2;
    snprintf(table->reference, sizeof table->reference, "a run of %s with a step of %.3g and %s=%.3g",
             trusted->name, dt, row->key, finer);
    table->trusted = trusted;
    table->reference_step = dt;
    gm_parameter_put(row, self, finer);
    table->finer = open_lane(table, trusted, dt, message);
    gm_parameter_put(row, self, usual);
    if (!table->finer) {
        return false;
    }
    run_reference(table, table->finer);
    return (table->finer->run->status == GM_OK && !stopped(table)) ||
           gm_refuse(message, "the reference, %s, failed: %s", table->reference,
                     gm_status_name(table->finer->run->status));
}

static double error_of(const struct gm_work_table *table, const struct gm_lane *lane, const double *reference)
{
    const struct gm_scene *scene = lane->scene;
    if (table->finer) {
        return scene->work->distance(lane, table->finer);
    }
    if (reference) {
        const double *state = gm_run_state(lane->run);
        double error = 0;
        for (size_t i = 0; i < lane->problem.n * lane->problem.m; i++) {
            const double difference = fabs(state[i] - reference[i]);
            error = gm_larger(error, difference);
        }
        return error;
    }
    const int observable = gm_scene_observable(scene, table->measure);
    return observable < 0 ? NAN : fabs(gm_lane_observe(lane, (size_t)observable));
}

/* The same of a scheme that chose its steps and ends behind `until`: the solution is taken on to where it ends. */
static double error_behind(const struct gm_work_table *table, const struct gm_lane *lane,
                           const double *reference)
{
    const struct gm_problem *problem = &lane->problem;
    const double until = timing_of(table)->until, gap = lane->run->t - until;
    const size_t count = problem->n * problem->m;
    double *state = malloc(count * sizeof *state), error = NAN;
    if (state && problem->exact) {
        problem->exact->solution(problem, lane->run->t, lane->start, state, problem->m);
        error = error_of(table, lane, state);
    } else if (state && gap > 0) {
        const int64_t steps = (int64_t)fmin(ceil(gap / table->reference_step), 1e5);
        const struct gm_settings settings = {.compensated = 1};
        struct gm_run *run =
            gm_run_open(problem, table->trusted, &settings, until, gap / (double)steps, reference);
        if (run && gm_run_advance(run, steps) == GM_OK) {
            error = error_of(table, lane, gm_run_state(run));
        }
        if (run) {
            gm_run_close(run);
        }
    } else if (state) {
        error = error_of(table, lane, reference);
    }
    free(state);
    return error;
}

/* Why the lane has no such number, where it says so. */
static void note_reason(const struct gm_work_table *table, const struct gm_lane *lane,
                        struct gm_work_line *line)
{
    const int observable = gm_scene_observable(table->request.scene, table->measure);
    const char *reason = observable < 0 ? NULL : gm_lane_missing(lane, (size_t)observable);
    snprintf(line->reason, sizeof line->reason, "%s", reason ? reason : "");
}

/* A line's scheme with one step. */
struct measuring {
    const struct gm_work_table *table;
    struct gm_work_line *line;
    const double *reference;
    struct gm_work_point *point;
    struct gm_lane *followed; /* NULL, or a lane at its start, for an observable that recalls the past */
    atomic_bool needless;     /* to follow it: the run does not come to its end */
    double recalled;          /* what it then says */
    bool opened;
    char *message;
};

/* Repeats the run, on a core of its own, and takes its end. */
static void time_runs(struct measuring *measuring)
{
    const struct gm_work_table *table = measuring->table;
    const bool adaptive = measuring->line->scheme->family->adaptive;
    const double *reference = measuring->reference;
    struct gm_work_point *point = measuring->point;
    double spent = 0;
    for (int repeat = 0; repeat < REPEATS && spent < enough_seconds && !stopped(table); repeat++) {
        struct gm_lane *lane = open_lane(table, measuring->line->scheme, point->dt, measuring->message);
        if (!lane) {
            measuring->opened = false;
            return;
        }
        const struct gm_run *run = lane->run;
        const int64_t steps = gm_run_steps_at(run, timing_of(table)->until);
        const double seconds = run_through(table, lane, steps, false, most_seconds);
        const bool whole = !goes_on(table, lane, steps);
        point->seconds = whole ? fmin(point->seconds, seconds) : point->seconds;
        spent += whole ? seconds : enough_seconds;
        if (repeat == 0) {
            point->status = run->status;
            point->t = run->t;
            point->steps = run->steps;
            point->evaluations = gm_run_per_member(run, run->evaluations);
            point->solves = gm_run_per_member(run, run->solves);
            if (run->status == GM_OK && whole && !stopped(table)) {
                point->error = reference && adaptive ? error_behind(table, lane, reference)
                                                     : error_of(table, lane, reference);
                if (!reference && isnan(point->error)) {
                    note_reason(table, lane, measuring->line);
                }
            }
        }
        gm_lane_close(lane);
        if (!isfinite(point->error)) {
            atomic_store(&measuring->needless, true);
        }
    }
}

/* Once more, looking on the way; beside the runs that are timed. */
static void follow_run(struct measuring *measuring)
{
    enum { SLICES = 100 };
    struct gm_lane *lane = measuring->followed;
    const int64_t steps = gm_run_steps_at(lane->run, timing_of(measuring->table)->until);
    for (int i = 1; i <= SLICES && !atomic_load(&measuring->needless); i++) {
        const int64_t slice = i < SLICES ? (int64_t)((double)steps * i / SLICES) : steps;
        run_through(measuring->table, lane, slice, true, INFINITY);
    }
    measuring->recalled = error_of(measuring->table, lane, NULL);
}

static void do_part(void *self, size_t index, size_t slot)
{
    (void)slot;
    if (index == 0) {
        time_runs(self);
    } else {
        follow_run(self);
    }
}

static bool took_part(void *self, size_t index, size_t slot)
{
    (void)self, (void)index, (void)slot;
    return true;
}

/* False with a sentence only if no lane could be opened. */
static bool measure_point(const struct gm_work_table *table, struct gm_work_line *line, double dt,
                          const double *reference, struct gm_work_point *point, char *message)
{
    struct measuring measuring = {.table = table,
                                  .line = line,
                                  .reference = reference,
                                  .point = point,
                                  .opened = true,
                                  .message = message};
    const bool follow = table->request.scene->follow > 0 && !reference;
    *point = (struct gm_work_point){.dt = dt, .error = NAN, .seconds = INFINITY};
    if (follow && !(measuring.followed = open_lane(table, line->scheme, dt, message))) {
        return false;
    }
    const size_t cores = gm_pool_cores();
    gm_pool_run(&(struct gm_pool){.count = follow ? 2 : 1,
                                  .jobs = cores < 2 ? 1 : 2,
                                  .window = 2,
                                  .work = do_part,
                                  .take = took_part,
                                  .self = &measuring});
    if (follow && point->status == GM_OK && isfinite(point->error)) {
        point->error = measuring.recalled;
    }
    gm_lane_close(measuring.followed);
    return measuring.opened;
}

/* Shorter steps than this are of no use: round-off rules, or it takes too long; or, where the resolution
   varies, the resolution rules. `count` points of this resolution were measured, the last ones of the
   line. */
static bool is_enough(const struct gm_work_table *table, const struct gm_work_line *line, size_t count)
{
    if (count < 2) {
        return false;
    }
    const struct gm_work_point *last = &line->points[line->count - 1], *before = last - 1;
    const bool resolved = table->resolution && fabs(last->error - before->error) < 0.03 * before->error;
    const bool round_off = last->error < 1e-9 && last->error > 0.7 * before->error;
    const bool long_enough = last->status == GM_OK && last->seconds > most_seconds / 3;
    return resolved || round_off || long_enough || !isfinite(last->seconds);
}

/* The step of a rung of the ladder, at the present resolution. */
static double step_of(const struct gm_work_table *table, size_t rung)
{
    struct gm_timing *timing = timing_of(table);
    if (!table->ratio) {
        return table->steps[rung];
    }
    char sentence[GM_MESSAGE];
    gm_parameter_put(table->ratio, timing, table->steps[rung]);
    table->request.scene->settle(timing, &table->ratio->key, 1, sentence);
    return timing->dt;
}

static void measure_line(struct gm_work_table *table, struct gm_work_line *line, const double *reference,
                         char *message)
{
    const size_t all = table->scheme_count * table->step_count * table->resolution_count;
    const size_t each = table->step_count * table->resolution_count;
    void *self = timing_of(table);
    for (size_t r = 0; r < table->resolution_count; r++) {
        const size_t first = line->count;
        if (table->resolution) {
            gm_parameter_put(table->resolution, self, table->resolutions[r]);
        }
        for (size_t k = 0; k < table->step_count && !is_enough(table, line, line->count - first); k++) {
            struct gm_work_point point;
            if (reference && line->scheme == table->trusted &&
                step_of(table, k) <= 1.01 * table->reference_step) {
                break; /* that is the run that the others are measured against */
            }
            gm_listener_hears(table->listener, line->scheme->name,
                              table->line_count * each - each + r * table->step_count + k, all);
            if (!measure_point(table, line, step_of(table, k), reference, &point, message)) {
                snprintf(line->reason, sizeof line->reason, "%s", message);
                return;
            }
            if (stopped(table)) {
                return;
            }
            point.resolution = table->resolution ? gm_work_resolution(table, table->resolutions[r]) : 0;
            line->points[line->count++] = point;
        }
    }
}

/* The best points by each cost, where resolution and step vary. Errors of both may cancel by chance: a point
   is credited with the largest error of its resolution at its step and all shorter ones. */
static bool choose_best(const struct gm_work_table *table, struct gm_work_line *line, char *message)
{
    if (!table->resolution) {
        return true;
    }
    struct gm_work_point *earned = calloc(line->count + 1, sizeof *earned);
    bool good = earned != NULL;
    for (size_t k = line->count; good && k-- > 0;) {
        earned[k] = line->points[k];
        if (k + 1 < line->count && earned[k + 1].resolution == earned[k].resolution &&
            earned[k + 1].error > earned[k].error) {
            earned[k].error = earned[k + 1].error;
        }
    }
    for (int cost = 0; good && cost < GM_COST_COUNT; cost++) {
        line->best[cost] = calloc(line->count + 1, sizeof *line->best[cost]);
        good = line->best[cost] != NULL;
        if (good) {
            line->best_count[cost] =
                gm_work_keep_best(earned, line->count, (enum gm_work_cost)cost, line->best[cost]);
        }
    }
    free(earned);
    return good || gm_refuse(message, "not enough memory");
}

bool gm_work_measure(struct gm_work_table *table, const struct gm_listener *listener, char *message)
{
    double *reference = NULL;
    table->listener = listener;
    const struct gm_work *work = table->request.scene->work;
    if (!table->observed && work && work->distance) {
        if (!run_finer(table, message)) {
            return false;
        }
    } else if (!table->observed) {
        reference = reference_state(table, message);
        if (!reference) {
            return false;
        }
    }
    bool good = true;
    size_t points = 0;
    for (size_t i = 0; i < table->scheme_count && good && !stopped(table); i++) {
        struct gm_work_line *line = &table->lines[table->line_count];
        *line = (struct gm_work_line){.scheme = table->schemes[i]};
        line->points = calloc(table->step_count * table->resolution_count, sizeof *line->points);
        if (!line->points) {
            good = gm_refuse(message, "not enough memory");
            break;
        }
        table->line_count++;
        measure_line(table, line, reference, message);
        points += line->count;
        good = choose_best(table, line, message);
    }
    free(reference);
    return good && points > 0;
}
