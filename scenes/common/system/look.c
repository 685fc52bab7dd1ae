/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Formulas of a user-defined system, in a view of its scene. */
#include "scenes/common/system/look.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The bright end of a path is this part of the whole run. */
static const double bright = 0.15;

const struct gm_system_scene *gm_system_scene_of(const struct gm_view *view)
{
    return ((const struct gm_system_lane *)view->parameters)->owner;
}

size_t gm_system_centre(const struct gm_view *view)
{
    return gm_system_scene_of(view)->hook ? 0 : view->problem->m - 1;
}

size_t gm_sight_numbers(const struct gm_sight *sight)
{
    return sight->dimensions * (sight->bodies + 2 * sight->rods);
}

size_t gm_system_bright_from(const struct gm_lane *lane)
{
    const struct gm_entries *past = &lane->entries[GM_TRACK_PAST];
    const struct gm_timing *timing = lane->parameters;
    const double whole = timing->until < GM_NEVER ? timing->until - lane->t0 : lane->run->t - lane->t0;
    size_t first = past->count;
    while (first > 0 && past->times[first - 1] > lane->run->t - bright * whole) {
        first--;
    }
    return past->count - first < 24 ? (past->count > 24 ? past->count - 24 : 0) : first;
}

const struct gm_sight *gm_system_sight(const struct gm_system_lane *lane)
{
    const struct gm_system_scene *system_scene = lane->owner;
    const char *name =
        system_scene->common[GM_ROW_SHOW - gm_system_skipped(system_scene)].choices[lane->show];
    if (system_scene->has_section && strcmp(name, system_scene->section.name) == 0) {
        return &system_scene->section;
    }
    size_t i = system_scene->sight_count - system_scene->pair_count;
    while (i < system_scene->sight_count && strcmp(system_scene->sights[i].name, name) != 0) {
        i++;
    }
    return &system_scene->sights[i < system_scene->sight_count ? i : 0];
}

/* Writes the exact solution at the current time, from the file, or from the problem. */
static void put_exact(const struct gm_view *view, double *variables)
{
    const struct gm_system_scene *system_scene = gm_system_scene_of(view);
    const size_t n = system_scene->system.n;
    const struct gm_exact *known = view->problem->exact;
    double *exact = variables + system_scene->system.exact;
    if (system_scene->exact.outputs > 0) {
        gm_tape_values(&system_scene->exact, variables, exact, 1);
        for (size_t i = 0; i < n; i++) {
            exact[i] = system_scene->system.variables[i].exact == GM_NO_NODE ? NAN : exact[i];
        }
    } else if (known) {
        known->solution(view->problem, variables[n] - view->t0, variables + system_scene->system.initial,
                        exact, 1);
    }
}

bool gm_system_is_parameter(const struct gm_system_scene *system_scene, size_t row)
{
    const size_t number = system_scene->variables[row];
    return row >= GM_SYSTEM_ROWS && number >= system_scene->system.parameters &&
           number < system_scene->system.velocities;
}

void gm_system_put_parameters(const struct gm_system_lane *lane, double *variables)
{
    for (size_t row = GM_SYSTEM_ROWS; row < lane->owner->row_count; row++) {
        if (gm_system_is_parameter(lane->owner, row)) {
            variables[lane->owner->variables[row]] = lane->values[row - GM_SYSTEM_ROWS];
        }
    }
}

void gm_system_variables(const struct gm_view *view, size_t member, bool exact, double *variables)
{
    const struct gm_system_lane *lane = view->parameters;
    const struct gm_user_system *system = &lane->owner->system;
    const size_t m = view->problem->m;
    for (size_t i = 0; i < system->variable_count; i++) {
        variables[i] = NAN;
    }
    for (size_t i = 0; i < system->n; i++) {
        variables[i] = view->state[i * m + member];
        variables[system->initial + i] = view->start[i * m + member];
    }
    gm_system_put_parameters(lane, variables);
    variables[system->n] = view->t;
    if (exact) {
        put_exact(view, variables);
    }
}

