/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Formulas of a user-defined system, in a view of its scene. */
#include "scenes/common/system/look.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/ode/kernel/loops.h"

const struct gm_system_scene *gm_system_scene_of(const struct gm_view *view)
{
    return ((const struct gm_system_lane *)view->parameters)->owner;
}

const struct gm_system_measure *gm_system_measure_of(const struct gm_view *view)
{
    const struct gm_system_scene *system_scene = gm_system_scene_of(view);
    return &system_scene->measures[view->observable - system_scene->observables];
}

size_t gm_system_centre(const struct gm_view *view)
{
    return gm_system_scene_of(view)->hook ? 0 : view->problem->m - 1;
}

size_t gm_sight_numbers(const struct gm_sight *sight)
{
    return sight->dimensions * (sight->bodies + 2 * sight->rods);
}

const struct gm_sight *gm_system_sight(const struct gm_system_lane *lane)
{
    static const struct gm_sight over_time = {
        .name = "", .dimensions = 2, .over_time = true, .labels = {"t"}, .components = {-1, -1}};
    const struct gm_system_scene *system_scene = lane->owner;
    if (system_scene->has_section && strcmp(lane->show, system_scene->section.name) == 0) {
        return &system_scene->section;
    }
    size_t i = system_scene->sight_count - system_scene->pair_count;
    while (i < system_scene->sight_count && strcmp(system_scene->sights[i].name, lane->show) != 0) {
        i++;
    }
    if (i == system_scene->sight_count &&
        strncmp(lane->show, GM_SHOW_OVER_TIME, strlen(GM_SHOW_OVER_TIME)) == 0) {
        return &over_time;
    }
    const struct gm_sight *sight = &system_scene->sights[i < system_scene->sight_count ? i : 0];
    const bool is_plane = sight->over_time || (sight->components[0] == 0 && sight->components[1] == 1);
    return lane->portrait && !is_plane ? &system_scene->sights[system_scene->sight_count - 1] : sight;
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
    if (gm_system_is_field(&lane->owner->system)) {
        variables[lane->owner->system.velocities - 1] = (double)lane->grid.points;
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
    /* unknown forms are not in the state */
    for (size_t i = 0; i < system->n && i < view->problem->n; i++) {
        variables[i] = view->state[i * m + member];
        variables[system->initial + i] = view->start[i * m + member];
    }
    gm_system_put_parameters(lane, variables);
    variables[system->n] = view->t;
    if (exact) {
        put_exact(view, variables);
    }
}

/* Writes the values of the variables that a tape reads; few if it reads only components and the time. */
static void put_used(const struct gm_tape *tape, const struct gm_view *view, size_t member, double *variables)
{
    const struct gm_user_system *system = &gm_system_scene_of(view)->system;
    if (tape->last_used > system->n + 1 || view->problem->n < system->n) {
        gm_system_variables(view, member, tape->last_used > system->exact, variables);
        return;
    }
    for (size_t i = tape->first_used; i < tape->last_used; i++) {
        variables[i] = i < system->n ? view->state[i * view->problem->m + member] : view->t;
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
        put_used(tape, view, member, variables);
        gm_tape_values(tape, variables, values, 1);
    }
    for (size_t i = 0; !variables && i < tape->outputs; i++) {
        values[i] = NAN;
    }
    free(many);
}

void gm_system_values_along(const struct gm_tape *tape, const struct gm_view *view,
                            const struct gm_trace *trace, double *values)
{
    const struct gm_user_system *system = &gm_system_scene_of(view)->system;
    const size_t count = (size_t)trace->count, n = view->problem->n, inputs = tape->inputs;
    double *variables = malloc(system->variable_count * sizeof *variables),
           *columns = malloc((inputs + tape->outputs) * count * sizeof *columns);
    const bool found = variables && columns;
    for (size_t i = found ? tape->first_used : inputs; i < tape->last_used; i++) {
        const bool is_state = i < system->n && i < n;
        const double *from = is_state         ? trace->states + n + i
                             : i == system->n ? trace->times + 1
                                              : &variables[i];
        const size_t stride = is_state ? n : i == system->n ? 1 : 0;
        if (i == tape->first_used) {
            gm_system_variables(view, 0, false, variables);
        }
        for (size_t k = 0; k < count; k++) {
            columns[i * count + k] = from[k * stride];
        }
    }
    if (found) {
        gm_tape_block(tape, columns, count, columns + inputs * count, count, count);
    }
    for (size_t k = 0; k < count; k++) {
        values[k] = found ? columns[inputs * count + k] : NAN;
    }
    free(columns);
    free(variables);
}

static void fill(double *row, double value, size_t count)
{
    for (size_t k = 0; k < count; k++) {
        row[k] = value;
    }
}

/* Other states of one member, each with its time: component c of the k-th is states[c * count + k]. */
struct states {
    const double *states, *times;
    size_t count, member;
};

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

/* Writes the values of a tape for these states: output i of the k-th is values[i * count + k]. */
static void values_of(const struct gm_tape *tape, const struct gm_view *view, const struct states *states,
                      double *values)
{
    const struct gm_system_lane *lane = view->parameters;
    const struct gm_user_system *system = &lane->owner->system;
    const size_t m = view->problem->m, n = system->n, count = states->count;
    double *variables = calloc(system->variable_count * count, sizeof *variables);
    if (!variables) {
        fill(values, NAN, count * tape->outputs);
        return;
    }
    memcpy(variables, states->states, n * count * sizeof *variables);
    memcpy(variables + n * count, states->times, count * sizeof *variables);
    for (size_t i = 0; i < n; i++) {
        fill(variables + (system->initial + i) * count, view->start[i * m + states->member], count);
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

/* Writes the values of a curve. When out of memory they are NaN. */
static void put_curve(const struct gm_curve *curve, const struct gm_view *view, const struct states *states,
                      double *values)
{
    const size_t n = gm_system_scene_of(view)->system.n, all = view->problem->n, count = states->count;
    if (!curve->tape && curve->number < n) {
        memcpy(values, states->states + curve->number * count, count * sizeof *values);
        return;
    }
    const size_t rows = curve->tape ? curve->tape->outputs : 2 * all;
    double *numbers = malloc(rows * count * sizeof *numbers);
    if (!numbers) {
        fill(values, NAN, count);
    } else if (curve->tape) {
        values_of(curve->tape, view, states, numbers);
        for (size_t k = 0; k < count; k++) {
            values[k] = rows == 1 || numbers[count + k] > 0 ? numbers[k] : NAN;
        }
    } else {
        memcpy(numbers, states->states, n * count * sizeof *numbers);
        for (size_t i = n; i < all; i++) { /* equations that hold the time */
            memcpy(numbers + i * count, states->times, count * sizeof *numbers);
        }
        gm_field(view->problem, numbers, numbers + all * count, count);
        memcpy(values, numbers + (all + curve->number - n) * count, count * sizeof *values);
    }
    free(numbers);
}

/* Writes the numbers of a sight for these states, as values_of. */
static void put_sight(const struct gm_sight *sight, const struct gm_view *view, const struct states *states,
                      double *values)
{
    if (!sight->curves) {
        values_of(&sight->tape, view, states, values);
        return;
    }
    for (size_t i = 0; i < sight->bodies; i++, values += 2 * states->count) {
        memcpy(values, states->times, states->count * sizeof *values);
        put_curve(&sight->curves[i], view, states, values + states->count);
    }
}

void gm_sight_values(const struct gm_sight *sight, const struct gm_view *view, size_t member, double *values)
{
    const size_t n = gm_system_scene_of(view)->system.n, m = view->problem->m;
    double *state = sight->curves ? malloc(n * sizeof *state) : NULL;
    for (size_t c = 0; state && c < n; c++) {
        state[c] = view->state[c * m + member];
    }
    if (state) {
        put_sight(sight, view, &(struct states){state, &view->t, 1, member}, values);
    } else if (sight->curves) {
        fill(values, NAN, gm_sight_numbers(sight));
    } else {
        gm_system_values(&sight->tape, view, member, values);
    }
    free(state);
}

size_t gm_system_followed(const struct gm_view *view)
{
    enum { MOST_MEMBERS = 64, MOST_NUMBERS = 4096 };
    const size_t others = view->problem->m - 1, n = gm_system_scene_of(view)->system.n,
                 most = MOST_NUMBERS / n < MOST_MEMBERS ? MOST_NUMBERS / n : MOST_MEMBERS;
    return others < most ? others : most;
}

size_t gm_system_followed_member(const struct gm_view *view, size_t shown)
{
    return shown * (view->problem->m - 1) / gm_system_followed(view);
}

struct gm_path gm_system_path(struct gm_picture *picture, const struct gm_lane *lane, size_t track,
                              size_t shown, const struct gm_sight *sight)
{
    enum { BATCH = 256 };
    const struct gm_view view = gm_lane_view(lane);
    const struct gm_entries *entries = &lane->entries[track];
    const size_t n = gm_system_scene_of(&view)->system.n, width = sight->dimensions * sight->bodies,
                 member = track == GM_TRACK_MEMBERS ? gm_system_followed_member(&view, shown)
                                                    : gm_system_centre(&view);
    double *points = gm_picture_memory(picture, (entries->count * width + 1) * sizeof *points),
           *states = gm_picture_memory(picture, BATCH * (n + gm_sight_numbers(sight)) * sizeof *states);
    for (size_t first = 0, count; first < entries->count; first += count) {
        count = entries->count - first < BATCH ? entries->count - first : BATCH;
        for (size_t i = 0; i < n * count; i++) {
            states[i] = entries->values[(first + i % count) * entries->width + shown * n + i / count];
        }
        double *values = states + n * count;
        put_sight(sight, &view, &(struct states){states, entries->times + first, count, member}, values);
        for (size_t i = 0; i < width * count; i++) {
            points[first * width + i] = values[i % width * count + i / width];
        }
    }
    return (struct gm_path){points, entries->times, entries->count, width};
}
