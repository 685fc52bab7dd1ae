/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The runs of a grid, cell by cell on all cores; timed runs one after the other. */
#include "app/grid/hooks.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "app/base/interrupt.h"
#include "app/base/pool.h"
#include "app/native/engine.h"
#include "app/words/drive.h"
#include "core/arena.h"

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
    const char *keys[2];
    size_t count = 0;
    if (timing && grid->parameter) {
        gm_parameter_put(grid->parameter, timing, cell->value);
        keys[count++] = grid->parameter->key;
    }
    if (timing && grid->ratio) {
        gm_parameter_put(grid->ratio, timing, cell->step);
        keys[count++] = grid->ratio->key;
    }
    if (timing && count > 0 && scene->settle) {
        scene->settle(timing, keys, count, contradiction);
    }
    if (timing && !grid->ratio) {
        timing->dt = cell->step * (grid->plan ? grid->plan->unit(timing) : 1);
    }
    cell->dt = timing ? timing->dt : 0;
    return gm_grid_start(grid, cell->spec, timing, scheme, message);
}

bool gm_grid_goes_on(const struct gm_grid *grid, const struct gm_lane *lane, int64_t steps)
{
    const double until = ((const struct gm_timing *)lane->parameters)->until;
    return gm_run_goes_on(lane->run, steps, until) && !gm_listener_stops(grid->listener);
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
    const char *fault; /* the reason for which all runs end, or NULL */
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

/* Tries a cell; if it is stopped during the run it stays untried. */
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
        measuring->fault = grid->row->alone ? NULL : line->reason;
        return grid->row->alone;
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

static bool has_numbers(const struct gm_grid *grid)
{
    bool any = false;
    for (size_t i = 0; i < grid->count; i++) {
        for (size_t k = 0; k < grid->lines[i].count; k++) {
            any |= grid->lines[i].cells[k].tried;
        }
    }
    return any;
}

static void measure_cells(struct gm_grid *grid)
{
    struct measuring measuring = {.grid = grid};
    const bool alone = grid->row->alone;
    if (grid->row->prepare) {
        grid->row->prepare(grid);
    }
    const struct gm_pool pool = {.count = gm_grid_cells(grid),
                                 .jobs = alone ? 1 : grid->jobs,
                                 .window = alone ? 1 : WINDOW,
                                 .work = try_cell,
                                 .take = take_cell,
                                 .stopped = is_stopped,
                                 .self = &measuring};
    grid->begun = grid->begun > 1 ? grid->begun : 1;
    gm_listener_hears(grid->listener, grid->lines[0].scheme->name, 0, pool.count);
    gm_pool_run(&pool);
    gm_arena_refuse_if(grid->arena, measuring.fault || !has_numbers(grid), "%s",
                       measuring.fault ? measuring.fault : grid->lines[0].reason);
}

static void measure(struct gm_arena *arena, void *data)
{
    struct gm_grid *grid = data;
    (void)arena;
    (grid->row->measure ? grid->row->measure : measure_cells)(grid);
}

bool gm_grid_measure(struct gm_grid *grid, const struct gm_listener *listener, char *message)
{
    grid->listener = listener;
    return gm_arena_run(grid->arena, measure, grid) || gm_refuse(message, "%s", gm_arena_reason(grid->arena));
}

/* ---- the listener of long work: a line on standard error, or nothing ---- */

bool gm_listener_stops(const struct gm_listener *listener)
{
    return gm_interrupted || (listener && listener->stopped && listener->stopped(listener->self));
}

void gm_listener_hears(const struct gm_listener *listener, const char *what, size_t done, size_t all)
{
    if (listener && listener->report) {
        listener->report(listener->self, what, done, all);
    }
}

static void write_line(void *self, const char *what, size_t done, size_t all)
{
    (void)self;
    if (isatty(STDERR_FILENO)) {
        fprintf(stderr, "\r%zu/%zu %-28s ", done, all, what);
    }
}

const struct gm_listener gm_terminal_listener = {.report = write_line};

void gm_terminal_listener_clear(void)
{
    if (isatty(STDERR_FILENO)) {
        fprintf(stderr, "\r%60s\r", "");
    }
}
