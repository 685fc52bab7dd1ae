/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A user-defined system as a scene: its parameters and the values of its start are keys, its invariants and
   the quantities that its file observes are observables, its section is a track. The scene is made while the
   program runs, and does not change afterwards; a lane finds its system through its parameters.

   With `members` the start is a disc in the plane that is shown, a grid of it, or a line along its first
   axis: the last member is in the middle, all others of a disc are on the edge. Observables are values of the
   centre; if the state is a plane, also the disc's area. */
#include "core/functions/functions.h"
#include "scenes/common/system/hook.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/events.h"
#include "core/linear/eigenvalues.h"
#include "core/memory.h"
#include "core/model/equations.h"
#include "core/ode/indicators/stiffness.h"
#include "core/ode/kernel/loops.h"
#include "core/ode/kernel/members.h"
#include "core/ode/variational/manifold.h"
#include "core/run.h"
#include "core/schemes.h"
#include "scenes/common/system/pieces.h"
#include "scenes/common/system/texts.h"
#include "scenes/common/system/variants.h"
#include "scenes/common/written.h"
#include "scenes/ode/system/optional.h"
#include "scenes/ode/system/parts.h"

enum { DT, UNTIL };
enum {
    MOST_OBSERVED = 60,
    MOST_LINEARISED = 200,
    STIFF_STEPS = 200,
    MOST_FOLLOWED = 32,
    CROSSINGS = 1 << 14,
    REMEMBERED = 256,
    MOST_FOLLOWED_STATES = 1024,
    MOST_RECORDED = 1 << 22 /* numbers of a track: many components have fewer entries */
};

/* ---- tracks ---- */

/* Records the state of the last member, from which every sight follows: another one may be chosen during the
   run. */
static void record_state(const struct gm_view *view, double *entry)
{
    gm_member_take(view->state, entry, gm_system_scene_of(view)->system.n, view->problem->m,
                   gm_system_centre(view));
}

static double step_of(const void *parameters)
{
    return fabs(((const struct gm_timing *)parameters)->dt);
}

/* Returns the interval of the disc's shapes: about a twelfth of the shortest period. */
static double shape_interval(const void *parameters)
{
    const struct gm_system_lane *lane = parameters;
    return fmax(lane->owner->radian * M_PI / 6, step_of(parameters));
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
    const struct gm_system_scene *system_scene = gm_system_scene_of(view);
    const size_t m = view->problem->m, members = m > 1 ? m - 1 : 1;
    for (size_t i = 0; i < members; i += shape_stride(members), entry += 2) {
        entry[0] = view->state[system_scene->disc[0] * m + i];
        entry[1] = view->state[system_scene->disc[1] * m + i];
    }
}

static size_t members_width(const struct gm_view *view)
{
    const size_t followed = gm_system_followed(view);
    return followed > 0 ? followed * gm_system_scene_of(view)->system.n : 1;
}

/* Records the states of some members, for their curves over time. */
static void record_members(const struct gm_view *view, double *entry)
{
    const size_t n = gm_system_scene_of(view)->system.n, m = view->problem->m,
                 followed = gm_system_followed(view);
    entry[0] = 0;
    for (size_t i = 0; i < followed * n; i++) {
        entry[i] = view->state[i % n * m + gm_system_followed_member(view, i / n)];
    }
}

static double section(const struct gm_view *view)
{
    const struct gm_system_scene *system_scene = gm_system_scene_of(view);
    double values[1 + GM_MOST_CONDITIONS];
    if (system_scene->at_event) {
        return NAN;
    }
    gm_system_values(&system_scene->where, view, view->member, values);
    if (system_scene->stroboscopic) {
        return gm_sin(2 * M_PI * (view->t - view->t0) / values[0]);
    }
    return system_scene->turns ? gm_sin(values[0] / 2) : values[0];
}

