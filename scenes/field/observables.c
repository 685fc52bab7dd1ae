/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Errors against a file's exact solution, and integrals of its densities. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/basics.h"
#include "core/field/problems/dispersive.h"
#include "core/functions/functions.h"
#include "core/tape.h"
#include "scenes/common/system/pieces.h"
#include "scenes/field/kind.h"

double gm_field_constant(const struct gm_view *view, size_t component)
{
    const struct gm_field_kind *kind = gm_viewed_field(view)->kind;
    const struct gm_grid1 *grid = &view->problem->line;
    return kind->by_matrices && gm_user_form_is_potential(view->problem, component)
               ? view->state[component * grid->points] -
                     gm_user_line_exact(gm_field_line(view), component, gm_grid1_node(grid, 0), view->t)
               : 0;
}

bool gm_field_holds(const struct gm_view *view)
{
    const struct gm_system_scene *of_file = &gm_viewed_field(view)->of_file;
    const struct gm_system_item *item = gm_system_item_of(&of_file->system, GM_WORD_EXACT_WHILE, 0);
    double value = 1;
    if (item) {
        gm_system_values(&of_file->of_items[item - of_file->system.items], view, 0, &value);
    }
    return value > 0;
}

bool gm_field_is_known(const struct gm_view *view)
{
    return view->t == view->t0 || gm_field_holds(view);
}

double gm_field_solution_error(const struct gm_view *view)
{
    const struct gm_user_field *field = gm_viewed_field(view);
    const struct gm_grid1 *grid = &view->problem->line;
    const size_t components = gm_line_components(&field->of_file.system);
    double constants[GM_MOST_OF_MATRICES], largest = gm_field_is_known(view) ? 0 : NAN;
    for (size_t c = 0; c < components; c++) {
        constants[c] = gm_field_constant(view, c);
    }
    const double shift = field->kind->shift ? field->kind->shift(view) : 0;
    for (size_t i = 0; i < gm_grid1_seen(grid) && !isnan(largest); i++) {
        const double x = gm_grid1_node(grid, i) + shift;
        double error = 0;
        for (size_t c = 0; c < components; c++) {
            const double there = gm_user_line_exact(gm_field_line(view), c, x, view->t),
                         by = view->state[c * grid->points + i] - constants[c] - there;
            error = field->kind->complex_valued ? gm_hypot(error, by) : gm_larger(fabs(by), error);
        }
        largest = gm_larger(error, largest);
    }
    return largest;
}

/* Returns the largest stable step by linear theory; NaN if the scheme has no limit. */
static double limit_at(const struct gm_view *view, const double *state)
{
    const struct gm_step_limit *limit = view->scheme->limit;
    return limit ? limit->longest(view->problem, state) : NAN;
}

double gm_field_longest_step(const struct gm_view *view)
{
    return limit_at(view, view->state);
}

void gm_field_failure(const struct gm_view *view, char *text, size_t size)
{
    const double longest = limit_at(view, view->start);
    text[0] = '\0';
    if (fabs(view->dt) > longest) {
        snprintf(text, size, "dt = %.4g is beyond %.4g, the limit of linear theory %s", fabs(view->dt),
                 longest, view->scheme->limit->condition);
    }
}

const struct gm_system_item *gm_field_density(const struct gm_view *view, size_t *number)
{
    const struct gm_user_system *system = &gm_viewed_field(view)->of_file.system;
    const char *key = view->observable->key;
    const struct gm_system_item *item = system->items;
    for (*number = 0; item < system->items + system->item_count; item++) {
        const size_t length = strlen(item->name);
        const bool kept = item->word == GM_WORD_INVARIANT;
        if (!kept && item->word != GM_WORD_OBSERVE) {
            continue;
        }
        if (strncmp(key, item->name, length) == 0 && strcmp(key + length, kept ? "_error" : "") == 0) {
            break;
        }
        ++*number;
    }
    return item;
}

enum { BATCH = 64 }; /* points that a density is evaluated at together */

/* Only the field, its derivatives and the place differ from point to point. */
static double integral_of(const struct gm_view *view, bool magnitude)
{
    const struct gm_user_field *field = gm_viewed_field(view);
    const struct gm_field_kind *kind = field->kind;
    const struct gm_system_scene *of_file = &field->of_file;
    if (!kind->place) {
        size_t number;
        gm_field_density(view, &number);
        return gm_user_evolution_integral(view->problem, number, magnitude, view->state);
    }
    double *values = gm_system_start_values(view->parameters, NULL);
    double *profile = kind->profile ? kind->profile(view) : NULL;
    const struct gm_user_system *system = &of_file->system;
    double *inputs = malloc(system->variable_count * BATCH * sizeof *inputs);
    const bool good = values && inputs && (profile || !kind->profile);
    double weights[BATCH], densities[BATCH], sum = good ? 0 : NAN;
    struct gm_view placed = *view;
    placed.state = profile ? profile : view->state;
    for (size_t i = 0; good && i < system->variable_count * BATCH; i++) {
        inputs[i] = values[i / BATCH];
    }
    size_t some = good ? BATCH : 0;
    for (size_t first = 0; some == BATCH; first += BATCH) {
        for (some = 0; some < BATCH && kind->place(&placed, first + some, values, &weights[some]); some++) {
            for (size_t c = 0; c < system->initial; c += c + 1 == system->n ? system->velocities - c : 1) {
                inputs[c * BATCH + some] = values[c];
            }
        }
        gm_tape_values(&of_file->formulas[view->observable - of_file->observables], inputs, densities, BATCH);
        for (size_t i = 0; i < some; i++) {
            sum += weights[i] * (magnitude ? fabs(densities[i]) : densities[i]);
        }
    }
    free(inputs);
    free(values);
    free(profile);
    return sum;
}

double gm_field_scale(const struct gm_view *view)
{
    const struct gm_system_scene *of_file = &gm_viewed_field(view)->of_file;
    double *values = gm_system_start_values(view->parameters, NULL), scale = NAN;
    if (values) {
        gm_tape_values(&of_file->terms[view->observable - of_file->observables], values, &scale, 1);
    }
    free(values);
    return scale;
}

double gm_field_integral(const struct gm_view *view)
{
    return integral_of(view, false);
}

double gm_field_terms(const struct gm_view *view)
{
    return integral_of(view, true);
}

double gm_field_exact(const struct gm_view *view, double x)
{
    return gm_field_is_known(view) ? gm_user_line_exact(gm_field_line(view), 0, x, view->t) : NAN;
}

const struct gm_observable gm_usual_errors[1] = {
    GM_LOG_OBSERVABLE("solution_error", gm_field_solution_error, "distance from the exact solution")};
