/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Measures error and cost of every scheme with every step. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/grid/hooks.h"
#include "app/grid/judge.h"
#include "core/basics.h"
#include "core/schemes.h"

enum { REPEATS = 5 };

/* A measurement is repeated until it has taken so long, and given up when one run takes longer. */
static const double enough_seconds = 0.1, most_seconds = 4;

/* ---- the reference ---- */

/* A run to the end that is not timed, which reports how far it is; false with a sentence if it fails. */
static bool run_reference(const struct gm_grid *grid, struct gm_lane *lane, char *message)
{
    const int64_t steps = gm_run_steps_at(lane->run, gm_grid_timing(grid)->until);
    lane->unfollowed = !lane->scene->stop;
    for (int percent = 0; percent < 100 && !gm_listener_stops(grid->listener); percent++) {
        char what[32];
        snprintf(what, sizeof what, percent ? "reference, %d %%" : "reference", percent);
        gm_listener_hears(grid->listener, what, 0, gm_grid_cells(grid));
        const double share = (percent + 1) / 100.;
        /* the carried rounding errors are worth their price here */
        gm_grid_advance(grid, lane, percent < 99 ? (int64_t)(share * (double)steps) : steps, INFINITY);
    }
    return (lane->run->status == GM_OK && !gm_listener_stops(grid->listener)) ||
           gm_refuse(message, "the reference, %s, failed: %s", grid->reference,
                     gm_status_name(lane->run->status));
}

/* A lane of the trusted scheme at its start, with another value of a parameter where `row` is not NULL. */
static struct gm_lane *open_reference(const struct gm_grid *grid, const struct gm_parameter *row,
                                      double value, char *message)
{
    const struct gm_lane_spec *spec = &grid->request.lanes[0];
    struct gm_timing *timing = gm_parameters_copy(grid->request.scene, spec->parameters);
    if (timing && row) {
        gm_parameter_put(row, timing, value);
    }
    if (timing) {
        timing->dt = grid->reference_step;
    }
    return gm_grid_start(grid, spec, timing, grid->trusted, message);
}

/* The run that errors are distances from, of a scene that measures these: at twice the finest resolution, with half the
   shortest step. */
static bool run_finer(struct gm_grid *grid, char *message)
{
    const struct gm_work *work = grid->request.scene->work;
    const struct gm_parameter *row = gm_scene_parameter(grid->request.scene, work->resolution);
    const double finest = grid->parameter ? grid->values.values[grid->values.count - 1]
                                          : gm_parameter_get(row, gm_grid_timing(grid)),
                 finer = grid->smaller_is_finer ? finest / 2 : 2 * finest;
    grid->trusted = gm_scheme_find(work->reference);
    grid->reference_step = grid->steps.values[grid->steps.count - 1] / 2;
    snprintf(grid->reference, sizeof grid->reference, "a run of %s with a step of %.3g and %s=%.3g",
             grid->trusted->name, grid->reference_step, row->key, finer);
    grid->finer = open_reference(grid, row, finer, message);
    return grid->finer && run_reference(grid, grid->finer, message);
}

/* The scheme of the reference run: the plan's, or that of the highest order which fits; NULL: there is none. */
static const struct gm_scheme *trusted_of(const struct gm_grid *grid, const struct gm_problem *problem)
{
    const struct gm_work *work = grid->request.scene->work;
    const struct gm_scheme *trusted = work && work->reference ? gm_scheme_find(work->reference) : NULL;
    const bool named = trusted != NULL;
    for (size_t i = 0; !named && i < gm_scheme_count(); i++) {
        const struct gm_scheme *scheme = gm_scheme_at(i);
        if (gm_scheme_fits(scheme, problem) && !scheme->family->adaptive && scheme->order >= 4) {
            trusted = trusted && trusted->order >= scheme->order ? trusted : scheme;
        }
    }
    return trusted;
}

/* The state that solutions are measured against: the exact one, or that of a trusted run, for all steps of the
   ladder; `lane` is at its start. */
