/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "app/work.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "app/nearest.h"

enum { MOST_WORDS = 64, REPEATS = 5 };

/* A measurement is repeated until it has taken so long, and given up when one run takes longer. */
static const double enough_seconds = 0.1, most_seconds = 4;

static const double usual_errors[3] = {1e-3, 1e-6, 1e-9};

static const char solution_error[] = "solution_error";

static bool refuse(char *message, const char *text)
{
    snprintf(message, GM_MESSAGE, "%s", text);
    return false;
}

static double processor_seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static struct gm_timing *timing_of(const struct gm_work_table *table)
{
    return table->request.lanes[0].parameters;
}

/* Whether the user gave a word with the key of `word`. */
static bool overridden(const struct gm_options *options, const char *word)
{
    const size_t length = strcspn(word, "=") + 1;
    for (int i = 0; i < options->word_count; i++) {
        if (strncmp(options->words[i], word, length) == 0) {
            return true;
        }
    }
    return false;
}

/* The scene, its arguments for this purpose unless overridden, and the user's words. */
static bool parse(struct gm_request *request, const struct gm_options *options, char *message)
{
    char *words[MOST_WORDS], arguments[512] = "", *rest = NULL;
    int count = 0;
    const struct gm_scene *scene = options->word_count > 0 ? gm_scene_find(options->words[0]) : NULL;
    if (options->word_count > 0) {
        words[count++] = options->words[0];
    }
    if (scene && scene->work) {
        snprintf(arguments, sizeof arguments, "%s", scene->work->arguments);
    }
    for (char *word = strtok_r(arguments, " ", &rest); word; word = strtok_r(NULL, " ", &rest)) {
        if (!overridden(options, word)) {
            words[count++] = word;
        }
    }
    for (int i = 1; i < options->word_count && count < MOST_WORDS; i++) {
        words[count++] = options->words[i];
    }
    return gm_request_parse(request, count, words, 1, message);
}

