/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Local laws, the largest residual and over space and time; errors against a file's exact solution; integrals of its
   densities. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/basics.h"
#include "core/field/families/laws/laws.h"
#include "core/functions/functions.h"
#include "core/tape.h"
#include "scenes/common/system/pieces.h"
#include "scenes/field/kind.h"

static bool residuals(const struct gm_view *view, enum gm_local_law law, double *residual)
{
    return gm_local_laws(view->problem, view->scheme, view->dt, view->state, law, residual);
}

static double largest(const struct gm_view *view, enum gm_local_law law)
{
    const size_t points = view->problem->line.points;
    double *residual = malloc(points * sizeof *residual), most = NAN;
    if (residual && residuals(view, law, residual)) {
        most = 0;
        for (size_t i = 0; i < points; i++) {
            most = fmax(most, fabs(residual[i]));
        }
    }
    free(residual);
    return most;
}

double gm_view_energy_residual(const struct gm_view *view)
{
    return largest(view, GM_LAW_OF_ENERGY);
}

double gm_view_momentum_residual(const struct gm_view *view)
{
    return largest(view, GM_LAW_OF_MOMENTUM);
}

double gm_view_content_residual(const struct gm_view *view)
{
    return largest(view, GM_LAW_OF_CONTENT);
}

/* The size of the surface: columns of the field, and rows, one every two hundredth of the run. */
enum { COLUMNS = 240, ROWS = 256 };

static size_t surface_width(const struct gm_view *view)
{
    const size_t seen = gm_grid1_seen(&view->problem->line);
    return seen < COLUMNS ? seen : COLUMNS;
}

static double surface_interval(const void *parameters)
{
    const struct gm_timing *timing = parameters;
    return fmax(timing->until / 200, fabs(timing->dt));
}

/* The field, or the residual of the law that is shown, NaN if the scheme has no such law. */
static void record_surface(const struct gm_view *view, double *entry)
{
    const struct gm_field_kind *kind = gm_viewed_field(view)->kind;
    const int show = ((const struct gm_system_lane *)view->parameters)->grid.show;
    const bool law = show != GM_SHOW_FIELD && !(kind->frame_shown && show == kind->frame_shown);
    const size_t seen = gm_grid1_seen(&view->problem->line), columns = surface_width(view);
    double *residual = law ? malloc(view->problem->line.points * sizeof *residual) : NULL;
    const bool known = residual && residuals(view, (enum gm_local_law)(show - 1), residual);
    for (size_t k = 0; k < columns; k++) {
        const size_t i = k * seen / columns;
        if (law) {
            entry[k] = known ? residual[i] : NAN;
        } else {
            entry[k] = kind->value(view, i);
        }
    }
    free(residual);
}

const struct gm_track gm_surface_track = {
    .key = "surface",
    .width = surface_width,
    .interval = surface_interval,
    .bound = ROWS,
    .record = record_surface,
};

double gm_field_form_residual(const struct gm_view *view)
{
    return gm_form_residual((struct gm_law){view->problem, view->scheme, view->dt, view->state, view->memory,
                                            .by_differences = false});
}

double gm_view_own_energy(const struct gm_view *view)
{
    return gm_field_seen(view, gm_wave_own_energy(view->problem, view->scheme, view->state, view->memory));
}

double gm_view_amplitude(const struct gm_view *view)
{
    double largest = 0;
    for (size_t i = 0; i < view->problem->line.points; i++) {
        largest = fmax(largest, fabs(view->state[i]));
    }
    return largest;
}

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
    const size_t count = gm_grid1_seen(grid);
    double events[2 * GM_LINE_ROOM], exact[GM_LINE_BLOCK];
    for (size_t first = 0, some; first < count && !isnan(largest); first += some) {
        some = count - first < GM_LINE_ROOM ? count - first : GM_LINE_ROOM;
        for (size_t i = 0; i < some; i++) {
            events[i] = gm_grid1_node(grid, first + i) + shift;
            events[some + i] = view->t;
        }
        gm_user_line_events(gm_field_line(view), events, some, exact);
        for (size_t i = 0; i < some; i++) {
            double error = 0;
            for (size_t c = 0; c < components; c++) {
                const double by =
                    view->state[c * grid->points + first + i] - constants[c] - exact[c * some + i];
                error = field->kind->complex_valued ? gm_hypot(error, by) : gm_larger(fabs(by), error);
            }
            largest = gm_larger(error, largest);
        }
    }
    return largest;
}

double gm_field_longest_step(const struct gm_view *view)
{
    return gm_wave_longest_step(view->problem, view->scheme, view->state);
}

void gm_field_failure(const struct gm_view *view, char *text, size_t size)
{
    const double longest = gm_wave_longest_step(view->problem, view->scheme, view->start);
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
    const bool ready = values && inputs && (profile || !kind->profile);
    double weights[BATCH], densities[BATCH], sum = ready ? 0 : NAN;
    struct gm_view placed = *view;
    placed.state = profile ? profile : view->state;
    for (size_t i = 0; ready && i < system->variable_count * BATCH; i++) {
        inputs[i] = values[i / BATCH];
    }
    size_t some = ready ? BATCH : 0;
    for (size_t first = 0; some == BATCH; first += BATCH) {
        for (some = 0; some < BATCH && kind->place(&placed, first + some, values, &weights[some]); some++) {
            for (size_t c = 0; c < system->initial; c += c + 1 == system->n ? system->velocities - c : 1) {
                inputs[c * BATCH + some] = values[c];
            }
        }
        gm_tape_values(gm_system_measure_of(view)->formula, inputs, densities, BATCH);
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
    double *values = gm_system_start_values(view->parameters, NULL), scale = NAN;
    if (values) {
        gm_tape_values(gm_system_measure_of(view)->terms, values, &scale, 1);
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
