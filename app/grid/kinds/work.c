/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The cost of accuracy: from the words of the command line to schemes, steps and a measure; error and cost
   of every scheme with every step. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/grid/grid.h"
#include "app/words/names.h"
#include "core/arena.h"
#include "core/basics.h"
#include "core/expression/lines.h"
#include "core/functions/functions.h"
#include "core/ode/families/composition.h"
#include "core/schemes.h"
#include "core/theory/certify.h"

/* ---- layout ---- */

static const double usual_errors[3] = {1e-3, 1e-6, 1e-9};

static const char solution_error[] = "solution_error";

static const char *usual(struct gm_grid *grid, const struct gm_scene *scene)
{
    (void)grid;
    return scene->work ? scene->work->arguments : "";
}

static bool is_typed(const struct gm_grid *grid, const char *key)
{
    char word[64];
    snprintf(word, sizeof word, "%s=", key);
    return gm_arguments_have(grid->typed, word);
}

/* Lanes may differ only in scheme, dt, resolution and ratio, and in values that follow from those unless
   typed. */
static bool is_one_problem(const struct gm_grid *grid)
{
    const struct gm_request *request = &grid->request;
    const struct gm_scene *scene = request->scene;
    for (size_t i = 1; i < request->count; i++) {
        for (size_t k = 0; k < scene->parameter_count; k++) {
            const struct gm_parameter *row = &scene->parameters[k];
            const bool varies = row->offset == offsetof(struct gm_timing, dt) || row == grid->parameter ||
                                row == grid->ratio || !is_typed(grid, row->key);
            const double first = gm_parameter_get(row, request->lanes[0].parameters);
            const double other = gm_parameter_get(row, request->lanes[i].parameters);
            const bool automatic = isnan(first) && isnan(other);
            if (!varies && first != other && !automatic) {
                return false;
            }
        }
    }
    return true;
}

/* Returns true if the ladders or the lines of the diagram vary this word. */
static bool is_varied(const struct gm_grid *grid, const char *word)
{
    const char *const keys[] = {"scheme", "dt", "until", grid->parameter ? grid->parameter->key : NULL,
                                grid->ratio ? grid->ratio->key : NULL};
    for (size_t i = 0; i < GM_COUNT(keys); i++) {
        const size_t length = keys[i] ? strlen(keys[i]) : 0;
        if (length > 0 && strncmp(word, keys[i], length) == 0 && word[length] == '=') {
            return true;
        }
    }
    return false;
}

/* Notes the words of the plan and of the user. */
static void note_settings(struct gm_grid *grid, const struct gm_arguments *words)
{
    for (int i = 1; i < words->count; i++) {
        if (!is_varied(grid, words->words[i])) {
            gm_append(grid->settings, sizeof grid->settings, "%s%s", grid->settings[0] ? " " : "",
                      words->words[i]);
        }
    }
}

/* Takes "best" out of the list of schemes. */
static void edit(struct gm_grid *grid, struct gm_arguments *words)
{
    static const char key[] = "scheme=", best[] = "best";
    for (int i = 1; i < words->count; i++) {
        char *const list = words->words[i];
        const char *others = "";
        if (strncmp(list, key, sizeof key - 1) != 0) {
            continue;
        }
        struct gm_span rest = {sizeof key - 1, strlen(list)}, name;
        while (gm_span_take(list, &rest, ",", &name)) {
            const int length = (int)(name.end - name.begin);
            if (length == sizeof best - 1 && memcmp(list + name.begin, best, sizeof best - 1) == 0) {
                grid->best = true;
            } else {
                others = gm_arena_print(grid->arena, "%s%s%.*s", others, *others ? "," : "", length,
                                        list + name.begin);
            }
        }
        gm_arena_refuse_if(grid->arena, grid->best && !*others,
                           "best are those to compare a scheme with: scheme=my.scheme,best");
        if (grid->best) {
            strcpy(list + sizeof key - 1, others);
        }
    }
}

