/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What work-precision is to measure: from the words of the command line to schemes, steps and a measure. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/grid/work.h"
#include "app/words/chosen.h"
#include "app/words/words.h"
#include "core/basics.h"
#include "core/certify.h"
#include "core/expression/lines.h"
#include "core/schemes.h"

static const double usual_errors[3] = {1e-3, 1e-6, 1e-9};

static const char solution_error[] = "solution_error";

static struct gm_timing *timing_of(const struct gm_work_table *table)
{
    return table->request.lanes[0].parameters;
}

/* Fills an empty list: the scene, its arguments for this purpose unless overridden, and the user's words. */
static bool complete(struct gm_arguments *words, const struct gm_arguments *typed, int *status, char *message)
{
    const struct gm_scene *scene = gm_request_scene(typed->count, typed->words, status, message);
    return scene && (gm_words_complete(words, scene, typed, scene->work ? scene->work->arguments : "") ||
                     gm_refuse(message, "not enough memory"));
}

/* Lanes may differ in scheme, dt, resolution and ratio alone, and in what was not typed but follows from
   those. */
static bool alike(const struct gm_work_table *table, const struct gm_arguments *typed)
{
    const struct gm_request *request = &table->request;
    const struct gm_scene *scene = request->scene;
    for (size_t i = 1; i < request->count; i++) {
        for (size_t k = 0; k < scene->parameter_count; k++) {
            const struct gm_parameter *row = &scene->parameters[k];
            char word[64];
            snprintf(word, sizeof word, "%s=", row->key);
            const bool varies = row->offset == offsetof(struct gm_timing, dt) || row == table->resolution ||
                                row == table->ratio || !gm_arguments_have(typed, word);
            const double first = gm_parameter_get(row, request->lanes[0].parameters);
            const double other = gm_parameter_get(row, request->lanes[i].parameters);
            const bool left_to_itself = isnan(first) && isnan(other);
            if (!varies && first != other && !left_to_itself) {
                return false;
            }
        }
    }
    return true;
}

/* Whether the ladders or the lines of the diagram have the values of this word. */
static bool is_varied(const struct gm_work_table *table, const char *word)
{
    const char *const keys[] = {"scheme", "dt", "until", table->resolution ? table->resolution->key : NULL,
                                table->ratio ? table->ratio->key : NULL};
    for (size_t i = 0; i < GM_COUNT(keys); i++) {
        const size_t length = keys[i] ? strlen(keys[i]) : 0;
        if (length > 0 && strncmp(word, keys[i], length) == 0 && word[length] == '=') {
            return true;
        }
    }
    return false;
}

static void tell_setting(struct gm_work_table *table, const char *word)
{
    const size_t used = strlen(table->settings);
    if (!is_varied(table, word)) {
        snprintf(table->settings + used, sizeof table->settings - used, "%s%s", used ? " " : "", word);
    }
}

/* Tells the words of the plan and of the user. */
static void tell_settings(struct gm_work_table *table, const struct gm_arguments *words)
{
    for (int i = 1; i < words->count; i++) {
        tell_setting(table, words->words[i]);
    }
}

