/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A system that somebody wrote, as a scene: its parameters and the values of its start are keys, what it
   keeps and what its file observes are observables, its section is a track. The scene is made while the
   program runs, and does not change afterwards; what it needs of itself a lane finds through its parameters.

   With `members` the start is a disc in the plane that is shown, a grid of it, or a line along its first
   axis: the last member is in the middle, of a disc all others are on the edge. Observables are those of the
   centre; where the state is a plane, the disc's area is one too. */
#include "scenes/ode/system.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/formula/equations.h"
#include "core/linear/eigenvalues.h"
#include "core/ode/kernel/loops.h"
#include "core/ode/variational/manifold.h"
#include "core/run.h"
#include "core/schemes.h"
#include "scenes/frame/written.h"
#include "scenes/ode/asked.h"
#include "scenes/ode/system_draw.h"

enum {
    DT,
    UNTIL,
    MEMBERS,
    SPREAD,
    SHAPE,
    SHOW,
    VALUES = GM_SYSTEM_ROWS /* the first row of the system's own */
};
enum { MOST_OBSERVED = 60, MOST_LINEARISED = 200, MOST_FOLLOWED = 32, CROSSINGS = 1 << 14, REMEMBERED = 256 };

static const struct gm_system_scene *scene_of(const struct gm_view *view)
{
    return ((const struct gm_system_lane *)view->parameters)->own;
}

/* Whether each row was given, bytes behind the values. */
static char *given_of(struct gm_system_lane *lane)
{
    return (char *)(lane->values + (lane->own->row_count - VALUES));
}

/* ---- formulas in flight ---- */

static double value_of(const struct gm_tape *tape, const struct gm_view *view)
{
    double value;
    gm_system_values(tape, view, view->problem->m - 1, &value);
    return value;
}

static double observed(const struct gm_view *view)
{
    const struct gm_system_scene *own = scene_of(view);
    return value_of(&own->formulas[view->observable - own->observables], view);
}

/* Of a Lagrangian system, whose formulas hold velocities. */
static double legendre_energy(const struct gm_view *view)
{
    const size_t n = view->problem->n, m = view->problem->m;
    double *centre = malloc(n * sizeof *centre), value = NAN;
    for (size_t i = 0; centre && i < n; i++) {
        centre[i] = view->state[i * m + m - 1];
    }
    if (centre) {
        gm_ode_of(view->problem)->hamiltonian->energy(view->problem, centre, &value, 1);
    }
    free(centre);
    return value;
}

/* What constraints are off by, of the last member. */
static struct gm_manifold_defects defects_of(const struct gm_view *view)
{
    const size_t n = view->problem->n, m = view->problem->m;
    struct gm_manifold_defects defects = {NAN, NAN};
    double *centre = malloc(n * sizeof *centre);
    for (size_t i = 0; centre && i < n; i++) {
        centre[i] = view->state[i * m + m - 1];
    }
    defects = centre ? gm_manifold_defects(view->problem, centre) : defects;
    free(centre);
    return defects;
}

static double constraint_defect(const struct gm_view *view)
{
    return defects_of(view).constraint;
}

static double hidden_defect(const struct gm_view *view)
{
    return defects_of(view).hidden;
}

/* The distance from the solution that the file tells, of the component that is farthest. */
static double solution_error(const struct gm_view *view)
{
    const struct gm_system_scene *own = scene_of(view);
    const size_t n = own->system.n, m = view->problem->m;
    double *exact = malloc(n * sizeof *exact), error = exact ? 0 : NAN;
    if (exact) {
        gm_system_values(&own->exact, view, m - 1, exact);
    }
    for (size_t i = 0; exact && i < n; i++) {
        const double away = fabs(view->state[i * m + m - 1] - exact[i]);
        if (own->system.variables[i].exact != GM_NO_NODE) {
            error = away > error || isnan(away) ? away : error;
        }
    }
    free(exact);
    return error;
}

/* Signed area of the polygon of the members, measured from the centre so that little cancels. */
static double area(const struct gm_view *view)
{
    const struct gm_system_lane *lane = view->parameters;
    const size_t m = view->problem->m, points = lane->shape == GM_SHAPE_DISC ? m - 1 : 0;
    const double *x = view->state, *y = view->state + m;
    double twice = 0;
    for (size_t i = 0; i < points; i++) {
        const size_t next = i + 1 < points ? i + 1 : 0;
        twice += (x[i] - x[points]) * (y[next] - y[points]) - (x[next] - x[points]) * (y[i] - y[points]);
    }
    return points >= 3 ? twice / 2 : NAN;
}

static double stop(const struct gm_view *view)
{
    return value_of(&scene_of(view)->stop, view);
}

static void stops(const struct gm_view *view, const double *states, const double *times, size_t count,
                  double *values)
{
    gm_system_values_of(&scene_of(view)->stop, view, states, times, count, values);
}

/* ---- what is remembered ---- */

static size_t sight_width(const struct gm_view *view)
{
    const struct gm_sight *sight = gm_system_sight(view->parameters);
    return sight->dimensions * sight->bodies;
}

static void record_sight(const struct gm_view *view, double *entry)
{
    const struct gm_sight *sight = gm_system_sight(view->parameters);
    if (sight->rods == 0) {
        gm_system_values(&sight->tape, view, view->problem->m - 1, entry);
        return;
    }
    double *all = malloc(gm_sight_numbers(sight) * sizeof *all);
    if (all) {
        gm_system_values(&sight->tape, view, view->problem->m - 1, all);
        memcpy(entry, all, sight->dimensions * sight->bodies * sizeof *entry);
    }
    free(all);
}

static double step_of(const void *parameters)
{
    return fabs(((const struct gm_timing *)parameters)->dt);
}

/* Shapes of the disc are those of every twelfth of the shortest turn, about. */
static double shape_interval(const void *parameters)
{
    const struct gm_system_lane *lane = parameters;
    return fmax(lane->own->radian * M_PI / 6, step_of(parameters));
}

static size_t shape_stride(size_t members)
{
    return (members + REMEMBERED - 1) / REMEMBERED;
}

static size_t shape_width(const struct gm_view *view)
{
    const size_t members = view->problem->m - 1, stride = shape_stride(members);
    return members > 0 ? 2 * ((members + stride - 1) / stride) : 2;
}

static void record_shape(const struct gm_view *view, double *entry)
{
    const struct gm_system_scene *own = scene_of(view);
    const size_t m = view->problem->m, members = m > 1 ? m - 1 : 1;
    for (size_t i = 0; i < members; i += shape_stride(members), entry += 2) {
        entry[0] = view->state[own->disc[0] * m + i];
        entry[1] = view->state[own->disc[1] * m + i];
    }
}

static double section(const struct gm_view *view)
{
    const struct gm_system_scene *own = scene_of(view);
    double values[1 + GM_MOST_CONDITIONS];
    gm_system_values(&own->where, view, view->member, values);
    if (own->stroboscopic) {
        return sin(2 * M_PI * (view->t - view->t0) / values[0]);
    }
    return own->turns ? sin(values[0] / 2) : values[0];
}

static bool is_admitted(const struct gm_view *view)
{
    const struct gm_system_scene *own = scene_of(view);
    double values[1 + GM_MOST_CONDITIONS];
    gm_system_values(&own->where, view, view->member, values);
    bool holds = !own->stroboscopic || cos(2 * M_PI * (view->t - view->t0) / values[0]) > 0;
    for (size_t i = 0; i < own->conditions; i++) {
        holds = holds && values[1 + i] > 0;
    }
    return holds;
}