static int falling(const void *a, const void *b)
{
    const double *x = a, *y = b;
    return (*x < *y) - (*x > *y);
}

/* The first lane with one tolerance after the other: the given ones, or 1e-3 to 1e-12. */
static const struct gm_lane_spec *tolerant_specs(struct gm_grid *grid, size_t *count)
{
    enum { TOLERANCES = 10 };
    const struct gm_request *request = &grid->request;
    const bool typed = is_typed(grid, "tolerance");
    const size_t most = typed ? request->count : TOLERANCES;
    struct gm_lane_spec *specs = gm_arena_take(grid->arena, most, sizeof *specs);
    struct gm_grid_axis axis = {.values = gm_arena_take(grid->arena, most, sizeof *axis.values)};
    for (size_t i = 0; i < most; i++) {
        gm_axis_add(&axis, typed ? request->lanes[i].settings.tolerance : gm_pow(10, -3 - (double)i));
    }
    qsort(axis.values, axis.count, sizeof *axis.values, falling);
    for (size_t i = 0; i < axis.count; i++) {
        specs[i] = request->lanes[0];
        specs[i].settings.tolerance = axis.values[i];
    }
    *count = axis.count;
    return specs;
}

/* A line for each scheme, however often it is named. */
static void add_scheme(struct gm_grid *grid, const struct gm_scheme *scheme)
{
    if (gm_grid_find(grid, scheme)) {
        return;
    }
    size_t ladder = grid->steps.count;
    const struct gm_lane_spec *specs = scheme->family->by_tolerance ? tolerant_specs(grid, &ladder) : NULL;
    struct gm_grid_line *line = gm_grid_add(grid, scheme, grid->values.count * ladder);
    for (size_t r = 0; r < grid->values.count; r++) {
        for (size_t k = 0; k < ladder; k++) {
            const double value = grid->values.values[r];
            line->cells[line->count++] =
                (struct gm_grid_cell){.spec = specs ? &specs[k] : &grid->request.lanes[0],
                                      .value = value,
                                      .step = grid->steps.values[specs ? 0 : k],
                                      .error = NAN,
                                      .resolution = grid->smaller_is_finer ? 1 / value : value};
        }
    }
    for (size_t cost = 0; grid->parameter && cost < GM_COST_COUNT; cost++) {
        line->front[cost] = gm_arena_take(grid->arena, line->count, sizeof *line->front[cost]);
    }
    line->credited = gm_arena_take(grid->arena, line->count, sizeof *line->credited);
}

/* Adds the built-in schemes of the first one's family, or of its base's, that promise the smallest error at equal cost:
   the smallest error constant by theory, of its order before those of higher orders. */
static void add_best(struct gm_grid *grid, const struct gm_lane *lane)
{
    enum { BEST = 3 };
    const struct gm_scheme *first = grid->lines[0].scheme, *like = first, *best[BEST] = {NULL};
    double constants[BEST] = {0};
    while (like->base || gm_scheme_is_composition(like)) {
        like = like->base ? like->base : ((const struct gm_substeps *)like->coefficients)->at[0].scheme;
    }
    for (size_t i = 0; i < gm_scheme_count(); i++) {
        const struct gm_scheme *scheme = gm_scheme_at(i);
        const struct gm_scheme *same = gm_scheme_same_as(scheme, &lane->problem);
        if (scheme->family != like->family || scheme == first || scheme->order < first->order ||
            !gm_scheme_fits(scheme, &lane->problem) || (same && same->family == like->family)) {
            continue;
        }
        const struct gm_theory theory = gm_scheme_theory(scheme);
        double constant = theory.known ? theory.error_constant : INFINITY;
        const struct gm_scheme *next = scheme;
        for (int k = 0; k < BEST && next; k++) {
            if (!best[k] || next->order < best[k]->order ||
                (next->order == best[k]->order && constant < constants[k])) {
                const struct gm_scheme *moved = best[k];
                const double its = constants[k];
                best[k] = next;
                constants[k] = constant;
                next = moved;
                constant = its;
            }
        }
    }
    for (int k = 0; k < BEST && best[k]; k++) {
        add_scheme(grid, best[k]);
    }
}

