/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which time step keeps which scheme bounded, or accurate: lanes over a grid of steps and of one parameter, judged. */
#include "app/grid/stability.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/base/pool.h"
#include "app/words/drive.h"
#include "app/words/words.h"
#include "render/clock.h"

/* A run that takes longer than this is judged where it is. */
static const double most_seconds = 10;

/* The plan's arguments and schemes, as a text; malloc'ed, NULL when memory is short. */
static char *usual_words(const struct gm_scene *scene)
{
    enum { MOST = 6 }; /* of the scene's schemes, where the plan names none */
    const bool planned = scene->stability->schemes != NULL;
    const char *const *schemes = planned ? scene->stability->schemes : scene->schemes;
    char list[512] = "", *text = NULL;
    for (size_t i = 0; schemes[i] && (planned || i < MOST); i++) {
        const size_t used = strlen(list);
        snprintf(list + used, sizeof list - used, "%s%s", i ? "," : "", schemes[i]);
    }
    return asprintf(&text, "%s scheme=%s", scene->stability->arguments, list) < 0 ? NULL : text;
}

/* The scene, what is usual for this purpose unless overridden, and the user's words. */
static bool parse(struct gm_stability_table *table, const struct gm_arguments *typed, char *message)
{
    const struct gm_scene *scene =
        gm_request_scene(typed->count, typed->words, &table->request.refusal, message);
    if (!scene) {
        return false;
    }
    if (!scene->stability) {
        return gm_refuse(message, "scene %s has no stability map: %s", scene->name,
                         scene->no_stability ? scene->no_stability
                                             : "stability --region SCHEME shows the limit of a scheme");
    }
    struct gm_arguments words = {0};
    char *usual = usual_words(scene);
    const bool good =
        (usual && gm_words_complete(&words, scene, typed, usual)) || gm_refuse(message, "not enough memory");
    const bool parsed =
        good && gm_request_parse(&table->request, words.count, words.words, GM_RUN_SCHEMES, message);
    gm_arguments_close(&words);
    free(usual);
    return parsed;
}

/* "accurate=1e-2"; the parsed scene has to have an error. */
static bool read_judge(struct gm_stability_table *table, const char *judge, char *message)
{
    static const char accurate[] = "accurate";
    const size_t length = strlen(accurate);
    table->accuracy = INFINITY;
    if (!judge || strcmp(judge, "bounded") == 0) {
        return true;
    }
    if (strncmp(judge, accurate, length) != 0 || (judge[length] && judge[length] != '=')) {
        return gm_refuse(message, "--judge %.60s is none of: bounded, accurate, accurate=ERROR", judge);
    }
    table->accuracy = 0.1;
    if (judge[length] && (!gm_number_parse(judge + length + 1, &table->accuracy) ||
                          !(table->accuracy > 0 && table->accuracy < INFINITY))) {
        return gm_refuse(message, "--judge %.60s needs an error above 0, such as accurate=1e-2", judge);
    }
    return table->plan->error ||
           gm_refuse(message, "scene %s has no error to be accurate by; take --judge bounded",
                     table->request.scene->name);
}

bool gm_stability_open(struct gm_stability_table *table, const struct gm_arguments *arguments,
                       const char *judge, char *message)
{
    *table = (struct gm_stability_table){0};
    if (arguments->count == 0) {
        return gm_refuse(message, "stability of which scene? Or --region SCHEME");
    }
    if (!parse(table, arguments, message)) {
        return false;
    }
    const struct gm_request *request = &table->request;
    table->plan = request->scene->stability;
    if (!read_judge(table, judge, message)) {
        gm_stability_close(table);
        return false;
    }
    table->parameter = gm_scene_parameter(request->scene, table->plan->parameter);
    table->count = request->count;
    table->maps = calloc(request->count, sizeof *table->maps);
    bool good = table->maps != NULL;
    for (size_t i = 0; good && i < request->count; i++) {
        table->maps[i].scheme = request->lanes[i].scheme;
        table->maps[i].cells =
            calloc(table->plan->step_count * table->plan->value_count, sizeof(struct gm_map_cell));
        good = table->maps[i].cells != NULL;
        for (size_t k = 0; k < i; k++) {
            if (request->lanes[k].scheme == request->lanes[i].scheme) {
                gm_refuse(message, "stability varies dt and %s itself: only scheme takes a list",
                          table->plan->parameter);
                gm_stability_close(table);
                return false;
            }
        }
    }
    if (!good) {
        gm_stability_close(table);
        return gm_refuse(message, "not enough memory");
    }
    return true;
}