static void record_crossing(const struct gm_view *view, double *entry)
{
    gm_system_values(&scene_of(view)->section.tape, view, view->member, entry);
}

/* ---- from parameters to problem and start ---- */

/* Item number `number` of those that a word made; NULL: there are fewer. */
static const struct gm_system_item *item_of(const struct gm_own_system *system, enum gm_system_word word,
                                            size_t number)
{
    for (size_t i = 0; i < system->item_count; i++) {
        if (system->items[i].word == word && number-- == 0) {
            return &system->items[i];
        }
    }
    return NULL;
}

/* Values of all variables at the start, of those rows that are `given`, or of all rows: NULL. */
static double *start_values(const struct gm_system_lane *lane, const char *given)
{
    const struct gm_system_scene *own = lane->own;
    double *known = malloc(own->system.variable_count * sizeof *known);
    for (size_t i = 0; known && i < own->system.variable_count; i++) {
        known[i] = NAN;
    }
    for (size_t row = VALUES; known && row < own->row_count; row++) {
        known[own->variables[row]] = !given || given[row] ? lane->values[row - VALUES] : NAN;
    }
    double *values = known ? gm_equations_start(&own->system, known) : NULL;
    free(known);
    return values;
}

/* Values that were not given follow from those that were, as the file says. */
static bool settle(void *parameters, const char *const *keys, size_t count, char *sentence)
{
    struct gm_system_lane *lane = parameters;
    const struct gm_system_scene *own = lane->own;
    char *given = given_of(lane);
    bool by_steps = false;
    for (size_t i = 0; i < count; i++) {
        by_steps |= strcmp(keys[i], "steps") == 0;
        for (size_t row = 0; row < own->row_count; row++) {
            given[row] |= strcmp(keys[i], own->rows[row].key) == 0;
        }
    }
    double *values = start_values(lane, given);
    if (!values) {
        return gm_refuse(sentence, "not enough memory");
    }
    bool good = true;
    for (size_t row = VALUES; row < own->row_count && good; row++) {
        const double value = values[own->variables[row]];
        lane->values[row - VALUES] = value;
        const struct gm_parameter *bounds = &own->rows[row];
        good = isfinite(value) || gm_refuse(sentence, "%s is not finite with these values", bounds->key);
        good = good && ((value >= bounds->lowest && value <= bounds->highest) ||
                        gm_refuse(sentence, "%s is %g with these values, and lies between %g and %g",
                                  bounds->key, value, bounds->lowest, bounds->highest));
    }
    for (size_t i = 0; i < GM_COUNT(own->timing) && good; i++) {
        double number = NAN;
        const enum gm_system_word word = (enum gm_system_word)((int)GM_WORD_DT + (int)i);
        if (item_of(&own->system, word, 0)) {
            gm_tape_values(&own->timing[i], values, &number, 1);
        }
        if (word == GM_WORD_DT && !given[DT] && number > 0) {
            lane->timing.dt = number;
        } else if (word == GM_WORD_UNTIL && !given[UNTIL] && number >= 0) {
            lane->timing.until = number;
        } else if (word == GM_WORD_STEPS && !given[UNTIL] && !by_steps && number >= 0) {
            lane->timing.until = number * lane->timing.dt;
        }
    }
    free(values);
    return good;
}

static bool starts_on_manifold(const struct gm_system_lane *lane, const struct gm_problem *problem,
                               char *sentence)
{
    double *values = start_values(lane, NULL);
    if (!values) {
        return gm_refuse(sentence, "not enough memory");
    }
    const struct gm_manifold_defects defects = gm_manifold_defects(problem, values);
    free(values);
    return (defects.constraint <= 1e-8 && defects.hidden <= 1e-8) ||
           gm_refuse(sentence,
                     "the start breaks the constraints: they are off by %.3g, and their rates by %.3g",
                     defects.constraint, defects.hidden);
}

/* Whether the surfaces have sizes. */
static bool has_surfaces(const struct gm_system_lane *lane, char *sentence)
{
    double sizes[3 * GM_MOST_SURFACES], *values = start_values(lane, NULL);
    if (!values) {
        return gm_refuse(sentence, "not enough memory");
    }
    gm_tape_values(&lane->own->surfaces, values, sizes, 1);
    free(values);
    for (size_t i = 0; i < lane->own->surfaces.outputs; i++) {
        if (!(sizes[i] > 0 && isfinite(sizes[i]))) {
            return gm_refuse(sentence, "the size of a surface is %g, and has to be above 0", sizes[i]);
        }
    }
    return true;
}

static bool setup(const void *parameters, struct gm_problem *problem, char *sentence)
{
    const struct gm_system_lane *lane = parameters;
    const struct gm_system_scene *own = lane->own;
    if (own->surfaces.outputs > 0 && !has_surfaces(lane, sentence)) {
        return false;
    }
    double *values = malloc(own->system.variable_count * sizeof *values);
    for (size_t i = 0; values && i < own->system.variable_count; i++) {
        values[i] = own->system.variables[i].value;
    }
    for (size_t row = VALUES; values && row < own->first_start; row++) {
        values[own->variables[row]] = lane->values[row - VALUES];
    }
    const bool good = values && gm_own_problem_open(problem, &own->model, values);
    free(values);
    if (!good) {
        return gm_refuse(sentence, "not enough memory");
    }
    problem->name = own->scene.name;
    if (gm_action_constraints(problem) > 0 && !starts_on_manifold(lane, problem, sentence)) {
        gm_own_problem_close(problem);
        return false;
    }
    problem->m = (size_t)lane->members;
    return true;
}

/* Where a member starts, from the last one on, which is the centre. A grid has as many rows as make a square,
   and its last row what is left. */
static void place_member(const struct gm_system_lane *lane, size_t member, size_t m, double *from_centre)
{
    const double last = (double)(m - 1), side = ceil(sqrt(last)), index = (double)member;
    from_centre[0] = from_centre[1] = 0;
    if (member + 1 == m) {
        return;
    }
    if (lane->shape == GM_SHAPE_DISC) {
        from_centre[0] = lane->spread * cos(2 * M_PI * index / last);
        from_centre[1] = lane->spread * sin(2 * M_PI * index / last);
    } else if (lane->shape == GM_SHAPE_LINE) {
        from_centre[0] = last > 1 ? lane->spread * (2 * index / (last - 1) - 1) : lane->spread;
    } else if (side > 1) {
        from_centre[0] = lane->spread * (2 * fmod(index, side) / (side - 1) - 1);
        from_centre[1] = lane->spread * (2 * floor(index / side) / (side - 1) - 1);
    } else {
        from_centre[0] = lane->spread;
    }
}

/* A member of a disc or line, as near to where it was as may be. */
static void put_on_manifold(const struct gm_problem *problem, double *y, size_t m, size_t member)
{
    double *one = malloc(problem->n * sizeof *one);
    for (size_t c = 0; one && c < problem->n; c++) {
        one[c] = y[c * m + member];
    }
    const bool found = one && gm_manifold_project(problem, one);
    for (size_t c = 0; c < problem->n; c++) {
        y[c * m + member] = found ? one[c] : NAN;
    }
    free(one);
}

