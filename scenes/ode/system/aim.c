/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A start from a point of the picture: the formulas of a body are solved for the coordinates. */
#include "core/functions/functions.h"
#include "scenes/ode/system/parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_multifit_nlinear.h>

#include "core/memory.h"

/* The search for the coordinates. */
struct aim {
    const struct gm_sight *sight;
    size_t body;
    size_t places[GM_CHOICES], count; /* the coordinates that the body depends on */
    const double *start, *target;
    double *variables, *numbers; /* the variables of the system; the numbers of the sight */
};

/* The way from the point to the body, and the changes of the coordinates, of which the shortest are wanted: they weigh so
   little that the body is on the point to more digits than are written. */
static int ways(const gsl_vector *x, void *data, gsl_vector *f)
{
    const double weight = 1e-6;
    const struct aim *aim = data;
    for (size_t i = 0; i < aim->count; i++) {
        const size_t c = aim->places[i];
        aim->variables[c] = gsl_vector_get(x, i);
        gsl_vector_set(f, 2 + i, weight * (aim->variables[c] - aim->start[c]));
    }
    gm_tape_values(&aim->sight->tape, aim->variables, aim->numbers, 1);
    for (size_t k = 0; k < 2; k++) {
        gsl_vector_set(f, k, aim->numbers[2 * aim->body + k] - aim->target[k]);
    }
    return GSL_SUCCESS;
}

/* Moves the coordinates by the method of Levenberg and Marquardt. */
static bool move(void *data)
{
    enum { MOST_STEPS = 100 };
    const double settled = 1e-12;
    const struct aim *aim = data;
    int info;
    double places[GM_CHOICES];
    for (size_t i = 0; i < aim->count; i++) {
        places[i] = aim->start[aim->places[i]];
    }
    gsl_multifit_nlinear_fdf ways_of = {.f = ways, .n = 2 + aim->count, .p = aim->count, .params = data};
    const gsl_multifit_nlinear_parameters usual = gsl_multifit_nlinear_default_parameters();
    gsl_multifit_nlinear_workspace *search =
        gsl_multifit_nlinear_alloc(gsl_multifit_nlinear_trust, &usual, ways_of.n, ways_of.p);
    if (search) {
        const gsl_vector_const_view start = gsl_vector_const_view_array(places, aim->count);
        gsl_multifit_nlinear_init(&start.vector, &ways_of, search);
        gsl_multifit_nlinear_driver(MOST_STEPS, settled, settled, 0, NULL, NULL, &info, search);
        ways(gsl_multifit_nlinear_position(search), data, gsl_multifit_nlinear_residual(search));
        gsl_multifit_nlinear_free(search);
    }
    return search;
}

/* Chooses the nearest moving body; false without one. */
static bool choose_body(struct aim *aim)
{
    double nearest = INFINITY;
    gm_tape_values(&aim->sight->tape, aim->variables, aim->numbers, 1);
    for (size_t i = 0; i < aim->sight->bodies; i++) {
        const double apart =
            gm_hypot(aim->target[0] - aim->numbers[2 * i], aim->target[1] - aim->numbers[2 * i + 1]);
        if (!aim->sight->fixed[i] && apart < nearest) {
            nearest = apart;
            aim->body = i;
        }
    }
    return nearest < INFINITY;
}

/* Finds the coordinates among the first `count` that change the body's place; false without any, or with too many. */
static bool choose_places(struct aim *aim, size_t count)
{
    const double before[] = {aim->numbers[2 * aim->body], aim->numbers[2 * aim->body + 1]};
    for (size_t c = 0; c < count; c++) {
        aim->variables[c] += 0.7312;
        gm_tape_values(&aim->sight->tape, aim->variables, aim->numbers, 1);
        aim->variables[c] = aim->start[c];
        if (memcmp(aim->numbers + 2 * aim->body, before, sizeof before) != 0) {
            if (aim->count == GM_CHOICES) {
                return false;
            }
            aim->places[aim->count++] = c;
        }
    }
    return aim->count > 0;
}

/* Writes the coordinates as values of the start's rows. */
static size_t tell(const struct aim *aim, const struct gm_system_scene *system_scene,
                   struct gm_choice *choices)
{
    size_t count = 0;
    for (size_t row = GM_SYSTEM_ROWS; row < system_scene->row_count; row++) {
        const size_t c = system_scene->variables[row];
        if (c >= system_scene->system.n ||
            fabs(aim->variables[c] - aim->start[c]) <= 1e-9 * fmax(1, fabs(aim->start[c]))) {
            continue;
        }
        if (!isfinite(aim->variables[c])) {
            return 0;
        }
        const bool angle = system_scene->system.variables[c].angle;
        gm_choose(&choices[count++], system_scene->rows[row].key,
                  angle ? remainder(aim->variables[c], 2 * M_PI) : aim->variables[c]);
    }
    return count;
}

size_t gm_system_aim(const struct gm_system_lane *lane, const double *start, double x, double y,
                     struct gm_choice *choices)
{
    const struct gm_user_system *system = &lane->owner->system;
    const struct gm_sight *sight = gm_system_sight(lane);
    const size_t places = system->kind <= GM_LAGRANGIAN ? system->n / 2 : system->n;
    struct aim aim = {.sight = sight, .start = start, .target = (const double[]){x, y}};
    if (sight == &lane->owner->section || sight->dimensions != 2 || sight->bodies == 0 ||
        lane->owner->model.constraints.count > 0) {
        return 0;
    }
    aim.variables = calloc(system->variable_count + gm_sight_numbers(sight), sizeof *aim.variables);
    if (!aim.variables) {
        return 0;
    }
    aim.numbers = aim.variables + system->variable_count;
    memcpy(aim.variables, start, system->n * sizeof *start);
    memcpy(aim.variables + system->initial, start, system->n * sizeof *start);
    gm_system_put_parameters(lane, aim.variables);
    const bool found = choose_body(&aim) && choose_places(&aim, places) && gm_memory_guard_gsl(move, &aim);
    const size_t count = found ? tell(&aim, lane->owner, choices) : 0;
    free(aim.variables);
    return count;
}