/* Returns true if a scheme is measured by default; a method with two names is measured once. */
static bool is_entrant(const struct gm_grid *grid, const struct gm_scheme *scheme, const struct gm_lane *lane)
{
    const struct gm_work *work = grid->request.scene->work;
    bool entrant = !work || !work->schemes;
    for (size_t k = 0; !entrant && work->schemes[k]; k++) {
        entrant = strcmp(work->schemes[k], scheme->name) == 0;
    }
    const bool exact = work && work->is_exact && strcmp(work->is_exact, scheme->name) == 0 && grid->observed;
    const struct gm_scheme *same = entrant && !exact ? gm_scheme_same_as(scheme, &lane->problem) : NULL;
    return entrant && !exact && gm_scheme_fits(scheme, &lane->problem) &&
           !(same && is_entrant(grid, same, lane));
}

/* Adds an explicit method that holds H, in both ways, where H is constant: such a step costs little more than its base's. */
static const char *const held_words[] = {"projected(rk4; H)", "relaxed(rk4; H)"};

static void add_held(struct gm_grid *grid, const struct gm_problem *problem)
{
    char message[GM_MESSAGE];
    int status;
    for (size_t i = 0; i < GM_COUNT(held_words); i++) {
        const struct gm_scheme *scheme = gm_scheme_sought(held_words[i], &status, message);
        if (scheme && gm_scheme_fits(scheme, problem)) {
            add_scheme(grid, scheme);
        }
    }
}

/* Chooses the given schemes, or all that fit `lane`'s problem and are not the reference. */
static void choose_schemes(struct gm_grid *grid, const struct gm_lane *lane, bool named)
{
    const struct gm_request *request = &grid->request;
    grid->lines = gm_arena_take(grid->arena, gm_scheme_count() + GM_COUNT(held_words) + request->count,
                                sizeof *grid->lines);
    for (size_t i = 0; named && i < request->count; i++) {
        add_scheme(grid, request->lanes[i].scheme);
    }
    for (size_t i = 0; !named && i < gm_scheme_count(); i++) {
        if (is_entrant(grid, gm_scheme_at(i), lane)) {
            add_scheme(grid, gm_scheme_at(i));
        }
    }
    if (!named && !(request->scene->work && request->scene->work->schemes)) {
        add_held(grid, &lane->problem);
    }
    const size_t given = grid->count;
    if (grid->best) {
        add_best(grid, lane);
    }
    grid->best_is_none = grid->best && grid->count == given;
}

/* The different values that the lanes have of a parameter. */
static void add_typed(struct gm_grid_axis *axis, const struct gm_request *request,
                      const struct gm_parameter *row)
{
    for (size_t i = 0; i < request->count; i++) {
        gm_axis_add(axis, gm_parameter_get(row, request->lanes[i].parameters));
    }
}

static void choose_steps(struct gm_grid *grid)
{
    const bool typed = is_typed(grid, "dt") || grid->ratio;
    enum { MOST_HALVINGS = 63 };
    const struct gm_request *request = &grid->request;
    const struct gm_work *work = request->scene->work;
    const struct gm_timing *timing = gm_grid_timing(grid);
    const double whole = timing->until - gm_scene_t0(request->scene, timing);
    const double coarsest = work && work->coarsest > 0 ? work->coarsest : 4 * timing->dt;
    const int halvings = work ? work->halvings : 7;
    grid->steps.values =
        gm_arena_take(grid->arena, typed ? request->count : MOST_HALVINGS + 1, sizeof *grid->steps.values);
    if (typed) {
        add_typed(&grid->steps, request,
                  grid->ratio ? grid->ratio : gm_scene_parameter(request->scene, "dt"));
        qsort(grid->steps.values, grid->steps.count, sizeof *grid->steps.values, falling);
        return;
    }
    double steps = fmax(1, ceil(whole / coarsest - 1e-9));
    for (int i = 0; i <= halvings; i++, steps *= 2) {
        gm_axis_add(&grid->steps, whole / steps);
    }
}

