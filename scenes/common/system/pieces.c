/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Common functions for making the scene of a user-defined system. */
#include "scenes/common/system/pieces.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "core/expression/lines.h"
#include "core/model/equations.h"

double *gm_system_start_values(const struct gm_system_lane *lane, const char *given)
{
    const struct gm_system_scene *system_scene = lane->owner;
    double *known = malloc(system_scene->system.variable_count * sizeof *known);
    for (size_t i = 0; known && i < system_scene->system.variable_count; i++) {
        known[i] = NAN;
    }
    for (size_t row = GM_SYSTEM_ROWS; known && row < system_scene->row_count; row++) {
        if (system_scene->variables[row] != GM_NO_VARIABLE && (!given || given[row])) {
            known[system_scene->variables[row]] = lane->values[row - GM_SYSTEM_ROWS];
        }
    }
    if (known && gm_system_is_field(&system_scene->system)) {
        const bool follows =
            given && !lane->grid.points_given && gm_system_points_follow(&system_scene->system);
        known[system_scene->system.velocities - 1] = follows ? NAN : (double)lane->grid.points;
    }
    double *values = known ? gm_equations_start(&system_scene->system, known) : NULL;
    free(known);
    return values;
}

double gm_system_half_length(const struct gm_system_lane *lane)
{
    double *values = gm_system_start_values(lane, NULL);
    const double half = values ? values[lane->owner->system.velocities - GM_RING_PARAMETERS] : NAN;
    free(values);
    return half;
}

void gm_system_open_tape(struct gm_system_scene *system_scene, struct gm_tape *tape, const gm_node_id *nodes,
                         size_t count)
{
    const size_t inputs = system_scene->system.variable_count;
    const double *unused = gm_arena_take(system_scene->arena, inputs, sizeof *unused);
    gm_tape_keep(system_scene->arena, tape,
                 gm_tape_open(tape, &system_scene->system.graph, nodes, count, inputs, unused));
}

struct gm_tape *gm_system_take_tape(struct gm_system_scene *system_scene, const gm_node_id *nodes,
                                    size_t count)
{
    struct gm_tape *tape = gm_arena_take(system_scene->arena, 1, sizeof *tape);
    gm_system_open_tape(system_scene, tape, nodes, count);
    return tape;
}

const char *gm_system_find_mesh(struct gm_system_scene *system_scene, const char *name,
                                const struct gm_built_in **inside)
{
    const char *path = system_scene->origin.path ? system_scene->origin.path : "",
               *slash = name[0] == '/' ? NULL : strrchr(path, '/'),
               *beside = gm_arena_print(system_scene->arena, "%.*s%s", slash ? (int)(slash + 1 - path) : 0,
                                        path, name);
    const bool there = path[0] && access(beside, F_OK) == 0;
    *inside = there ? NULL : gm_built_in_find(GM_FILE_MESH, name);
    return there || *inside || access(name, F_OK) != 0 ? beside : name;
}

void gm_system_take_observables(struct gm_system_scene *system_scene, size_t most)
{
    system_scene->observables = gm_arena_take(system_scene->arena, most, sizeof *system_scene->observables);
    system_scene->measures = gm_arena_take(system_scene->arena, most, sizeof *system_scene->measures);
    system_scene->scene.observables = system_scene->observables;
}

struct gm_system_measure *gm_system_add_observable(struct gm_system_scene *system_scene,
                                                   struct gm_observable row, size_t most)
{
    const size_t count = system_scene->observable_count;
    for (size_t k = 0; k < count; k++) {
        if (gm_observables_clash(row.key, system_scene->observables[k].key)) {
            gm_arena_refuse(system_scene->arena, "there are two observables %s", row.key);
        }
    }
    if (count == most) {
        gm_arena_refuse(system_scene->arena, "a system of this kind has at most %zu observables", most);
    }
    system_scene->observables[count] = row;
    system_scene->scene.observable_count = ++system_scene->observable_count;
    return &system_scene->measures[count];
}

/* ---- keys ---- */

/* Returns true if a line of a system has a name. */
static bool has_name(const char *text, struct gm_span span, const char *name)
{
    bool found = false;
    for (size_t at = span.begin, length; at < span.end && !found; at += length) {
        const size_t letters = gm_name_length(text + at, span.end - at);
        found = gm_text_same(text + at, letters, name, strlen(name));
        length = letters > 0 ? letters : 1;
    }
    return found;
}