static void start(const void *parameters, const struct gm_problem *problem, double *y)
{
    const struct gm_system_lane *lane = parameters;
    const struct gm_system_scene *own = lane->own;
    const size_t n = own->system.n, m = problem->m;
    double *centre = malloc(n * sizeof *centre);
    if (!centre) {
        return; /* noted: the lane says that memory was short */
    }
    double *values = start_values(lane, NULL);
    for (size_t c = 0; c < n; c++) {
        centre[c] = values ? values[c] : NAN;
    }
    free(values);
    for (size_t i = 0; i < m; i++) {
        double from_centre[2];
        place_member(lane, i, m, from_centre);
        for (size_t c = 0; c < problem->n; c++) {
            y[c * m + i] = c < n ? centre[c] : 0;
        }
        y[own->disc[0] * m + i] += from_centre[0];
        y[own->disc[1] * m + i] += own->disc[1] != own->disc[0] ? from_centre[1] : 0;
        if (gm_action_constraints(problem) > 0 && i + 1 < m) {
            put_on_manifold(problem, y, m, i);
        }
    }
    free(centre);
}

static void close_problem(struct gm_problem *problem)
{
    gm_own_problem_close(problem);
}

/* ---- what went wrong, and how fast the system is ---- */

/* A formula that is no number: "log(x) is not finite where x = -0.3". */
static void tell_node(const struct gm_own_system *system, gm_node_id node, const double *values, char *text,
                      size_t size)
{
    const struct gm_naming naming = gm_system_naming(system);
    const struct gm_node *at = &system->graph.nodes[node];
    const gm_node_id operand = at->operation == GM_OPERATION_DIVIDE ? at->b : at->a;
    char *part = gm_formula_text(&system->graph, node, &naming), *inside = NULL;
    if (at->operation != GM_VARIABLE) {
        inside = gm_formula_text(&system->graph, operand, &naming);
    }
    snprintf(text, size, inside ? "%.120s is not finite where %.80s = %.4g" : "%.120s is not finite",
             part ? part : "a long formula", inside ? inside : "", inside ? values[operand] : 0);
    free(part);
    free(inside);
}

/* The first part of H, else of a rate, that is no number in a state; false if there is none. */
static bool tell_part(const struct gm_system_scene *own, const struct gm_view *view, const double *state,
                      char *text, size_t size)
{
    const struct gm_own_system *system = &own->system;
    const struct gm_formula *graph = &system->graph;
    const struct gm_system_lane *lane = view->parameters;
    const size_t m = view->problem->m;
    double *variables = malloc(system->variable_count * sizeof *variables);
    double *values = malloc((graph->count + (size_t)1) * sizeof *values);
    bool told = false;
    for (size_t i = 0; variables && i < system->variable_count; i++) {
        variables[i] = i < system->n ? state[i * m + m - 1] : i == system->n ? view->t : NAN;
    }
    for (size_t row = VALUES; variables && row < own->first_start; row++) {
        variables[own->variables[row]] = lane->values[row - VALUES];
    }
    if (variables && values) {
        gm_formula_evaluate(graph, graph->count, variables, values);
    }
    for (size_t i = 0; variables && values && i <= system->n && !told; i++) {
        const gm_node_id root = i > 0                      ? system->rates[i - 1]
                                : system->kind != GM_RATES ? system->energy
                                                           : GM_NO_NODE;
        size_t count = 0;
        gm_node_id *parts =
            root != GM_NO_NODE && !isfinite(values[root]) ? gm_formula_parts(graph, root, &count) : NULL;
        for (size_t k = 0; parts && k < count && !told; k++) {
            told = !isfinite(values[parts[k]]);
            if (told) {
                tell_node(system, parts[k], values, text, size);
            }
        }
        free(parts);
    }
    free(variables);
    free(values);
    return told;
}

/* A state of a Lagrangian system, of its last member, from which it does not move on: its momenta have no
   velocities, or no rates. */
static bool tell_velocities(const struct gm_system_scene *own, const struct gm_view *view,
                            const double *state, const double *slope, char *text, size_t size)
{
    const size_t m = view->problem->m, half = own->system.n / 2;
    bool placed = true, moves = true, turns = true;
    for (size_t i = 0; i < 2 * half; i++) {
        const bool finite = isfinite(slope[i * m + m - 1]);
        placed = placed && isfinite(state[i * m + m - 1]);
        moves = moves && (i >= half || finite);
        turns = turns && (i < half || finite);
    }
    if (!placed || (moves && turns)) {
        return false;
    }
    size_t length =
        (size_t)snprintf(text, size, "%s where ",
                         moves ? "dL/dq is not finite"
                               : "momenta do not determine velocities (the Legendre transform of L is "
                                 "singular)");
    for (size_t i = 0; i < half && length + 60 < size; i++) {
        length += (size_t)snprintf(text + length, size - length, "%s%.16s = %.6g", i > 0 ? ", " : "",
                                   own->system.variables[i].name, state[i * m + m - 1]);
    }
    return true;
}

/* Of a step whose length the monitor decided: how fast that falls. */
static void tell_monitor(const struct gm_view *view, const double *slope, double *ahead, char *text,
                         size_t size)
{
    const struct gm_monitor *monitor = gm_ode_of(view->problem)->monitor;
    double here, there;
    monitor->density(view->problem, view->state, &here, NULL);
    for (size_t i = 0; i < view->problem->n; i++) {
        ahead[i] = view->state[i] + view->dt / here * slope[i];
    }
    monitor->density(view->problem, ahead, &there, NULL);
    if (!(there >= here)) {
        snprintf(text, size, "the monitor, how dense steps are to be, is %.3g, and %.3g a step further", here,
                 there);
    }
}

static void tell_failure(const struct gm_view *view, char *text, size_t size)
{
    const struct gm_system_scene *own = scene_of(view);
    const size_t total = view->problem->n * view->problem->m;
    const bool lagrangian = own->system.kind == GM_LAGRANGIAN; /* its formulas hold velocities */
    double *slope = malloc(3 * total * sizeof *slope);
    text[0] = '\0';
    if (!slope) {
        return;
    }
    double *const ahead = slope + total, *const there = ahead + total;
    memcpy(ahead, view->state, total * sizeof *ahead);
    gm_field(view->problem, view->state, slope, view->problem->m);
    for (int part = 0; part <= 4; part++) { /* stages look ahead */
        for (size_t i = 0; i < total && part > 0; i++) {
            ahead[i] = view->state[i] + view->dt * part / 4 * slope[i];
        }
        if (lagrangian) {
            gm_field(view->problem, ahead, there, view->problem->m);
        }
        if (lagrangian ? tell_velocities(own, view, ahead, there, text, size)
                       : tell_part(own, view, ahead, text, size)) {
            break;
        }
    }
    if (!text[0] && (view->scheme->needs & GM_NEEDS_MONITOR)) {
        tell_monitor(view, slope, ahead, text, size);
    }
    free(slope);
}

/* 1 / the largest frequency of the linearised field at a state of one member, or, where nothing turns, of its
   largest rate; 1 where there is none. */
static double radian_at(const struct gm_problem *problem, const double *y)
{
    const size_t n = problem->n;
    double *there = malloc((n * n + 4 * n) * sizeof *there), fastest = 0, largest = 0;
    if (there) {
        double *below = there + n, *above = below + n, *matrix = above + n;
        for (size_t k = 0; k < n; k++) {
            memcpy(there, y, n * sizeof *y);
            const double h = 1e-6 * fmax(fabs(y[k]), 1e-2);
            there[k] = y[k] - h;
            gm_field(problem, there, below, 1);
            there[k] = y[k] + h;
            gm_field(problem, there, above, 1);
            for (size_t i = 0; i < n; i++) {
                matrix[i * n + k] = (above[i] - below[i]) / (2 * h);
            }
        }
        if (gm_eigenvalues(matrix, n, there, below)) {
            for (size_t i = 0; i < n; i++) {
                fastest = fmax(fastest, fabs(below[i]));
                largest = fmax(largest, hypot(there[i], below[i]));
            }
        }
    }
    free(there);
    const double rate = fastest > 1e-4 * largest ? fastest : largest;
    return rate > 1e-6 && isfinite(rate) ? 1 / rate : 1;
}