/* The same for steps that were made together. */
static void sections(const struct gm_view *view, const struct gm_trace *trace, double *values)
{
    const struct gm_system_scene *system_scene = gm_system_scene_of(view);
    const bool alike = !system_scene->stroboscopic && !system_scene->turns &&
                       system_scene->where.last_used <= system_scene->system.exact;
    if (alike) {
        gm_system_values_along(&system_scene->where, view, trace, values);
    }
    for (int64_t k = 0; k < trace->count && !alike; k++) {
        const struct gm_view there = gm_view_along(view, trace, k + 1);
        values[k] = section(&there);
    }
}

static bool is_admitted(const struct gm_view *view)
{
    const struct gm_system_scene *system_scene = gm_system_scene_of(view);
    double values[1 + GM_MOST_CONDITIONS];
    gm_system_values(&system_scene->where, view, view->member, values);
    bool holds = !system_scene->stroboscopic || gm_cos(2 * M_PI * (view->t - view->t0) / values[0]) > 0;
    for (size_t i = 0; i < system_scene->conditions; i++) {
        holds = holds && values[1 + i] > 0;
    }
    return holds;
}

/* True if the section is at this event. */
static bool is_at_event(const struct gm_view *view, size_t event)
{
    const struct gm_system_scene *system_scene = gm_system_scene_of(view);
    const struct gm_system_item *item = gm_system_item_of(&system_scene->system, GM_WORD_SECTION, 0);
    return system_scene->at_event && strcmp(view->problem->events->names[event], item->name) == 0;
}

static void record_crossing(const struct gm_view *view, double *entry)
{
    gm_system_values(&gm_system_scene_of(view)->section.tape, view, view->member, entry);
}

/* ---- from parameters to problem and start ---- */

static bool starts_on_manifold(const struct gm_problem *problem, const double *values, char *sentence)
{
    const struct gm_manifold_defects defects = gm_manifold_defects(problem, values);
    return (defects.constraint <= 1e-8 && defects.hidden <= 1e-8) ||
           gm_refuse(
               sentence,
               "the start violates the constraints: their residual is %.3g, and that of their rates %.3g",
               defects.constraint, defects.hidden);
}

/* Returns true if momenta, or theta, determine velocities at this start; the file's start is checked when it is read. */
static bool has_velocities(const struct gm_user_system *system, double *values, char *sentence)
{
    struct gm_fault fault = {.sentence = "not enough memory"};
    return gm_equations_check_velocities(system, values, &fault) || gm_refuse(sentence, "%s", fault.sentence);
}

/* Looks at the rates at the start. Returns false if one is not finite in a magnetic field, whose steps do not evaluate the
   field at their start. Momenta that are 0 may have a unit in which their first step is far larger than all numbers of the
   start. That is not a blow-up, so the bound grows with it. */
static bool has_field(struct gm_problem *problem, double dt, const double *values, char *sentence)
{
    const double other = 1e6, growth = 1e10; /* as core/run.c */
    const struct gm_ode *ode = gm_ode_of(problem);
    double *rates = ode->magnetic || ode->hamiltonian ? malloc(problem->n * sizeof *rates) : NULL;
    double largest = 1, fastest = 0;
    bool finite = true;
    if (rates) {
        struct gm_problem alone = *problem;
        alone.m = 1;
        gm_field(&alone, values, rates, 1);
    }
    for (size_t i = 0; rates && i < problem->n; i++) {
        finite = finite && isfinite(rates[i]);
        largest = fmax(largest, fabs(values[i]));
        fastest = fmax(fastest, fabs(dt * rates[i]));
    }
    problem->bound = fastest > other * largest && isfinite(fastest) ? growth * fastest : problem->bound;
    free(rates);
    return finite || !ode->magnetic || gm_refuse(sentence, "the rates are not finite at the start");
}

/* Returns true if the sizes of the surfaces are positive. */
static bool has_surfaces(const struct gm_tape *surfaces, const double *values, char *sentence)
{
    double sizes[3 * GM_MOST_SURFACES];
    if (surfaces->outputs > 0) {
        gm_tape_values(surfaces, values, sizes, 1);
    }
    for (size_t i = 0; i < surfaces->outputs; i++) {
        if (!(sizes[i] > 0 && isfinite(sizes[i]))) {
            return gm_refuse(sentence, "the size of a surface is %g, and has to be above 0", sizes[i]);
        }
    }
    return true;
}