static bool add_scheme(struct gm_work_table *table, const struct gm_scheme *scheme)
{
    for (size_t i = 0; i < table->scheme_count; i++) {
        if (table->schemes[i] == scheme) {
            return true;
        }
    }
    table->schemes[table->scheme_count++] = scheme;
    return true;
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

/* The built-in schemes of the first one's family that promise the smallest error at equal cost: the smallest
   error constant by theory, of its order before those of other orders. */
static bool add_best(struct gm_work_table *table, const struct gm_lane *lane, char *message)
{
    enum { BEST = 3 };
    const struct gm_scheme *like = table->schemes[0], *best[BEST] = {NULL};
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
    for (int k = 0; k < BEST && best[k]; k++) {
        add_scheme(table, best[k]);
    }
    return best[0] || gm_refuse(message, "best: of the family of %s, %s, no other scheme fits", like->name,
                                like->family->title);
}

/* Those of the words, or all that fit `lane`'s problem and are no yardstick themselves. */
static bool choose_schemes(struct gm_work_table *table, const struct gm_lane *lane, bool named, char *message)
{
    const struct gm_request *request = &table->request;
    table->schemes = calloc(gm_scheme_count() + request->count, sizeof *table->schemes);
    table->lines = calloc(gm_scheme_count() + request->count, sizeof *table->lines);
    if (!table->schemes || !table->lines) {
        return gm_refuse(message, "not enough memory");
    }
    for (size_t i = 0; named && i < request->count; i++) {
        add_scheme(table, request->lanes[i].scheme);
    }
    if (table->best && !add_best(table, lane, message)) {
        return false;
    }
    for (size_t i = 0; !named && i < gm_scheme_count(); i++) {
        const struct gm_work *work = request->scene->work;
        bool entrant = !work || !work->schemes;
        for (size_t k = 0; !entrant && work->schemes[k]; k++) {
            entrant = strcmp(work->schemes[k], gm_scheme_at(i)->name) == 0;
        }
        const bool exact =
            work && work->is_exact && strcmp(work->is_exact, gm_scheme_at(i)->name) == 0 && table->observed;
        if (entrant && !exact && gm_scheme_fits(gm_scheme_at(i), &lane->problem)) {
            add_scheme(table, gm_scheme_at(i));
        }
    }
    return true;
}

static int falling(const void *a, const void *b)
{
    const double *x = a, *y = b;
    return (*x < *y) - (*x > *y);
}

static bool choose_steps(struct gm_work_table *table, bool given, char *message)
{
    const struct gm_request *request = &table->request;
    const struct gm_work *work = request->scene->work;
    const struct gm_timing *timing = timing_of(table);
    const double whole = timing->until - gm_scene_t0(request->scene, timing);
    const size_t most = given ? request->count : 64;
    table->steps = calloc(most, sizeof *table->steps);
    if (!table->steps) {
        return gm_refuse(message, "not enough memory");
    }
    if (given) {
        for (size_t i = 0; i < request->count; i++) {
            const void *self = request->lanes[i].parameters;
            const double step =
                table->ratio ? gm_parameter_get(table->ratio, self) : ((const struct gm_timing *)self)->dt;
            bool known = false;
            for (size_t k = 0; k < table->step_count; k++) {
                known |= table->steps[k] == step;
            }
            if (!known) {
                table->steps[table->step_count++] = step;
            }
        }
        qsort(table->steps, table->step_count, sizeof *table->steps, falling);
        return true;
    }
    const double coarsest = work && work->coarsest > 0 ? work->coarsest : 4 * timing->dt;
    const int halvings = work ? work->halvings : 7;
    double steps = fmax(1, ceil(whole / coarsest - 1e-9));
    for (int i = 0; i <= halvings; i++, steps *= 2) {
        table->steps[table->step_count++] = whole / steps;
    }
    return true;
}

/* The values of the plan, or those of the words if they give more than one; a single one is no ladder. */
static bool choose_resolutions(struct gm_work_table *table, const struct gm_arguments *typed, char *message)
{
    const struct gm_work *work = table->request.scene->work;
    const struct gm_parameter *row = table->resolution;
    char word[64];
    snprintf(word, sizeof word, "%s=", row ? row->key : "");
    const bool given = row && gm_arguments_have(typed, word);
    const size_t most = given ? table->request.count : row ? work->resolution_count : 0;
    table->smaller_is_finer = row && work->resolutions[0] > work->resolutions[work->resolution_count - 1];
    table->resolutions = calloc(most + 1, sizeof *table->resolutions);
    if (!table->resolutions) {
        return gm_refuse(message, "not enough memory");
    }
    for (size_t i = 0; i < most; i++) {
        const double value =
            given ? gm_parameter_get(row, table->request.lanes[i].parameters) : work->resolutions[i];
        bool known = false;
        for (size_t k = 0; k < table->resolution_count; k++) {
            known |= table->resolutions[k] == value;
        }
        if (!known) {
            table->resolutions[table->resolution_count++] = value;
        }
    }
    if (table->resolution_count < 2) {
        table->resolution = NULL;
        table->resolution_count = 1;
    }
    return true;
}

static bool choose_measure(struct gm_work_table *table, const struct gm_lane *lane, const char *asked,
                           char *message)
{
    const struct gm_scene *scene = table->request.scene;
    table->measure = asked                                 ? asked
                     : scene->work && scene->work->measure ? scene->work->measure
                                                           : solution_error;
    const struct gm_work *work = scene->work;
    table->measure_title = work && work->distance ? work->distance_title
                           : lane->problem.exact  ? "largest difference from the true solution"
                                                  : "largest difference from a run of short steps";
    table->observed =
        strcmp(table->measure, solution_error) != 0 ||
        (scene->work && scene->work->measure && strcmp(scene->work->measure, solution_error) == 0) ||
        (!lane->problem.exact && gm_scene_observable(scene, solution_error) >= 0);
    if (!table->observed) {
        return true;
    }
    const int found = gm_scene_observable(scene, table->measure);
    if (found < 0) {
        return gm_chosen_refuse(scene, table->measure, message);
    }
    /* at the start already a measure can say nothing with these parameters, as a distance from an exact
       solution that there is not; or with this scheme, but then others may say more */
    const struct gm_observable *observable = gm_scene_observable_at(scene, (size_t)found);
    if (observable->why || isfinite(gm_lane_observe(lane, (size_t)found))) {
        table->measure_title = observable->title;
        return true;
    }
    if (!asked) {
        table->measure = solution_error;
        table->observed = false;
        return true;
    }
    return gm_refuse(message, "%s says nothing with these parameters", asked);
}

/* One lane is set up, and tells which measure says something and which schemes fit. */
static bool choose(struct gm_work_table *table, const struct gm_arguments *typed, const char *measure,
                   char *message)
{
    struct gm_lane *lane = gm_request_open_lane(&table->request, 0, message);
    const bool good = lane && choose_measure(table, lane, measure, message) &&
                      choose_schemes(table, lane, gm_arguments_have(typed, "scheme="), message);
    gm_lane_close(lane);
    return good;
}

/* The table of a request that was read from `words`, among which are those typed. */
static bool plan(struct gm_work_table *table, const struct gm_arguments *words,
                 const struct gm_arguments *typed, const char *measure, char *message)
{
    const struct gm_work *work = table->request.scene->work;
    table->resolution =
        work && work->resolution ? gm_scene_parameter(table->request.scene, work->resolution) : NULL;
    table->errors = work && work->errors ? work->errors : usual_errors;
    if (work && work->ratio) {
        char word[64];
        snprintf(word, sizeof word, "%s=", work->ratio);
        table->ratio =
            gm_arguments_have(typed, word) ? gm_scene_parameter(table->request.scene, work->ratio) : NULL;
    }
    if (!gm_request_ends_together(&table->request, message)) {
        return false;
    }
    if (!alike(table, typed)) {
        return gm_refuse(message,
                         "work-precision compares on one problem: only scheme%s%s%s%s and dt take a list",
                         table->resolution ? ", " : "", table->resolution ? table->resolution->key : "",
                         work && work->ratio ? ", " : "", work && work->ratio ? work->ratio : "");
    }
    tell_settings(table, words);
    if (!(timing_of(table)->until > gm_scene_t0(table->request.scene, timing_of(table)))) {
        return gm_refuse(message, "until=%g is the start: there is nothing to measure",
                         timing_of(table)->until);
    }
    return choose_steps(table, gm_arguments_have(typed, "dt=") || table->ratio, message) &&
           choose_resolutions(table, typed, message) && choose(table, typed, measure, message);
}

bool gm_work_open(struct gm_work_table *table, const struct gm_arguments *arguments, const char *measure,
                  char *message)
{
    *table = (struct gm_work_table){0};
    if (arguments->count == 0) {
        return gm_refuse(message, "work-precision of which scene? See geomint list scenes");
    }
    struct gm_arguments words = {0};
    bool good = complete(&words, arguments, &table->request.refusal, message);
    table->best = good && take_best(&words);
    for (int i = 1; good && table->best && i < words.count; i++) {
        good = strcmp(words.words[i], "scheme=") != 0 ||
               gm_refuse(message, "best are those to compare a scheme with: scheme=my.scheme,best");
    }
    good = good && gm_request_parse(&table->request, words.count, words.words, 1, message);
    if (good && !plan(table, &words, arguments, measure, message)) {
        gm_work_close(table);
        good = false;
    }
    gm_arguments_close(&words);
    return good;
}

void gm_work_close(struct gm_work_table *table)
{
    for (size_t i = 0; i < table->line_count; i++) {
        free(table->lines[i].points);
        for (size_t cost = 0; cost < GM_COST_COUNT; cost++) {
            free(table->lines[i].best[cost]);
        }
    }
    gm_lane_close(table->finer);
    free(table->lines);
    free(table->schemes);
    free(table->steps);
    free(table->resolutions);
    gm_request_close(&table->request);
    *table = (struct gm_work_table){0};
}
