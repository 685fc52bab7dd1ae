/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Exercises of tours: the conditions that a lane must meet. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/base/arguments.h"
#include "app/tours/tour.h"
#include "app/words/drive.h"
#include "core/arena.h"
#include "core/theory/certify.h"

/* ---- the names of a condition ---- */

enum { TIME, STEPS, EVALUATIONS, ORDER, CERTIFIED, TYPED, FIXED };
static const char *const fixed[FIXED] = {
    [TIME] = "t",      [STEPS] = "steps",         [EVALUATIONS] = "evaluations",
    [ORDER] = "order", [CERTIFIED] = "certified", [TYPED] = "typed"};

/* Names are numbered: the fixed ones, claims, parameters of the scene and of schemes, observables. */
struct names {
    const struct gm_scene *scene;
    char claims[GM_CLAIM_COUNT][40]; /* "keeps_energy" */
    struct gm_expectation *expectation;
};

static const struct gm_parameter *row_of(const struct gm_scene *scene, size_t name)
{
    const size_t first = FIXED + GM_CLAIM_COUNT, settings = first + scene->parameter_count;
    return name < first                                    ? NULL
           : name < settings                               ? &scene->parameters[name - first]
           : name < settings + gm_settings_parameter_count ? &gm_settings_parameters[name - settings]
                                                           : NULL;
}

static size_t observable_of(const struct gm_scene *scene, size_t name)
{
    return name - FIXED - GM_CLAIM_COUNT - scene->parameter_count - gm_settings_parameter_count;
}

static const char *name_at(size_t i, const void *data)
{
    const struct names *names = data;
    const struct gm_parameter *row = row_of(names->scene, i);
    if (row || i < FIXED + GM_CLAIM_COUNT) {
        return row ? row->key : i < FIXED ? fixed[i] : names->claims[i - FIXED];
    }
    const struct gm_observable *observable =
        gm_scene_observable_at(names->scene, observable_of(names->scene, i));
    return observable ? observable->key : NULL;
}

/* The number of a name, or that behind the last one. */
static size_t number_of(const struct names *names, const char *word)
{
    size_t number = 0;
    for (const char *known; (known = name_at(number, names)) && strcmp(known, word) != 0;) {
        number++;
    }
    return number;
}

static enum gm_meaning find_name(void *data, const struct gm_name *name, gm_node_id *node, char *sentence)
{
    struct names *names = data;
    struct gm_expectation *expectation = names->expectation;
    char word[96], index[32] = "";
    if (name->indexed) {
        snprintf(index, sizeof index, "[%ld]", name->index);
    }
    /* an observable may be called q[1] */
    snprintf(word, sizeof word, "%.*s%s", (int)name->length, name->text, index);
    size_t number = number_of(names, word), at = 0;
    const char *known = name_at(number, names);
    if (!known && name->indexed) {
        gm_refuse(sentence, "there is no value %s; geomint list names those of the scene", word);
        return GM_REFUSED;
    }
    if (!known || name->initial) {
        return GM_UNKNOWN;
    }
    const size_t own = FIXED + GM_CLAIM_COUNT;
    const char *another;
    for (size_t i = own; number < own && (another = name_at(i, names)); i++) {
        if (strcmp(another, known) == 0) {
            gm_refuse(sentence,
                      "%s is a name of all exercises and of this scene; give the scene's another name",
                      known);
            return GM_REFUSED;
        }
    }
    const struct gm_parameter *row = row_of(names->scene, number);
    if (row && row->type != GM_REAL && row->type != GM_INTEGER) {
        gm_refuse(sentence, "%s is a word, not a number", known);
        return GM_REFUSED;
    }
    if (row && row->starts) {
        gm_refuse(
            sentence,
            "%s is where a lane starts, and no value at the end; geomint list names the scene's observables",
            known);
        return GM_REFUSED;
    }
    while (at < expectation->count && expectation->names[at] != number) {
        at++;
    }
    if (at == GM_MOST_NAMES) {
        gm_refuse(sentence, "a condition has at most %d names", GM_MOST_NAMES);
        return GM_REFUSED;
    }
    expectation->names[at] = number;
    expectation->keys[at] = known;
    expectation->count += at == expectation->count;
    *node = gm_formula_variable(&expectation->graph, at);
    return GM_KNOWN;
}

bool gm_expectation_read(struct gm_arena *arena, const struct gm_scene *scene, char *text,
                         struct gm_expectation *expectation, struct gm_fault *fault)
{
    struct names *names = gm_arena_take(arena, 1, sizeof *names);
    *names = (struct names){.scene = scene, .expectation = expectation};
    for (size_t i = 0; i < GM_CLAIM_COUNT; i++) {
        snprintf(names->claims[i], sizeof names->claims[i], "%s", gm_claims[i].key);
        for (char *at = names->claims[i]; (at = strpbrk(at, " -"));) {
            *at = '_';
        }
    }
    const struct gm_scope scope = {.find = find_name, .known = name_at, .data = names, .is_condition = true};
    expectation->text = text;
    gm_formula_open(&expectation->graph);
    gm_arena_keep(arena, &expectation->graph, gm_formula_close);
    const bool read =
        gm_formula_read(&expectation->graph, text, 0, strlen(text), &scope, &expectation->node, fault);
    return read && (expectation->count > 0 ||
                    gm_fail(fault, 0, "a condition names at least one value, as in energy_error < 1e-6"));
}

