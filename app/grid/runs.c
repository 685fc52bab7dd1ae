/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The runs of a grid, cell by cell on all cores; where they are timed, one after the other. */
#include "app/grid/hooks.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/base/pool.h"
#include "app/grid/judge.h"
#include "app/native/engine.h"
#include "app/words/drive.h"

struct gm_lane *gm_grid_start(const struct gm_grid *grid, const struct gm_lane_spec *spec,
                              struct gm_timing *parameters, const struct gm_scheme *scheme, char *message)
{
    struct gm_lane *lane =
        parameters ? gm_lane_open(grid->request.scene, parameters, &spec->settings, scheme, message) : NULL;
    if (lane) {
        gm_engine_meet(lane);
    } else if (!parameters) {
        gm_refuse(message, "not enough memory");
    }
    free(parameters);
    return lane;
}

struct gm_lane *gm_grid_open_lane(const struct gm_grid *grid, const struct gm_scheme *scheme,
                                  struct gm_grid_cell *cell, char *message)
{
    char contradiction[GM_MESSAGE];
    const struct gm_scene *scene = grid->request.scene;
    struct gm_timing *timing = gm_parameters_copy(scene, cell->spec->parameters);
    if (timing && grid->parameter) {
        gm_parameter_put(grid->parameter, timing, cell->value);
    }
    if (timing && grid->ratio) {
        gm_parameter_put(grid->ratio, timing, cell->step);
        scene->settle(timing, &grid->ratio->key, 1, contradiction);
    } else if (timing) {
        timing->dt = cell->step * (grid->plan ? grid->plan->unit(timing) : 1);
    }
    cell->dt = timing ? timing->dt : 0;
    return gm_grid_start(grid, cell->spec, timing, scheme, message);
}

bool gm_grid_goes_on(const struct gm_grid *grid, const struct gm_lane *lane, int64_t steps)
{
    const double until = ((const struct gm_timing *)lane->parameters)->until;
    return gm_run_goes_on(lane->run, steps, until) && !gm_lane_stopped(lane) &&
           !gm_listener_stops(grid->listener);
}

double gm_grid_advance(const struct gm_grid *grid, struct gm_lane *lane, int64_t steps, double most)
{
    const double until = ((const struct gm_timing *)lane->parameters)->until;
    double spent = 0, each = 0;
    while (gm_grid_goes_on(grid, lane, steps) && spent < most) {
        spent += gm_lane_burst(lane, steps, until, &each);
    }
    return spent;
}

/* ---- stability ---- */

/* A run that takes longer than this is judged where it is. */
static const double most_seconds = 10;

static const struct gm_observable *find(const struct gm_scene *scene, const char *key)
{
    const int observable = key ? gm_scene_observable(scene, key) : -1;
    return observable < 0 ? NULL : &scene->observables[observable];
}

static double value_of(const struct gm_lane *lane, const struct gm_observable *observable)
{
    const struct gm_view view = gm_lane_view(lane);
    return observable ? gm_observe(observable, &view) : 1;
}

static double error_of(const struct gm_lane *lane, const struct gm_observable *error)
{
    return error ? fabs(gm_lane_observe(lane, (size_t)(error - lane->scene->observables))) : NAN;
}

/* Up to `steps` steps in all, one by one; returns the largest value after them, and at least `largest`. */
static double largest_to(const struct gm_grid *grid, struct gm_lane *lane, int64_t steps,
                         double (*value)(const struct gm_lane *lane, const struct gm_observable *observable),
                         const struct gm_observable *observable, double largest)
{
    for (double spent = 0; gm_grid_goes_on(grid, lane, steps) && spent < most_seconds;) {
        spent += gm_grid_advance(grid, lane, lane->run->steps + 1, INFINITY);
        largest = fmax(largest, value(lane, observable));
    }
    return largest;
}

/* The end to the start; of a conserved quantity that may start at 0 as a part of its size. */
static double ratio_of(const struct gm_lane *lane, const struct gm_observable *conserved, double before,
                       double after)
{
    const double size = conserved && conserved->error
                            ? gm_lane_divisor(lane, (size_t)(conserved - lane->scene->observables))
                            : 0;
    return size > fabs(before) ? 1 + copysign(after - before, (after - before) * before) / size
                               : after / before;
}

