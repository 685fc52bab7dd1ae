/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A start from a point of the picture: the formulas of a body are solved for the coordinates. */
#include "scenes/ode/system/parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The state of the search for the coordinates. */
struct aim {
    const struct gm_sight *sight;
    size_t body, places;
    double target[2];
    double *variables, *numbers; /* the variables of the system; the numbers of the sight */
    double *slopes, *step;       /* the Jacobian of the body's two numbers by the coordinates; the step */
    double *before;              /* the coordinates before the step */
};

/* Returns the squared distance of the body from the point; `way` leads there. */
static double distance(const struct aim *aim, size_t body, double way[2])
{
    way[0] = aim->target[0] - aim->numbers[2 * body];
    way[1] = aim->target[1] - aim->numbers[2 * body + 1];
    return way[0] * way[0] + way[1] * way[1];
}

static void look(const struct aim *aim)
{
    gm_tape_values(&aim->sight->tape, aim->variables, aim->numbers, 1);
}

/* Chooses the nearest moving body; false without one. */
static bool choose_body(struct aim *aim)
{
    double nearest = INFINITY, way[2];
    for (size_t i = 0; i < aim->sight->bodies; i++) {
        const double apart = distance(aim, i, way);
        if (!aim->sight->fixed[i] && apart < nearest) {
            nearest = apart;
            aim->body = i;
        }
    }
    return nearest < INFINITY;
}

static void find_slopes(struct aim *aim)
{
    for (size_t c = 0; c < aim->places; c++) {
        const double here = aim->variables[c], reach = 1e-6 * fmax(1, fabs(here));
        for (int side = -1; side <= 1; side += 2) {
            aim->variables[c] = here + side * reach;
            look(aim);
            for (size_t k = 0; k < 2; k++) {
                double *slope = &aim->slopes[2 * c + k];
                *slope = (side > 0 ? *slope : 0) + side * aim->numbers[2 * aim->body + k] / (2 * reach);
            }
        }
        aim->variables[c] = here;
    }
}

/* Finds the step of the coordinates to the point by the linear map: J' (J J' + m)^-1 r, the shortest one for
   m = 0. A larger m shortens it and turns it straight towards the point. K. Levenberg, Q. Appl. Math. 2
   (1944) 164. */
static void find_step(struct aim *aim, const double way[2], double m)
{
    double xx = 0, xy = 0, yy = 0;
    for (size_t c = 0; c < aim->places; c++) {
        const double *slope = &aim->slopes[2 * c];
        xx += slope[0] * slope[0];
        xy += slope[0] * slope[1];
        yy += slope[1] * slope[1];
    }
    m *= xx + yy;
    xx += m;
    yy += m;
    const double determinant = xx * yy - xy * xy;
    const double along[2] = {(yy * way[0] - xy * way[1]) / determinant,
                             (xx * way[1] - xy * way[0]) / determinant};
    for (size_t c = 0; c < aim->places; c++) {
        const double *slope = &aim->slopes[2 * c];
        aim->step[c] = slope[0] * along[0] + slope[1] * along[1];
    }
}

/* Returns the squared distance from the point after the step; the coordinates stay. */
static double try_step(struct aim *aim, double way[2])
{
    memcpy(aim->before, aim->variables, aim->places * sizeof *aim->before);
    for (size_t c = 0; c < aim->places; c++) {
        aim->variables[c] += aim->step[c];
    }
    look(aim);
    memcpy(aim->variables, aim->before, aim->places * sizeof *aim->before);
    return distance(aim, aim->body, way);
}

/* Takes the step that leads nearest; false if none leads nearer. */
static bool go(struct aim *aim, double *apart, double way[2])
{
    double best = -1, nearest = *apart, next[2];
    for (double m = 1e-9; m < 1e9; m *= 3) {
        find_step(aim, way, m);
        const double now = try_step(aim, next);
        best = now < nearest ? m : best;
        nearest = fmin(nearest, now);
    }
    if (best < 0) {
        return false;
    }
    find_step(aim, way, best);
    *apart = try_step(aim, way);
    for (size_t c = 0; c < aim->places; c++) {
        aim->variables[c] += aim->step[c];
    }
    return true;
}

/* Writes the coordinates as values of the start's rows. */
static size_t tell(const struct aim *aim, const struct gm_system_lane *lane, const double *start,
                   struct gm_choice *choices)
{
    const struct gm_system_scene *system_scene = lane->owner;
    size_t count = 0;
    for (size_t row = GM_SYSTEM_ROWS; row < system_scene->row_count; row++) {
        const size_t c = system_scene->variables[row];
        if (c >= aim->places || fabs(aim->variables[c] - start[c]) <= 1e-9 * fmax(1, fabs(start[c]))) {
            continue;
        }
        if (count == GM_CHOICES || !isfinite(aim->variables[c])) {
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
    enum { MOST_STEPS = 100 };
    const struct gm_user_system *system = &lane->owner->system;
    const struct gm_sight *sight = gm_system_sight(lane);
    struct aim aim = {.sight = sight,
                      .places = system->kind <= GM_LAGRANGIAN ? system->n / 2 : system->n,
                      .target = {x, y}};
    if (sight == &lane->owner->section || sight->dimensions != 2 || sight->bodies == 0 ||
        lane->owner->model.constraints.count > 0) {
        return 0;
    }
    aim.variables =
        calloc(system->variable_count + gm_sight_numbers(sight) + 4 * aim.places + 1, sizeof *aim.variables);
    if (!aim.variables) {
        return 0;
    }
    aim.numbers = aim.variables + system->variable_count;
    aim.slopes = aim.numbers + gm_sight_numbers(sight);
    aim.step = aim.slopes + 2 * aim.places;
    aim.before = aim.step + aim.places;
    memcpy(aim.variables, start, system->n * sizeof *start);
    memcpy(aim.variables + system->initial, start, system->n * sizeof *start);
    gm_system_put_parameters(lane, aim.variables);
    look(&aim);
    size_t count = 0;
    if (choose_body(&aim)) {
        double way[2], apart = distance(&aim, aim.body, way);
        for (int i = 0; i < MOST_STEPS && apart > 0; i++) {
            find_slopes(&aim);
            if (!go(&aim, &apart, way)) {
                break;
            }
        }
        count = tell(&aim, lane, start, choices);
    }
    free(aim.variables);
    return count;
}