/* ---- grading ---- */

bool gm_exercise_is_about(const struct gm_tour_step *step, const struct gm_scene *scene, char *message)
{
    const struct gm_scene *shown = step->request.scene;
    return scene == shown || (scene->text && shown->text && strcmp(scene->text, shown->text) == 0) ||
           gm_refuse(message, "the exercise is about %s, and the answer about %s%s", shown->name,
                     strcmp(shown->name, scene->name) == 0 ? "another " : "", scene->name);
}

/* Returns the least value that measurement gives for the schemes of a lane. */
static double certified_value(const struct gm_lane *lane, size_t name)
{
    double least = INFINITY;
    for (size_t i = 0; i <= lane->switch_count; i++) {
        const struct gm_scheme *scheme = gm_lane_scheme_after(lane, i);
        double value = scheme->word != NULL;
        if (name != TYPED) {
            const struct gm_certificate certificate = gm_certify(scheme);
            value = !certificate.order_problem[0] ? NAN /* nothing was measured */
                    : name == ORDER               ? certificate.order
                    : name == CERTIFIED           ? certificate.holds
                                                  : certificate.claims[name - FIXED].holds;
        }
        least = value < least || isnan(value) ? value : least;
    }
    return least;
}

static double value_of(const struct gm_lane *lane, size_t name)
{
    const struct gm_run *run = lane->run;
    const struct gm_parameter *row = row_of(lane->scene, name);
    if (row && gm_is_setting(row)) {
        return gm_scheme_takes(lane->scheme, row) ? gm_parameter_get(row, &lane->settings) : NAN;
    }
    if (row) {
        return gm_parameter_get(row, lane->parameters);
    }
    return name >= FIXED + GM_CLAIM_COUNT ? gm_lane_observe(lane, observable_of(lane->scene, name))
           : name == TIME                 ? run->t
           : name == STEPS                ? (double)run->steps
           : name == EVALUATIONS          ? gm_run_per_member(run, run->evaluations)
                                          : certified_value(lane, name);
}

/* Returns true if the lane meets the condition; the sentence gives the values of its names. */
static bool meets(const struct gm_expectation *expectation, const struct gm_lane *lane, char *sentence)
{
    double values[GM_MOST_NAMES] = {0};
    bool finite = true;
    sentence[0] = '\0';
    for (size_t i = 0; i < expectation->count; i++) {
        values[i] = value_of(lane, expectation->names[i]);
        finite = finite && isfinite(values[i]);
        gm_append(sentence, GM_MESSAGE, "%s%.60s = %.6g", i > 0 ? ", " : "", expectation->keys[i], values[i]);
    }
    const gm_node_id count = expectation->node + 1;
    double *nodes = malloc(count * sizeof *nodes);
    if (nodes) {
        gm_formula_evaluate(&expectation->graph, count, values, nodes);
    }
    for (gm_node_id i = 0; nodes && i < count; i++) {
        finite =
            finite && !isnan(nodes[i]); /* a comparison with NaN decides nothing, nor does its opposite */
    }
    const bool met = nodes && finite && nodes[expectation->node] == 1;
    free(nodes);
    return met;
}

/* Returns true if an expectation of the step names this parameter. */
static bool is_named(const struct gm_tour_step *step, const struct gm_parameter *row)
{
    bool named = false;
    for (size_t i = 0; i < step->expectation_count; i++) {
        for (size_t k = 0; k < step->expectations[i].count; k++) {
            named = named || row_of(step->request.scene, step->expectations[i].names[k]) == row;
        }
    }
    return named;
}

/* Returns true if the answer may change a parameter. */
static bool is_free(const struct gm_tour_step *step, const struct gm_parameter *row)
{
    return !row || row->looks || strcmp(row->key, "show") == 0 || gm_is_setting(row) ||
           row->offset == offsetof(struct gm_timing, dt) ||
           row->offset == offsetof(struct gm_timing, until) || row->sets_step || is_named(step, row);
}

/* The number of parameters that differ from a lane that is shown, and the first of them. */
static size_t count_others(const struct gm_tour_step *step, size_t shown_lane, const void *parameters,
                           const struct gm_parameter **first)
{
    const struct gm_scene *scene = step->request.scene;
    size_t count = 0;
    for (size_t i = 0; i < scene->parameter_count; i++) {
        const struct gm_parameter *row = &scene->parameters[i];
        const double shown = gm_parameter_get(row, step->request.lanes[shown_lane].parameters),
                     now = gm_parameter_get(row, parameters);
        if (!is_free(step, row) && now != shown && !(isnan(now) && isnan(shown))) {
            *first = count == 0 ? row : *first;
            count++;
        }
    }
    return count;
}