/* Chooses the values of the words, or those of the plan if the words give only one, which is not a ladder. */
static void choose_resolutions(struct gm_grid *grid)
{
    const struct gm_work *work = grid->request.scene->work;
    const struct gm_parameter *row = grid->parameter;
    grid->values.values = gm_arena_take(grid->arena, row ? grid->request.count + work->resolution_count : 1,
                                        sizeof *grid->values.values);
    grid->smaller_is_finer = row && work->resolutions[0] > work->resolutions[work->resolution_count - 1];
    if (row && is_typed(grid, row->key)) {
        add_typed(&grid->values, &grid->request, row);
    }
    for (size_t i = 0; row && !is_typed(grid, row->key) && i < work->resolution_count; i++) {
        gm_axis_add(&grid->values, work->resolutions[i]);
    }
    if (grid->values.count < 2) {
        grid->parameter = NULL;
        grid->values.count = 1;
    }
}

static void choose_measure(struct gm_grid *grid, const struct gm_lane *lane)
{
    const char *requested = grid->requested;
    char message[GM_MESSAGE];
    const struct gm_scene *scene = grid->request.scene;
    const struct gm_work *work = scene->work;
    const bool planned = work && work->measure;
    grid->measure = planned ? work->measure : solution_error;
    grid->measure = requested ? requested : grid->measure;
    grid->measure_title = lane->problem.exact ? "largest difference from the true solution"
                                              : "largest difference from a run of short steps";
    grid->measure_title = work && work->distance ? work->distance_title : grid->measure_title;
    grid->observed = strcmp(grid->measure, solution_error) != 0 ||
                     (planned && strcmp(work->measure, solution_error) == 0) ||
                     (!lane->problem.exact && gm_scene_observable(scene, solution_error) >= 0);
    if (!grid->observed) {
        return;
    }
    const int found = gm_scene_observable(scene, grid->measure);
    if (found < 0) {
        gm_chosen_refuse(scene, grid->measure, message);
        gm_arena_refuse(grid->arena, "%s", message);
    }
    /* the measure may be undefined with these parameters, as a distance from a missing exact solution, or
       only with this scheme; others may then have it */
    const struct gm_observable *observable = gm_scene_observable_at(scene, (size_t)found);
    if (observable->why || isfinite(gm_lane_observe(lane, (size_t)found))) {
        grid->measure_title = observable->title;
        return;
    }
    gm_arena_refuse_if(grid->arena, requested, "%s is undefined with these parameters", requested);
    grid->measure = solution_error;
    grid->observed = false;
}

static void lay_out(struct gm_grid *grid, const struct gm_arguments *words)
{
    char message[GM_MESSAGE];
    const struct gm_scene *scene = grid->request.scene;
    const struct gm_work *work = scene->work;
    const struct gm_timing *timing = gm_grid_timing(grid);
    const char *resolution = work ? work->resolution : NULL, *ratio = work ? work->ratio : NULL;
    grid->parameter = resolution ? gm_scene_parameter(scene, resolution) : NULL;
    grid->errors = work && work->errors ? work->errors : usual_errors;
    grid->ratio = ratio && is_typed(grid, ratio) ? gm_scene_parameter(scene, ratio) : NULL;
    gm_arena_check(grid->arena, gm_request_ends_together(&grid->request, message), message);
    gm_arena_refuse_if(grid->arena, !is_one_problem(grid),
                       "work-precision compares on one problem: only scheme%s%s%s%s and dt take a list",
                       resolution ? ", " : "", resolution ? resolution : "", ratio ? ", " : "",
                       ratio ? ratio : "");
    note_settings(grid, words);
    gm_arena_refuse_if(grid->arena, !(timing->until > gm_scene_t0(scene, timing)),
                       "until=%g is the start: there is nothing to measure", timing->until);
    choose_steps(grid);
    choose_resolutions(grid);
    /* one open lane shows which measure has a number and which schemes fit */
    const struct gm_lane *lane =
        gm_lane_in(grid->arena, gm_request_open_lane(&grid->request, 0, message), message);
    choose_measure(grid, lane);
    choose_schemes(grid, lane, is_typed(grid, "scheme"));
    gm_arena_drop(grid->arena, lane);
    gm_arena_refuse_if(grid->arena, grid->count == 0, "no scheme that is compared here fits %s", scene->name);
}