/* That at the start, and, with `looks`, the shortest of so many places along the first ten of it. */
static double shortest_radian(const struct gm_system_lane *lane, int looks)
{
    struct gm_problem problem;
    char sentence[GM_MESSAGE];
    if (lane->own->system.n > MOST_LINEARISED || !setup(lane, &problem, sentence)) {
        return 1;
    }
    double *y = calloc(problem.n, sizeof *y), *values = start_values(lane, NULL), radian = 1;
    if (y && values) {
        memcpy(y, values, lane->own->system.n * sizeof *y);
        problem.m = 1;
        radian = radian_at(&problem, y);
    }
    const struct gm_settings settings = {0};
    const double step = radian / 20;
    struct gm_run *run =
        y && values && looks > 0 ? gm_run_open(&problem, gm_scheme_find("rk4"), &settings, 0, step, y) : NULL;
    for (int i = 0; run && i < looks && gm_run_advance(run, 200 / looks) == GM_OK; i++) {
        radian = fmin(radian, radian_at(&problem, gm_run_state(run)));
    }
    gm_run_close(run);
    free(values);
    free(y);
    gm_own_problem_close(&problem);
    return radian;
}

static double radian_time(const void *parameters)
{
    return shortest_radian(parameters, 0);
}

/* ---- a click ---- */

/* Where a plane is shown there is nothing to go around. */
static const char *idle(const void *parameters, const char *key)
{
    const struct gm_system_lane *lane = parameters;
    return gm_camera_has(key) && gm_system_sight(lane)->dimensions < 3 ? "a plane is shown" : NULL;
}

static size_t point(const void *parameters, double x, double y, struct gm_choice *choices)
{
    const struct gm_system_lane *lane = parameters;
    const struct gm_sight *sight = gm_system_sight(lane);
    size_t count = 0;
    for (size_t k = 0; k < 2; k++) {
        for (size_t row = lane->own->first_start; row < lane->own->row_count; row++) {
            if (sight->components[k] >= 0 && lane->own->variables[row] == (size_t)sight->components[k]) {
                gm_choose(&choices[count++], lane->own->rows[row].key, k ? y : x);
            }
        }
    }
    return count == 2 ? 2 : 0;
}

/* ---- the scene is made ---- */

__attribute__((format(printf, 2, 3))) static const char *text_of(struct gm_system_scene *own,
                                                                 const char *format, ...)
{
    char *text = NULL;
    va_list arguments;
    va_start(arguments, format);
    const int length = vasprintf(&text, format, arguments);
    va_end(arguments);
    return gm_kept_texts_add(&own->texts, length < 0 ? NULL : text);
}

/* A tape whose inputs are all variables, so that lanes with different parameters share it. */
static bool open_tape(struct gm_system_scene *own, struct gm_tape *tape, const gm_node_id *nodes,
                      size_t count)
{
    const size_t inputs = own->system.variable_count;
    double *unused = calloc(inputs, sizeof *unused);
    const bool good = unused && gm_tape_open(tape, &own->system.graph, nodes, count, inputs, unused);
    free(unused);
    return good;
}

static size_t count_items(const struct gm_own_system *system, enum gm_system_word word)
{
    size_t count = 0;
    while (item_of(system, word, count)) {
        count++;
    }
    return count;
}

static const char *number_text(struct gm_system_scene *own, double value)
{
    char text[64];
    return text_of(own, "%s", gm_number_format(value, text, sizeof text));
}

static bool make_rows(struct gm_system_scene *own, bool typed)
{
    const struct gm_own_system *system = &own->system;
    const size_t n = system->n, half = n / 2, parameters = system->velocities - system->parameters;
    own->row_count = VALUES + parameters + n;
    own->first_start = VALUES + parameters;
    own->rows = calloc(own->row_count + GM_CAMERA_KEYS, sizeof *own->rows);
    own->variables = calloc(own->row_count, sizeof *own->variables);
    own->initial = calloc(1, sizeof *own->initial + (own->row_count) * (sizeof(double) + 1));
    double *start = gm_equations_start(system, NULL);
    bool good = own->rows && own->variables && own->initial && start;
    static const char *const shapes[] = {"disc", "grid", "line", NULL};
    static const struct gm_parameter common[VALUES] = {
        [DT] = GM_DT("", 1e-30, 1e30),
        [UNTIL] = GM_UNTIL(""),
        [MEMBERS] =
            GM_INTEGER_ROW(struct gm_system_lane, members, "members", "1", 1, 1e6,
                           "how many start: one, or a disc, a grid or a line of them", .logarithmic = true),
        [SPREAD] = GM_REAL_ROW(struct gm_system_lane, spread, "spread", "0.1", 0, 1e6,
                               "radius of that disc, half the width of a grid or a line"),
        [SHAPE] = GM_CHOICE_ROW(struct gm_system_lane, shape, "shape", "disc", shapes,
                                "of the members: on a disc's edge, in a grid, on a line"),
        [SHOW] = GM_CHOICE_ROW(struct gm_system_lane, show, "show", "all", NULL,
                               "all, the section, or a plane of two components"),
    };
    static const struct gm_parameter camera[] = {GM_CAMERA_ROWS(struct gm_system_lane, camera)};
    if (good) {
        memcpy(own->rows, common, sizeof common);
        memcpy(own->rows + own->row_count, camera, sizeof camera);
        own->initial->own = own;
    }
    for (size_t row = VALUES; good && row < own->row_count; row++) {
        const bool is_start = row >= own->first_start;
        size_t number = is_start ? row - own->first_start : system->parameters + row - VALUES;
        if (is_start && system->variables[number].start == GM_NO_NODE) {
            number = system->velocities + number - half; /* it is the velocity that the file gives */
        }
        const struct gm_system_variable *variable = &system->variables[number];
        const char *unit = variable->unit, *help = variable->meaning;
        const double value = start[number], reach = 1e300; /* sliders find their usual size themselves */
        const bool ranged = !isnan(variable->low);
        own->variables[row] = number;
        own->rows[row] = (struct gm_parameter){
            .key = variable->name,
            .unit = unit ? unit : "",
            .help = help && help[0] ? help
                    : is_start      ? "where it starts"
                                    : "a parameter",
            .type = GM_REAL,
            .offset = offsetof(struct gm_system_lane, values) + (row - VALUES) * sizeof(double),
            .standard = number_text(own, value),
            .lowest = variable->fixed ? value
                      : ranged        ? variable->low
                                      : -reach,
            .highest = variable->fixed ? value
                       : ranged        ? variable->high
                                       : reach,
            .required = typed,
        };
        good = own->rows[row].standard != NULL;
    }
    free(start);
    return good;
}

