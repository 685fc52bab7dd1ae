/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A published figure, reproduced and compared with the statements of its document. */
#include "app/figures/figure.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/base/arguments.h"
#include "app/base/interrupt.h"
#include "app/output/printer.h"
#include "app/words/drive.h"
#include "app/words/words.h"
#include "core/memory.h"
#include "render/clock.h"
#include "render/pixels/canvas.h"

enum { FEW_SCHEMES = 3 };

/* Replaces arguments by those of `quick` with the same keys; when out of memory they do not change. */
static void shorten(char *arguments, size_t size, const char *quick)
{
    struct gm_arguments self = {0}, instead = {0};
    if (gm_arguments_split(&self, arguments) && gm_arguments_split(&instead, quick)) {
        arguments[0] = '\0';
        for (int i = 0; i < self.count; i++) {
            if (!gm_arguments_have(&instead, self.words[i])) {
                gm_append(arguments, size, "%s ", self.words[i]);
            }
        }
        gm_append(arguments, size, "%s", quick);
    }
    gm_arguments_close(&self);
    gm_arguments_close(&instead);
}

static bool parse(struct gm_request *request, const struct gm_figure_job *job, char *message)
{
    char sentence[GM_MESSAGE] = "not enough memory";
    struct gm_arguments words = {0};
    gm_arguments_add(&words, gm_figure_word(job));
    const bool parsed = gm_arguments_split(&words, job->arguments) &&
                        gm_request_parse(request, words.count, words.words, FEW_SCHEMES, sentence);
    gm_arguments_close(&words);
    return parsed || gm_refuse(message, "%s: %.400s", job->figure->name, sentence);
}

const struct gm_figure *gm_figure_at(size_t index, const struct gm_scene **scene)
{
    for (size_t i = 0; i < gm_scene_count(); i++) {
        *scene = gm_scene_at(i);
        if (index < (*scene)->figure_count) {
            return &(*scene)->figures[index];
        }
        index -= (*scene)->figure_count;
    }
    return NULL;
}

void gm_figure_plan(struct gm_figure_job *job, const struct gm_scene *scene, const struct gm_figure *figure,
                    bool quick)
{
    *job = (struct gm_figure_job){
        .scene = scene, .figure = figure, .published = gm_published_find(figure->name)};
    snprintf(job->arguments, sizeof job->arguments, "%s", figure->arguments);
    if (quick && job->published && job->published->quick) {
        shorten(job->arguments, sizeof job->arguments, job->published->quick);
        job->shortened = true;
    }
}

/* Returns true if a lane has this value of a key; *known is false if there is no such key. */
static bool has_value(const struct gm_request *request, const struct gm_lane_spec *spec, const char *key,
                      const char *value, bool *known)
{
    if (strcmp(key, "scheme") == 0) {
        return strcmp(spec->scheme->name, value) == 0;
    }
    const struct gm_parameter *row = gm_scene_parameter(request->scene, key);
    void *other = row ? gm_parameters_copy(request->scene, spec->parameters) : NULL;
    bool same = false;
    if (other) {
        *known &= gm_parameter_set(row, other, value) == GM_PARSED;
        same = gm_parameter_get(row, other) == gm_parameter_get(row, spec->parameters);
    } else {
        *known = false;
    }
    free(other);
    return same;
}

/* Returns true if it has one of the values of a word "scheme=rk4" or "dt=0.1,0.2". */
static bool has(const struct gm_request *request, const struct gm_lane_spec *spec, const char *word,
                bool *known)
{
    char key[64], value[GM_TEXT_SIZE];
    size_t length = strcspn(word, "=");
    bool any = false;
    snprintf(key, sizeof key, "%.*s", (int)length, word);
    for (const char *at = word + length; *at; at += length) {
        at += strspn(at, "=,");
        length = strcspn(at, ",");
        snprintf(value, sizeof value, "%.*s", (int)length, at);
        any |= length > 0 && has_value(request, spec, key, value, known);
    }
    return any;
}

size_t gm_figure_lanes(const struct gm_request *request, const char *lanes, size_t *chosen, bool *known)
{
    struct gm_arguments words = {0};
    size_t count = 0;
    *known &= gm_arguments_split(&words, lanes);
    for (size_t i = 0; i < request->count && i < GM_FIGURE_LANES; i++) {
        bool all = true;
        for (int k = 0; k < words.count; k++) {
            all &= has(request, &request->lanes[i], words.words[k], known);
        }
        if (all) {
            chosen[count++] = i;
        }
    }
    gm_arguments_close(&words);
    return count;
}