/* Returns the first parameter that the lane has otherwise than that lane of `show:` which is most like it, or that was changed
   during the run; or NULL. */
static const struct gm_parameter *first_changed(const struct gm_tour_step *step,
                                                const struct gm_request *request, size_t lane)
{
    const struct gm_scene *scene = step->request.scene;
    size_t fewest = SIZE_MAX;
    const struct gm_parameter *other = NULL;
    for (size_t i = 0; i < step->request.count; i++) {
        const struct gm_parameter *first;
        const size_t count = count_others(step, i, request->lanes[lane].parameters, &first);
        other = count >= fewest ? other : count > 0 ? first : NULL;
        fewest = count < fewest ? count : fewest;
    }
    if (other) {
        return other;
    }
    for (size_t i = 0; i < request->change_count; i++) {
        const struct gm_change *change = &request->changes[i];
        char key[96];
        snprintf(key, sizeof key, "%.*s", (int)strcspn(change->text, "="), change->text);
        const struct gm_parameter *row = gm_scene_parameter(scene, key);
        if (change->lane == lane && !is_free(step, row)) {
            return row;
        }
    }
    return NULL;
}

/* Returns true if the lane has made no step with its dt and its scheme. */
static bool was_changed_last(const struct gm_request *request, size_t lane, int64_t steps)
{
    bool last = false;
    for (size_t i = 0; i < request->change_count; i++) {
        const struct gm_change *change = &request->changes[i];
        last |= change->lane == lane && change->step >= steps &&
                (strncmp(change->text, "dt=", 3) == 0 || strncmp(change->text, "scheme=", 7) == 0);
    }
    return last;
}

/* Returns the number of expectations that the lane meets one after the other, all plus 1 if it passes. */
static size_t grade_lane(const struct gm_tour_step *step, const struct gm_request *request, size_t index,
                         const struct gm_lane *lane, char *sentence)
{
    const struct gm_run *run = lane->run;
    const char *title = lane->schemes;
    char values[GM_MESSAGE];
    const struct gm_parameter *changed = first_changed(step, request, index);
    if (run->status != GM_OK) {
        gm_failure_sentence(lane, values, sizeof values);
        gm_refuse(sentence, "Not passed: %.100s: %.300s", title, values);
        return 0;
    }
    if (was_changed_last(request, index, run->steps)) {
        gm_refuse(sentence, "Not passed: %.100s has made no step since its last change.", title);
        return 0;
    }
    if (run->dt < 0) {
        gm_refuse(sentence, "Not passed: %.100s runs backwards in time.", title);
        return 0;
    }
    /* The time at which a lane is judged is not chosen: a step of length dt would lead beyond the end, and one step earlier it
       would not have done so. Where dt is long, the lane must still be near the end. */
    const double left = step->until - run->t, dt = run->dt, near = (step->until - lane->t0) / 20;
    const bool varies = run->scheme->family->adaptive; /* otherwise t has the rounding of n dt */
    const bool beyond = varies ? step->until - run->t_behind < dt * (1 - 1e-9) : left < -2e-6 * dt;
    if (beyond || left >= dt * (1 - 1e-9) || fabs(left) > near) {
        const int digits = fabs(left) > 1e-5 * fabs(step->until) ? 6 : 15;
        gm_refuse(sentence, "Not passed: %.100s is at t = %.*g, and the exercise ends at t = %.*g.", title,
                  digits, run->t, digits, step->until);
        return 0;
    }
    if (changed) {
        gm_refuse(sentence, "Not passed: %.100s has another %.60s than the exercise.", title, changed->key);
        return 0;
    }
    gm_refuse(sentence, "Passed with %.100s: ", title);
    for (size_t i = 0; i < step->expectation_count; i++) {
        const struct gm_expectation *expectation = &step->expectations[i];
        if (!meets(expectation, lane, values)) {
            char condition[160] = "";
            gm_append(condition, sizeof condition, "%s", expectation->text);
            gm_refuse(sentence, "Not passed: %.100s misses %s: %s.", title, condition, values);
            return i;
        }
        gm_append(sentence, GM_MESSAGE, "%s%s", values, i + 1 < step->expectation_count ? ", " : ".");
    }
    return step->expectation_count + 1;
}

bool gm_exercise_passed(const struct gm_tour_step *step, const struct gm_request *request,
                        const struct gm_lane *const *lanes, char *sentence)
{
    size_t best = 0;
    for (size_t i = 0; i < request->count && best <= step->expectation_count; i++) {
        char text[GM_MESSAGE];
        const size_t met = grade_lane(step, request, i, lanes[i], text);
        if (i == 0 || met > best) {
            snprintf(sentence, GM_MESSAGE, "%s", text);
            best = met;
        }
    }
    return best > step->expectation_count;
}