/* dt and until: as the file says, or by how fast the system is. */
static bool make_timing(struct gm_system_scene *own, char *sentence)
{
    const struct gm_own_system *system = &own->system;
    gm_parameters_reset(own->rows + VALUES, own->row_count + GM_CAMERA_KEYS - VALUES, own->initial);
    own->initial->members = 1;
    own->radian = radian_time(own->initial);
    double *values = start_values(own->initial, NULL);
    double numbers[3] = {NAN, NAN, NAN};
    for (size_t i = 0; values && i < 3; i++) {
        const struct gm_system_item *item =
            item_of(system, (enum gm_system_word)((int)GM_WORD_DT + (int)i), 0);
        if (item && open_tape(own, &own->timing[i], item->nodes, 1)) {
            gm_tape_values(&own->timing[i], values, &numbers[i], 1);
        }
    }
    free(values);
    if (numbers[2] < 0 || (isfinite(numbers[2]) && numbers[2] != floor(numbers[2]))) {
        return gm_refuse(sentence, "steps: %.10g is no whole number", numbers[2]);
    }
    const int looks = system->n <= MOST_FOLLOWED ? 10 : 0;
    const double dt =
        numbers[0] > 0 ? numbers[0] : gm_written_rounded(0.1 * shortest_radian(own->initial, looks));
    const double until = numbers[1] >= 0   ? numbers[1]
                         : numbers[2] >= 0 ? numbers[2] * dt
                                           : gm_written_rounded(100 * own->radian);
    own->rows[DT].standard = number_text(own, dt);
    own->rows[UNTIL].standard = number_text(own, until);
    return values && own->rows[DT].standard && own->rows[UNTIL].standard;
}

/* The exact solution, where the file tells one, begins where the system does. */
static bool check_exact(struct gm_system_scene *own, const struct gm_problem *problem, char *sentence)
{
    const size_t n = own->exact.outputs;
    struct gm_problem alone = *problem;
    double *start = n > 0 ? start_values(own->initial, NULL) : NULL, *exact = calloc(n + 1, sizeof *exact);
    bool good = n == 0 || (start && exact);
    alone.m = 1;
    if (n > 0 && good) {
        gm_system_values(
            &own->exact,
            &(struct gm_view){.parameters = own->initial, .problem = &alone, .state = start, .start = start},
            0, exact);
    }
    for (size_t i = 0; good && i < n; i++) {
        const struct gm_system_variable *variable = &own->system.variables[i];
        const double most = 1e-9 * fmax(1, fabs(start[i]));
        if (variable->exact != GM_NO_NODE && variable->start != GM_NO_NODE &&
            !(fabs(exact[i] - start[i]) <= most)) {
            good = gm_refuse(sentence, "exact: %.60s would begin at %.10g, and it starts at %.10g",
                             variable->name, exact[i], start[i]);
        }
    }
    free(start);
    free(exact);
    return good;
}

static bool add_observable(struct gm_system_scene *own, struct gm_observable row, gm_node_id node)
{
    const size_t i = own->observable_count;
    own->observables[i] = row;
    own->observable_count++;
    return row.key && row.title && (node == GM_NO_NODE || open_tape(own, &own->formulas[i], &node, 1));
}

static bool is_forced(const struct gm_own_system *system)
{
    for (size_t i = 0; i < system->n; i++) {
        if (system->variables[i].force != GM_NO_NODE) {
            return true;
        }
    }
    return false;
}

/* What the momentum map of a symmetry is measured by: its terms at the start, which may cancel. */
static double momentum_scale(struct gm_system_scene *own, const struct gm_system_item *item)
{
    const size_t half = own->system.n / 2;
    double *values = start_values(own->initial, NULL), *generator = malloc(half * sizeof *generator), sum = 0;
    struct gm_tape tape = {0};
    if (values && generator && open_tape(own, &tape, item->nodes, half)) {
        gm_tape_values(&tape, values, generator, 1);
        for (size_t i = 0; i < half; i++) {
            sum += fabs(generator[i] * values[half + i]);
        }
    }
    gm_tape_close(&tape);
    free(generator);
    free(values);
    return isfinite(sum) ? sum : 0;
}

/* The text, which is the scene's, with blanks for what joins words. */
static const char *spaced(struct gm_system_scene *own, const char *text)
{
    for (char *at = text ? own->texts.list[own->texts.count - 1] : NULL; at && *at; at++) {
        *at = *at == '_' ? ' ' : *at;
    }
    return text;
}

static bool add_energy(struct gm_system_scene *own, const struct gm_problem *problem)
{
    const struct gm_own_system *system = &own->system;
    const bool lagrangian = system->kind == GM_LAGRANGIAN, kept = !system->timed && !is_forced(system);
    if (system->kind == GM_RATES || (lagrangian && !gm_ode_of(problem)->hamiltonian)) {
        return true;
    }
    struct gm_observable energy =
        kept ? (struct gm_observable)GM_KEPT_OBSERVABLE("energy_error", observed, "H", "energy error")
             : (struct gm_observable)GM_OBSERVABLE("energy", observed, "energy, which is not constant");
    energy.evaluate = lagrangian ? legendre_energy : observed;
    return add_observable(own, energy, lagrangian ? GM_NO_NODE : system->energy);
}

/* The error of an invariant, of a Casimir, or of the momentum that belongs to a symmetry, which has this number
   among those without a name. */
static bool add_invariant(struct gm_system_scene *own, const struct gm_system_item *item, size_t nameless)
{
    const bool symmetry = item->word == GM_WORD_SYMMETRY;
    const char *name = item->name[0] ? item->name : text_of(own, "momentum%zu", nameless);
    if (!name) {
        return false;
    }
    const double scale = symmetry ? momentum_scale(own, item) : item->scale;
    struct gm_observable row =
        GM_KEPT_OBSERVABLE(text_of(own, "%s_error", name), observed, strlen(name) > 2 ? "I" : name,
                           spaced(own, text_of(own, "%s error", name)), .least = scale,
                           .scale_text = scale > 0 ? text_of(own, "%.3g", scale) : NULL);
    row.kept = item->check != GM_NOT_ZERO; /* else forces change it: no scheme is to blame */
    return add_observable(own, row, item->nodes[symmetry ? own->system.n / 2 : 0]);
}

/* What the file names: observe:, invariant:, casimir:, symmetry:. */
static bool add_named(struct gm_system_scene *own)
{
    const struct gm_own_system *system = &own->system;
    size_t nameless = 0;
    bool good = true;
    for (size_t i = 0; good && i < system->item_count; i++) {
        const struct gm_system_item *item = &system->items[i];
        switch (item->word) {
        case GM_WORD_OBSERVE:
            good = add_observable(own, (struct gm_observable)GM_OBSERVABLE(item->name, observed, item->name),
                                  item->nodes[0]);
            break;
        case GM_WORD_SYMMETRY:
            nameless += !item->name[0];
            good = system->kind > GM_LAGRANGIAN || add_invariant(own, item, nameless);
            break;
        case GM_WORD_INVARIANT:
        case GM_WORD_CASIMIR:
            good = add_invariant(own, item, 0);
            break;
        default:
            break;
        }
    }
    return good;
}

static bool add_defects(struct gm_system_scene *own, const struct gm_problem *problem)
{
    return gm_action_constraints(problem) == 0 ||
           (add_observable(own,
                           (struct gm_observable)GM_LOG_OBSERVABLE("constraint_defect", constraint_defect,
                                                                   "the largest |g|"),
                           GM_NO_NODE) &&
            add_observable(own,
                           (struct gm_observable)GM_LOG_OBSERVABLE("hidden_defect", hidden_defect,
                                                                   "the largest |dg/dt|"),
                           GM_NO_NODE));
}