/* Returns true if a parameter determines the step, by the line `tie`, and no other line of equations has it. */
static bool sets_step(const struct gm_user_system *system, size_t number)
{
    static const char *const others[] = {"tie", "title", "subtitle", "about", "watch", "caption", "figure"};
    const struct gm_system_item *tie = gm_system_item_of(system, GM_WORD_TIE, 0);
    const char *text = system->source, *name = system->variables[number].name;
    struct gm_text_line line;
    struct gm_fault fault;
    bool alone = tie && tie->variable == number;
    for (size_t at = 0; alone && gm_lines_next(text, strlen(text), &at, &line, &fault);) {
        const size_t first = gm_name_length(text + line.value.begin, line.value.end - line.value.begin);
        bool passes = gm_span_is(text, line.word, "parameter") &&
                      gm_text_same(text + line.value.begin, first, name, strlen(name));
        for (size_t i = 0; i < GM_COUNT(others); i++) {
            passes = passes || gm_span_is(text, line.word, others[i]);
        }
        alone = passes || !has_name(text, line.value, name);
    }
    return alone;
}

void gm_system_make_rows(struct gm_system_scene *system_scene, const struct gm_parameter *timing,
                         const struct gm_parameter *common, size_t count, bool typed)
{
    const struct gm_user_system *system = &system_scene->system;
    const size_t n = system->n, half = n / 2, parameters = system->velocities - system->parameters,
                 starts = gm_system_is_field(system) || gm_system_is_form(system) ? 0 : n;
    const size_t choices = system->choices.count, most = GM_SYSTEM_ROWS + choices + parameters + starts;
    struct gm_arena *arena = system_scene->arena;
    system_scene->rows = gm_arena_take(arena, most + count, sizeof *system_scene->rows);
    system_scene->variables = gm_arena_take(arena, most, sizeof *system_scene->variables);
    system_scene->initial =
        gm_arena_take(arena, 1, sizeof *system_scene->initial + most * (sizeof(double) + 1));
    const double *start = gm_arena_keep(arena, gm_equations_start(system, NULL), free);
    for (size_t i = 0; i < choices; i++) {
        system_scene->variables[GM_SYSTEM_ROWS + i] = GM_NO_VARIABLE;
        system_scene->rows[GM_SYSTEM_ROWS + i] = gm_written_choice(
            arena, system, i, "", offsetof(struct gm_system_lane, values) + i * sizeof(double));
    }
    size_t row = GM_SYSTEM_ROWS + choices;
    for (size_t i = 0; i < parameters + starts; i++) {
        const bool is_start = i >= parameters;
        size_t number = is_start ? i - parameters : system->parameters + i;
        if (is_start && system->variables[number].start == GM_NO_NODE) {
            number = system->velocities + number - half; /* it is the velocity that the file gives */
        }
        const struct gm_system_variable *variable = &system->variables[number];
        if (variable->derived) {
            continue;
        }
        system_scene->variables[row] = number;
        system_scene->rows[row] =
            gm_written_row(arena, variable, start[number], is_start ? "where it starts" : "a parameter",
                           offsetof(struct gm_system_lane, values) + (row - GM_SYSTEM_ROWS) * sizeof(double));
        system_scene->rows[row].starts = is_start;
        system_scene->rows[row].sets_step = !is_start && sets_step(system, number);
        system_scene->rows[row++].required = typed;
    }
    system_scene->row_count = row;
    system_scene->common = system_scene->rows + row;
    system_scene->common_count = count;
    memcpy(system_scene->rows, timing, GM_SYSTEM_ROWS * sizeof *timing);
    memcpy(system_scene->common, common, count * sizeof *common);
    system_scene->initial->owner = system_scene;
}

void gm_system_open_timing(struct gm_system_scene *system_scene, double numbers[GM_SYSTEM_TIMES])
{
    struct gm_arena *arena = system_scene->arena;
    const double *values = gm_arena_keep(arena, gm_system_start_values(system_scene->initial, NULL), free);
    for (size_t i = 0; i < GM_SYSTEM_TIMES; i++) {
        const struct gm_system_item *item =
            gm_system_item_of(&system_scene->system, (enum gm_system_word)((int)GM_WORD_DT + (int)i), 0);
        numbers[i] = NAN;
        if (item) {
            gm_system_open_tape(system_scene, &system_scene->timing[i], item->nodes, 1);
            gm_tape_values(&system_scene->timing[i], values, &numbers[i], 1);
        }
    }
    const double steps = numbers[GM_SYSTEM_TIMES - 1];
    if (steps < 0 || (isfinite(steps) && steps != floor(steps))) {
        gm_arena_refuse(arena, "steps: %.10g is not a whole number", steps);
    }
}
