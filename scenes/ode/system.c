/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A system that somebody wrote, as a scene: its parameters and the values of its start are keys, what it
   keeps and what its file observes are observables, its section is a track. The scene is made while the
   program runs, and does not change afterwards; what it needs of itself a lane finds through its parameters.

   With `members` the start is a disc in the plane that is shown, a grid of it, or a line along its first
   axis: the last member is in the middle, of a disc all others are on the edge. Observables are those of the
   centre; where the state is a plane, the disc's area is one too. */
#include "scenes/ode/system.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/linear/eigenvalues.h"
#include "core/ode/kernel/loops.h"
#include "core/ode/variational/manifold.h"
#include "core/run.h"
#include "core/schemes.h"
#include "core/system/equations.h"
#include "scenes/frame/written.h"
#include "scenes/ode/asked.h"
#include "scenes/ode/system/aim.h"
#include "scenes/ode/system/draw.h"
#include "scenes/ode/system/failure.h"
#include "scenes/ode/system/observed.h"
#include "scenes/ode/system/pieces.h"
#include "scenes/ode/system/sights.h"

enum {
    DT,
    UNTIL,
    MEMBERS,
    SPREAD,
    SHAPE,
    SHOW, /* then the system's own: GM_SYSTEM_ROWS */
};
enum { MOST_OBSERVED = 60, MOST_LINEARISED = 200, MOST_FOLLOWED = 32, CROSSINGS = 1 << 14, REMEMBERED = 256 };

/* Whether each row was given, bytes behind the values. */
static char *given_of(struct gm_system_lane *lane)
{
    return (char *)(lane->values + (lane->own->row_count - GM_SYSTEM_ROWS));
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
    const struct gm_system_scene *own = gm_system_scene_of(view);
    const size_t m = view->problem->m, members = m > 1 ? m - 1 : 1;
    for (size_t i = 0; i < members; i += shape_stride(members), entry += 2) {
        entry[0] = view->state[own->disc[0] * m + i];
        entry[1] = view->state[own->disc[1] * m + i];
    }
}

static double section(const struct gm_view *view)
{
    const struct gm_system_scene *own = gm_system_scene_of(view);
    double values[1 + GM_MOST_CONDITIONS];
    gm_system_values(&own->where, view, view->member, values);
    if (own->stroboscopic) {
        return sin(2 * M_PI * (view->t - view->t0) / values[0]);
    }
    return own->turns ? sin(values[0] / 2) : values[0];
}

static bool is_admitted(const struct gm_view *view)
{
    const struct gm_system_scene *own = gm_system_scene_of(view);
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
    gm_system_values(&gm_system_scene_of(view)->section.tape, view, view->member, entry);
}