/* The largest value of an observable after the time `from`, up to `to`. */
static double largest(const struct gm_lane *lane, int observable, double from, double to)
{
    const struct gm_history *history = &lane->history;
    double most = -INFINITY;
    for (size_t i = 0; i < history->count; i++) {
        const struct gm_bin *bin = &history->bins[i * history->series + (size_t)observable];
        if (bin->t > from && bin->t <= to) {
            most = fmax(most, bin->high);
        }
    }
    return most;
}

/* The middle of the bin that holds the largest or smallest value, or the first one above a level. */
static double when(const struct gm_lane *lane, int observable, const struct gm_statement *statement)
{
    const struct gm_history *history = &lane->history;
    const double level = statement->level * (statement->scale ? statement->scale->size : 1);
    double best = NAN, at = INFINITY, before = lane->t0;
    for (size_t i = 0; i < history->count; i++) {
        const struct gm_bin *bin = &history->bins[i * history->series + (size_t)observable];
        const bool better = statement->measure == GM_EXCEEDS ? isnan(best) && bin->high > level
                            : statement->measure == GM_PEAKS ? !(bin->high <= best)
                                                             : !(bin->low >= best);
        if (better && bin->t >= statement->from && (statement->to == 0 || bin->t <= statement->to)) {
            best = statement->measure == GM_DIPS ? bin->low : bin->high;
            at = (before + bin->t) / 2;
        }
        before = bin->t;
    }
    return at;
}

static double at_start(const struct gm_lane *lane, size_t observable)
{
    struct gm_view view = gm_lane_view(lane);
    view.state = view.start;
    view.t = view.t0;
    return gm_observe(&lane->scene->observables[observable], &view);
}

static double measure_of(const struct gm_lane *lane, const struct gm_statement *statement, int observable)
{
    const double middle = (lane->t0 + lane->run->t) / 2;
    switch (statement->measure) {
    case GM_MAXIMUM:
        return largest(lane, observable, -INFINITY, INFINITY);
    case GM_GROWTH:
        return largest(lane, observable, middle, INFINITY) / largest(lane, observable, -INFINITY, middle);
    case GM_LASTS:
        return lane->run->t;
    case GM_FACTOR:
        return gm_lane_observe(lane, (size_t)observable) / at_start(lane, (size_t)observable);
    case GM_PEAKS:
    case GM_DIPS:
    case GM_EXCEEDS:
        return when(lane, observable, statement);
    case GM_AT_END:
        return gm_lane_observe(lane, (size_t)observable);
    }
    return NAN;
}

static double measure(const struct gm_lane *lane, const struct gm_statement *statement)
{
    return measure_of(
        lane, statement,
        statement->measure == GM_LASTS ? 0 : gm_scene_observable(lane->scene, statement->observable));
}

static double scale_of(const struct gm_lane *lane, const struct gm_statement *statement)
{
    const struct gm_figure_scale *scale = statement->scale;
    if (!scale || statement->measure == GM_EXCEEDS) {
        return 1;
    }
    return scale->observable
               ? measure_of(lane, statement, gm_scene_observable(lane->scene, scale->observable))
               : scale->size;
}

static double abscissa(const struct gm_lane *lane, const char *key)
{
    const int observable = gm_scene_observable(lane->scene, key);
    return observable >= 0 ? gm_lane_observe(lane, (size_t)observable)
                           : gm_parameter_get(gm_scene_parameter(lane->scene, key), lane->parameters);
}

/* The order from the first lane to the last, positive if the measure falls; failed lanes have no usable
   error. */
static double order(struct gm_lane *const *lanes, const size_t *chosen, size_t count,
                    const struct gm_statement *statement)
{
    const struct gm_lane *first = NULL, *last = NULL;
    for (size_t i = 0; i < count; i++) {
        const struct gm_lane *lane = lanes[chosen[i]];
        if (lane->run->status == GM_OK) {
            first = first ? first : lane;
            last = lane;
        }
    }
    if (first == last) {
        return NAN;
    }
    return log(measure(first, statement) / measure(last, statement)) /
           fabs(log(abscissa(first, statement->over) / abscissa(last, statement->over)));
}