void gm_stability_close(struct gm_stability_table *table)
{
    for (size_t i = 0; i < table->count && table->maps; i++) {
        free(table->maps[i].cells);
    }
    free(table->maps);
    gm_request_close(&table->request);
    *table = (struct gm_stability_table){0};
}

static const struct gm_observable *find(const struct gm_scene *scene, const char *key)
{
    const int observable = key ? gm_scene_observable(scene, key) : -1;
    return observable < 0 ? NULL : &scene->observables[observable];
}

static double evaluate(const struct gm_lane *lane, const struct gm_observable *observable)
{
    const struct gm_view view = gm_lane_view(lane);
    return observable ? gm_observe(observable, &view) : 1;
}

static double error_of(const struct gm_lane *lane, const struct gm_observable *error)
{
    return error ? fabs(gm_lane_observe(lane, (size_t)(error - lane->scene->observables))) : NAN;
}

/* Up to `steps` steps in all, or the end of a scheme that chooses them; one by one where the largest value on
   the way is asked for. */
static void run_to(struct gm_lane *lane, int64_t steps,
                   double (*value)(const struct gm_lane *lane, const struct gm_observable *observable),
                   const struct gm_observable *observable, double *largest,
                   const struct gm_listener *listener)
{
    const double until = ((const struct gm_timing *)lane->parameters)->until;
    const double started = gm_clock_processor_seconds();
    double each = 0;
    while (gm_run_goes_on(lane->run, steps, until) && gm_clock_processor_seconds() - started < most_seconds &&
           !gm_lane_stopped(lane) && !gm_listener_stops(listener)) {
        gm_lane_burst(lane, largest ? lane->run->steps + 1 : steps, until, &each);
        if (largest) {
            *largest = fmax(*largest, value(lane, observable));
        }
    }
}

/* The end to the start; of a conserved quantity that may start at 0 as a part of its size. */
static double ratio_of(const struct gm_lane *lane, const struct gm_observable *kept, double before,
                       double after)
{
    const double size =
        kept && kept->error ? gm_lane_divisor(lane, (size_t)(kept - lane->scene->observables)) : 0;
    return size > fabs(before) ? 1 + copysign(after - before, (after - before) * before) / size
                               : after / before;
}

static void judge(struct gm_lane *lane, const struct gm_stability *plan, double accuracy,
                  const struct gm_listener *listener, struct gm_map_cell *cell)
{
    const struct gm_observable *kept = find(lane->scene, plan->kept), *error = find(lane->scene, plan->error);
    const struct gm_timing *timing = lane->parameters;
    const int64_t some = gm_run_steps_at(lane->run, timing->until), all = some > 1 ? some : 1;
    double before = evaluate(lane, kept), after = -INFINITY, worst = -INFINITY;
    if (plan->settle > 0 && all > 2 * plan->settle && !lane->scheme->family->adaptive) {
        run_to(lane, plan->settle, evaluate, kept, &before, listener);
        run_to(lane, all - plan->settle, NULL, NULL, NULL, listener);
        run_to(lane, all, evaluate, kept, &after, listener);
    } else {
        run_to(lane, all, error_of, error, error && plan->throughout ? &worst : NULL, listener);
        after = evaluate(lane, kept);
    }
    cell->status = lane->run->status;
    cell->t = lane->run->t;
    cell->ratio = ratio_of(lane, kept, before, after);
    cell->error = error && plan->throughout ? worst : error_of(lane, error);
    if (cell->status != GM_OK) {
        cell->verdict = GM_FAILED;
    } else if (fabs(cell->ratio) > 2 || (!kept && error && !(cell->error <= 1))) {
        cell->verdict = GM_GAINED;
    } else if (!(cell->ratio >= 0.5)) {
        cell->verdict = GM_LOST;
    } else {
        cell->verdict = accuracy < INFINITY && !(cell->error <= accuracy) ? GM_WRONG : GM_BOUNDED;
    }
}