/* ---- runs ---- */

enum { REPEATS = 5 };

/* A measurement is repeated up to this time, and given up when one run takes longer. */
static const double enough_seconds = 0.1, most_seconds = 4;

/* A run of the trusted scheme with this step, to its end or a failure, which is not timed and reports its progress; with
   another value of a parameter unless `row` is NULL. */
static struct gm_lane *run_trusted(struct gm_grid *grid, double step, const struct gm_parameter *row,
                                   double value)
{
    char message[GM_MESSAGE];
    const struct gm_lane_spec *spec = &grid->request.lanes[0];
    struct gm_timing *timing = gm_parameters_copy(grid->request.scene, spec->parameters);
    gm_arena_need(grid->arena, timing);
    if (row) {
        gm_parameter_put(row, timing, value);
    }
    timing->dt = step;
    struct gm_lane *lane =
        gm_lane_in(grid->arena, gm_grid_start(grid, spec, timing, grid->trusted, message), message);
    const int64_t steps = gm_run_steps_at(lane->run, gm_grid_timing(grid)->until);
    lane->unfollowed = true;
    for (int percent = 0; percent < 100 && !gm_listener_stops(grid->listener); percent++) {
        char what[32];
        snprintf(what, sizeof what, percent ? "reference, %d %%" : "reference", percent);
        gm_listener_hears(grid->listener, what, 0, gm_grid_cells(grid));
        const double share = (percent + 1) / 100.;
        /* the carried rounding errors are worth their cost here */
        gm_grid_advance(grid, lane, percent < 99 ? (int64_t)(share * (double)steps) : steps, INFINITY);
    }
    return lane;
}

static struct gm_lane *run_reference(struct gm_grid *grid, const struct gm_parameter *row, double value)
{
    struct gm_lane *lane = run_trusted(grid, grid->reference_step, row, value);
    gm_arena_refuse_if(grid->arena, lane->run->status != GM_OK || gm_listener_stops(grid->listener),
                       "the reference, %s, failed: %s", grid->reference, gm_status_name(lane->run->status));
    return lane;
}

/* The error of the reference, by runs with two and four times its step: their errors grow by the power of the step that
   the system allows, which may be a lower one than the scheme's order. NaN if one fails. */
static double error_of_reference(struct gm_grid *grid, size_t count)
{
    double ends[2], *last = gm_arena_take(grid->arena, count, sizeof *last);
    memcpy(last, grid->solution, count * sizeof *last);
    for (int k = 0; k < 2; k++) {
        const struct gm_lane *lane = run_trusted(grid, (2 << k) * grid->reference_step, NULL, 0);
        ends[k] = lane->run->status == GM_OK ? gm_distance(gm_run_state(lane->run), last, count) : NAN;
        memcpy(last, gm_run_state(lane->run), count * sizeof *last);
        gm_arena_drop(grid->arena, lane);
    }
    const double growth = ends[1] / ends[0];
    return ends[0] / fmax(growth - 1, 1);
}

/* The reference run of a scene that measures distances from it: at twice the finest resolution, with half
   the shortest step. */
static void run_finer(struct gm_grid *grid)
{
    const struct gm_work *work = grid->request.scene->work;
    const struct gm_parameter *row = gm_scene_parameter(grid->request.scene, work->resolution);
    const double finest = grid->parameter ? grid->values.values[grid->values.count - 1]
                                          : gm_parameter_get(row, gm_grid_timing(grid)),
                 finer = grid->smaller_is_finer ? finest / 2 : 2 * finest;
    grid->trusted = gm_scheme_find(work->reference);
    grid->reference_step = grid->steps.values[grid->steps.count - 1] / 2;
    snprintf(grid->reference, sizeof grid->reference, "a run of %s with a step of %.3g and %s=%.3g",
             grid->trusted->name, grid->reference_step, row->key, finer);
    grid->finer = run_reference(grid, row, finer);
}

