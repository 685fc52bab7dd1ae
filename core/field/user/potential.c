/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Waves in a user-defined potential: V, V' and V'' are formulas. The quotient of V is the mean of its
   slope,
       [V(a) - V(b)] / (a - b) = integral of V'(b + s (a - b)) over 0 < s < 1,
   by Gauss's formula of six points on one, two, four .. pieces, until two results agree: nothing cancels,
   however near a and b are. If they do not, the quotient is computed directly when rounding leaves more
   of it. */
#include "core/field/user/potential.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/basics.h"
#include "core/field/problems/problems.h"
#include "core/tape.h"

enum { ROOM = 128 }; /* slopes that a tape computes together */

struct own {
    struct gm_user_line line; /* first */
    struct gm_field facets;
    struct gm_tape potential, slope, curvature;
    bool brief; /* Gauss's formula on one piece is exact for V' */
};

static const struct own *own_of(const struct gm_problem *problem)
{
    return problem->parameters;
}

static double value_of(const struct gm_tape *tape, double u)
{
    double value;
    gm_tape_values(tape, &u, &value, 1);
    return value;
}

static double potential(const struct gm_problem *problem, double u)
{
    return value_of(&own_of(problem)->potential, u);
}

static double slope(const struct gm_problem *problem, double u)
{
    return value_of(&own_of(problem)->slope, u);
}

static double curvature(const struct gm_problem *problem, double u)
{
    return value_of(&own_of(problem)->curvature, u);
}

static void slopes(const struct gm_problem *problem, const double *u, double *slope, size_t count)
{
    double values[ROOM]; /* u and slope may be the same, inputs and outputs of a tape not */
    for (size_t first = 0; first < count; first += ROOM) {
        const size_t some = count - first < ROOM ? count - first : ROOM;
        gm_tape_values(&own_of(problem)->slope, u + first, values, some);
        memcpy(slope + first, values, some * sizeof *values);
    }
}

/* Gauss's points and weights on (-1, 1), those above 0: exact for polynomials of degree EXACT and less. */
enum { HALF = 3, EXACT = 4 * HALF - 1, MOST_PIECES = 16 };
static const double abscissas[HALF] = {0.238619186083196908630501721680712,
                                       0.661209386466264513661399595019905,
                                       0.932469514203152027812301554493995};
static const double weights[HALF] = {0.467913934572691047389870343989551, 0.360761573048138607569833513837716,
                                     0.171324492379170345040296142172733};

/* The mean of a formula between a and b, on `pieces` pieces; if `weighted`, with the weight s, which is 1
   at a and 0 at b. *size is the largest value. Without weight, exchanging a and b changes no bit. */
static double mean_of(const struct gm_tape *tape, double a, double b, size_t pieces, bool weighted,
                      double *size)
{
    const double middle = (a + b) / 2, half = (a - b) / 2;
    double sum = 0;
    for (size_t piece = 0; piece < pieces; piece++) {
        /* pairs that lie as far from the middle on either side are added first */
        double from[HALF], at[2 * HALF], value[2 * HALF];
        for (size_t k = 0; k < HALF; k++) {
            from[k] = (2 * (double)piece + 1 - (double)pieces + abscissas[k]) / (double)pieces;
            at[2 * k] = middle + half * from[k];
            at[2 * k + 1] = middle - half * from[k];
        }
        gm_tape_values(tape, at, value, 2 * HALF);
        for (size_t k = 0; k < HALF; k++) {
            const double near_a = value[2 * k], near_b = value[2 * k + 1];
            sum += weights[k] *
                   (weighted ? (near_a * (1 + from[k]) + near_b * (1 - from[k])) / 2 : near_a + near_b);
            *size = fmax(*size, fmax(fabs(near_a), fabs(near_b)));
        }
    }
    return sum / (2 * (double)pieces);
}

static double quotient(const struct gm_problem *problem, double a, double b)
{
    const struct own *self = own_of(problem);
    double size = 0, last = mean_of(&self->slope, a, b, 1, false, &size), differ = INFINITY;
    if (self->brief) {
        return last;
    }
    for (size_t pieces = 2; pieces <= MOST_PIECES; pieces *= 2) {
        const double mean = mean_of(&self->slope, a, b, pieces, false, &size), before = differ;
        differ = fabs(mean - last);
        last = mean;
        if (!(differ > 8 * DBL_EPSILON * size)) {
            return mean;
        }
        if (differ >= before) {
            break;
        }
    }
    /* Near an extremum of V the values of V' may be rounding alone, and means always differ by that;
       between points that lie far apart they may differ by more than rounding leaves of the quotient. */
    const double at_a = potential(problem, a), at_b = potential(problem, b);
    const double rounding = DBL_EPSILON * fmax(fabs(at_a), fabs(at_b)) / fabs(a - b);
    return differ > rounding ? (at_a - at_b) / (a - b) : last;
}