/* Opens the problem of a lane, with these values of all variables at the start. */
static bool open_problem(const struct gm_system_lane *lane, double *values, struct gm_problem *problem,
                         char *sentence)
{
    const struct gm_system_scene *system_scene = lane->owner;
    if (!has_surfaces(&system_scene->surfaces, values, sentence) ||
        !has_velocities(&system_scene->system, values, sentence) ||
        (lane->portrait && !gm_system_is_plane(system_scene, sentence)) ||
        !gm_system_can_show(lane, sentence) || !gm_system_is_admitted(lane, values, sentence)) {
        return false;
    }
    if (!gm_user_problem_open(problem, &system_scene->model, values)) {
        return gm_refuse(sentence, "not enough memory");
    }
    problem->name = system_scene->scene.name;
    if ((gm_action_constraints(problem) > 0 && !starts_on_manifold(problem, values, sentence)) ||
        !has_field(problem, lane->timing.dt, values, sentence)) {
        gm_user_problem_close(problem);
        return false;
    }
    problem->m =
        system_scene->hook ? system_scene->hook->members : (size_t)lane->members + system_scene->centre;
    if (problem->m > 1 && problem->events && problem->events->changes) {
        gm_user_problem_close(problem);
        return gm_refuse(sentence, "events change the state of one motion at a time: members=1, or a sweep");
    }
    return true;
}

static bool setup(const void *parameters, struct gm_problem *problem, char *sentence)
{
    double *values = gm_system_start_values(parameters, NULL);
    const bool opened = values ? open_problem(parameters, values, problem, sentence)
                               : gm_refuse(sentence, "not enough memory");
    free(values);
    return opened;
}

/* Sets a member's start relative to the last one, the centre. A grid has as many rows as make a square; its
   last row has the rest. */
static void place_member(const struct gm_system_lane *lane, size_t member, size_t m, double *from_centre)
{
    const double last = (double)(m - 1), side = ceil(sqrt(last)), index = (double)member;
    from_centre[0] = from_centre[1] = 0;
    if (member + 1 == m) {
        return;
    }
    if (lane->shape == GM_SHAPE_DISC) {
        from_centre[0] = lane->spread * gm_cos(2 * M_PI * index / last);
        from_centre[1] = lane->spread * gm_sin(2 * M_PI * index / last);
    } else if (lane->shape == GM_SHAPE_LINE) {
        from_centre[0] = last > 1 ? lane->spread * (2 * index / (last - 1) - 1) : lane->spread;
    } else if (side > 1) {
        from_centre[0] = lane->spread * (2 * fmod(index, side) / (side - 1) - 1);
        from_centre[1] = lane->spread * (2 * floor(index / side) / (side - 1) - 1);
    } else {
        from_centre[0] = lane->spread;
    }
}