static bool find_solution(struct gm_grid *grid, const struct gm_lane *lane, char *message)
{
    const struct gm_problem *problem = &lane->problem;
    const size_t count = problem->n * problem->m;
    grid->solution = malloc(count * sizeof *grid->solution);
    if (!grid->solution) {
        return gm_refuse(message, "not enough memory");
    }
    if (problem->exact) {
        snprintf(grid->reference, sizeof grid->reference, "the exact solution");
        problem->exact->solution(problem, gm_grid_timing(grid)->until, lane->start, grid->solution,
                                 problem->m);
        return true;
    }
    grid->trusted = trusted_of(grid, problem);
    if (!grid->trusted) {
        return gm_refuse(
            message,
            "there is nothing to compare with: neither an exact solution nor a scheme of order 4 or more to "
            "make a reference with; --measure KEY compares an observable of the scene instead");
    }
    /* a quarter of the shortest step that halving the ladder a few times less gives: beyond, rounding rules */
    const size_t middle = grid->steps.count > 3 ? grid->steps.count - 3 : grid->steps.count - 1;
    grid->reference_step = grid->steps.values[middle] / 4;
    snprintf(grid->reference, sizeof grid->reference, "a run of %s with a step of %.3g", grid->trusted->name,
             grid->reference_step);
    struct gm_lane *run = open_reference(grid, NULL, 0, message);
    const bool good = run && run_reference(grid, run, message);
    if (good) {
        memcpy(grid->solution, gm_run_state(run->run), count * sizeof *grid->solution);
    }
    gm_lane_close(run);
    return good;
}

bool gm_work_prepare(struct gm_grid *grid, char *message)
{
    const struct gm_work *work = grid->request.scene->work;
    if (grid->observed) {
        return true;
    }
    if (work && work->distance) {
        return run_finer(grid, message);
    }
    struct gm_lane *lane = gm_request_open_lane(&grid->request, 0, message);
    const bool good = lane && find_solution(grid, lane, message);
    gm_lane_close(lane);
    return good;
}

/* ---- cells ---- */

static double error_of(const struct gm_grid *grid, const struct gm_lane *lane, const double *solution)
{
    const struct gm_scene *scene = lane->scene;
    if (grid->finer) {
        return scene->work->distance(lane, grid->finer);
    }
    if (solution) {
        const double *state = gm_run_state(lane->run);
        double error = 0;
        for (size_t i = 0; i < lane->problem.n * lane->problem.m; i++) {
            const double difference = fabs(state[i] - solution[i]);
            error = gm_larger(error, difference);
        }
        return error;
    }
    const int observable = gm_scene_observable(scene, grid->measure);
    return observable < 0 ? NAN : fabs(gm_lane_observe(lane, (size_t)observable));
}

/* The same of a scheme that chose its steps and ends behind `until`: the solution is taken on to where it ends. */
static double error_behind(const struct gm_grid *grid, const struct gm_lane *lane)
{
    const struct gm_problem *problem = &lane->problem;
    const double until = gm_grid_timing(grid)->until, gap = lane->run->t - until;
    double *state = malloc(problem->n * problem->m * sizeof *state), error = NAN;
    if (state && problem->exact) {
        problem->exact->solution(problem, lane->run->t, lane->start, state, problem->m);
        error = error_of(grid, lane, state);
    } else if (state && gap > 0) {
        const int64_t steps = (int64_t)fmin(ceil(gap / grid->reference_step), 1e5);
        const struct gm_settings settings = {.compensated = 1};
        struct gm_run *run =
            gm_run_open(problem, grid->trusted, &settings, until, gap / (double)steps, grid->solution);
        if (run && gm_run_advance(run, steps) == GM_OK) {
            error = error_of(grid, lane, gm_run_state(run));
        }
        if (run) {
            gm_run_close(run);
        }
    } else if (state) {
        error = error_of(grid, lane, grid->solution);
    }
    free(state);
    return error;
}

