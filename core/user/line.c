/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/user/line.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

size_t gm_line_components(const struct gm_user_system *system)
{
    return system->kind == GM_FIELD ? 1 : system->n;
}

bool gm_line_is_solved(const struct gm_user_system *system)
{
    bool solved = true;
    for (size_t c = 0; c < gm_line_components(system); c++) {
        solved &= system->variables[c].exact != GM_NO_NODE;
    }
    return solved;
}

bool gm_line_derive(struct gm_line_formulas *formulas, struct gm_user_system *system)
{
    const size_t components = gm_line_components(system);
    for (size_t c = 0; c < components; c++) {
        formulas->start[c] = system->variables[c].start;
        formulas->exact[c] = system->variables[c].exact;
    }
    return gm_system_place(system, formulas->start, components) &&
           (!gm_line_is_solved(system) || gm_system_place(system, formulas->exact, components));
}

bool gm_user_line_problem(void (*body)(struct gm_arena *arena, void *opening),
                          struct gm_line_opening *opening)
{
    const bool opened = gm_arena_made(body, opening);
    if (!opened) {
        opening->problem->parameters = opening->problem->facets = NULL;
    }
    return opened;
}

void gm_user_line_close(struct gm_problem *problem)
{
    const struct gm_user_line *line = problem->parameters;
    if (line) {
        gm_arena_close(line->arena);
    }
    problem->parameters = problem->facets = NULL;
}

void *gm_user_line_take(struct gm_arena *arena, struct gm_problem *problem,
                        const struct gm_user_system *system, size_t size)
{
    struct gm_user_line *line = gm_arena_take(arena, 1, size);
    line->arena = arena;
    line->system = system;
    line->begin = system->variables[system->n].value;
    problem->parameters = line;
    return line;
}

void gm_user_line_open(struct gm_user_line *line, const gm_node_id *start, size_t outputs,
                       const gm_node_id *exact, const double *values)
{
    gm_user_line_tape(line, &line->start, start, outputs, 1, values);
    if (gm_line_is_solved(line->system)) {
        gm_user_line_tape(line, &line->exact, exact, gm_line_components(line->system), 2, values);
    }
}

void gm_user_line_tape(const struct gm_user_line *line, struct gm_tape *tape, const gm_node_id *nodes,
                       size_t count, size_t inputs, const double *values)
{
    gm_tape_keep(line->arena, tape, gm_tape_open(tape, &line->system->graph, nodes, count, inputs, values));
}

double gm_user_line_exact(const struct gm_user_line *line, size_t component, double x, double t)
{
    const double place[] = {x, t};
    double values[GM_MOST_OF_MATRICES];
    if (line->exact.outputs == 0) {
        return NAN;
    }
    gm_tape_values(&line->exact, place, values, 1);
    return values[component];
}

void gm_user_line_events(const struct gm_user_line *line, const double *events, size_t count, double *values)
{
    gm_tape_values(line->exact.outputs > 0 ? &line->exact : &line->start, events, values, count);
}

/* Writes the outputs at nodes from number `first` on, at most GM_LINE_ROOM, [output * nodes + i]. Returns the number of
   nodes. */
static size_t start_of_block(const struct gm_user_line *line, const struct gm_grid1 *grid, size_t first,
                             double values[GM_LINE_BLOCK])
{
    const size_t some = grid->points - first < GM_LINE_ROOM ? grid->points - first : GM_LINE_ROOM;
    double x[GM_LINE_ROOM];
    for (size_t i = 0; i < some; i++) {
        x[i] = gm_grid1_node(grid, first + i);
    }
    gm_tape_values(&line->start, x, values, some);
    return some;
}

void gm_user_line_start(const struct gm_user_line *line, const struct gm_grid1 *grid, double *y)
{
    double values[GM_LINE_BLOCK];
    for (size_t first = 0, some; first < grid->points; first += some) {
        some = start_of_block(line, grid, first, values);
        for (size_t k = 0; k < line->start.outputs; k++) {
            memcpy(y + k * grid->points + first, values + k * some, some * sizeof *y);
        }
    }
}