void gm_system_values(const struct gm_tape *tape, const struct gm_view *view, size_t member, double *values)
{
    const struct gm_user_system *system = &gm_system_scene_of(view)->system;
    enum { FEW = 256 }; /* this runs after every step: small systems need no allocation */
    double few[FEW], *many = NULL, *variables = few;
    if (system->variable_count > FEW) {
        variables = many = malloc(system->variable_count * sizeof *many);
    }
    if (variables) {
        gm_system_variables(view, member, tape->last_used > system->exact, variables);
        gm_tape_values(tape, variables, values, 1);
    }
    for (size_t i = 0; !variables && i < tape->outputs; i++) {
        values[i] = NAN;
    }
    free(many);
}

static void fill(double *row, double value, size_t count)
{
    for (size_t k = 0; k < count; k++) {
        row[k] = value;
    }
}

/* The exact solution of `count` states beside each other, whose other variables are set. */
static void put_all_exact(const struct gm_view *view, double *variables, size_t count)
{
    const struct gm_user_system *system = &gm_system_scene_of(view)->system;
    double *one = malloc(system->variable_count * sizeof *one);
    for (size_t k = 0; k < count; k++) {
        for (size_t i = 0; one && i < system->variable_count; i++) {
            one[i] = i < system->exact ? variables[i * count + k] : NAN;
        }
        if (one) {
            put_exact(view, one);
        }
        for (size_t i = system->exact; i < system->variable_count; i++) {
            variables[i * count + k] = one ? one[i] : NAN;
        }
    }
    free(one);
}

void gm_system_values_of(const struct gm_tape *tape, const struct gm_view *view, const double *states,
                         const double *times, size_t count, double *values)
{
    const struct gm_system_lane *lane = view->parameters;
    const struct gm_user_system *system = &lane->owner->system;
    const size_t m = view->problem->m, n = system->n;
    double *variables = calloc(system->variable_count * count, sizeof *variables);
    if (!variables) {
        fill(values, NAN, count * tape->outputs);
        return;
    }
    memcpy(variables, states, n * count * sizeof *variables);
    memcpy(variables + n * count, times, count * sizeof *variables);
    for (size_t i = 0; i < n; i++) {
        fill(variables + (system->initial + i) * count, view->start[i * m + gm_system_centre(view)], count);
    }
    for (size_t row = GM_SYSTEM_ROWS; row < lane->owner->row_count; row++) {
        if (gm_system_is_parameter(lane->owner, row)) {
            fill(variables + lane->owner->variables[row] * count, lane->values[row - GM_SYSTEM_ROWS], count);
        }
    }
    if (tape->last_used > system->exact) {
        put_all_exact(view, variables, count);
    }
    gm_tape_values(tape, variables, values, count);
    free(variables);
}

struct gm_path gm_system_path(struct gm_picture *picture, const struct gm_lane *lane, size_t track,
                              const struct gm_sight *sight)
{
    enum { BATCH = 256 };
    const struct gm_view view = gm_lane_view(lane);
    const struct gm_entries *entries = &lane->entries[track];
    const size_t n = entries->width, width = sight->dimensions * sight->bodies;
    double *points = gm_picture_memory(picture, (entries->count * width + 1) * sizeof *points),
           *states = gm_picture_memory(picture, BATCH * (n + gm_sight_numbers(sight)) * sizeof *states);
    for (size_t first = 0, count; points && states && first < entries->count; first += count) {
        count = entries->count - first < BATCH ? entries->count - first : BATCH;
        for (size_t i = 0; i < n * count; i++) {
            states[i] = entries->values[(first + i % count) * n + i / count];
        }
        double *values = states + n * count;
        gm_system_values_of(&sight->tape, &view, states, entries->times + first, count, values);
        for (size_t i = 0; i < width * count; i++) {
            points[first * width + i] = values[i % width * count + i / width];
        }
    }
    return (struct gm_path){points, points && states ? entries->count : 0, width};
}