void gm_stability_run(const struct gm_grid *grid, struct gm_lane *lane, struct gm_grid_cell *cell,
                      char *message)
{
    (void)message;
    const struct gm_stability *plan = grid->plan;
    const struct gm_observable *conserved = find(lane->scene, plan->kept),
                               *error = find(lane->scene, plan->error);
    const struct gm_timing *timing = lane->parameters;
    const int64_t some = gm_run_steps_at(lane->run, timing->until), all = some > 1 ? some : 1;
    double before = value_of(lane, conserved), after;
    if (plan->settle > 0 && all > 2 * plan->settle && !lane->scheme->family->adaptive) {
        before = largest_to(grid, lane, plan->settle, value_of, conserved, before);
        gm_grid_advance(grid, lane, all - plan->settle, most_seconds);
        after = largest_to(grid, lane, all, value_of, conserved, -INFINITY);
        cell->error = error_of(lane, error);
    } else if (error && plan->throughout) {
        cell->error = largest_to(grid, lane, all, error_of, error, -INFINITY);
        after = value_of(lane, conserved);
    } else {
        gm_grid_advance(grid, lane, all, most_seconds);
        cell->error = error_of(lane, error);
        after = value_of(lane, conserved);
    }
    cell->ratio = ratio_of(lane, conserved, before, after);
    gm_grid_take_end(lane, cell);
    cell->verdict = gm_stability_verdict(grid, cell);
}

/* ---- modified energies ---- */

/* The terms of H~ in the lane's state, of its last member. */
static void look(const struct gm_lane *lane, struct gm_modified_energy *energy, double *y, double *terms)
{
    const double *state = gm_run_state(lane->run);
    const size_t m = lane->problem.m;
    for (size_t i = 0; i < lane->problem.n; i++) {
        y[i] = state[i * m + m - 1];
    }
    gm_modified_energy_terms(energy, y, terms);
}

/* Runs a lane; `y` is scratch. */
static void watch(const struct gm_grid *grid, struct gm_lane *lane, struct gm_modified_energy *energy,
                  double *y, struct gm_grid_cell *cell)
{
    enum { LOOKS = 400 }; /* at a run, at most */
    double first[GM_POWERS], terms[GM_POWERS];
    const int plain = gm_scene_observable(lane->scene, "energy_error");
    const double divisor = plain >= 0 ? gm_lane_divisor(lane, (size_t)plain) : 1;
    const int64_t steps = cell->spec->steps, looks = steps < LOOKS ? steps : LOOKS;
    look(lane, energy, y, first);
    for (int64_t i = 0; i <= looks && lane->run->status == GM_OK; i++) {
        const int64_t step = looks == steps ? i : (int64_t)((double)steps * (double)i / (double)looks);
        if (i > 0) {
            gm_grid_advance(grid, lane, step, INFINITY);
        }
        /* by a shorter step, whose H~ is another one; or on the way */
        if (gm_lane_stopped(lane) || gm_listener_stops(grid->listener)) {
            break;
        }
        look(lane, energy, y, terms);
        double difference = 0, power = 1;
        for (int k = 0; k < GM_POWERS; k++, power *= cell->dt) {
            difference += power * (terms[k] - first[k]);
            const double error = fabs(difference) / divisor;
            cell->errors[k] = isnan(error) || isnan(cell->errors[k]) ? NAN : fmax(cell->errors[k], error);
            cell->terms[k] = fmax(cell->terms[k], fabs(power * terms[k]) / divisor);
        }
    }
}

void gm_backward_run(const struct gm_grid *grid, struct gm_lane *lane, struct gm_grid_cell *cell,
                     char *message)
{
    double *y = malloc(lane->problem.n * sizeof *y);
    char reason[GM_MODIFIED_WHY] = "";
    struct gm_modified_energy *energy =
        y ? gm_modified_energy_open(&lane->problem, lane->scheme, GM_MODIFIED_POWER, reason) : NULL;
    cell->tried = energy != NULL;
    if (energy) {
        watch(grid, lane, energy, y, cell);
        gm_grid_take_end(lane, cell);
        gm_backward_judge(cell);
    } else {
        gm_refuse(message, "%s", reason[0] ? reason : "not enough memory");
    }
    gm_modified_energy_close(energy);
    free(y);
}

/* ---- all ---- */

void gm_grid_take_end(const struct gm_lane *lane, struct gm_grid_cell *cell)
{
    const struct gm_run *run = lane->run;
    cell->status = run->status;
    cell->t = run->t;
    cell->steps = run->steps;
    cell->evaluations = gm_run_per_member(run, run->evaluations);
    cell->solves = gm_run_per_member(run, run->solves);
}

/* Cells that may wait for an earlier one. */
enum { WINDOW = 64 };