/* The distance from exact:, of the components that it tells. */
static bool add_solution_error(struct gm_system_scene *own)
{
    const struct gm_own_system *system = &own->system;
    gm_node_id *exact = calloc(system->n, sizeof *exact);
    bool told = false;
    for (size_t i = 0; exact && i < system->n; i++) {
        const gm_node_id node = system->variables[i].exact;
        told |= node != GM_NO_NODE;
        exact[i] = node != GM_NO_NODE ? node : 0;
    }
    bool good = exact != NULL;
    if (good && told) {
        good = open_tape(own, &own->exact, exact, system->n) &&
               add_observable(own,
                              (struct gm_observable)GM_LOG_OBSERVABLE("solution_error", solution_error,
                                                                      "distance from the exact solution"),
                              GM_NO_NODE);
        own->work.measure = "solution_error";
    }
    free(exact);
    return good;
}

/* The area of a disc of members, in the plane. */
static bool add_area(struct gm_system_scene *own)
{
    static const char one_member[] = "with members= of at least 4 in a disc alone";
    const struct gm_own_system *system = &own->system;
    if (system->n != 2) {
        return true;
    }
    struct gm_observable error =
        GM_KEPT_OBSERVABLE("area_error", area, "A", "area error", .missing = one_member);
    /* a disc that is drawn out far is no polygon of its members any more: no scheme is to blame */
    error.kept = false;
    return add_observable(own,
                          (struct gm_observable)GM_OBSERVABLE("area", area, "area of the disc of members",
                                                              .missing = one_member),
                          GM_NO_NODE) &&
           (system->kind > GM_LAGRANGIAN || is_forced(system) || add_observable(own, error, GM_NO_NODE));
}

static bool make_observables(struct gm_system_scene *own, const struct gm_problem *problem, char *sentence)
{
    const size_t most = own->system.item_count + 7;
    own->observables = calloc(most, sizeof *own->observables);
    own->formulas = calloc(most, sizeof *own->formulas);
    bool good = own->observables && own->formulas && add_energy(own, problem) && add_named(own) &&
                add_defects(own, problem) && add_solution_error(own) && add_area(own);
    for (size_t i = 0; i < own->observable_count && good; i++) {
        for (size_t k = 0; k < i && good; k++) {
            good = strcmp(own->observables[i].key, own->observables[k].key) != 0 ||
                   gm_refuse(sentence, "there are two observables %s", own->observables[i].key);
        }
    }
    return good;
}

/* Whether a formula turns with the angles: one of them further by 2 pi makes that of it, or of its
   negative. */
static bool is_angle(struct gm_system_scene *own, gm_node_id node)
{
    const struct gm_own_system *system = &own->system;
    bool angles = false, found = false;
    for (size_t i = 0; i < system->n; i++) {
        angles |= system->variables[i].angle;
    }
    if (!angles) {
        return false;
    }
    double *values = start_values(own->initial, NULL), before, after;
    struct gm_tape tape = {0};
    if (values && open_tape(own, &tape, &node, 1)) {
        gm_tape_values(&tape, values, &before, 1);
        for (size_t i = 0; i < system->n && !found; i++) {
            if (system->variables[i].angle) {
                values[i] += 2 * M_PI;
                gm_tape_values(&tape, values, &after, 1);
                values[i] -= 2 * M_PI;
                found = fabs(fabs(after - before) - 2 * M_PI) < 1e-9;
            }
        }
    }
    gm_tape_close(&tape);
    free(values);
    return found;
}

/* An axis: what it is called, whether it is an angle, whether a component. */
static bool describe_axis(struct gm_system_scene *own, struct gm_sight *sight, size_t k, gm_node_id node)
{
    const struct gm_own_system *system = &own->system;
    const struct gm_node *at = &system->graph.nodes[node];
    const struct gm_naming naming = gm_system_naming(system);
    if (k < 2) {
        sight->components[k] = at->operation == GM_VARIABLE && at->a < system->n ? (long)at->a : -1;
        sight->angles[k] = is_angle(own, node);
    }
    sight->labels[k] = gm_kept_texts_add(&own->texts, gm_formula_text(&system->graph, node, &naming));
    return sight->labels[k] != NULL;
}

/* A plane of two formulas. */
static bool open_plane(struct gm_system_scene *own, struct gm_sight *sight, gm_node_id x, gm_node_id y)
{
    const gm_node_id nodes[] = {x, y};
    sight->dimensions = 2;
    sight->bodies = 1;
    sight->fixed = calloc(1, sizeof *sight->fixed);
    return sight->fixed && describe_axis(own, sight, 0, x) && describe_axis(own, sight, 1, y) &&
           open_tape(own, &sight->tape, nodes, 2);
}

/* Copies the formulas of all lines of a word; returns where they end. */
static gm_node_id *copy_nodes(const struct gm_own_system *system, enum gm_system_word word, gm_node_id *to)
{
    const struct gm_system_item *item;
    for (size_t i = 0; (item = item_of(system, word, i)); i++) {
        memcpy(to, item->nodes, item->count * sizeof *to);
        to += item->count;
    }
    return to;
}

/* Which bodies stand still. */
static bool find_fixed(const struct gm_own_system *system, struct gm_sight *sight, const gm_node_id *nodes)
{
    bool *marked = calloc(system->variable_count, sizeof *marked), *moves = NULL;
    for (size_t i = 0; marked && i <= system->n; i++) {
        marked[i] = true;
    }
    moves = marked ? gm_formula_dependent(&system->graph, marked, system->variable_count) : NULL;
    for (size_t i = 0; moves && i < sight->bodies; i++) {
        sight->fixed[i] = true;
        for (size_t k = 0; k < sight->dimensions; k++) {
            sight->fixed[i] = sight->fixed[i] && !moves[nodes[i * sight->dimensions + k]];
        }
    }
    free(marked);
    free(moves);
    return moves != NULL;
}

/* Axes of a plane have names where its one body tells them, and clicks there are starts; those of space are x, y
   and z where the first body does not tell others. */
static void name_axes(const struct gm_own_system *system, struct gm_sight *sight)
{
    static const char *const usual[] = {"x", "y", "z"};
    const struct gm_system_item *first = item_of(system, GM_WORD_VIEW, 0);
    const bool in_space = sight->dimensions == 3;
    bool told = first && (in_space || sight->rods == 0);
    for (size_t k = 0; told && k < sight->dimensions; k++) {
        const struct gm_node *at = &system->graph.nodes[first->nodes[k]];
        told = at->operation == GM_VARIABLE && at->a < system->n;
        if (told) {
            sight->labels[k] = system->variables[at->a].name;
            sight->components[k % 2] = in_space ? -1 : (long)at->a;
        }
    }
    for (size_t k = 0; k < 3 && !told; k++) {
        sight->labels[k] = in_space ? usual[k] : NULL;
    }
    if (sight->bodies > 1 && sight->components[0] >= 0) {
        sight->labels[0] = sight->labels[1] = NULL; /* they are those of one body only */
        for (size_t i = 1; i < sight->bodies; i++) {
            if (!sight->fixed[i]) {
                sight->components[0] = sight->components[1] = -1;
            }
        }
    }
}