/* A statement's measure of lane `index` of the chosen ones, or the order of all of them. */
static double number_of(struct gm_lane *const *lanes, const size_t *chosen, size_t index, size_t count,
                        const struct gm_statement *statement, bool *failed)
{
    if (statement->over) {
        return order(lanes, chosen, count, statement);
    }
    *failed |= lanes[chosen[index]]->run->status != GM_OK;
    return measure(lanes[chosen[index]], statement);
}

/* A failed run may have a number that is large enough, but never one that is small enough: its further
   course is unknown. */
static bool holds(const struct gm_statement *statement, double number, bool failed)
{
    return number >= statement->low && number <= statement->high &&
           !(failed && statement->measure != GM_LASTS && statement->high < INFINITY);
}

/* A lane's value of a parameter, its scene's or its scheme's. */
static const char *value_of(const struct gm_request *request, size_t lane, const char *key, char *text,
                            size_t size)
{
    const struct gm_parameter *row = gm_word_parameter(request->scene, key);
    return gm_parameter_format(row, gm_lane_owner(&request->lanes[lane], row), text, size);
}

/* "dt=0.1 until=20": a lane's values of the keys that its document does not give. */
static void open_values(const struct gm_request *request, size_t lane, const char *keys, char *text,
                        size_t size)
{
    struct gm_arguments words = {0};
    char value[GM_TEXT_SIZE];
    text[0] = '\0';
    gm_arguments_split(&words, keys);
    for (int i = 0; i < words.count; i++) {
        gm_append(text, size, "%s%s=%s", text[0] ? " " : "", words.words[i],
                  value_of(request, lane, words.words[i], value, sizeof value));
    }
    gm_arguments_close(&words);
}

/* "with strength=1": the values for which all lanes hold, texts[true], and those for which a lane does
   not, texts[false]; "" without such values. */
static void put_values(const struct gm_request *request, const char *keys, const size_t *chosen,
                       const bool *held, size_t count, char texts[2][GM_FIGURE_LABEL])
{
    char own[GM_FIGURE_LABEL], other[GM_FIGURE_LABEL];
    texts[false][0] = texts[true][0] = '\0';
    for (size_t i = 0; i < count; i++) {
        bool first = true, all = true;
        open_values(request, chosen[i], keys, own, sizeof own);
        for (size_t k = 0; k < count; k++) {
            open_values(request, chosen[k], keys, other, sizeof other);
            const bool same = strcmp(own, other) == 0;
            first &= !same || k >= i;
            all &= !same || held[k];
        }
        if (first) {
            gm_append(texts[all], GM_FIGURE_LABEL, "%s%s", texts[all][0] ? ", " : "with ", own);
        }
    }
}

static void judge(const struct gm_request *request, struct gm_lane *const *lanes,
                  const struct gm_statement *statement, struct gm_outcome *outcome)
{
    size_t chosen[GM_FIGURE_LANES], others[GM_FIGURE_LANES];
    bool known = true, held[GM_FIGURE_LANES], all = true;
    const size_t count = gm_figure_lanes(request, statement->lanes, chosen, &known);
    const size_t other_count =
        statement->against ? gm_figure_lanes(request, statement->against, others, &known) : 0;
    const size_t at = outcome->verdict_count++;
    double low = INFINITY, high = -INFINITY, scale = INFINITY;
    for (size_t i = 0; i < (statement->over ? 1 : count); i++) {
        bool failed = false;
        const double size = scale_of(lanes[chosen[i]], statement);
        double number = number_of(lanes, chosen, i, count, statement, &failed);
        if (other_count > 0) {
            number /= number_of(lanes, others, other_count == count ? i : 0, other_count, statement, &failed);
        }
        held[i] = holds(statement, number / size, failed);
        all &= held[i];
        low = isnan(number) ? number : fmin(low, number);
        high = isnan(number) ? number : fmax(high, number);
        scale = fmin(scale, size);
    }
    outcome->verdicts[at].low = low;
    outcome->verdicts[at].high = high;
    outcome->verdicts[at].scale = scale;
    outcome->verdicts[at].holds = all;
    if (statement->open) {
        char with[2][GM_FIGURE_LABEL];
        put_values(request, statement->open, chosen, held, statement->over ? 1 : count, with);
        outcome->verdicts[at].open = with[true][0] && with[false][0];
        snprintf(outcome->verdicts[at].note, GM_FIGURE_NOTE, "%s%s%s, not given by the document", with[true],
                 outcome->verdicts[at].open ? ", not " : "", with[false]);
    }
}