/* The scheme of the reference run: the plan's, or the fitting one with the highest order, or NULL. */
static const struct gm_scheme *trusted_of(const struct gm_grid *grid, const struct gm_problem *problem)
{
    const struct gm_work *work = grid->request.scene->work;
    const struct gm_scheme *trusted = work && work->reference ? gm_scheme_find(work->reference) : NULL;
    const bool named = trusted != NULL;
    for (size_t i = 0; !named && i < gm_scheme_count(); i++) {
        const struct gm_scheme *scheme = gm_scheme_at(i);
        if (gm_scheme_fits(scheme, problem) && !scheme->family->adaptive && !scheme->family->by_tolerance &&
            scheme->order >= 4) {
            trusted = trusted && trusted->order >= scheme->order ? trusted : scheme;
        }
    }
    return trusted;
}

/* The state that solutions are measured against: the exact one, or that of a trusted run, for all steps of the
   ladder; `lane` is at its start. */
static void find_solution(struct gm_grid *grid, const struct gm_lane *lane)
{
    const struct gm_problem *problem = &lane->problem;
    const size_t count = problem->n * problem->m;
    grid->solution = gm_arena_take(grid->arena, count, sizeof *grid->solution);
    if (problem->exact) {
        snprintf(grid->reference, sizeof grid->reference, "the exact solution");
        problem->exact->solution(problem, gm_grid_timing(grid)->until, lane->start, grid->solution,
                                 problem->m);
        return;
    }
    grid->trusted = trusted_of(grid, problem);
    gm_arena_refuse_if(
        grid->arena, !grid->trusted,
        "there is nothing to compare with: neither an exact solution nor a scheme of order 4 or more to "
        "make a reference with; --measure KEY compares an observable of the scene instead");
    /* a quarter of the shortest step that halving the ladder a few times less gives: beyond, rounding rules */
    const size_t middle = grid->steps.count > 3 ? grid->steps.count - 3 : grid->steps.count - 1;
    grid->reference_step = grid->steps.values[middle] / 4;
    snprintf(grid->reference, sizeof grid->reference, "a run of %s with a step of %.3g", grid->trusted->name,
             grid->reference_step);
    const struct gm_lane *reference = run_reference(grid, NULL, 0);
    memcpy(grid->solution, gm_run_state(reference->run), count * sizeof *grid->solution);
    gm_arena_drop(grid->arena, reference);
    grid->reference_error = error_of_reference(grid, count);
}

static void prepare(struct gm_grid *grid)
{
    char message[GM_MESSAGE];
    const struct gm_work *work = grid->request.scene->work;
    if (grid->observed) {
        return;
    }
    if (work && work->distance) {
        run_finer(grid);
        return;
    }
    const struct gm_lane *lane =
        gm_lane_in(grid->arena, gm_request_open_lane(&grid->request, 0, message), message);
    find_solution(grid, lane);
    gm_arena_drop(grid->arena, lane);
}

static double error_of(const struct gm_grid *grid, const struct gm_lane *lane, const double *solution)
{
    const struct gm_scene *scene = lane->scene;
    if (grid->finer) {
        return scene->work->distance(lane, grid->finer);
    }
    if (solution) {
        const double *state = gm_run_state(lane->run);
        double error = 0;
        for (size_t i = 0; i < lane->problem.n * lane->problem.m; i++) {
            error = gm_larger(error, fabs(state[i] - solution[i]));
        }
        return error;
    }
    const int observable = gm_scene_observable(scene, grid->measure);
    return observable < 0 ? NAN : fabs(gm_lane_observe(lane, (size_t)observable));
}