static double quotient_slope(const struct gm_problem *problem, double a, double b)
{
    double size = 0;
    return mean_of(&own_of(problem)->curvature, a, b, own_of(problem)->brief ? 1 : 2, true, &size);
}

static void quotients(const struct gm_problem *problem, const double *a, const double *b, double *quotients,
                      double *slopes, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        quotients[i] = quotient(problem, a[i], b[i]);
        if (slopes) {
            slopes[i] = quotient_slope(problem, a[i], b[i]);
        }
    }
}

static const struct gm_wave formulas = {
    .potential = potential,
    .curvature = curvature,
    .slopes = slopes,
    .quotients = quotients,
};

/* Returns the problem whose loops compute V = 0 or V = 1 - cos(u); NULL for other potentials. */
static const struct gm_problem *known_potential(const struct gm_user_system *system)
{
    const struct gm_node *nodes = system->graph.nodes, *V = &nodes[system->energy];
    if (gm_is_constant(&system->graph, system->energy, 0)) {
        return &gm_problem_wave;
    }
    const bool sine_gordon = V->operation == GM_OPERATION_SUBTRACT &&
                             gm_is_constant(&system->graph, V->a, 1) &&
                             nodes[V->b].operation == GM_OPERATION_COS &&
                             nodes[nodes[V->b].a].operation == GM_VARIABLE && nodes[nodes[V->b].a].a == 0;
    return sine_gordon ? &gm_problem_sine_gordon : NULL;
}

static void open_problem(struct gm_arena *arena, void *data)
{
    const struct gm_line_opening *opening = data;
    const struct gm_user_wave *wave = opening->formulas;
    struct gm_problem *problem = opening->problem;
    const double *values = opening->values;
    const struct gm_user_system *system = wave->system;
    const struct gm_system_item *jump = gm_system_item_of(system, GM_WORD_JUMP, 0);
    struct own *self = gm_user_line_take(arena, problem, system, sizeof *self);
    self->facets = (struct gm_field){.form = &gm_form_of_waves, .wave = &formulas};
    const struct gm_problem *known = known_potential(system);
    if (known) {
        self->facets.wave = gm_field_of(known)->wave;
        problem->bound = known->bound;
    }
    problem->facets = &self->facets;
    self->brief = wave->degree <= EXACT;
    gm_user_line_tape(&self->line, &self->potential, &system->energy, 1, 1, values);
    gm_user_line_tape(&self->line, &self->slope, &wave->by_u[0], 1, 1, values);
    gm_user_line_tape(&self->line, &self->curvature, &wave->by_u[1], 1, 1, values);
    gm_user_line_open(&self->line, wave->start, gm_wave_start_count(wave), &wave->exact, values);
    gm_arena_need(arena, !jump || gm_user_line_numbers(system, jump->nodes, 1, values, &problem->line.jump));
}

bool gm_user_wave_open(struct gm_problem *problem, const struct gm_user_wave *wave, const double *values,
                       const struct gm_grid1 *grid)
{
    *problem = (struct gm_problem){.name = "wave equation",
                                   .kind = &gm_kind_field,
                                   .m = 1,
                                   .n = gm_wave_size(grid->points),
                                   .line = *grid};
    return gm_user_line_problem(open_problem, &(struct gm_line_opening){problem, wave, values, NULL});
}

bool gm_user_wave_closes(const struct gm_problem *problem, struct gm_fault *fault)
{
    const struct gm_grid1 *grid = &problem->line;
    struct gm_line_ends ends;
    if (grid->walls && grid->jump != 0) {
        return gm_fail(fault, 0, "a field between walls has no jump");
    }
    if (!gm_user_line_closes(problem->parameters, grid, 0, grid->jump, &ends, fault)) {
        return false;
    }
    for (int i = 0; i <= 8 && grid->jump != 0; i++) {
        const double u = ends.low + (ends.high - ends.low) * i / 8, force = slope(problem, u),
                     further = slope(problem, u + grid->jump);
        if (!(fabs(further - force) <= 1e-9 * fmax(1, fabs(force)))) {
            return gm_fail(
                fault, 0,
                "V' does not repeat after the jump: it is %.6g at %.60s = %.6g and %.6g further by %.6g",
                force, own_of(problem)->line.system->variables[0].name, u, further, grid->jump);
        }
    }
    return true;
}