/* Moves a member of a disc or line to the nearest point of the manifold. */
static void put_on_manifold(const struct gm_problem *problem, double *y, size_t m, size_t member)
{
    double *one = malloc(problem->n * sizeof *one);
    if (one) {
        gm_member_take(y, one, problem->n, m, member);
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
    const struct gm_system_scene *system_scene = lane->owner;
    const size_t n = system_scene->system.n, m = problem->m;
    double *values = gm_system_start_values(lane, NULL); /* NULL is noted: the lane reports it */
    for (size_t i = 0; values && i < m; i++) {
        double from_centre[2] = {0, 0};
        if (!system_scene->hook) {
            place_member(lane, i, m, from_centre);
        }
        for (size_t c = 0; c < problem->n; c++) {
            y[c * m + i] = c < n ? values[c] : 0;
        }
        y[system_scene->disc[0] * m + i] += from_centre[0];
        y[system_scene->disc[1] * m + i] +=
            system_scene->disc[1] != system_scene->disc[0] ? from_centre[1] : 0;
        if (gm_action_constraints(problem) > 0 && i + 1 < m) {
            put_on_manifold(problem, y, m, i);
        }
    }
    if (values && system_scene->hook) {
        system_scene->hook->place(y);
    }
    free(values);
}

/* ---- how fast the system is ---- */

/* The slope of a value from places at distances -2, -1, 1 and 2 h. Of a field that is not smooth, across a jump, it is that
   of the steeper side. */
static double slope_of(const double *values[4], size_t i, double h, bool rough)
{
    const double central = (values[2][i] - values[1][i]) / (2 * h);
    if (!rough) {
        return central;
    }
    const double below = (values[1][i] - values[0][i]) / h, above = (values[3][i] - values[2][i]) / h,
                 beside = fabs(below) > fabs(above) ? below : above;
    return fabs(central) > 1e3 * (fabs(beside) + 1) ? beside : central;
}

/* Returns 1 / the largest frequency of the linearised field at a state of one member, or of its largest rate
   if nothing turns; 1 if both are 0. */
static double radian_at(const struct gm_problem *problem, const double *y)
{
    const size_t n = problem->n;
    const bool rough = gm_ode_of(problem)->rough;
    double *there = malloc((n * n + 5 * n) * sizeof *there), fastest = 0, largest = 0;
    if (there) {
        double *matrix = there + 5 * n;
        const double *values[4] = {there + n, there + 2 * n, there + 3 * n, there + 4 * n};
        for (size_t k = 0; k < n; k++) {
            static const double places[] = {-2, -1, 1, 2};
            memcpy(there, y, n * sizeof *y);
            const double h = 1e-6 * fmax(fabs(y[k]), 1e-2);
            for (size_t p = rough ? 0 : 1; p < (rough ? 4 : 3); p++) {
                there[k] = y[k] + places[p] * h;
                gm_field(problem, there, there + (p + 1) * n, 1);
            }
            for (size_t i = 0; i < n; i++) {
                matrix[i * n + k] = slope_of(values, i, h, rough);
            }
        }
        double *below = there + n;
        if (gm_eigenvalues(matrix, n, there, below)) {
            for (size_t i = 0; i < n; i++) {
                fastest = fmax(fastest, fabs(below[i]));
                largest = fmax(largest, gm_hypot(there[i], below[i]));
            }
        }
    }
    free(there);
    const double rate = fastest > 1e-4 * largest ? fastest : largest;
    return rate > 1e-6 && isfinite(rate) ? 1 / rate : 1;
}

/* Returns 1 / the largest frequency at a state, or the shortest such time at `looks` more points along the
   first ten of it. */
static double radian_along(const struct gm_problem *problem, const double *y, double looks)
{
    const struct gm_settings settings = {0};
    double radian = radian_at(problem, y);
    struct gm_run *run =
        looks > 0 ? gm_run_open(problem, gm_scheme_find("rk4"), &settings, 0, radian / 20, y) : NULL;
    for (int i = 0; run && i < looks && gm_run_advance(run, (int64_t)(200 / looks)) == GM_OK; i++) {
        radian = fmin(radian, radian_at(problem, gm_run_state(run)));
    }
    gm_run_close(run);
    return radian;
}

static double is_stiff(const struct gm_problem *problem, const double *y, double until)
{
    return gm_stiffness_of(problem, y, until).stiff;
}

/* Measures a lane's problem with one member at its start; `otherwise` if it is large, or when out of memory. */
static double measure_start(const struct gm_system_lane *lane,
                            double (*measure)(const struct gm_problem *problem, const double *y, double data),
                            double data, double otherwise)
{
    struct gm_problem problem;
    char sentence[GM_MESSAGE];
    if (lane->owner->system.n > MOST_LINEARISED || !setup(lane, &problem, sentence)) {
        return otherwise;
    }
    double *y = calloc(problem.n, sizeof *y), *values = gm_system_start_values(lane, NULL);
    problem.m = 1;
    if (y && values) {
        memcpy(y, values, lane->owner->system.n * sizeof *y);
        otherwise = measure(&problem, y, data);
    }
    free(values);
    free(y);
    gm_user_problem_close(&problem);
    return otherwise;
}

static double radian_time(const void *parameters)
{
    return measure_start(parameters, radian_along, 0, 1);
}

/* ---- a click ---- */

/* Returns why a key has no effect: a plane has no camera, another word of a choice has other values. */
static const char *idle(const void *parameters, const char *key)
{
    const char *reason = gm_system_idle(parameters, key);
    return !reason && gm_camera_has(key) && gm_system_sight(parameters)->dimensions < 3 ? "a plane is shown"
                                                                                        : reason;
}

/* Adds the component that is 0 in the section, if that is a component. */
static size_t on_section(const struct gm_system_lane *lane, const struct gm_sight *sight,
                         struct gm_choice *choice)
{
    const struct gm_system_scene *system_scene = lane->owner;
    if (sight != &system_scene->section || system_scene->stroboscopic || system_scene->at_event) {
        return 0;
    }
    const struct gm_system_item *item = gm_system_item_of(&system_scene->system, GM_WORD_SECTION, 0);
    const struct gm_node *node = &system_scene->system.graph.nodes[item->nodes[0]];
    for (size_t row = GM_SYSTEM_ROWS; row < system_scene->row_count; row++) {
        if (node->operation == GM_VARIABLE && system_scene->variables[row] == node->a &&
            sight->components[0] != (long)node->a && sight->components[1] != (long)node->a) {
            gm_choose(choice, system_scene->rows[row].key, 0);
            return 1;
        }
    }
    return 0;
}

/* Returns the variable that sets a component's start: a parameter that is its start, or itself. */
static size_t start_of(const struct gm_user_system *system, long component)
{
    if (component < 0 || (size_t)component >= system->n) {
        return GM_NO_VARIABLE;
    }
    const gm_node_id start = system->variables[component].start;
    const struct gm_node *node = start == GM_NO_NODE ? NULL : &system->graph.nodes[start];
    const bool given = node && node->operation == GM_VARIABLE && node->a >= system->parameters &&
                       node->a < system->velocities;
    return given ? node->a : (size_t)component;
}

static size_t point(const void *parameters, double x, double y, struct gm_choice *choices)
{
    const struct gm_system_lane *lane = parameters;
    const struct gm_sight *sight = gm_system_sight(lane);
    size_t count = 0;
    for (size_t k = 0; k < 2; k++) {
        const size_t number = start_of(&lane->owner->system, sight->components[k]);
        for (size_t row = GM_SYSTEM_ROWS; row < lane->owner->row_count; row++) {
            if (number != GM_NO_VARIABLE && lane->owner->variables[row] == number) {
                gm_choose(&choices[count++], lane->owner->rows[row].key, k ? y : x);
            }
        }
    }
    if (count == (sight->over_time ? 1 : 2)) {
        return count + on_section(lane, sight, &choices[count]);
    }
    double *start = gm_system_start_values(lane, NULL);
    count = start ? gm_system_aim(lane, start, x, y, choices) : 0;
    free(start);
    return count;
}

/* ---- the scene is made ---- */

static void make_rows(struct gm_system_scene *system_scene, bool typed)
{
    static const char *const shapes[] = {"disc", "grid", "line", NULL};
    static const struct gm_parameter timing[GM_SYSTEM_ROWS] = {
        [DT] = GM_DT("", 1e-30, 1e30), [UNTIL] = GM_UNTIL("")};
    static const struct gm_parameter common[GM_COMMON_ROWS + GM_CAMERA_KEYS] = {
        [GM_ROW_MEMBERS] =
            GM_INTEGER_ROW(struct gm_system_lane, members, "members", "1", 1, 1e6,
                           "how many start: one, or a disc, a grid or a line of them", .logarithmic = true),
        [GM_ROW_SPREAD] = GM_REAL_ROW(struct gm_system_lane, spread, "spread", "0.1", 0, 1e6,
                                      "radius of that disc, half the width of a grid or a line"),
        [GM_ROW_SHAPE] = GM_CHOICE_ROW(struct gm_system_lane, shape, "shape", "disc", shapes,
                                       "of the members: on a disc's edge, in a grid, on a line"),
        [GM_ROW_SHOW] = GM_TEXT_ROW(struct gm_system_lane, show, "show", "all",
                                    "all, a plane of two components, or names over time, as in t:q+p",
                                    .live = true, .admits = gm_system_admits_show),
        [GM_ROW_TRAILS] = GM_TRAILS_ROW(struct gm_system_lane),
        [GM_ROW_PORTRAIT] = GM_BOOLEAN_ROW(struct gm_system_lane, portrait, "portrait", "no",
                                           "the direction field, nullclines and equilibria of a plane",
                                           .live = true, .looks = true, .admits = gm_system_admits_portrait),
        [GM_ROW_WINDOW] = GM_TEXT_ROW(struct gm_system_lane, window, "window", "auto",
                                      "the plane that is shown: XMIN,XMAX,YMIN,YMAX, or auto", .names = true,
                                      .live = true, .looks = true, .admits = gm_system_admits_window),
        GM_CAMERA_ROWS(struct gm_system_lane, camera),
    };
    const size_t skipped = gm_system_skipped(system_scene);
    gm_system_make_rows(system_scene, timing, common + skipped, GM_COUNT(common) - skipped, typed);
    for (int k = 0; k < 2 && !system_scene->hook; k++) {
        const enum gm_system_word word = k ? GM_WORD_SPREAD : GM_WORD_MEMBERS;
        const struct gm_system_item *item = gm_system_item_of(&system_scene->system, word, 0);
        struct gm_parameter *row = &system_scene->common[k ? GM_ROW_SPREAD : GM_ROW_MEMBERS];
        if (item) {
            row->key = item->name[0] ? item->name : row->key;
            row->help = item->text[0] ? item->text : row->help;
            row->standard =
                gm_written_number(system_scene->arena, item->value, system_scene->system.texts[word]);
            row->lowest = fmax(item->low, row->lowest);
            row->highest = fmin(item->high, row->highest);
            row->logarithmic = row->lowest > 0;
            system_scene->centre += word == GM_WORD_MEMBERS && item->name[0];
        }
    }
}

/* Makes dt and until, from the file, or from the system's frequency. */
static void make_timing(struct gm_system_scene *system_scene)
{
    const struct gm_user_system *system = &system_scene->system;
    gm_parameters_reset(system_scene->rows + GM_SYSTEM_ROWS, system_scene->row_count - GM_SYSTEM_ROWS,
                        system_scene->initial);
    system_scene->initial->members = 1;
    int exponent; /* without the round-off of differences: shapes are at multiples of pi/6 for a unit frequency */
    const double part = frexp(radian_time(system_scene->initial), &exponent);
    system_scene->radian = ldexp(round(ldexp(part, 20)), exponent - 20);
    double numbers[GM_SYSTEM_TIMES];
    gm_system_open_timing(system_scene, numbers);
    const int looks = system->n <= MOST_FOLLOWED ? 10 : 0;
    const double dt =
        numbers[0] > 0
            ? numbers[0]
            : gm_written_rounded(0.1 * measure_start(system_scene->initial, radian_along, looks, 1));
    const double until = numbers[1] >= 0   ? numbers[1]
                         : numbers[2] >= 0 ? numbers[2] * dt
                                           : gm_written_rounded(100 * system_scene->radian);
    const double end = system_scene->origin.until > 0 ? system_scene->origin.until : until;
    system_scene->is_stiff = !(numbers[0] > 0) && !(numbers[2] >= 0) && !system->texts[GM_WORD_SCHEMES] &&
                             measure_start(system_scene->initial, is_stiff, end, 0) > 0;
    gm_written_timing(system_scene->arena, system,
                      system_scene->is_stiff ? gm_written_rounded(end / STIFF_STEPS) : dt, until,
                      system_scene->rows);
}

/* Makes the sights of the state, and the one of the modified energy. */
static void make_shows(struct gm_system_scene *system_scene)
{
    gm_system_make_sights(system_scene);
    size_t shows = 0;
    while (system_scene->shows[shows]) {
        shows++;
    }
    system_scene->shows[shows] = system_scene->system.kind == GM_CANONICAL ? GM_SHOW_MODIFIED : NULL;
    struct gm_parameter *show = &system_scene->common[GM_ROW_SHOW - gm_system_skipped(system_scene)];
    show->choices = system_scene->shows;
    show->admitting = show[GM_ROW_PORTRAIT - GM_ROW_SHOW].admitting = system_scene;
    if (system_scene->has_section) {
        show->help = "all, the section, a plane of two components, or names over time, as in t:q+p";
        if (gm_system_item_of(&system_scene->system, GM_WORD_SECTION, 0)->alone) {
            show->standard = system_scene->shows[GM_SHOW_SECTION];
        }
    }
}

static void make_tracks(struct gm_system_scene *system_scene)
{
    static const struct gm_track tracks[GM_SYSTEM_TRACKS] = {
        [GM_TRACK_PAST] = {.key = "past",
                           .interval = step_of,
                           .bound = 8192,
                           .jumps = true,
                           .is_state = true,
                           .record = record_state},
        [GM_TRACK_TRAIL] = {.key = "trail",
                            .bound = 2048,
                            .recent = true,
                            .jumps = true,
                            .is_state = true,
                            .record = record_state},
        [GM_TRACK_SHAPES] = {.key = "shapes",
                             .width = shape_width,
                             .interval = shape_interval,
                             .bound = 96,
                             .record = record_shape},
        [GM_TRACK_MEMBERS] = {.key = "members",
                              .width = members_width,
                              .interval = step_of,
                              .bound = MOST_FOLLOWED_STATES,
                              .record = record_members},
        [GM_TRACK_SECTION] = {.key = "section",
                              .numbers = 2,
                              .section = section,
                              .sections = sections,
                              .admits = is_admitted,
                              .at_event = is_at_event,
                              .again = true,
                              .bound = CROSSINGS,
                              .record = record_crossing},
    };
    const size_t n = system_scene->system.n, bound = 2 + MOST_RECORDED / n;
    memcpy(system_scene->tracks, tracks, sizeof tracks);
    for (size_t i = GM_TRACK_PAST; i <= GM_TRACK_TRAIL; i++) {
        system_scene->tracks[i].numbers = n;
        system_scene->tracks[i].bound = bound < tracks[i].bound ? bound : tracks[i].bound;
    }
    system_scene->tracks[GM_TRACK_SECTION].each = !system_scene->hook;
    system_scene->scene.tracks = system_scene->tracks;
    system_scene->scene.track_count = system_scene->has_section ? GM_SYSTEM_TRACKS : GM_TRACK_SECTION;
    system_scene->scene.follow = system_scene->has_section ? 1 : 0;
}

/* Chooses the schemes that the file names, or the best known ones that fit. */
static void make_schemes(struct gm_system_scene *system_scene, const struct gm_problem *problem)
{
    static const char *const usual[] = {"gsl-msbdf", "radau5", "rattle2",          "verlet",  "midpoint",
                                        "rk4",       "gauss4", "symplectic-euler", "yoshida4"};
    enum { STIFF = 2 }; /* the first are for stiff systems */
    const char *lacks = gm_user_model_lacks(&system_scene->model);
    if (lacks[0]) {
        gm_arena_refuse(system_scene->arena, "%s", lacks);
    }
    size_t count = gm_written_schemes(system_scene->arena, system_scene->system.texts[GM_WORD_SCHEMES],
                                      problem, system_scene->schemes);
    const bool named = count > 0;
    for (size_t i = system_scene->is_stiff ? 0 : STIFF; i < GM_COUNT(usual) && !named; i++) {
        const struct gm_scheme *scheme = gm_scheme_find_for(usual[i], problem);
        if (gm_scheme_fits(scheme, problem)) {
            system_scene->schemes[count++] = scheme->name;
        }
    }
    if (count == 0) {
        gm_arena_refuse(system_scene->arena, "no scheme fits this system");
    }
    system_scene->scene.schemes = system_scene->schemes;
    system_scene->scene.lanes = system_scene->system.texts[GM_WORD_LANES];
}

/* Returns the title of a file that has none: the formula if that is short. */
static const char *title_of(struct gm_system_scene *system_scene)
{
    enum { SHORT = 48 };
    const struct gm_user_system *system = &system_scene->system;
    const bool rates = system->kind == GM_RATES;
    const struct gm_naming naming = gm_system_naming(system);
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
        whole = formula != NULL; /* a long formula is left out */
        free(formula);
    }
    return whole && strlen(text) <= SHORT ? gm_arena_print(system_scene->arena, "%s", text)
                                          : "A user's system";
}