/* Returns u(t) by Taylor's formula about t = 0, of `count` rates that lie apart. */
static double taylor(const double *rates, size_t count, size_t apart, double t)
{
    double u = 0;
    for (size_t k = count; k-- > 0;) {
        u = rates[k * apart] + u * t / (double)(k + 1);
    }
    return u;
}

void gm_user_line_levels(const struct gm_user_line *line, const struct gm_grid1 *grid, double gap, double *y)
{
    const size_t points = grid->points;
    const bool known = line->exact.outputs > 0;
    double rates[GM_LINE_BLOCK], places[2 * GM_LINE_ROOM];
    for (size_t first = 0, some; first < points; first += some) {
        some = start_of_block(line, grid, first, rates);
        for (size_t i = 0; i < some; i++) {
            y[first + i] = rates[i];
            y[points + first + i] = known ? 0 : taylor(rates + i, line->start.outputs, some, gap);
            places[i] = gm_grid1_node(grid, first + i);
            places[some + i] = line->begin + gap;
        }
        if (known) {
            gm_tape_values(&line->exact, places, y + points + first, some);
        }
    }
    y[2 * points] = gap;
}

bool gm_user_line_numbers(const struct gm_user_system *system, const gm_node_id *nodes, size_t count,
                          const double *values, double *numbers)
{
    struct gm_tape tape;
    const bool opened = gm_tape_open(&tape, &system->graph, nodes, count, 0, values);
    if (opened) {
        gm_tape_values(&tape, NULL, numbers, 1);
    }
    gm_tape_close(&tape);
    return opened;
}

/* Returns true if number i of a block is finite, the component and its derivatives; else false with the suffix. */
static bool is_finite(const struct gm_user_line *line, const double *values, size_t some, size_t i,
                      size_t component, const char **suffix)
{
    static const char *const derived[] = {"_t", "_tt", "_ttt", "_tttt"};
    const size_t components = gm_line_components(line->system);
    for (size_t k = 0; k < line->start.outputs; k++) {
        *suffix = k < components ? "" : derived[k - components];
        if ((k == component || k >= components) && !isfinite(values[k * some + i])) {
            return false;
        }
    }
    return true;
}

bool gm_user_line_closes(const struct gm_user_line *line, const struct gm_grid1 *grid, size_t component,
                         double jump, struct gm_line_ends *ends, struct gm_fault *fault)
{
    const char *name = line->system->variables[component].name, *suffix;
    double values[GM_LINE_BLOCK];
    *ends = (struct gm_line_ends){.low = INFINITY, .high = -INFINITY};
    for (size_t first = 0, some; first < grid->points; first += some) {
        some = start_of_block(line, grid, first, values);
        for (size_t i = 0; i < some; i++) {
            if (!is_finite(line, values, some, i, component, &suffix)) {
                return gm_fail(fault, 0, "%.60s%s at the start is not finite where x = %.6g", name, suffix,
                               gm_grid1_node(grid, first + i));
            }
            ends->low = fmin(ends->low, values[component * some + i]);
            ends->high = fmax(ends->high, values[component * some + i]);
        }
    }
    const double right = grid->first + grid->dx * (double)grid->points,
                 x[] = {grid->first, grid->walls ? -grid->first : right};
    gm_tape_values(&line->start, x, values, 2);
    ends->left = values[2 * component];
    ends->right = values[2 * component + 1];
    const double largest = fmax(fabs(ends->low), fabs(ends->high));
    if (!grid->walls && !isnan(jump) &&
        !(fabs(ends->right - ends->left - jump) <= 1e-3 * fmax(ends->high - ends->low, 1e-12 * largest))) {
        return gm_fail(
            fault, 0,
            "%.60s at the start does not close on the ring: it is %.6g at one end and %.6g at the other%s",
            name, ends->left, ends->right,
            line->system->kind == GM_EVOLUTION ? "" : " (give their difference in a line jump:)");
    }
    return true;
}