/* Lanes may differ in scheme, dt and resolution alone, and in what was not typed but follows from those. */
static bool alike(const struct gm_request *request, const struct gm_options *options,
                  const struct gm_parameter *resolution)
{
    const struct gm_scene *scene = request->scene;
    for (size_t i = 1; i < request->count; i++) {
        for (size_t k = 0; k < scene->parameter_count; k++) {
            const struct gm_parameter *row = &scene->parameters[k];
            char word[64];
            snprintf(word, sizeof word, "%s=", row->key);
            const bool varies = row->offset == offsetof(struct gm_timing, dt) || row == resolution ||
                                !overridden(options, word);
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

static bool choose_schemes(struct gm_work_table *table, bool named, char *message)
{
    const struct gm_request *request = &table->request;
    table->schemes = calloc(gm_scheme_count() + request->count, sizeof *table->schemes);
    table->lines = calloc(gm_scheme_count() + request->count, sizeof *table->lines);
    if (!table->schemes || !table->lines) {
        return refuse(message, "not enough memory");
    }
    for (size_t i = 0; named && i < request->count; i++) {
        add_scheme(table, request->lanes[i].scheme);
    }
    for (size_t i = 0; !named && i < gm_scheme_count(); i++) {
        const struct gm_work *work = request->scene->work;
        const bool exact =
            work && work->is_exact && strcmp(work->is_exact, gm_scheme_at(i)->name) == 0 && table->observed;
        if (!exact && gm_scene_fits(request->scene, request->lanes[0].parameters, gm_scheme_at(i))) {
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
    const size_t most = given ? request->count : 64;
    table->steps = calloc(most, sizeof *table->steps);
    if (!table->steps) {
        return refuse(message, "not enough memory");
    }
    if (given) {
        for (size_t i = 0; i < request->count; i++) {
            const double dt = ((const struct gm_timing *)request->lanes[i].parameters)->dt;
            bool known = false;
            for (size_t k = 0; k < table->step_count; k++) {
                known |= table->steps[k] == dt;
            }
            if (!known) {
                table->steps[table->step_count++] = dt;
            }
        }
        qsort(table->steps, table->step_count, sizeof *table->steps, falling);
        return true;
    }
    const double coarsest = work ? work->coarsest : 4 * timing->dt;
    const int halvings = work ? work->halvings : 7;
    double steps = fmax(1, ceil(timing->until / coarsest - 1e-9));
    for (int i = 0; i <= halvings; i++, steps *= 2) {
        table->steps[table->step_count++] = timing->until / steps;
    }
    return true;
}

/* The values of the plan, or those of the words if they give more than one; a single one is no ladder. */
static bool choose_resolutions(struct gm_work_table *table, const struct gm_options *options, char *message)
{
    const struct gm_work *work = table->request.scene->work;
    const struct gm_parameter *row = table->resolution;
    char word[64];
    snprintf(word, sizeof word, "%s=", row ? row->key : "");
    const bool given = row && overridden(options, word);
    const size_t most = given ? table->request.count : row ? work->resolution_count : 0;
    table->resolutions = calloc(most + 1, sizeof *table->resolutions);
    if (!table->resolutions) {
        return refuse(message, "not enough memory");
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

static const char *observable_name(size_t i, const void *scene)
{
    return ((const struct gm_scene *)scene)->observables[i].key;
}

/* A measure that says nothing with these parameters, as a distance from an exact solution that there is not.
 */
static bool is_silent(const struct gm_work_table *table, size_t observable)
{
    char sentence[GM_MESSAGE];
    struct gm_lane *lane = gm_request_open_lane(&table->request, 0, sentence);
    const bool silent = lane && !isfinite(gm_lane_observe(lane, observable));
    gm_lane_close(lane);
    return silent;
}

static bool choose_measure(struct gm_work_table *table, const char *asked, char *message)
{
    const struct gm_scene *scene = table->request.scene;
    table->measure = asked                                 ? asked
                     : scene->work && scene->work->measure ? scene->work->measure
                                                           : solution_error;
    table->measure_title = "largest difference from the true solution";
    table->observed =
        strcmp(table->measure, solution_error) != 0 ||
        (scene->work && scene->work->measure && strcmp(scene->work->measure, solution_error) == 0);
    if (!table->observed) {
        return true;
    }
    for (size_t i = 0; i < scene->observable_count; i++) {
        if (strcmp(scene->observables[i].key, table->measure) != 0) {
            continue;
        }
        if (!is_silent(table, i)) {
            table->measure_title = scene->observables[i].title;
            return true;
        }
        if (!asked) {
            table->measure = solution_error;
            table->observed = false;
            return true;
        }
        snprintf(message, GM_MESSAGE, "%s says nothing with these parameters", asked);
        return false;
    }
    const char *near = gm_nearest(table->measure, scene->observable_count, observable_name, scene);
    snprintf(message, GM_MESSAGE, "scene %s has no observable %.60s%s%s", scene->name, table->measure,
             near ? "; did you mean " : "", near ? near : "");
    return false;
}

bool gm_work_open(struct gm_work_table *table, const struct gm_options *options, char *message)
{
    *table = (struct gm_work_table){0};
    if (options->word_count == 0) {
        return refuse(message, "work-precision of which scene? See geomint list scenes");
    }
    if (!parse(&table->request, options, message)) {
        return false;
    }
    const struct gm_work *work = table->request.scene->work;
    table->resolution =
        work && work->resolution ? gm_scene_parameter(table->request.scene, work->resolution) : NULL;
    table->errors = work && work->errors ? work->errors : usual_errors;
    if (!alike(&table->request, options, table->resolution)) {
        snprintf(message, GM_MESSAGE,
                 "work-precision compares on one problem: only scheme%s%s and dt take a list",
                 table->resolution ? ", " : "", table->resolution ? table->resolution->key : "");
        gm_work_close(table);
        return false;
    }
    if (!(timing_of(table)->until > 0)) {
        gm_work_close(table);
        return refuse(message, "until is 0: there is nothing to measure");
    }
    if (!choose_steps(table, overridden(options, "dt="), message) ||
        !choose_resolutions(table, options, message) || !choose_measure(table, options->measure, message) ||
        !choose_schemes(table, overridden(options, "scheme="), message)) {
        gm_work_close(table);
        return false;
    }
    return true;
}

void gm_work_close(struct gm_work_table *table)
{
    for (size_t i = 0; i < table->line_count; i++) {
        free(table->lines[i].points);
        for (size_t cost = 0; cost < GM_COST_COUNT; cost++) {
            free(table->lines[i].best[cost]);
        }
    }
    free(table->lines);
    free(table->schemes);
    free(table->steps);
    free(table->resolutions);
    gm_request_close(&table->request);
    *table = (struct gm_work_table){0};
}

/* A lane of this scheme and step at its start. */
static struct gm_lane *open_lane(const struct gm_work_table *table, const struct gm_scheme *scheme, double dt,
                                 char *message)
{
    struct gm_timing *timing = timing_of(table);
    const double usual = timing->dt;
    timing->dt = dt; /* the lane takes a copy */
    struct gm_lane *lane =
        gm_lane_open(table->request.scene, timing, &table->request.lanes[0].settings, scheme, message);
    timing->dt = usual;
    return lane;
}

static bool stopped(const struct gm_work_table *table)
{
    return gm_listener_stops(table->listener);
}

static bool ended(const struct gm_lane *lane, long steps)
{
    const struct gm_run *run = lane->run;
    const double until = ((const struct gm_timing *)lane->parameters)->until;
    return run->status != GM_OK ||
           (lane->scheme->family->own_time ? run->t >= until * (1 - 1e-12) : run->steps >= steps);
}

/* To the end, in bursts that answer an interruption; gives up after `most` seconds. Returns the processor
 * time. */
static double run_through(const struct gm_work_table *table, struct gm_lane *lane, long steps, bool follow,
                          double most)
{
    const double size = (double)(lane->problem.n * lane->problem.m);
    const long burst = lane->scheme->family->own_time ? 1 : (long)fmax(1, fmin(1e5, 1e6 / size));
    double spent = 0;
    while (!ended(lane, steps) && spent < most && !stopped(table)) {
        const long left = steps - lane->run->steps;
        const double started = processor_seconds();
        if (follow) {
            gm_lane_advance(lane, left < burst ? left : burst);
        } else {
            gm_run_advance(lane->run, left < burst ? left : burst);
        }
        spent += processor_seconds() - started;
    }
    return spent;
}

/* The state that solutions are measured against: the exact one, or that of a trusted run, for all steps of
   the ladder. NULL if there is none. */
static double *reference_state(struct gm_work_table *table, char *message)
{
    const struct gm_work *work = table->request.scene->work;
    const struct gm_scheme *trusted = work && work->reference ? gm_scheme_find(work->reference) : NULL;
    struct gm_lane *lane = open_lane(table, table->request.lanes[0].scheme, timing_of(table)->dt, message);
    if (!lane) {
        return NULL;
    }
    const size_t count = lane->problem.n * lane->problem.m;
    double *state = malloc(count * sizeof *state);
    const bool named = trusted != NULL;
    for (size_t i = 0; !named && i < gm_scheme_count(); i++) {
        const struct gm_scheme *scheme = gm_scheme_at(i);
        if (gm_scheme_fits(scheme, &lane->problem) && !scheme->family->own_time && scheme->order >= 4) {
            trusted = trusted && trusted->order >= scheme->order ? trusted : scheme;
        }
    }
    if (state && lane->problem.exact) {
        snprintf(table->reference, sizeof table->reference, "the exact solution");
        lane->problem.exact->solution(&lane->problem, timing_of(table)->until, lane->start, state,
                                      lane->problem.m);
    } else if (state && trusted) {
        /* a quarter of the shortest step that halving the ladder a few times less gives: beyond, rounding
         * rules */
        const size_t middle = table->step_count > 3 ? table->step_count - 3 : table->step_count - 1;
        const double dt = table->steps[middle] / 4;
        snprintf(table->reference, sizeof table->reference, "a run of %s with a step of %.3g", trusted->name,
                 dt);
        gm_lane_close(lane);
        lane = open_lane(table, trusted, dt, message);
        const long steps = (long)round(timing_of(table)->until / dt);
        if (lane) {
            /* the carried rounding errors are worth their price here */
            run_through(table, lane, steps, false, INFINITY);
        }
        if (!lane || lane->run->status != GM_OK || stopped(table)) {
            if (lane) {
                snprintf(message, GM_MESSAGE, "the reference, %s, failed: %s", table->reference,
                         gm_status_name(lane->run->status));
            }
            free(state);
            state = NULL;
        } else {
            memcpy(state, gm_run_state(lane->run), count * sizeof *state);
        }
    } else {
        free(state);
        state = NULL;
        refuse(message,
               "there is neither an exact solution nor a scheme to make a reference with; try --measure");
    }
    gm_lane_close(lane);
    return state;
}

static double error_of(const struct gm_work_table *table, const struct gm_lane *lane, const double *reference)
{
    const struct gm_scene *scene = lane->scene;
    if (reference) {
        const double *state = gm_run_state(lane->run);
        double error = 0;
        for (size_t i = 0; i < lane->problem.n * lane->problem.m; i++) {
            const double difference = fabs(state[i] - reference[i]);
            error = difference <= error ? error : difference; /* keeps a NaN */
        }
        return error;
    }
    for (size_t i = 0; i < scene->observable_count; i++) {
        if (strcmp(scene->observables[i].key, table->measure) == 0) {
            return fabs(gm_lane_observe(lane, i));
        }
    }
    return NAN;
}

/* One scheme with one step. False with a sentence only if no lane could be opened. */
static bool measure_point(const struct gm_work_table *table, const struct gm_scheme *scheme, double dt,
                          const double *reference, struct gm_work_point *point, char *message)
{
    const bool own_time = scheme->family->own_time;
    const long steps = own_time ? INT64_MAX : (long)round(timing_of(table)->until / dt);
    const bool follow = table->request.scene->follow > 0 && !reference;
    *point = (struct gm_work_point){.dt = dt, .error = NAN, .seconds = INFINITY};
    double spent = 0;
    for (int repeat = 0; repeat < REPEATS && spent < enough_seconds && !stopped(table); repeat++) {
        struct gm_lane *lane = open_lane(table, scheme, dt, message);
        if (!lane) {
            return false;
        }
        const double seconds = run_through(table, lane, steps, false, most_seconds);
        const struct gm_run *run = lane->run;
        const bool whole = run->status != GM_OK || ended(lane, steps);
        point->seconds = whole ? fmin(point->seconds, seconds) : point->seconds;
        spent += whole ? seconds : enough_seconds;
        if (repeat == 0) {
            point->status = run->status;
            point->t = run->t;
            point->steps = run->steps;
            point->evaluations = gm_run_per_member(run, run->evaluations);
            point->solves = gm_run_per_member(run, run->solves);
            if (run->status == GM_OK && whole && !stopped(table) && (!reference || !own_time)) {
                point->error = error_of(table, lane, reference);
            }
        }
        gm_lane_close(lane);
    }
    /* an observable that recalls the past: once more, looking on the way */
    if (follow && point->status == GM_OK && isfinite(point->error) && !stopped(table)) {
        struct gm_lane *lane = open_lane(table, scheme, dt, message);
        if (!lane) {
            return false;
        }
        run_through(table, lane, steps, true, INFINITY);
        point->error = error_of(table, lane, reference);
        gm_lane_close(lane);
    }
    return true;
}

/* Shorter steps than this are of no use: round-off rules, or it takes too long; or, where the resolution
   varies, the resolution rules. `count` points of this resolution were measured, the last ones of the line.
 */
static bool is_enough(const struct gm_work_table *table, const struct gm_work_line *line, size_t count)
{
    if (count < 2) {
        return false;
    }
    const struct gm_work_point *last = &line->points[line->count - 1], *before = last - 1;
    const bool resolved = table->resolution && fabs(last->error - before->error) < 0.03 * before->error;
    const bool round_off = last->error < 1e-9 && last->error > 0.7 * before->error;
    const bool long_enough = last->status == GM_OK && last->seconds > most_seconds / 3;
    return resolved || round_off || long_enough || !isfinite(last->seconds);
}

static bool measure_line(struct gm_work_table *table, struct gm_work_line *line, const double *reference,
                         char *message)
{
    const size_t all = table->scheme_count * table->step_count * table->resolution_count;
    const size_t each = table->step_count * table->resolution_count;
    void *own = timing_of(table);
    for (size_t r = 0; r < table->resolution_count; r++) {
        const size_t first = line->count;
        if (table->resolution) {
            gm_parameter_put(table->resolution, own, table->resolutions[r]);
        }
        for (size_t k = 0; k < table->step_count && !is_enough(table, line, line->count - first); k++) {
            struct gm_work_point point;
            gm_listener_hears(table->listener, line->scheme->name,
                              table->line_count * each - each + r * table->step_count + k, all);
            if (!measure_point(table, line->scheme, table->steps[k], reference, &point, message)) {
                return false;
            }
            if (stopped(table)) {
                return true;
            }
            point.resolution = table->resolution ? table->resolutions[r] : 0;
            line->points[line->count++] = point;
        }
    }
    return true;
}

/* The best points by each cost, where resolution and step vary. Errors of both may cancel by chance: a point
   is credited with the largest error of its resolution at its step and all shorter ones. */
static bool choose_best(const struct gm_work_table *table, struct gm_work_line *line, char *message)
{
    if (!table->resolution) {
        return true;
    }
    struct gm_work_point *earned = calloc(line->count + 1, sizeof *earned);
    bool good = earned != NULL;
    for (size_t k = line->count; good && k-- > 0;) {
        earned[k] = line->points[k];
        if (k + 1 < line->count && earned[k + 1].resolution == earned[k].resolution &&
            earned[k + 1].error > earned[k].error) {
            earned[k].error = earned[k + 1].error;
        }
    }
    for (int cost = 0; good && cost < GM_COST_COUNT; cost++) {
        line->best[cost] = calloc(line->count + 1, sizeof *line->best[cost]);
        good = line->best[cost] != NULL;
        if (good) {
            line->best_count[cost] =
                gm_work_keep_best(earned, line->count, (enum gm_work_cost)cost, line->best[cost]);
        }
    }
    free(earned);
    return good || refuse(message, "not enough memory");
}

bool gm_work_measure(struct gm_work_table *table, const struct gm_listener *listener, char *message)
{
    double *reference = NULL;
    table->listener = listener;
    gm_listener_hears(listener, "reference", 0,
                      table->scheme_count * table->step_count * table->resolution_count);
    if (!table->observed) {
        reference = reference_state(table, message);
        if (!reference) {
            return false;
        }
    }
    bool good = true;
    for (size_t i = 0; i < table->scheme_count && good && !stopped(table); i++) {
        struct gm_work_line *line = &table->lines[table->line_count];
        *line = (struct gm_work_line){.scheme = table->schemes[i]};
        line->points = calloc(table->step_count * table->resolution_count, sizeof *line->points);
        if (!line->points) {
            good = refuse(message, "not enough memory");
            break;
        }
        table->line_count++;
        good = measure_line(table, line, reference, message) && choose_best(table, line, message);
    }
    free(reference);
    return good;
}