/* What `view` and `rod` lines say. */
static bool open_view(struct gm_system_scene *own, struct gm_sight *sight)
{
    const struct gm_own_system *system = &own->system;
    const size_t views = count_items(system, GM_WORD_VIEW), rods = count_items(system, GM_WORD_ROD);
    const size_t dimensions =
        views > 0 ? item_of(system, GM_WORD_VIEW, 0)->count : item_of(system, GM_WORD_ROD, 0)->count / 2;
    *sight = (struct gm_sight){
        .name = "view", .dimensions = dimensions, .bodies = views, .rods = rods, .components = {-1, -1}};
    gm_node_id *nodes = calloc(gm_sight_numbers(sight), sizeof *nodes);
    sight->fixed = calloc(views + 1, sizeof *sight->fixed);
    bool good = nodes && sight->fixed;
    if (good) {
        copy_nodes(system, GM_WORD_ROD, copy_nodes(system, GM_WORD_VIEW, nodes));
        good =
            find_fixed(system, sight, nodes) && open_tape(own, &sight->tape, nodes, gm_sight_numbers(sight));
        name_axes(system, sight);
    }
    free(nodes);
    return good;
}

static bool open_surfaces(struct gm_system_scene *own, char *sentence)
{
    gm_node_id nodes[3 * GM_MOST_SURFACES];
    const size_t count = count_items(&own->system, GM_WORD_SURFACE);
    if (count > GM_MOST_SURFACES) {
        return gm_refuse(sentence, "a system has at most %d surfaces; this has %zu", GM_MOST_SURFACES, count);
    }
    copy_nodes(&own->system, GM_WORD_SURFACE, nodes);
    return count == 0 || open_tape(own, &own->surfaces, nodes, 3 * count);
}

static bool add_pair(struct gm_system_scene *own, size_t a, size_t b)
{
    struct gm_own_system *system = &own->system;
    if (own->sight_count == GM_MOST_SIGHTS) {
        return true;
    }
    struct gm_sight *sight = &own->sights[own->sight_count++];
    own->pair_count++;
    sight->name = text_of(own, "%s:%s", system->variables[a].name, system->variables[b].name);
    const gm_node_id x = gm_formula_variable(&system->graph, a), y = gm_formula_variable(&system->graph, b);
    return sight->name && open_plane(own, sight, x, y);
}

static bool make_sights(struct gm_system_scene *own)
{
    const struct gm_own_system *system = &own->system;
    const size_t n = system->n, half = n / 2;
    own->sights = calloc(GM_MOST_SIGHTS, sizeof *own->sights);
    own->shows = calloc(GM_MOST_SIGHTS + 4, sizeof *own->shows);
    bool good = own->sights && own->shows;
    if (good && (count_items(system, GM_WORD_VIEW) > 0 || count_items(system, GM_WORD_ROD) > 0)) {
        good = open_view(own, &own->sights[own->sight_count++]);
    }
    if (n == 1) {
        good = good && add_pair(own, 1, 0); /* over time */
    }
    for (size_t i = 0; good && system->kind <= GM_LAGRANGIAN && i < half; i++) {
        good = add_pair(own, i, half + i);
    }
    const size_t planar = system->kind <= GM_LAGRANGIAN ? half : n;
    for (size_t i = 0; good && i < planar && n > 1; i++) {
        for (size_t k = i + 1; good && k < planar && own->sight_count < GM_MOST_SIGHTS; k++) {
            good = add_pair(own, i, k);
        }
    }
    const struct gm_sight *first = &own->sights[0];
    own->disc[1] = n == 1 ? 0 : system->kind <= GM_LAGRANGIAN ? half : 1;
    if (good && first->components[0] >= 0 && first->components[1] >= 0 && n > 1) {
        own->disc[0] = (size_t)first->components[0];
        own->disc[1] = (size_t)first->components[1];
    }
    const struct gm_system_item *section_item = item_of(system, GM_WORD_SECTION, 0);
    if (good && section_item) {
        gm_node_id nodes[1 + GM_MOST_CONDITIONS] = {section_item->nodes[0]};
        own->has_section = true;
        own->stroboscopic = section_item->periodic;
        own->conditions =
            section_item->count - 3 < GM_MOST_CONDITIONS ? section_item->count - 3 : GM_MOST_CONDITIONS;
        memcpy(nodes + 1, section_item->nodes + 3, own->conditions * sizeof *nodes);
        own->turns = !own->stroboscopic && is_angle(own, nodes[0]);
        own->section.name = "section";
        good = open_plane(own, &own->section, section_item->nodes[1], section_item->nodes[2]) &&
               open_tape(own, &own->where, nodes, 1 + own->conditions);
    }
    size_t shows = 0;
    if (good) {
        own->shows[shows++] = "all";
        if (own->has_section) {
            own->shows[shows++] = "section";
        }
        for (size_t i = own->sight_count - own->pair_count; i < own->sight_count; i++) {
            own->shows[shows++] = own->sights[i].name;
        }
        if (own->system.kind == GM_CANONICAL) {
            own->shows[shows++] = GM_SHOW_MODIFIED;
        }
        own->rows[SHOW].choices = own->shows;
    }
    return good;
}

static void make_tracks(struct gm_system_scene *own)
{
    own->tracks[GM_TRACK_PAST] = (struct gm_track){
        .key = "past", .width = sight_width, .interval = step_of, .bound = 8192, .record = record_sight};
    own->tracks[GM_TRACK_TRAIL] = (struct gm_track){
        .key = "trail", .width = sight_width, .bound = 2048, .recent = true, .record = record_sight};
    own->tracks[GM_TRACK_SHAPES] = (struct gm_track){.key = "shapes",
                                                     .width = shape_width,
                                                     .interval = shape_interval,
                                                     .bound = 96,
                                                     .record = record_shape};
    own->tracks[GM_TRACK_SECTION] = (struct gm_track){.key = "section",
                                                      .numbers = 2,
                                                      .section = section,
                                                      .admits = is_admitted,
                                                      .again = true,
                                                      .each = true,
                                                      .bound = CROSSINGS,
                                                      .record = record_crossing};
    own->scene.tracks = own->tracks;
    own->scene.track_count = own->has_section ? GM_SYSTEM_TRACKS : GM_TRACK_SECTION;
    own->scene.follow = own->has_section ? 1 : 0;
}

/* Those that the file names, or of the best known the ones that fit. */
static bool make_schemes(struct gm_system_scene *own, const struct gm_problem *problem, char *sentence)
{
    static const char *const usual[] = {"rattle2", "verlet",           "midpoint", "rk4",
                                        "gauss4",  "symplectic-euler", "yoshida4"};
    const char *lacks = gm_own_model_lacks(&own->model);
    if (lacks[0]) {
        return gm_refuse(sentence, "%s", lacks);
    }
    size_t count;
    if (!gm_written_schemes(own->system.texts[GM_WORD_SCHEMES], problem, own->schemes, GM_MOST_PREFERRED,
                            &count, sentence)) {
        return false;
    }
    const bool named = count > 0;
    for (size_t i = 0; i < GM_COUNT(usual) && !named; i++) {
        const struct gm_scheme *scheme = gm_scheme_find_for(usual[i], problem);
        if (gm_scheme_fits(scheme, problem)) {
            own->schemes[count++] = scheme->name;
        }
    }
    if (count == 0) {
        return gm_refuse(sentence, "no scheme fits this system");
    }
    own->scene.schemes = own->schemes;
    return true;
}

/* The map of stability: over the first parameter that can change, or over where the first component
   starts. */