struct measuring {
    struct gm_grid *grid;
    bool failed;
    char *message;
    struct {
        struct gm_grid_cell cell;
        bool opened;
        char message[GM_MESSAGE];
    } slots[WINDOW];
};

/* The line of cell number `index` of all, which becomes its number there. */
static struct gm_grid_line *line_of(const struct gm_grid *grid, size_t *index)
{
    struct gm_grid_line *line = grid->lines;
    while (*index >= line->count) {
        *index -= line->count;
        line++;
    }
    return line;
}

size_t gm_grid_cells(const struct gm_grid *grid)
{
    size_t cells = 0;
    for (size_t i = 0; i < grid->count; i++) {
        cells += grid->lines[i].count;
    }
    return cells;
}

/* Tries a cell: stopped on the way, it stays untried. */
static void try_cell(void *self, size_t index, size_t slot)
{
    struct measuring *measuring = self;
    const struct gm_grid *grid = measuring->grid;
    const struct gm_grid_line *line = line_of(grid, &index);
    struct gm_grid_cell *cell = &measuring->slots[slot].cell;
    char *message = measuring->slots[slot].message;
    *cell = line->cells[index];
    message[0] = '\0';
    measuring->slots[slot].opened = true;
    if (grid->row->is_needless && grid->row->is_needless(grid, line, index)) {
        return;
    }
    struct gm_lane *lane = gm_grid_open_lane(grid, line->scheme, cell, message);
    measuring->slots[slot].opened = lane != NULL;
    if (lane) {
        cell->tried = true;
        grid->row->run(grid, lane, cell, message);
    }
    cell->tried = cell->tried && !gm_listener_stops(grid->listener);
    gm_lane_close(lane);
}

static bool take_cell(void *self, size_t index, size_t slot)
{
    struct measuring *measuring = self;
    struct gm_grid *grid = measuring->grid;
    const size_t all = gm_grid_cells(grid), next = index + 1 < all ? index + 1 : index;
    size_t at = index, after = next;
    struct gm_grid_line *line = line_of(grid, &at);
    if (measuring->slots[slot].message[0]) {
        snprintf(line->reason, sizeof line->reason, "%s", measuring->slots[slot].message);
    }
    if (!measuring->slots[slot].opened) {
        line->ended = true;
        measuring->failed = !grid->row->alone;
        return gm_refuse(measuring->message, "%s", line->reason) || grid->row->alone;
    }
    if (measuring->slots[slot].cell.tried) {
        line->cells[at] = measuring->slots[slot].cell;
    }
    if (grid->row->conclude) {
        grid->row->conclude(grid, line);
    }
    const struct gm_grid_line *following = line_of(grid, &after);
    const size_t begun = (size_t)(following - grid->lines) + 1;
    grid->begun = begun > grid->begun ? begun : grid->begun;
    gm_listener_hears(grid->listener, following->scheme->name, next, all);
    return true;
}

static bool is_stopped(void *self)
{
    return gm_listener_stops(((const struct measuring *)self)->grid->listener);
}

/* Whether there is anything to show; a sentence if not. */
static bool has_numbers(const struct gm_grid *grid, char *message)
{
    bool any = false;
    for (size_t i = 0; i < grid->count; i++) {
        for (size_t k = 0; k < grid->lines[i].count; k++) {
            any |= grid->lines[i].cells[k].tried;
        }
    }
    return any || gm_refuse(message, "%s", grid->lines[0].reason);
}

bool gm_cells_measure(struct gm_grid *grid, const struct gm_listener *listener, char *message)
{
    struct measuring *measuring = calloc(1, sizeof *measuring);
    grid->listener = listener;
    bool good = measuring || gm_refuse(message, "not enough memory");
    good = good && (!grid->row->prepare || grid->row->prepare(grid, message));
    if (good) {
        *measuring = (struct measuring){.grid = grid, .message = message};
        const struct gm_pool pool = {.count = gm_grid_cells(grid),
                                     .jobs = grid->row->alone ? 1 : grid->jobs,
                                     .window = grid->row->alone ? 1 : WINDOW,
                                     .work = try_cell,
                                     .take = take_cell,
                                     .stopped = is_stopped,
                                     .self = measuring};
        grid->begun = grid->begun > 1 ? grid->begun : 1;
        gm_listener_hears(listener, grid->lines[0].scheme->name, 0, pool.count);
        gm_pool_run(&pool);
        good = !measuring->failed && has_numbers(grid, message);
    }
    free(measuring);
    return good;
}