/* Cells that may wait for an earlier one. */
enum { WINDOW = 64 };

struct measuring {
    struct gm_stability_table *table;
    const struct gm_listener *listener;
    bool failed;
    char *message;
    struct {
        struct gm_map_cell cell;
        bool opened;
        char message[GM_MESSAGE];
    } slots[WINDOW];
};

static size_t cells_of(const struct gm_stability_table *table)
{
    return table->plan->step_count * table->plan->value_count;
}

/* Tries a cell, in parameters of its own: stopped on the way, it stays untried. */
static void try_cell(void *self, size_t index, size_t slot)
{
    struct measuring *measuring = self;
    const struct gm_stability_table *table = measuring->table;
    const struct gm_stability *plan = table->plan;
    const struct gm_lane_spec *spec = &table->request.lanes[index / cells_of(table)];
    const size_t k = index % cells_of(table);
    struct gm_map_cell cell = {.verdict = GM_UNTRIED};
    char *message = measuring->slots[slot].message;
    struct gm_timing *timing = gm_parameters_copy(table->request.scene, spec->parameters);
    struct gm_lane *lane = NULL;
    if (timing) {
        gm_parameter_put(table->parameter, timing, plan->values[k % plan->value_count]);
        timing->dt = cell.dt = plan->steps[k / plan->value_count] * plan->unit(timing);
        lane = gm_lane_open(table->request.scene, timing, &spec->settings, spec->scheme, message);
    } else {
        gm_refuse(message, "not enough memory");
    }
    if (lane) {
        judge(lane, plan, table->accuracy, measuring->listener, &cell);
    }
    if (gm_listener_stops(measuring->listener)) {
        cell.verdict = GM_UNTRIED;
    }
    measuring->slots[slot].opened = lane != NULL;
    measuring->slots[slot].cell = cell;
    gm_lane_close(lane);
    free(timing);
}

static bool take_cell(void *self, size_t index, size_t slot)
{
    struct measuring *measuring = self;
    struct gm_stability_table *table = measuring->table;
    const size_t each = cells_of(table), all = table->count * each;
    if (!measuring->slots[slot].opened) {
        measuring->failed = true;
        return gm_refuse(measuring->message, "%s", measuring->slots[slot].message);
    }
    table->maps[index / each].cells[index % each] = measuring->slots[slot].cell;
    const size_t next = index + 1 < all ? index + 1 : index;
    gm_listener_hears(measuring->listener, table->maps[next / each].scheme->name, next, all);
    return true;
}

static bool stops(void *self)
{
    return gm_listener_stops(((const struct measuring *)self)->listener);
}

bool gm_stability_measure(struct gm_stability_table *table, const struct gm_listener *listener, char *message)
{
    struct measuring *measuring = calloc(1, sizeof *measuring);
    if (!measuring) {
        return gm_refuse(message, "not enough memory");
    }
    *measuring = (struct measuring){.table = table, .listener = listener, .message = message};
    const struct gm_pool pool = {.count = table->count * cells_of(table),
                                 .window = WINDOW,
                                 .work = try_cell,
                                 .take = take_cell,
                                 .stopped = stops,
                                 .self = measuring};
    gm_listener_hears(listener, table->maps[0].scheme->name, 0, pool.count);
    gm_pool_run(&pool);
    const bool good = !measuring->failed;
    free(measuring);
    return good;
}

const char *gm_stability_judge(const struct gm_stability_table *table)
{
    return table->accuracy < INFINITY ? "accurate" : "bounded";
}

const char *gm_stability_question(const struct gm_stability_table *table, char *text, size_t size)
{
    const char *judge = gm_stability_judge(table);
    if (table->accuracy < INFINITY) {
        snprintf(text, size, "%s to %.3g (%s)", judge, table->accuracy, table->plan->error);
    } else {
        snprintf(text, size, "%s", judge);
    }
    return text;
}

