/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Studies of a system: lines work: and stability:, or default ones. */
#include "scenes/common/system/pieces.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/model/scope.h"
#include "core/schemes.h"

/* Refuses an option unless it names an observable. */
static void check_observable(const struct gm_system_scene *system_scene, const struct gm_system_item *item,
                             enum gm_system_option_word word)
{
    const char *key = gm_system_option_text(item, word, NULL);
    if (key && gm_scene_observable(&system_scene->scene, key) < 0) {
        gm_arena_refuse(system_scene->arena, "%s: %.60s is not an observable",
                        gm_system_words[item->word].word, key);
    }
}

/* Reads the schemes that an option names, ended by NULL. Returns NULL for the usual ones. */
static const char *const *take_schemes(struct gm_arena *arena, const struct gm_system_item *item,
                                       const struct gm_problem *problem, const char **schemes)
{
    const char *text = gm_system_option_text(item, GM_OPTION_SCHEMES, "usual");
    if (strcmp(text, "usual") == 0) {
        return NULL;
    }
    gm_written_schemes(arena, text, problem, schemes);
    return schemes;
}

/* ---- work and precision ---- */

static void make_work(struct gm_system_scene *system_scene, const struct gm_problem *problem)
{
    const struct gm_system_item *item = gm_system_item_of(&system_scene->system, GM_WORD_WORK, 0);
    struct gm_arena *arena = system_scene->arena;
    struct gm_work *work = &system_scene->work;
    system_scene->scene.work =
        item || system_scene->radian > 0 || work->halvings > 0 ? work : NULL; /* or the file has none */
    if (system_scene->radian > 0) { /* a field has a work of its own */
        work->coarsest = system_scene->radian;
        work->halvings = 8;
    }
    if (!item && system_scene->radian > 0) {
        const double until = atof(gm_scene_parameter(&system_scene->scene, "until")->standard);
        work->arguments =
            gm_arena_print(arena, "until=%.17g", fmin(until, gm_written_rounded(20 * system_scene->radian)));
    }
    if (!item) {
        return;
    }
    const struct gm_system_option *errors = gm_system_option(item, GM_OPTION_ERRORS);
    const struct gm_system_item *tie = gm_system_item_of(&system_scene->system, GM_WORD_TIE, 0);
    const char *solves = gm_system_option_text(item, GM_OPTION_SOLVES, NULL),
               *reference = gm_system_option_text(item, GM_OPTION_REFERENCE, NULL);
    const char *const known[] = {solves, reference};
    for (size_t i = 0; i < GM_COUNT(known); i++) {
        if (known[i] && !gm_scheme_find(known[i])) {
            gm_arena_refuse(arena, "work: %.60s is not a scheme", known[i]);
        }
    }
    if (errors && (errors->count != 3 ||
                   !(errors->numbers[0] > errors->numbers[1] && errors->numbers[1] > errors->numbers[2]))) {
        gm_arena_refuse(arena, "work: errors are three numbers that fall: errors 1e-3, 1e-6, 1e-9");
    }
    gm_written_work(work, item);
    work->reference = reference ? reference : work->reference;
    work->is_exact = solves;
    work->ratio = tie ? system_scene->system.variables[tie->variable].name : NULL;
    if (gm_system_option(item, GM_OPTION_VALUES) && !gm_scene_parameter(&system_scene->scene, item->name)) {
        gm_arena_refuse(arena, "work: %.60s is not a parameter", item->name);
    }
    if (!(work->coarsest > 0) || work->halvings < 1 || work->halvings > 30) {
        gm_arena_refuse(arena, "work: a ladder of steps begins above 0 and has 1 to 30 halvings");
    }
    check_observable(system_scene, item, GM_OPTION_MEASURE);
    work->schemes = take_schemes(arena, item, problem, system_scene->work_schemes);
}

/* ---- maps of stability ---- */

/* Returns the unit of the steps that the file names. */
static double unit_of(const void *parameters)
{
    const struct gm_system_lane *lane = parameters;
    const struct gm_system_scene *system_scene = lane->owner;
    const struct gm_system_item *item = gm_system_item_of(&system_scene->system, GM_WORD_STABILITY, 0);
    double *values = gm_system_start_values(lane, NULL), unit = NAN;
    if (values) {
        gm_tape_values(&system_scene->of_items[item - system_scene->system.items], values, &unit, 1);
    }
    free(values);
    return unit;
}

/* Makes the map of a system whose file has none: over the first parameter that can change, or over the start
   of the first component. */