/* The same for an adaptive scheme that ends after `until`: the solution is advanced to its end. NaN if a step went so far
   that there is no reference. */
static double error_behind(const struct gm_grid *grid, const struct gm_lane *lane)
{
    const struct gm_problem *problem = &lane->problem;
    const double until = gm_grid_timing(grid)->until, gap = lane->run->t - until;
    const double most = 1e5, steps = ceil(gap / grid->reference_step);
    double *state = malloc(problem->n * problem->m * sizeof *state), error = NAN;
    if (state && problem->exact) {
        problem->exact->solution(problem, lane->run->t, lane->start, state, problem->m);
        error = error_of(grid, lane, state);
    } else if (state && gap > 0 && steps <= most) {
        const struct gm_settings settings = {.compensated = 1};
        struct gm_run *run =
            gm_run_open(problem, grid->trusted, &settings, until, gap / steps, grid->solution);
        if (run && gm_run_advance(run, (int64_t)steps) == GM_OK) {
            error = error_of(grid, lane, gm_run_state(run));
        }
        if (run) {
            gm_run_close(run);
        }
    } else if (state && !(gap > 0)) {
        error = error_of(grid, lane, grid->solution);
    }
    free(state);
    return error;
}

/* Makes a run and returns its time, INFINITY if it was given up. */
static double time_run(const struct gm_grid *grid, struct gm_lane *lane)
{
    const int64_t steps = gm_run_steps_at(lane->run, gm_grid_timing(grid)->until);
    lane->unfollowed = true;
    const double seconds = gm_grid_advance(grid, lane, steps, most_seconds);
    return gm_grid_goes_on(grid, lane, steps) ? INFINITY : seconds;
}

/* Repeats a run in slices, for an observable that needs the past. Returns its value. */
static double follow(const struct gm_grid *grid, const struct gm_scheme *scheme, struct gm_grid_cell *cell,
                     char *message)
{
    enum { SLICES = 100 };
    struct gm_lane *lane = gm_grid_open_lane(grid, scheme, cell, message);
    const int64_t steps = lane ? gm_run_steps_at(lane->run, gm_grid_timing(grid)->until) : 0;
    for (int i = 1; lane && i <= SLICES; i++) {
        gm_grid_advance(grid, lane, i < SLICES ? (int64_t)((double)steps * i / SLICES) : steps, INFINITY);
    }
    const double error = lane ? error_of(grid, lane, NULL) : NAN;
    gm_lane_close(lane);
    return error;
}

static void run(const struct gm_grid *grid, struct gm_lane *lane, struct gm_grid_cell *cell, char *message)
{
    const struct gm_scheme *scheme = lane->scheme;
    if (grid->solution && scheme == grid->trusted && cell->dt <= 1.01 * grid->reference_step) {
        cell->tried = false; /* the run is the reference of the others */
        return;
    }
    double spent = cell->seconds = time_run(grid, lane);
    gm_grid_take_end(lane, cell);
    cell->error = NAN;
    if (cell->status == GM_OK && isfinite(spent)) {
        cell->error = grid->solution && scheme->family->adaptive ? error_behind(grid, lane)
                                                                 : error_of(grid, lane, grid->solution);
        const int observable = gm_scene_observable(lane->scene, grid->measure);
        const char *reason = !grid->solution && isnan(cell->error) && observable >= 0
                                 ? gm_lane_missing(lane, (size_t)observable)
                                 : NULL;
        if (reason) {
            gm_refuse(message, "%s", reason);
        }
    }
    for (int repeat = 1; repeat < REPEATS && spent < enough_seconds && !gm_listener_stops(grid->listener);
         repeat++) {
        struct gm_lane *again = gm_grid_open_lane(grid, scheme, cell, message);
        const double seconds = again ? time_run(grid, again) : INFINITY;
        gm_lane_close(again);
        cell->seconds = fmin(cell->seconds, seconds);
        spent += seconds;
    }
    if (grid->request.scene->follow > 0 && !grid->solution && isfinite(cell->error)) {
        cell->error = follow(grid, scheme, cell, message);
    }
}