const char *gm_cell_word(const struct gm_stability_table *table, const struct gm_map_cell *cell)
{
    static const char *const words[] = {
        [GM_UNTRIED] = "untried", [GM_LOST] = "lost", [GM_GAINED] = "gained", [GM_WRONG] = "wrong"};
    if (cell->verdict == GM_BOUNDED) {
        return gm_stability_judge(table);
    }
    return cell->verdict == GM_FAILED ? gm_status_name(cell->status) : words[cell->verdict];
}

char gm_cell_letter(const struct gm_map_cell *cell)
{
    switch (cell->verdict) {
    case GM_UNTRIED:
        return '?';
    case GM_BOUNDED:
        return '.';
    case GM_LOST:
        return 'L';
    case GM_GAINED:
        return 'G';
    case GM_WRONG:
        return 'W';
    case GM_FAILED:
        break;
    }
    switch (cell->status) {
    case GM_BLOW_UP:
        return 'B';
    case GM_NO_CONVERGENCE:
        return 'N';
    case GM_MESH_CROSSING:
        return 'M';
    default:
        return 'C';
    }
}

const char *gm_stability_letters(const struct gm_stability_table *table, char *text, size_t size)
{
    const size_t each = table->plan->step_count * table->plan->value_count;
    bool told[128] = {['.'] = true};
    size_t used = (size_t)snprintf(text, size, "%s", "");
    for (size_t i = 0; i < table->count * each; i++) {
        const struct gm_map_cell *cell = &table->maps[i / each].cells[i % each];
        const char letter = gm_cell_letter(cell);
        if (!told[(size_t)letter] && used < size) {
            used += (size_t)snprintf(text + used, size - used, "%s%c %s", used ? ", " : "", letter,
                                     gm_cell_word(table, cell));
            told[(size_t)letter] = true;
        }
    }
    return text;
}

double gm_stability_limit(const struct gm_stability_table *table, const struct gm_stability_map *map)
{
    const struct gm_stability *plan = table->plan;
    double limit = 0;
    for (size_t s = 0; s < plan->step_count; s++) {
        bool open = false;
        for (size_t v = 0; v < plan->value_count; v++) {
            const enum gm_cell_verdict verdict = map->cells[s * plan->value_count + v].verdict;
            if (verdict != GM_BOUNDED && verdict != GM_UNTRIED) {
                return limit;
            }
            open = open || verdict == GM_UNTRIED;
        }
        if (open) {
            return NAN;
        }
        limit = plan->steps[s];
    }
    return limit;
}

bool gm_stability_write(const struct gm_stability_table *table, const char *path)
{
    const struct gm_stability *plan = table->plan;
    FILE *csv = fopen(path, "w");
    if (!csv) {
        return false;
    }
    fprintf(csv, "scene,scheme,%s,step,dt,verdict,status,t,ratio,error,judge\n", plan->parameter);
    for (size_t i = 0; i < table->count; i++) {
        for (size_t k = 0; k < plan->step_count * plan->value_count; k++) {
            const struct gm_map_cell *cell = &table->maps[i].cells[k];
            if (cell->verdict == GM_UNTRIED) {
                continue;
            }
            fprintf(csv, "%s,%s,%.17g,%.17g,%.17g,%s,%s,%.17g,", table->request.scene->name,
                    table->maps[i].scheme->name, plan->values[k % plan->value_count],
                    plan->steps[k / plan->value_count], cell->dt, gm_cell_word(table, cell),
                    gm_status_name(cell->status), cell->t);
            if (isfinite(cell->ratio)) {
                fprintf(csv, "%.9g", cell->ratio);
            }
            fputc(',', csv);
            if (isfinite(cell->error)) {
                fprintf(csv, "%.9g", cell->error);
            }
            fprintf(csv, ",%s", gm_stability_judge(table));
            if (table->accuracy < INFINITY) {
                fprintf(csv, "=%.9g", table->accuracy);
            }
            fputc('\n', csv);
        }
    }
    const bool failed = ferror(csv) != 0;
    return fclose(csv) == 0 && !failed;
}