/* "rk4 dt=0.1": the scheme, and the keys of which the figure lists several values. */
static void label(const struct gm_figure_job *job, const struct gm_request *request, size_t lane, char *text,
                  size_t size)
{
    struct gm_arguments words = {0};
    char value[GM_TEXT_SIZE];
    snprintf(text, size, "%s", request->lanes[lane].scheme->name);
    gm_arguments_split(&words, job->arguments);
    for (int i = 0; i < words.count; i++) {
        char key[64];
        snprintf(key, sizeof key, "%.*s", (int)strcspn(words.words[i], "="), words.words[i]);
        if (strchr(words.words[i], ',') && gm_word_parameter(request->scene, key)) {
            gm_append(text, size, " %s=%s", key, value_of(request, lane, key, value, sizeof value));
        }
    }
    gm_arguments_close(&words);
}

static void take_numbers(const struct gm_figure_job *job, const struct gm_request *request,
                         struct gm_lane *const *lanes, struct gm_outcome *outcome)
{
    outcome->lane_count = request->count;
    for (size_t i = 0; i < request->count; i++) {
        label(job, request, i, outcome->lanes[i].label, sizeof outcome->lanes[i].label);
        gm_failure_sentence(lanes[i], outcome->lanes[i].failure, sizeof outcome->lanes[i].failure);
        outcome->lanes[i].t = lanes[i]->run->t;
        for (size_t k = 0; k < gm_figure_observables(job); k++) {
            outcome->lanes[i].observables[k] = gm_lane_observe(lanes[i], k);
        }
    }
    for (size_t i = 0; job->published && i < job->published->count && i < GM_FIGURE_STATEMENTS; i++) {
        judge(request, lanes, &job->published->statements[i], outcome);
    }
}

bool gm_outcome_has(const struct gm_outcome *outcome, size_t index)
{
    bool has = false;
    for (size_t i = 0; i < outcome->lane_count; i++) {
        has |= !isnan(outcome->lanes[i].observables[index]);
    }
    return has;
}

const char *gm_figure_path(const struct gm_figure_output *output, const char *name, enum gm_theme theme,
                           enum gm_format format, char path[GM_FIGURE_PATH])
{
    snprintf(path, GM_FIGURE_PATH, "%s/%s%s.%s", output->folder, name, theme == GM_THEME_DARK ? "-dark" : "",
             gm_format_name(format));
    return path;
}

/* Prints the pictures in both themes. The page shows PNG files. */
static int paint(const struct gm_figure_job *job, const struct gm_request *request,
                 struct gm_lane *const *lanes, const struct gm_figure_output *output, char *message)
{
    const enum gm_theme themes[] = {GM_THEME_LIGHT, GM_THEME_DARK};
    const enum gm_format formats[] = {GM_FORMAT_PNG, output->format};
    char path[GM_FIGURE_PATH];
    for (size_t i = 0; i < (output->format == GM_FORMAT_PNG ? 2 : 4); i++) {
        struct gm_print print = {.format = formats[i / 2], .look = output->look};
        print.look.theme = themes[i % 2];
        print.path = gm_figure_path(output, job->figure->name, print.look.theme, print.format, path);
        if (!gm_still_write(&print, request, (const struct gm_lane *const *)lanes, message)) {
            return GM_EXIT_FILE;
        }
    }
    return GM_EXIT_OK;
}

static int make(const struct gm_figure_job *job, const struct gm_figure_output *output,
                const struct gm_request *request, struct gm_lane **lanes, struct gm_outcome *outcome)
{
    if (request->count > GM_FIGURE_LANES) {
        snprintf(outcome->message, sizeof outcome->message, "it has more than %d lanes", GM_FIGURE_LANES);
        return GM_EXIT_USAGE;
    }
    gm_printer_expect(GM_FORMAT_PNG);
    for (size_t i = 0; i < request->count; i++) {
        lanes[i] = gm_request_open_lane(request, i, outcome->message);
        struct gm_drive drive = {.lane = lanes[i], .request = request, .index = i};
        if (!lanes[i] || !gm_drive_to(&drive, request->lanes[i].steps, true, outcome->message)) {
            return GM_EXIT_USAGE;
        }
        if (gm_interrupted) {
            snprintf(outcome->message, sizeof outcome->message, "interrupted");
            return GM_EXIT_INTERRUPTED;
        }
    }
    const int status = paint(job, request, lanes, output, outcome->message);
    if (status == GM_EXIT_OK) {
        take_numbers(job, request, lanes, outcome);
    }
    return status;
}