/* Returns true if shorter steps are of no use: round-off dominates, or they take too long, or the
   resolution dominates. */
static bool is_enough(const struct gm_grid *grid, const struct gm_grid_cell *last)
{
    const struct gm_grid_cell *before = last - 1;
    const bool resolved = grid->parameter && fabs(last->error - before->error) < 0.03 * before->error;
    const bool round_off = last->error < 1e-9 && last->error > 0.7 * before->error;
    const bool long_enough = last->status == GM_OK && last->seconds > most_seconds / 3;
    return resolved || round_off || long_enough || !isfinite(last->seconds);
}

static bool is_needless(const struct gm_grid *grid, const struct gm_grid_line *line, size_t cell)
{
    const struct gm_grid_cell *last = &line->cells[cell] - 1;
    const size_t ladder = line->count / grid->values.count;
    const size_t before = cell % ladder; /* cells before it with the same resolution */
    return line->ended || (before > 0 && !last->tried) || (before > 1 && is_enough(grid, last));
}

/* Errors of both may cancel by chance: a cell is credited with the largest error of its resolution at its step
   and all shorter ones. */
static void conclude(const struct gm_grid *grid, struct gm_grid_line *line)
{
    struct gm_grid_cell *credited = line->credited;
    for (size_t k = line->count; grid->parameter && k-- > 0;) {
        credited[k] = line->cells[k];
        if (k + 1 < line->count && credited[k + 1].value == credited[k].value &&
            credited[k + 1].error > credited[k].error) {
            credited[k].error = credited[k + 1].error;
        }
    }
    for (int cost = 0; grid->parameter && cost < GM_COST_COUNT; cost++) {
        line->front_count[cost] =
            gm_work_keep_best(credited, line->count, (enum gm_cost)cost, line->front[cost]);
    }
}

/* Returns true if a scheme is measured by its tolerance. */
static bool has_tolerances(const struct gm_grid *grid)
{
    bool has = false;
    for (size_t i = 0; i < grid->count; i++) {
        has |= grid->lines[i].scheme->family->by_tolerance;
    }
    return has;
}

static void put(struct gm_row *row, const struct gm_grid *grid, const struct gm_grid_cell *cell, int number)
{
    (void)number;
    if (grid->parameter) {
        gm_row_number(row, grid->parameter->key, cell->value, 17);
    }
    gm_row_put(row, "dt %.17g, steps %.0f, t %.17g, status %s", cell->dt, (double)cell->steps, cell->t,
               gm_status_name(cell->status));
    const double tolerance = cell->spec->settings.tolerance;
    const bool is_step = cell->spec == grid->request.lanes; /* of a ladder of steps, not of tolerances */
    if (row->form == GM_ROW_JSON ? tolerance > 0 : has_tolerances(grid)) {
        gm_row_number(row, "tolerance", row->form == GM_ROW_CSV && is_step ? NAN : tolerance, 17);
    }
    gm_row_number(row, row->form == GM_ROW_HEAD ? grid->measure : "error",
                  isfinite(cell->error) ? cell->error : NAN, 17);
    gm_row_put(row, "seconds %.6g, evaluations %.0f, solves %.0f", cell->seconds, cell->evaluations,
               cell->solves);
}

const struct gm_study_row gm_study_work = {.name = "work-precision",
                                           .refusal = GM_EXIT_NUMERICAL,
                                           .draw = gm_work_draw,
                                           .print = gm_work_print,
                                           .cells = "points",
                                           .put_front = gm_work_put_front,
                                           .put_end = gm_work_put_end,
                                           .which = "work-precision of which scene? See geomint list scenes",
                                           .schemes = 1,
                                           .usual = usual,
                                           .edit = edit,
                                           .lay_out = lay_out,
                                           .alone = true,
                                           .prepare = prepare,
                                           .is_needless = is_needless,
                                           .run = run,
                                           .conclude = conclude,
                                           .ordered = true,
                                           .rows = 1,
                                           .put_cell = put};