/* ---- from parameters to problem and start ---- */

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
    double *values = gm_system_start_values(lane, given);
    if (!values) {
        return gm_refuse(sentence, "not enough memory");
    }
    bool good = true;
    for (size_t row = GM_SYSTEM_ROWS; row < own->row_count && good; row++) {
        const double value = values[own->variables[row]];
        lane->values[row - GM_SYSTEM_ROWS] = value;
        const struct gm_parameter *bounds = &own->rows[row];
        good = isfinite(value) || gm_refuse(sentence, "%s is not finite with these values", bounds->key);
        good = good && ((value >= bounds->lowest && value <= bounds->highest) ||
                        gm_refuse(sentence, "%s is %g with these values, and lies between %g and %g",
                                  bounds->key, value, bounds->lowest, bounds->highest));
    }
    for (size_t i = 0; i < GM_COUNT(own->timing) && good; i++) {
        double number = NAN;
        const enum gm_system_word word = (enum gm_system_word)((int)GM_WORD_DT + (int)i);
        if (gm_system_item_of(&own->system, word, 0)) {
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
    double *values = gm_system_start_values(lane, NULL);
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

/* Whether momenta determine velocities where this lane starts: the file's start is checked when it is read. */
static bool has_velocities(const struct gm_system_lane *lane, char *sentence)
{
    double *values = gm_system_start_values(lane, NULL);
    struct gm_fault fault = {.sentence = "not enough memory"};
    const bool good = values && gm_equations_check_legendre(&lane->own->system, values, &fault);
    free(values);
    return good || gm_refuse(sentence, "%s", fault.sentence);
}

/* Whether the surfaces have sizes. */
static bool has_surfaces(const struct gm_system_lane *lane, char *sentence)
{
    double sizes[3 * GM_MOST_SURFACES], *values = gm_system_start_values(lane, NULL);
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
    if (own->system.kind == GM_LAGRANGIAN && !has_velocities(lane, sentence)) {
        return false;
    }
    double *values = gm_system_start_values(lane, NULL);
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
    double *values = gm_system_start_values(lane, NULL);
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

/* ---- how fast the system is ---- */

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
    double *y = calloc(problem.n, sizeof *y), *values = gm_system_start_values(lane, NULL), radian = 1;
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

/* A start in the section lies in it too, where that says which component is 0. */
static size_t on_section(const struct gm_system_lane *lane, const struct gm_sight *sight,
                         struct gm_choice *choice)
{
    const struct gm_system_scene *own = lane->own;
    if (sight != &own->section || own->stroboscopic) {
        return 0;
    }
    const struct gm_system_item *item = gm_system_item_of(&own->system, GM_WORD_SECTION, 0);
    const struct gm_node *node = &own->system.graph.nodes[item->nodes[0]];
    for (size_t row = own->first_start; row < own->row_count; row++) {
        if (node->operation == GM_VARIABLE && own->variables[row] == node->a &&
            sight->components[0] != (long)node->a && sight->components[1] != (long)node->a) {
            gm_choose(choice, own->rows[row].key, 0);
            return 1;
        }
    }
    return 0;
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
    if (count == 2) {
        return count + on_section(lane, sight, &choices[count]);
    }
    double *start = gm_system_start_values(lane, NULL);
    count = start ? gm_system_aim(lane, start, x, y, choices) : 0;
    free(start);
    return count;
}

/* ---- the scene is made ---- */

static const char *number_text(struct gm_system_scene *own, double value)
{
    char text[64];
    return gm_system_kept_text(own, "%s", gm_number_format(value, text, sizeof text));
}

static bool make_rows(struct gm_system_scene *own, bool typed)
{
    const struct gm_own_system *system = &own->system;
    const size_t n = system->n, half = n / 2, parameters = system->velocities - system->parameters;
    own->row_count = GM_SYSTEM_ROWS + parameters + n;
    own->first_start = GM_SYSTEM_ROWS + parameters;
    own->rows = calloc(own->row_count + GM_CAMERA_KEYS, sizeof *own->rows);
    own->variables = calloc(own->row_count, sizeof *own->variables);
    own->initial = calloc(1, sizeof *own->initial + (own->row_count) * (sizeof(double) + 1));
    double *start = gm_equations_start(system, NULL);
    bool good = own->rows && own->variables && own->initial && start;
    static const char *const shapes[] = {"disc", "grid", "line", NULL};
    static const struct gm_parameter common[GM_SYSTEM_ROWS] = {
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
    for (size_t row = GM_SYSTEM_ROWS; good && row < own->row_count; row++) {
        const bool is_start = row >= own->first_start;
        size_t number = is_start ? row - own->first_start : system->parameters + row - GM_SYSTEM_ROWS;
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
            .offset = offsetof(struct gm_system_lane, values) + (row - GM_SYSTEM_ROWS) * sizeof(double),
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
    gm_parameters_reset(own->rows + GM_SYSTEM_ROWS, own->row_count + GM_CAMERA_KEYS - GM_SYSTEM_ROWS,
                        own->initial);
    own->initial->members = 1;
    own->radian = radian_time(own->initial);
    double *values = gm_system_start_values(own->initial, NULL);
    double numbers[3] = {NAN, NAN, NAN};
    for (size_t i = 0; values && i < 3; i++) {
        const struct gm_system_item *item =
            gm_system_item_of(system, (enum gm_system_word)((int)GM_WORD_DT + (int)i), 0);
        if (item && gm_system_open_tape(own, &own->timing[i], item->nodes, 1)) {
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

/* The ways to look at the state, and those at what the scheme does to the energy. */
static bool make_shows(struct gm_system_scene *own)
{
    if (!gm_system_make_sights(own)) {
        return false;
    }
    size_t shows = 0;
    while (own->shows[shows]) {
        shows++;
    }
    own->shows[shows] = own->system.kind == GM_CANONICAL ? GM_SHOW_MODIFIED : NULL;
    own->rows[SHOW].choices = own->shows;
    return true;
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
    own->scene.lanes = own->system.texts[GM_WORD_LANES];
    return true;
}

/* The map of stability: over the first parameter that can change, or over where the first component
   starts. */
static bool make_studies(struct gm_system_scene *own)
{
    static const double factors[] = {0.5, 0.75, 1, 1.5, 2};
    static const double steps[] = {0.1, 0.2, 0.5, 1, 1.5, 1.95, 2.05, 3};
    size_t row = GM_SYSTEM_ROWS;
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
        .arguments = gm_system_kept_text(own, "until=%.17g", until),
        .parameter = parameter->key,
        .values = own->values,
        .value_count = count,
        .label = "h ω",
        .unit = radian_time,
        .told =
            "ω is the largest frequency, or rate where nothing turns, of the linearised field at the start, or "
            "1 where none is found",
        .steps = steps,
        .step_count = GM_COUNT(steps),
        .throughout = true,
        .kept = own->observable_count > 0 && own->observables[0].kept ? own->observables[0].key : NULL,
        .error = own->observable_count > 0 && own->observables[0].kept ? own->observables[0].key : NULL,
    };
    own->work.arguments = gm_system_kept_text(
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
    const char *kept = whole && strlen(text) <= SHORT ? gm_system_kept_text(own, "%s", text) : NULL;
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
        .failure = gm_system_tell_failure,
    };
    const struct gm_system_item *end = gm_system_item_of(system, GM_WORD_STOP, 0);
    const char *members = system->texts[GM_WORD_MEMBERS];
    struct gm_problem problem;
    if (members && gm_parameter_set(&own->rows[MEMBERS], own->initial, members) != GM_PARSED) {
        return gm_refuse(sentence, "members: %.60s is no whole number from 1 to 1e6", members);
    }
    own->rows[MEMBERS].standard = members ? members : "1";
    if (!make_timing(own, sentence) || (end && !gm_system_open_tape(own, &own->stop, end->nodes, 1)) ||
        !make_shows(own) || !gm_system_open_surfaces(own, sentence) ||
        !setup(own->initial, &problem, sentence)) {
        return false;
    }
    make_tracks(own);
    own->scene.parameter_count += own->sights[0].dimensions == 3 ? GM_CAMERA_KEYS : 0;
    if (end) {
        own->scene.stop = gm_system_stop;
        own->scene.stops = gm_system_stops;
        own->scene.follow = 1;
    }
    const bool good = gm_system_make_observables(own, &problem, sentence) &&
                      gm_system_check_exact(own, &problem, sentence) &&
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

void gm_system_scene_close(const struct gm_scene *scene)
{
    struct gm_system_scene *own = (struct gm_system_scene *)scene; /* which it is the first member of */
    for (size_t i = 0; i < own->sight_count; i++) {
        gm_system_close_sight(&own->sights[i]);
    }
    gm_system_close_sight(&own->section);
    gm_tape_close(&own->surfaces);
    for (size_t i = 0; own->formulas && i < own->observable_count; i++) {
        gm_tape_close(&own->formulas[i]);
    }
    for (size_t i = 0; own->terms && i < own->observable_count; i++) {
        gm_tape_close(&own->terms[i]);
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
    free(own->terms);
    free(own->variables);
    free(own->rows);
    free(own->initial);
    free(own);
}
