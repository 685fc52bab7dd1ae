/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What work-precision is to measure: from the words of the command line to schemes, steps and a measure. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/grid/hooks.h"
#include "app/words/chosen.h"
#include "core/basics.h"
#include "core/certify.h"
#include "core/expression/lines.h"
#include "core/schemes.h"

static const double usual_errors[3] = {1e-3, 1e-6, 1e-9};

static const char solution_error[] = "solution_error";

char *gm_work_usual(const struct gm_scene *scene, char *message)
{
    (void)message;
    return strdup(scene->work ? scene->work->arguments : "");
}

static bool is_typed(const struct gm_arguments *typed, const char *key)
{
    char word[64];
    snprintf(word, sizeof word, "%s=", key);
    return gm_arguments_have(typed, word);
}

/* Lanes may differ in scheme, dt, resolution and ratio alone, and in what was not typed but follows from
   those. */
static bool is_one_problem(const struct gm_grid *grid, const struct gm_arguments *typed)
{
    const struct gm_request *request = &grid->request;
    const struct gm_scene *scene = request->scene;
    for (size_t i = 1; i < request->count; i++) {
        for (size_t k = 0; k < scene->parameter_count; k++) {
            const struct gm_parameter *row = &scene->parameters[k];
            const bool varies = row->offset == offsetof(struct gm_timing, dt) || row == grid->parameter ||
                                row == grid->ratio || !is_typed(typed, row->key);
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

/* Whether the ladders or the lines of the diagram have the values of this word. */
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
        const size_t used = strlen(grid->settings);
        if (!is_varied(grid, words->words[i])) {
            snprintf(grid->settings + used, sizeof grid->settings - used, "%s%s", used ? " " : "",
                     words->words[i]);
        }
    }
}

/* Takes "best" out of the list of schemes, wherever it stands; false: it is not among them. */
static bool take_best(struct gm_arguments *words)
{
    static const char key[] = "scheme=", best[] = "best";
    for (int i = 1; i < words->count; i++) {
        char *const list = words->words[i];
        if (strncmp(list, key, sizeof key - 1) != 0) {
            continue;
        }
        struct gm_span rest = {sizeof key - 1, strlen(list)}, name;
        while (gm_span_take(list, &rest, ",", &name)) {
            if (name.end - name.begin == sizeof best - 1 &&
                memcmp(list + name.begin, best, sizeof best - 1) == 0) {
                /* with the comma behind it, or else that before it, so that something is left to be alike */
                const bool last = rest.begin == rest.end, alone = last && name.begin == sizeof key - 1;
                const size_t from = last && !alone ? name.begin - 1 : name.begin,
                             to = last ? name.end : rest.begin;
                memmove(list + from, list + to, strlen(list + to) + 1);
                return true;
            }
        }
    }
    return false;
}

bool gm_work_edit(struct gm_grid *grid, struct gm_arguments *words, char *message)
{
    grid->best = take_best(words);
    for (int i = 1; grid->best && i < words->count; i++) {
        if (strcmp(words->words[i], "scheme=") == 0) {
            return gm_refuse(message, "best are those to compare a scheme with: scheme=my.scheme,best");
        }
    }
    return true;
}

/* A line for each scheme, however often it is named. */
static bool add_scheme(struct gm_grid *grid, const struct gm_scheme *scheme, char *message)
{
    for (size_t i = 0; i < grid->count; i++) {
        if (grid->lines[i].scheme == scheme) {
            return true;
        }
    }
    struct gm_grid_line *line = gm_grid_add(grid, scheme, grid->values.count * grid->steps.count, message);
    for (size_t r = 0; line && r < grid->values.count; r++) {
        for (size_t k = 0; k < grid->steps.count; k++) {
            const double value = grid->values.values[r];
            line->cells[line->count++] =
                (struct gm_grid_cell){.spec = &grid->request.lanes[0],
                                      .value = value,
                                      .step = grid->steps.values[k],
                                      .error = NAN,
                                      .resolution = grid->smaller_is_finer ? 1 / value : value};
        }
    }
    if (line && grid->parameter) {
        line->credited = calloc(line->count, sizeof *line->credited);
    }
    bool good = line && (!grid->parameter || line->credited || gm_refuse(message, "not enough memory"));
    for (size_t cost = 0; good && grid->parameter && cost < GM_COST_COUNT; cost++) {
        line->front[cost] = calloc(line->count, sizeof *line->front[cost]);
        good = line->front[cost] || gm_refuse(message, "not enough memory");
    }
    return good;
}

/* The built-in schemes of the first one's family that promise the smallest error at equal cost: the smallest
   error constant by theory, of its order before those of other orders. */
static bool add_best(struct gm_grid *grid, const struct gm_lane *lane, char *message)
{
    enum { BEST = 3 };
    const struct gm_scheme *like = grid->lines[0].scheme, *best[BEST] = {NULL};
    double constants[BEST] = {0};
    for (size_t i = 0; i < gm_scheme_count(); i++) {
        const struct gm_scheme *scheme = gm_scheme_at(i);
        if (scheme->family != like->family || scheme == like || !gm_scheme_fits(scheme, &lane->problem)) {
            continue;
        }
        const struct gm_theory theory = gm_scheme_theory(scheme);
        double constant = theory.known ? theory.error_constant : INFINITY;
        const struct gm_scheme *next = scheme;
        for (int k = 0; k < BEST && next; k++) {
            const int off = abs(next->order - like->order);
            const int than = best[k] ? abs(best[k]->order - like->order) : 0;
            if (!best[k] || off < than || (off == than && constant < constants[k])) {
                const struct gm_scheme *moved = best[k];
                const double its = constants[k];
                best[k] = next;
                constants[k] = constant;
                next = moved;
                constant = its;
            }
        }
    }
    bool good = best[0] || gm_refuse(message, "best: of the family of %s, %s, no other scheme fits",
                                     like->name, like->family->title);
    for (int k = 0; good && k < BEST && best[k]; k++) {
        good = add_scheme(grid, best[k], message);
    }
    return good;
}

/* Whether a scheme is measured where none is named. */
static bool is_entrant(const struct gm_grid *grid, const struct gm_scheme *scheme, const struct gm_lane *lane)
{
    const struct gm_work *work = grid->request.scene->work;
    bool entrant = !work || !work->schemes;
    for (size_t k = 0; !entrant && work->schemes[k]; k++) {
        entrant = strcmp(work->schemes[k], scheme->name) == 0;
    }
    const bool exact = work && work->is_exact && strcmp(work->is_exact, scheme->name) == 0 && grid->observed;
    return entrant && !exact && gm_scheme_fits(scheme, &lane->problem);
}

/* Those of the words, or all that fit `lane`'s problem and are no yardstick themselves. */
static bool choose_schemes(struct gm_grid *grid, const struct gm_lane *lane, bool named, char *message)
{
    const struct gm_request *request = &grid->request;
    bool good = gm_grid_lines(grid, gm_scheme_count() + request->count, message);
    for (size_t i = 0; good && named && i < request->count; i++) {
        good = add_scheme(grid, request->lanes[i].scheme, message);
    }
    for (size_t i = 0; good && !named && i < gm_scheme_count(); i++) {
        good = !is_entrant(grid, gm_scheme_at(i), lane) || add_scheme(grid, gm_scheme_at(i), message);
    }
    return good && (!grid->best || add_best(grid, lane, message));
}

static int falling(const void *a, const void *b)
{
    const double *x = a, *y = b;
    return (*x < *y) - (*x > *y);
}

/* The different values that the lanes have of a parameter. */
static void add_typed(struct gm_grid_axis *axis, const struct gm_request *request,
                      const struct gm_parameter *row)
{
    for (size_t i = 0; i < request->count; i++) {
        gm_axis_add(axis, gm_parameter_get(row, request->lanes[i].parameters));
    }
}

static bool choose_steps(struct gm_grid *grid, bool typed, char *message)
{
    enum { MOST_HALVINGS = 63 };
    const struct gm_request *request = &grid->request;
    const struct gm_work *work = request->scene->work;
    const struct gm_timing *timing = gm_grid_timing(grid);
    const double whole = timing->until - gm_scene_t0(request->scene, timing);
    const double coarsest = work && work->coarsest > 0 ? work->coarsest : 4 * timing->dt;
    const int halvings = work ? work->halvings : 7;
    if (!gm_axis_open(&grid->steps, typed ? request->count : MOST_HALVINGS, message)) {
        return false;
    }
    if (typed) {
        add_typed(&grid->steps, request,
                  grid->ratio ? grid->ratio : gm_scene_parameter(request->scene, "dt"));
        qsort(grid->steps.values, grid->steps.count, sizeof *grid->steps.values, falling);
        return true;
    }
    double steps = fmax(1, ceil(whole / coarsest - 1e-9));
    for (int i = 0; i <= halvings; i++, steps *= 2) {
        gm_axis_add(&grid->steps, whole / steps);
    }
    return true;
}

/* The values of the plan, or those of the words if they give more than one; a single one is no ladder. */
static bool choose_resolutions(struct gm_grid *grid, const struct gm_arguments *typed, char *message)
{
    const struct gm_work *work = grid->request.scene->work;
    const struct gm_parameter *row = grid->parameter;
    if (!gm_axis_open(&grid->values, row ? grid->request.count + work->resolution_count : 1, message)) {
        return false;
    }
    grid->smaller_is_finer = row && work->resolutions[0] > work->resolutions[work->resolution_count - 1];
    if (row && is_typed(typed, row->key)) {
        add_typed(&grid->values, &grid->request, row);
    }
    for (size_t i = 0; row && !is_typed(typed, row->key) && i < work->resolution_count; i++) {
        gm_axis_add(&grid->values, work->resolutions[i]);
    }
    if (grid->values.count < 2) {
        grid->parameter = NULL;
        grid->values.count = 1;
    }
    return true;
}

static bool choose_measure(struct gm_grid *grid, const struct gm_lane *lane, const char *asked, char *message)
{
    const struct gm_scene *scene = grid->request.scene;
    const struct gm_work *work = scene->work;
    const bool planned = work && work->measure;
    grid->measure = planned ? work->measure : solution_error;
    grid->measure = asked ? asked : grid->measure;
    grid->measure_title = lane->problem.exact ? "largest difference from the true solution"
                                              : "largest difference from a run of short steps";
    grid->measure_title = work && work->distance ? work->distance_title : grid->measure_title;
    grid->observed = strcmp(grid->measure, solution_error) != 0 ||
                     (planned && strcmp(work->measure, solution_error) == 0) ||
                     (!lane->problem.exact && gm_scene_observable(scene, solution_error) >= 0);
    if (!grid->observed) {
        return true;
    }
    const int found = gm_scene_observable(scene, grid->measure);
    if (found < 0) {
        return gm_chosen_refuse(scene, grid->measure, message);
    }
    /* at the start already a measure can say nothing with these parameters, as a distance from an exact
       solution that there is not; or with this scheme, but then others may say more */
    const struct gm_observable *observable = gm_scene_observable_at(scene, (size_t)found);
    if (observable->why || isfinite(gm_lane_observe(lane, (size_t)found))) {
        grid->measure_title = observable->title;
        return true;
    }
    if (!asked) {
        grid->measure = solution_error;
        grid->observed = false;
        return true;
    }
    return gm_refuse(message, "%s says nothing with these parameters", asked);
}

bool gm_work_lay_out(struct gm_grid *grid, const struct gm_arguments *words, const struct gm_arguments *typed,
                     const char *measure, char *message)
{
    const struct gm_scene *scene = grid->request.scene;
    const struct gm_work *work = scene->work;
    const struct gm_timing *timing = gm_grid_timing(grid);
    const char *resolution = work ? work->resolution : NULL, *ratio = work ? work->ratio : NULL;
    grid->parameter = resolution ? gm_scene_parameter(scene, resolution) : NULL;
    grid->errors = work && work->errors ? work->errors : usual_errors;
    grid->ratio = ratio && is_typed(typed, ratio) ? gm_scene_parameter(scene, ratio) : NULL;
    if (!gm_request_ends_together(&grid->request, message)) {
        return false;
    }
    if (!is_one_problem(grid, typed)) {
        return gm_refuse(
            message, "work-precision compares on one problem: only scheme%s%s%s%s and dt take a list",
            resolution ? ", " : "", resolution ? resolution : "", ratio ? ", " : "", ratio ? ratio : "");
    }
    note_settings(grid, words);
    if (!(timing->until > gm_scene_t0(scene, timing))) {
        return gm_refuse(message, "until=%g is the start: there is nothing to measure", timing->until);
    }
    if (!choose_steps(grid, is_typed(typed, "dt") || grid->ratio, message) ||
        !choose_resolutions(grid, typed, message)) {
        return false;
    }
    /* one open lane shows which measure has a number and which schemes fit */
    struct gm_lane *lane = gm_request_open_lane(&grid->request, 0, message);
    const bool good = lane && choose_measure(grid, lane, measure, message) &&
                      choose_schemes(grid, lane, is_typed(typed, "scheme"), message);
    gm_lane_close(lane);
    return good &&
           (grid->count > 0 || gm_refuse(message, "no scheme that is compared here fits %s", scene->name));
}