static bool make_studies(struct gm_system_scene *own)
{
    static const double factors[] = {0.5, 0.75, 1, 1.5, 2};
    static const double steps[] = {0.1, 0.2, 0.5, 1, 1.5, 1.95, 2.05, 3};
    size_t row = VALUES;
    while (row < own->first_start && own->rows[row].lowest == own->rows[row].highest) {
        row++;
    }
    const struct gm_parameter *parameter = &own->rows[row];
    const double usual = gm_parameter_get(parameter, own->initial);
    size_t count = 0;
    for (size_t i = 0; i < GM_COUNT(factors); i++) {
        const double value = usual != 0 ? usual * factors[usual > 0 ? i : GM_COUNT(factors) - 1 - i]
                                        : fmin(1, parameter->highest) * (double)i / GM_COUNT(factors);
        if (value >= parameter->lowest && value <= parameter->highest) {
            own->values[count++] = value;
        }
    }
    const double until = gm_written_rounded(200 * own->radian);
    own->stability = (struct gm_stability){
        .arguments = text_of(own, "until=%.17g", until),
        .parameter = parameter->key,
        .values = own->values,
        .value_count = count,
        .label = "h ω",
        .unit = radian_time,
        .told = "ω is the largest frequency of the linearised field at the start",
        .steps = steps,
        .step_count = GM_COUNT(steps),
        .throughout = true,
        .error = own->observable_count > 0 && own->observables[0].kept ? own->observables[0].key : NULL,
    };
    own->work.arguments = text_of(
        own, "until=%.17g", fmin(atof(own->rows[UNTIL].standard), gm_written_rounded(20 * own->radian)));
    own->work.coarsest = own->radian;
    own->work.halvings = 8;
    own->scene.work = &own->work;
    own->scene.stability = &own->stability;
    return own->stability.arguments && own->work.arguments;
}

/* What the file calls it, or its formula where that is short. */
static const char *title_of(struct gm_system_scene *own)
{
    enum { SHORT = 48 };
    const struct gm_own_system *system = &own->system;
    const bool rates = system->kind == GM_RATES;
    const struct gm_naming naming = gm_system_naming(system);
    if (system->texts[GM_WORD_TITLE]) {
        return system->texts[GM_WORD_TITLE];
    }
    char text[4 * SHORT] = "";
    bool whole = true;
    for (size_t i = 0; i < (rates ? system->n : 1) && strlen(text) <= SHORT && whole; i++) {
        char *formula = gm_formula_text(&system->graph, rates ? system->rates[i] : system->energy, &naming);
        const size_t used = strlen(text);
        snprintf(text + used, sizeof text - used, "%s%.16s%s = %.64s", i ? ",  " : "",
                 rates                           ? system->variables[i].name
                 : system->kind == GM_LAGRANGIAN ? "L"
                                                 : "H",
                 rates ? "'" : "", formula ? formula : "");
        whole = formula != NULL; /* too long a one is not written */
        free(formula);
    }
    const char *kept = whole && strlen(text) <= SHORT ? text_of(own, "%s", text) : NULL;
    return kept ? kept : "A system of one’s own";
}

static bool make(struct gm_system_scene *own, const char *name, const char *const *words, bool typed,
                 char *sentence)
{
    struct gm_own_system *system = &own->system;
    gm_refuse(sentence, "not enough memory");
    if (!gm_own_model_open(&own->model, system) || !make_rows(own, typed)) {
        return false;
    }
    own->scene = (struct gm_scene){
        .name = name,
        .title = title_of(own),
        .blurb = system->texts[GM_WORD_ABOUT] ? system->texts[GM_WORD_ABOUT] : "A system of one’s own.",
        .watch = system->texts[GM_WORD_WATCH] ? system->texts[GM_WORD_WATCH] : "",
        .time = "that of its equations",
        .size = sizeof *own->initial + own->row_count * (sizeof(double) + 1),
        .initial = own->initial,
        .words = words,
        .source = typed ? NULL : system->source,
        .text = system->source,
        .mark = gm_kept_texts_add(&own->texts, gm_written_mark(name, system->source)),
        .parameters = own->rows,
        .parameter_count = own->row_count,
        .idle = idle,
        .settle = settle,
        .setup = setup,
        .close = close_problem,
        .start = start,
        .draw = gm_system_draw,
        .point = point,
        .failure = tell_failure,
    };
    const struct gm_system_item *end = item_of(system, GM_WORD_STOP, 0);
    const char *members = system->texts[GM_WORD_MEMBERS];
    struct gm_problem problem;
    if (members && gm_parameter_set(&own->rows[MEMBERS], own->initial, members) != GM_PARSED) {
        return gm_refuse(sentence, "members: %.60s is no whole number from 1 to 1e6", members);
    }
    own->rows[MEMBERS].standard = members ? members : "1";
    if (!make_timing(own, sentence) || (end && !open_tape(own, &own->stop, end->nodes, 1)) ||
        !make_sights(own) || !open_surfaces(own, sentence) || !setup(own->initial, &problem, sentence)) {
        return false;
    }
    make_tracks(own);
    own->scene.parameter_count += own->sights[0].dimensions == 3 ? GM_CAMERA_KEYS : 0;
    if (end) {
        own->scene.stop = stop;
        own->scene.stops = stops;
        own->scene.follow = 1;
    }
    const bool good = make_observables(own, &problem, sentence) && check_exact(own, &problem, sentence) &&
                      make_schemes(own, &problem, sentence) && make_studies(own);
    gm_own_problem_close(&problem);
    own->scene.observables = own->observables;
    own->scene.observable_count = own->observable_count;
    const size_t skipped = system->kind == GM_RATES ? GM_MODIFIED_OBSERVABLES : 0;
    own->scene.asked = gm_ode_asked + skipped;
    own->scene.asked_count = GM_ODE_ASKED - skipped;
    own->scene.asked_shown = skipped ? NULL : gm_modified_shown;
    own->scene.draw_asked = gm_draw_modified;
    if (good && own->observable_count > MOST_OBSERVED) {
        return gm_refuse(sentence, "a system has at most %d observables and invariants; this has %zu",
                         MOST_OBSERVED, own->observable_count);
    }
    return good;
}

const struct gm_scene *gm_system_scene_open(struct gm_own_system *system, const char *name,
                                            const char *const *words, bool typed, char *sentence)
{
    struct gm_system_scene *own = calloc(1, sizeof *own);
    if (!own) {
        gm_system_close(system);
        gm_refuse(sentence, "not enough memory");
        return NULL;
    }
    own->system = *system;
    if (!make(own, name, words, typed, sentence)) {
        gm_system_scene_close(&own->scene);
        return NULL;
    }
    return &own->scene;
}

static void close_sight(struct gm_sight *sight)
{
    gm_tape_close(&sight->tape);
    free(sight->fixed);
}

void gm_system_scene_close(const struct gm_scene *scene)
{
    struct gm_system_scene *own = (struct gm_system_scene *)scene; /* which it is the first member of */
    for (size_t i = 0; i < own->sight_count; i++) {
        close_sight(&own->sights[i]);
    }
    close_sight(&own->section);
    gm_tape_close(&own->surfaces);
    for (size_t i = 0; own->formulas && i < own->observable_count; i++) {
        gm_tape_close(&own->formulas[i]);
    }
    struct gm_tape *const others[] = {&own->where,     &own->stop,      &own->exact,
                                      &own->timing[0], &own->timing[1], &own->timing[2]};
    for (size_t i = 0; i < GM_COUNT(others); i++) {
        gm_tape_close(others[i]);
    }
    gm_kept_texts_close(&own->texts);
    gm_own_model_close(&own->model);
    gm_system_close(&own->system);
    free(own->sights);
    free(own->shows);
    free(own->observables);
    free(own->formulas);
    free(own->variables);
    free(own->rows);
    free(own->initial);
    free(own);
}