void gm_figure_make(const struct gm_figure_job *job, const struct gm_figure_output *output,
                    struct gm_outcome *outcome)
{
    const double begin = gm_clock_seconds();
    struct gm_request request;
    struct gm_lane *lanes[GM_FIGURE_LANES] = {NULL};
    outcome->status = GM_EXIT_USAGE;
    if (parse(&request, job, outcome->message)) {
        outcome->status = make(job, output, &request, lanes, outcome);
        for (size_t i = 0; i < request.count && i < GM_FIGURE_LANES; i++) {
            gm_lane_close(lanes[i]);
        }
        gm_request_close(&request);
    }
    gm_canvas_settle();
    /* another process prints the message; a lack of memory may also have caused other failures: a lane
       that could not be opened, arguments that were not read */
    if (gm_memory_was_short() && outcome->status != GM_EXIT_INTERRUPTED) {
        snprintf(outcome->message, sizeof outcome->message, "not enough memory");
        outcome->status = GM_EXIT_MEMORY;
    }
    outcome->seconds = gm_clock_seconds() - begin;
    outcome->progress = outcome->status == GM_EXIT_OK ? GM_MADE : GM_NOT_MADE;
}

enum gm_source gm_statement_source(const struct gm_figure_job *job, size_t index)
{
    if (strncmp(job->published->statements[index].says, GM_OURS, strlen(GM_OURS)) == 0) {
        return GM_OF_OURS;
    }
    return job->published->variant ? GM_OF_VARIANT : GM_OF_DOCUMENT;
}

struct gm_figure_sum gm_figures_sum(const struct gm_figure_job *jobs, const struct gm_outcome *outcomes,
                                    size_t count)
{
    struct gm_figure_sum sum = {0};
    for (size_t i = 0; i < count; i++) {
        sum.made += outcomes[i].progress == GM_MADE;
        for (size_t k = 0; k < outcomes[i].verdict_count && !jobs[i].shortened; k++) {
            struct gm_tally *tally = &sum.of[gm_statement_source(&jobs[i], k)];
            tally->hold += outcomes[i].verdicts[k].holds;
            tally->open += outcomes[i].verdicts[k].open;
            tally->fail += !outcomes[i].verdicts[k].holds && !outcomes[i].verdicts[k].open;
        }
    }
    return sum;
}

const char *gm_verdict_word(const struct gm_figure_job *job, const struct gm_outcome *outcome, size_t index)
{
    if (job->shortened) {
        return "not judged";
    }
    if (outcome->verdicts[index].open) {
        return "open";
    }
    return outcome->verdicts[index].holds ? "holds" : "does not hold";
}

void gm_statement_expectation(const struct gm_statement *statement, double scale, char *text, size_t size)
{
    const double low = statement->low, high = statement->high, bound = low == -INFINITY ? high : low;
    char part[64];
    if (low < high && low > -INFINITY && high < INFINITY) {
        snprintf(text, size, "%.5g to %.5g", low * scale, high * scale);
        snprintf(part, sizeof part, "%.3g to %.3g", 100 * low, 100 * high);
    } else {
        const char *which = low == -INFINITY ? "at most " : "at least ";
        snprintf(text, size, "%s%.*g", low == high ? "" : which, low == high ? 6 : 3, bound * scale);
        snprintf(part, sizeof part, "%.3g", 100 * bound);
    }
    if (statement->scale && statement->measure != GM_EXCEEDS) {
        gm_append(text, size, ", %s %% of %s", part, statement->scale->name);
    }
}

void gm_verdict_number(double low, double high, char *text, size_t size)
{
    char first[32], last[32];
    snprintf(first, sizeof first, "%.4g", low);
    snprintf(last, sizeof last, "%.4g", high);
    const bool one = strcmp(first, last) == 0;
    if (!(low <= high)) {
        snprintf(text, size, "not a number");
    } else {
        snprintf(text, size, "%s%s%s", first, one ? "" : " to ", one ? "" : last);
    }
}
