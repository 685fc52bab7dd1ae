/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The common part of all kinds: from the words of a command line to lines and cells, their runs, and cells as rows of
   CSV, as JSON, and in pictures. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "app/base/interrupt.h"
#include "app/base/pool.h"
#include "app/grid/grid.h"
#include "app/native/engine.h"
#include "app/words/drive.h"
#include "app/words/words.h"
#include "core/arena.h"
#include "core/functions/functions.h"

struct gm_timing *gm_grid_timing(const struct gm_grid *grid)
{
    return grid->request.lanes[0].parameters;
}

void gm_axis_add(struct gm_grid_axis *axis, double value)
{
    for (size_t i = 0; i < axis->count; i++) {
        if (axis->values[i] == value) {
            return;
        }
    }
    axis->values[axis->count++] = value;
}

struct gm_grid_line *gm_grid_find(const struct gm_grid *grid, const struct gm_scheme *scheme)
{
    for (size_t i = 0; i < grid->count; i++) {
        if (grid->lines[i].scheme == scheme) {
            return &grid->lines[i];
        }
    }
    return NULL;
}

struct gm_grid_line *gm_grid_add(struct gm_grid *grid, const struct gm_scheme *scheme, size_t most)
{
    struct gm_grid_line *line = &grid->lines[grid->count++];
    *line = (struct gm_grid_line){.scheme = scheme,
                                  .cells = gm_arena_take(grid->arena, most, sizeof *line->cells)};
    return line;
}

void gm_cells_open(struct gm_grid *grid)
{
    char message[GM_MESSAGE];
    const struct gm_arguments *typed = grid->typed;
    const struct gm_study_row *row = grid->row;
    gm_arena_refuse_if(grid->arena, typed->count == 0, "%s", row->which);
    const struct gm_scene *scene =
        gm_request_scene(typed->count, typed->words, &grid->request.refusal, message);
    gm_arena_check(grid->arena, scene, message);
    struct gm_arguments *words = gm_arguments_in(grid->arena);
    gm_arena_need(grid->arena, gm_words_complete(words, scene, typed, row->usual(grid, scene)));
    if (row->edit) {
        row->edit(grid, words);
    }
    gm_arena_check(grid->arena,
                   gm_request_parse(&grid->request, words->count, words->words, row->schemes, message),
                   message);
    gm_arena_keep(grid->arena, &grid->request, gm_request_close);
    row->lay_out(grid, words);
}

static void put_scheme(struct gm_row *row, const struct gm_grid *grid, const struct gm_scheme *scheme)
{
    gm_row_put(row, "scene %s, scheme %s", grid->request.scene->name, scheme->name);
    if (grid->row->ordered) {
        gm_row_put(row, "order %i", scheme->order);
    }
}

static void put_row(struct gm_row row, const struct gm_grid *grid, const struct gm_grid_line *line,
                    size_t cell, int number)
{
    put_scheme(&row, grid, line->scheme);
    grid->row->put_cell(&row, grid, &line->cells[cell], number);
    fputc('\n', row.stream);
}

static bool write_cells(const struct gm_grid *grid, FILE *csv)
{
    put_row((struct gm_row){.stream = csv, .form = GM_ROW_HEAD}, grid, &grid->lines[0], 0, 0);
    for (size_t i = 0; i < grid->begun; i++) {
        const struct gm_grid_line *line = &grid->lines[i];
        for (size_t k = 0; k < line->count; k++) {
            for (int number = 0; line->cells[k].tried && number < grid->row->rows; number++) {
                put_row((struct gm_row){.stream = csv, .form = GM_ROW_CSV}, grid, line, k, number);
            }
        }
    }
    return true;
}

static void put_cells(struct gm_row *row, const struct gm_grid *grid, const struct gm_grid_line *line)
{
    struct gm_row list = gm_row_open(row, grid->row->cells, ']');
    for (size_t k = 0; k < line->count; k++) {
        if (line->cells[k].tried) {
            struct gm_row cell = gm_row_open(&list, NULL, '}');
            grid->row->put_cell(&cell, grid, &line->cells[k], 0);
        }
    }
}

static void put_line(const struct gm_grid *grid, const struct gm_grid_line *line)
{
    struct gm_row row = gm_row_begin(stdout);
    put_scheme(&row, grid, line->scheme);
    grid->row->put_front(&row, grid, line);
    put_cells(&row, grid, line);
    if (grid->row->put_end) {
        grid->row->put_end(&row, grid, line);
    }
    gm_row_close(&row, "\n");
}

void gm_grid_print(const struct gm_grid *grid, bool json)
{
    if (!json) {
        grid->row->print(grid);
        return;
    }
    for (size_t i = 0; i < grid->begun; i++) {
        put_line(grid, &grid->lines[i]);
    }
}

void gm_print_number(const char *format, int width, double value)
{
    if (isfinite(value)) {
        printf(format, value);
    } else {
        printf(" %*s", width, "-");
    }
}

/* ---- grids ---- */

void gm_grid_close(void *self)
{
    struct gm_grid *grid = self;
    gm_arena_close(grid->arena);
    *grid = (struct gm_grid){0};
}

void gm_grid_draw(const void *grid, struct gm_picture *picture)
{
    ((const struct gm_grid *)grid)->row->draw(grid, picture);
}

bool gm_grid_write(const void *grid, FILE *table)
{
    const struct gm_study_row *row = ((const struct gm_grid *)grid)->row;
    return (row->write ? row->write : write_cells)(grid, table);
}

/* ---- the runs: cell by cell on all cores; timed runs one after the other ---- */

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

/* ---- panels, lines and cells of pictures ---- */

struct gm_panel *gm_chart_panel(struct gm_picture *picture, enum gm_place place, const char *title,
                                const struct gm_axis *x, const struct gm_axis *y)
{
    struct gm_panel *panel = gm_panel_add(picture, place, title);
    panel->axes = true;
    panel->x = *x;
    panel->y = *y;
    return panel;
}

static double on_scale(double value, bool logarithmic)
{
    return logarithmic ? gm_log(value) : value;
}

struct gm_axis gm_chart_edges(const char *label, const double *values, size_t count, bool logarithmic,
                              double *edges)
{
    const double start = on_scale(values[0], logarithmic), end = on_scale(values[count - 1], logarithmic);
    /* a single value has no neighbour that sets the width of its cell */
    const double first = count > 1 ? on_scale(values[1], logarithmic) - start : 1;
    const double last = count > 1 ? end - on_scale(values[count - 2], logarithmic) : 1;
    for (size_t i = 0; i <= count; i++) {
        const double before = i > 0 ? on_scale(values[i - 1], logarithmic) : start - first;
        const double after = i < count ? on_scale(values[i], logarithmic) : end + last;
        const double edge = (before + after) / 2;
        edges[i] = logarithmic ? gm_exp(edge) : edge;
    }
    return (struct gm_axis){.label = label,
                            .scale = logarithmic ? GM_LOG : GM_LINEAR,
                            .low = edges[0],
                            .high = edges[count],
                            .least_tick = values[0],
                            .largest_tick = values[count - 1]};
}