/* Why the lane has no such number, where it says so. */
static void note_reason(const struct gm_grid *grid, const struct gm_lane *lane, char *message)
{
    const int observable = gm_scene_observable(lane->scene, grid->measure);
    const char *reason = observable < 0 ? NULL : gm_lane_missing(lane, (size_t)observable);
    gm_refuse(message, "%s", reason ? reason : "");
}

/* Makes and times a run; returns the time, INFINITY where it was given up. A run that its scene may stop is followed in
   any case. */
static double time_run(const struct gm_grid *grid, struct gm_lane *lane)
{
    const int64_t steps = gm_run_steps_at(lane->run, gm_grid_timing(grid)->until);
    lane->unfollowed = !lane->scene->stop;
    const double seconds = gm_grid_advance(grid, lane, steps, most_seconds);
    return gm_grid_goes_on(grid, lane, steps) ? INFINITY : seconds;
}

/* Once more, looking on the way, for an observable that recalls the past. Returns what it then says. */
static double follow(const struct gm_grid *grid, const struct gm_scheme *scheme, struct gm_grid_cell *cell,
                     char *message)
{
    enum { SLICES = 100 };
    struct gm_lane *lane = gm_grid_open_lane(grid, scheme, cell, message);
    const int64_t steps = lane ? gm_run_steps_at(lane->run, gm_grid_timing(grid)->until) : 0;
    for (int i = 1; lane && i <= SLICES; i++) {
        gm_grid_advance(grid, lane, i < SLICES ? (int64_t)((double)steps * i / SLICES) : steps, INFINITY);
    }
    const double error = lane ? error_of(grid, lane, NULL) : NAN;
    gm_lane_close(lane);
    return error;
}

void gm_work_run(const struct gm_grid *grid, struct gm_lane *lane, struct gm_grid_cell *cell, char *message)
{
    const struct gm_scheme *scheme = lane->scheme;
    if (grid->solution && scheme == grid->trusted && cell->dt <= 1.01 * grid->reference_step) {
        cell->tried = false; /* that is the run that the others are measured against */
        return;
    }
    double spent = cell->seconds = time_run(grid, lane);
    gm_grid_take_end(lane, cell);
    cell->error = NAN;
    if (cell->status == GM_OK && isfinite(spent)) {
        cell->error = grid->solution && scheme->family->adaptive ? error_behind(grid, lane)
                                                                 : error_of(grid, lane, grid->solution);
        if (!grid->solution && isnan(cell->error)) {
            note_reason(grid, lane, message);
        }
    }
    for (int repeat = 1; repeat < REPEATS && spent < enough_seconds && !gm_listener_stops(grid->listener);
         repeat++) {
        struct gm_lane *again = gm_grid_open_lane(grid, scheme, cell, message);
        const double seconds = again ? time_run(grid, again) : INFINITY;
        gm_lane_close(again);
        cell->seconds = fmin(cell->seconds, seconds);
        spent += seconds;
    }
    if (grid->request.scene->follow > 0 && !grid->solution && isfinite(cell->error)) {
        cell->error = follow(grid, scheme, cell, message);
    }
}

/* Shorter steps than this are of no use: round-off rules, or it takes too long; or, where the resolution
   varies, the resolution rules. */
static bool is_enough(const struct gm_grid *grid, const struct gm_grid_cell *last)
{
    const struct gm_grid_cell *before = last - 1;
    const bool resolved = grid->parameter && fabs(last->error - before->error) < 0.03 * before->error;
    const bool round_off = last->error < 1e-9 && last->error > 0.7 * before->error;
    const bool long_enough = last->status == GM_OK && last->seconds > most_seconds / 3;
    return resolved || round_off || long_enough || !isfinite(last->seconds);
}

bool gm_work_is_needless(const struct gm_grid *grid, const struct gm_grid_line *line, size_t cell)
{
    const struct gm_grid_cell *last = &line->cells[cell] - 1;
    const size_t before = cell % grid->steps.count; /* of the same resolution */
    return line->ended || (before > 0 && !last->tried) || (before > 1 && is_enough(grid, last));
}