static void make(struct gm_system_making *making)
{
    const unsigned long refusals = gm_memory_refusals();
    struct gm_system_scene *system_scene = making->scene;
    struct gm_arena *arena = system_scene->arena;
    struct gm_user_system *system = &system_scene->system;
    const bool typed = system_scene->origin.typed;
    gm_system_find_hook(system_scene);
    gm_arena_need(arena, gm_user_model_open(&system_scene->model, system));
    make_rows(system_scene, typed);
    gm_system_describe(system_scene, (struct gm_scene){.title = title_of(system_scene),
                                                       .blurb = "A user's system.",
                                                       .time = "the unit of its equations",
                                                       .idle = idle,
                                                       .setup = setup,
                                                       .close = gm_user_problem_close,
                                                       .start = start,
                                                       .draw = gm_system_draw,
                                                       .portrait = gm_system_portrait,
                                                       .point = point,
                                                       .failure = gm_system_tell_failure});
    system_scene->scene.source = typed ? NULL : system_scene->scene.source;
    system_scene->scene.parameter_count -= GM_CAMERA_KEYS; /* unless it is in space */
    gm_system_open_items(system_scene);
    make_timing(system_scene);
    make_shows(system_scene);
    gm_system_check_levels(system_scene);
    gm_system_open_surfaces(system_scene);
    gm_system_open_problem(making);
    make_tracks(system_scene);
    system_scene->scene.parameter_count += system_scene->sights[0].dimensions == 3 ? GM_CAMERA_KEYS : 0;
    gm_system_make_observables(system_scene, &making->problem);
    gm_system_check_exact(system_scene, &making->problem);
    make_schemes(system_scene, &making->problem);
    gm_system_make_studies(system_scene, &making->problem, radian_time);
    const size_t skipped = system->kind == GM_RATES ? GM_MODIFIED_OBSERVABLES : 0;
    gm_ode_ask(arena, &system_scene->scene, gm_ode_asked + skipped,
               GM_ODE_ASKED - skipped - (system_scene->hook ? 1 : 0) +
                   (system->kind <= GM_LAGRANGIAN ? GM_RING_OBSERVABLES : 0),
               making->problem.n - (system->n - gm_system_motion(system)));
    system_scene->scene.asked_shown = skipped ? NULL : gm_modified_shown;
    for (size_t i = 0; i < system->choices.count; i++) {
        const char *key = system->choices.list[i].name;
        if (gm_scene_observable(&system_scene->scene, key) >= 0) {
            gm_arena_refuse(arena, "choice: %s is an observable of this system: take another name", key);
        }
    }
    if (system_scene->observable_count > MOST_OBSERVED) {
        gm_arena_refuse(arena, "a system has at most %d observables and invariants; this has %zu",
                        MOST_OBSERVED, system_scene->observable_count);
    }
    gm_arena_need(arena, gm_memory_refusals() == refusals); /* a default would have another value */
}

const struct gm_system_maker gm_system_motions = {
    .size = sizeof(struct gm_system_scene), .rebuilt = true, .make = make};