static void make_usual_map(struct gm_system_scene *system_scene, double (*radian)(const void *parameters))
{
    static const double factors[] = {0.5, 0.75, 1, 1.5, 2};
    static const double steps[] = {0.1, 0.2, 0.5, 1, 1.5, 1.95, 2.05, 3};
    size_t row = GM_SYSTEM_ROWS;
    while (system_scene->rows[row].lowest == system_scene->rows[row].highest) { /* every start has a range */
        row++;
    }
    const struct gm_parameter *parameter = &system_scene->rows[row];
    const double usual = gm_parameter_get(parameter, system_scene->initial);
    size_t count = 0;
    for (size_t i = 0; i < GM_COUNT(factors); i++) {
        const double value = usual != 0 ? usual * factors[usual > 0 ? i : GM_COUNT(factors) - 1 - i]
                                        : fmin(1, parameter->highest) * (double)i / GM_COUNT(factors);
        if (value >= parameter->lowest && value <= parameter->highest) {
            system_scene->values[count++] = value;
        }
    }
    const bool kept = system_scene->observable_count > 0 && system_scene->observables[0].kept;
    system_scene->stability = (struct gm_stability){
        .arguments = gm_arena_print(system_scene->arena, "until=%.17g",
                                    gm_written_rounded(200 * system_scene->radian)),
        .parameter = parameter->key,
        .values = system_scene->values,
        .value_count = count,
        .label = "h ω",
        .unit = radian,
        .told =
            "ω is the largest frequency of the linearised field at the start; without one, the largest rate; "
            "without either, 1",
        .steps = steps,
        .step_count = GM_COUNT(steps),
        .throughout = true,
        .kept = kept ? system_scene->observables[0].key : NULL,
        .error = kept ? system_scene->observables[0].key : NULL,
    };
}

/* Reads the map in the line stability:. */
static void read_map(struct gm_system_scene *system_scene, const struct gm_problem *problem,
                     const struct gm_system_item *item)
{
    struct gm_arena *arena = system_scene->arena;
    struct gm_stability *map = &system_scene->stability;
    const struct gm_system_option *values = gm_system_option(item, GM_OPTION_VALUES),
                                  *unit = gm_system_option(item, GM_OPTION_STEP_UNIT),
                                  *steps = gm_system_option(item, GM_OPTION_STEPS);
    const struct gm_parameter *row = values ? gm_scene_parameter(&system_scene->scene, item->name) : NULL;
    if (!values) {
        gm_arena_refuse(arena, "stability: a parameter and its values are missing: q 0, 1");
    }
    if (!row) {
        gm_arena_refuse(arena, "stability: %.60s is not a parameter", item->name);
    }
    for (size_t i = 0; i < values->count; i++) {
        if (!(values->numbers[i] >= row->lowest && values->numbers[i] <= row->highest)) {
            gm_arena_refuse(arena, "stability: %s lies between %g and %g, and one of its values is %g",
                            row->key, row->lowest, row->highest, values->numbers[i]);
        }
    }
    for (size_t i = 0; steps && i < steps->count; i++) {
        if (!(steps->numbers[i] > 0)) {
            gm_arena_refuse(arena, "stability: a step is above 0, and this is %g", steps->numbers[i]);
        }
    }
    map->arguments = item->words;
    map->parameter = row->key;
    map->values = values->numbers;
    map->value_count = values->count;
    if (unit) {
        map->label = unit->text;
        map->unit = unit_of;
        map->told = NULL;
    }
    if (steps && steps->count > 0) { /* else the usual ones */
        map->steps = steps->numbers;
        map->step_count = steps->count;
    }
    if (!map->unit || !map->steps) {
        gm_arena_refuse(arena,
                        "stability: a field needs a unit and steps: unit 2*half_length/points = Δt / Δx; "
                        "steps 0.5, 1, 2");
    }
    map->throughout = gm_system_option(item, GM_OPTION_LARGEST) != NULL;
    map->settle = (int64_t)gm_system_option_number(item, GM_OPTION_SETTLE, 0);
    map->kept = gm_system_option_text(item, GM_OPTION_LOST, NULL);
    map->error = gm_system_option_text(item, GM_OPTION_WRONG, NULL);
    check_observable(system_scene, item, GM_OPTION_LOST);
    check_observable(system_scene, item, GM_OPTION_WRONG);
    map->schemes = take_schemes(arena, item, problem, system_scene->stability_schemes);
}

void gm_system_make_studies(struct gm_system_scene *system_scene, const struct gm_problem *problem,
                            double (*radian)(const void *parameters))
{
    const struct gm_system_item *item = gm_system_item_of(&system_scene->system, GM_WORD_STABILITY, 0),
                                *graph;
    for (size_t i = 0; (graph = gm_system_item_of(&system_scene->system, GM_WORD_GRAPH, i)); i++) {
        if (gm_scene_observable(&system_scene->scene, graph->name) < 0) {
            gm_arena_refuse(system_scene->arena, "graph: %.60s is not an observable", graph->name);
        }
    }
    const char *missing = item ? gm_system_option_text(item, GM_OPTION_MISSING, NULL) : NULL;
    gm_written_figures(system_scene->arena, &system_scene->system, &system_scene->scene);
    make_work(system_scene, problem);
    if (missing) {
        system_scene->scene.no_stability = gm_arena_print(
            system_scene->arena, "%s; stability --region SCHEME shows the limit of a scheme", missing);
        return;
    }
    system_scene->scene.stability = item || radian ? &system_scene->stability : NULL;
    if (radian) {
        make_usual_map(system_scene, radian);
    }
    if (item) {
        read_map(system_scene, problem, item);
    }
}
