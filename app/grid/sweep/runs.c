/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The runs of a sweep: from a number to a run, and from a run to a row. */
#include "app/base/arguments.h"
#include "app/base/interrupt.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/grid/sweep.h"
#include "app/output/row.h"
#include "app/words/drive.h"
#include "core/arena.h"
#include "core/basics.h"
#include "core/expression/nearest.h"
#include "core/expression/number.h"
#include "core/memory.h"
#include "core/quantity.h"
#include "core/schemes.h"

const char gm_sweep_statuses[] =
    "ok, blow-up, no-convergence, mesh-crossing, step-collapse, step-too-small, events-accumulate, sliding, out-of-memory, refused, warning";

/* Returns true if a word determines the list of runs and is not a key of a run. */
static bool is_of_the_list(const struct gm_word *word)
{
    return strcmp(word->key, "zip") == 0;
}

static bool is_column(const struct gm_word *word)
{
    return !is_of_the_list(word) && strcmp(word->key, "scheme") != 0;
}

/* ---- the words of a run ---- */

/* Returns true if a word is a parameter of schemes that this one does not have. */
static bool is_idle(const struct gm_sweep *sweep, const struct gm_word *word, const struct gm_scheme *scheme)
{
    const struct gm_parameter *setting = gm_setting_find(word->key);
    return setting && scheme && !gm_scene_parameter(sweep->scene, word->key) &&
           !gm_scheme_takes(scheme, setting);
}

/* The words of run number `run`, with `instead` for the key `key` unless it is NULL. A parameter that its
   scheme does not have is left out if another scheme of the sweep has it. The caller closes the words. */
static bool words_of(const struct gm_sweep *sweep, size_t run, const char *key, const char *instead,
                     struct gm_arguments *arguments)
{
    char text[GM_TEXT_SIZE];
    const struct gm_word *schemes = gm_words_find(&sweep->words, "scheme");
    const size_t choice = gm_words_choice(&sweep->words, (size_t)(schemes - sweep->words.list), run);
    const struct gm_scheme *scheme =
        gm_scheme_find(key && strcmp(key, "scheme") == 0 ? instead : gm_word_value(schemes, choice, text));
    *arguments = (struct gm_arguments){0};
    gm_arguments_add(arguments, sweep->scene->words ? sweep->scene->words[0] : sweep->scene->name);
    for (size_t i = 1; sweep->scene->words && sweep->scene->words[i]; i++) {
        gm_arguments_add(arguments, sweep->scene->words[i]);
    }
    for (size_t i = 0; i < sweep->words.count; i++) {
        const struct gm_word *word = &sweep->words.list[i];
        bool idle = is_idle(sweep, word, scheme);
        for (size_t k = 0; idle && k < schemes->count; k++) {
            idle = is_idle(sweep, word, gm_scheme_find(schemes->pieces[k].text));
        }
        if (!is_of_the_list(word) && (idle || !is_idle(sweep, word, scheme))) {
            const bool other = key && strcmp(key, word->key) == 0;
            gm_arguments_print(arguments, "%s=%s", word->key,
                               other ? instead
                                     : gm_word_value(word, gm_words_choice(&sweep->words, i, run), text));
        }
    }
    return !arguments->failed;
}

char *gm_sweep_words(const struct gm_sweep *sweep, size_t run)
{
    struct gm_arguments arguments;
    struct gm_text_stream writing = {0};
    FILE *stream = words_of(sweep, run, NULL, NULL, &arguments) ? gm_stream_begin(&writing) : NULL;
    for (int i = 0; stream && i < arguments.count; i++) {
        fputs(i > 0 ? " " : "run ", stream);
        gm_arguments_put_shell(stream, arguments.words[i]);
    }
    gm_arguments_close(&arguments);
    return gm_stream_end(&writing);
}

/* ---- reading ---- */

/* The run with the middle of every list. */
static size_t middle_of(const struct gm_sweep *sweep)
{
    size_t run = 0;
    for (size_t i = 0; i < sweep->words.count && !sweep->words.zip; i++) {
        run = run * sweep->words.list[i].count + sweep->words.list[i].count / 2;
    }
    return sweep->words.zip ? sweep->count / 2 : run;
}

/* Reads a run's words as `geomint run` does. Returns false with a sentence; the caller closes the request
   in any case. */
static bool ask(const struct gm_sweep *sweep, size_t run, const char *key, const char *instead,
                struct gm_request *request, char *message)
{
    struct gm_arguments arguments;
    *request = (struct gm_request){0};
    const bool read =
        (words_of(sweep, run, key, instead, &arguments) || gm_refuse(message, "not enough memory")) &&
        gm_request_parse_for(request, sweep->scene, arguments.count, arguments.words, 1, message);
    gm_arguments_close(&arguments);
    return read;
}

static bool try_run(const struct gm_sweep *sweep, size_t run, const char *key, const char *value, int *status,
                    char *message)
{
    struct gm_request request;
    const bool read = ask(sweep, run, key, value, &request, message);
    *status = !read && request.refusal == GM_EXIT_FILE ? GM_EXIT_FILE : GM_EXIT_USAGE;
    gm_request_close(&request);
    return read;
}

/* Refuses a value of a key if neither the first run nor the middle one can be made with it, with the sentence on
   the first: a corner of ranges may have no run. */
static void try_some(const struct gm_sweep *sweep, const char *key, const char *value, int *status)
{
    char message[GM_MESSAGE], ignored[GM_MESSAGE];
    int other;
    gm_arena_check(sweep->arena,
                   try_run(sweep, 0, key, value, status, message) ||
                       try_run(sweep, middle_of(sweep), key, value, &other, ignored),
                   message);
}

static bool fits(const struct gm_scene *scene, const char *key, const char *value)
{
    char *own = gm_scene_defaults(scene);
    struct gm_settings settings;
    double steps = 0;
    const struct gm_parameter *row = gm_word_parameter(scene, key);
    void *owner = gm_scene_parameter(scene, key) ? own : (void *)&settings;
    const bool taken = row ? own && gm_parameter_set(row, owner, value) == GM_PARSED
                           : gm_number_parse(value, &steps) && steps >= 0 && steps <= (double)GM_MOST_STEPS;
    free(own);
    return taken;
}

/* Checks a run with each scheme, and that every list holds values of its key: for a range, both ends. */
static void check(const struct gm_sweep *sweep, int *status)
{
    char first[GM_TEXT_SIZE], last[GM_TEXT_SIZE];
    for (size_t i = 0; i < sweep->words.count; i++) {
        const struct gm_word *word = &sweep->words.list[i];
        gm_arena_refuse_if(sweep->arena, strcmp(word->key, "equal") == 0 || strcmp(word->key, "overlay") == 0,
                           "%s= is of lanes beside each other; a sweep has none", word->key);
        for (size_t k = 0; strcmp(word->key, "scheme") == 0 && k < word->count; k++) {
            try_some(sweep, "scheme", gm_word_value(word, k, first), status);
        }
        size_t value = 0;
        for (size_t k = 0; is_column(word) && k < word->piece_count; k++) {
            const size_t values = word->pieces[k].range.count ? word->pieces[k].range.count : 1;
            const char *ends[] = {gm_word_value(word, value, first),
                                  gm_word_value(word, value + values - 1, last)};
            for (size_t end = 0; end < 2; end++) {
                if (!fits(sweep->scene, word->key, ends[end])) {
                    try_some(sweep, word->key, ends[end], status);
                }
            }
            value += values;
        }
    }
    *status = GM_EXIT_USAGE;
}

/* A text about a run; malloc'ed. Returns NULL when out of memory. */
static char *text_of(const struct gm_sweep *sweep, size_t run,
                     void (*put)(const struct gm_sweep *sweep, size_t run, FILE *stream))
{
    struct gm_text_stream writing;
    FILE *stream = gm_stream_begin(&writing);
    if (stream) {
        put(sweep, run, stream);
    }
    return gm_stream_end(&writing);
}

/* Puts the cells before the status of a run, or their names. */
static void put_front(const struct gm_sweep *sweep, size_t run, struct gm_row *row)
{
    char text[GM_TEXT_SIZE];
    gm_row_text(row, "scene", sweep->scene->mark ? sweep->scene->mark : sweep->scene->name);
    for (size_t pass = 0; pass < 2; pass++) { /* the scheme, wherever it was typed, is the first column */
        for (size_t i = 0; i < sweep->words.count; i++) {
            const struct gm_word *word = &sweep->words.list[i];
            if (is_of_the_list(word) || is_column(word) != (pass == 1)) {
                continue;
            }
            /* the number of steps made is a column after the status */
            const char *key = strcmp(word->key, "steps") == 0 ? "steps_asked" : word->key;
            const char *value = gm_word_value(word, gm_words_choice(&sweep->words, i, run), text);
            const struct gm_scheme *scheme = pass == 0 ? gm_scheme_find(value) : NULL;
            double number = 0;
            if (gm_word_is_number(sweep->scene, word->key) && gm_number_parse(value, &number)) {
                gm_row_number(row, key, number, 17);
            } else {
                gm_row_text(row, key, scheme ? gm_scheme_word(scheme) : value);
            }
        }
    }
    if (sweep->values) { /* a table of other values is not continued */
        snprintf(text, sizeof text, "%s at %s", sweep->values, sweep->at);
        gm_row_text(row, "values", text);
    }
}

/* Puts the cells after the front, for a run that has ended or could not begin (no lane), or their names. */
static void put_end(const struct gm_sweep *sweep, const struct gm_drive *drive, const char *status,
                    const char *warning, const double *values, struct gm_row *row)
{
    const struct gm_run *run = drive->lane ? drive->lane->run : NULL;
    gm_row_put(row, "status %s, warning %s", status, "");
    if (warning[0]) {
        gm_csv_put_quoted(row->stream, warning);
    }
    if (run) {
        gm_row_put(row, "t %.17g, steps %.0f, evaluations %.0f, solves %.0f, seconds %.6g", run->t,
                   (double)run->steps, gm_run_per_member(run, run->evaluations),
                   gm_run_per_member(run, run->solves), drive->seconds);
    } else {
        gm_row_put(row, "t %s, steps %s, evaluations %s, solves %s, seconds %s", "", "", "", "", "");
    }
    for (size_t i = 0; i < sweep->chosen.count; i++) {
        gm_row_number(row, gm_scene_observable_at(sweep->scene, sweep->chosen.numbers[i])->key,
                      run ? values[i] : NAN, 17);
    }
}

static void write_head(const struct gm_sweep *sweep, size_t run, FILE *stream)
{
    struct gm_row row = {.stream = stream, .form = GM_ROW_HEAD};
    put_front(sweep, run, &row);
    put_end(sweep, &(const struct gm_drive){0}, "", "", NULL, &row);
    if (sweep->values) {
        fprintf(stream, ",index,t,%s", sweep->name);
    }
    fputc('\n', stream);
}

static void write_front(const struct gm_sweep *sweep, size_t run, FILE *stream)
{
    put_front(sweep, run, &(struct gm_row){.stream = stream, .form = GM_ROW_CSV});
    fputc(',', stream);
}

static void close_sweep(void *data)
{
    struct gm_sweep *sweep = data;
    gm_words_close(&sweep->words);
    gm_chosen_close(&sweep->chosen);
}

/* ---- many values a run ---- */

/* The last values of a component or an observable, after each step, at each passage of the section, or at each maximum,
   where the parabola through three values has its vertex. */

/* The values of a run, of which the last are kept in a ring: pairs of t and value. */
struct series {
    double *pairs; /* malloc'ed */
    size_t count;  /* all of them */
};

enum { MOST_VALUES = 1000000, PASSAGES = 256 /* in steps that are made together */ };

static const char *const places[] = {"step", "section", "maximum"};

/* The names that values may have: components, then observables. */
struct names {
    struct gm_arena *arena;
    const struct gm_lane *lane;
    size_t components;
};

static const char *name_at(size_t i, const void *data)
{
    const struct names *names = data;
    return i < names->components ? gm_component_name(names->arena, names->lane->run, i)
                                 : gm_scene_observable_at(names->lane->scene, i - names->components)->key;
}

/* Returns true if steps have the length 1: they are those of a map, which has no values between them. */
static bool is_map(const struct gm_lane *lane)
{
    return fabs(lane->run->dt) == 1;
}

/* Reads --values and --at for runs such as the one of a lane; leaves the body of the sweep's arena with a sentence. */
static void open_values(struct gm_sweep *sweep, const char *values, const char *at,
                        const struct gm_lane *lane)
{
    struct gm_arena *arena = sweep->arena;
    const struct gm_scene *scene = lane->scene;
    const size_t length = strcspn(values, ":");
    const struct names names = {arena, lane, lane->problem.n - 2 * lane->problem.passive};
    const size_t count = names.components + scene->observable_count;
    double kept = NAN;
    gm_arena_refuse_if(
        arena,
        !values[length] || !gm_number_parse(values + length + 1, &kept) || !(kept >= 1) ||
            kept > MOST_VALUES || kept != floor(kept),
        "--values %.60s is not NAME:K, the last K values of a component or an observable, K from "
        "1 to 1e6",
        values);
    sweep->values = gm_arena_print(arena, "%s", values);
    sweep->name = gm_arena_print(arena, "%.*s", (int)length, values);
    sweep->kept = (size_t)kept;
    for (sweep->number = 0; sweep->number < count; sweep->number++) {
        if (strcmp(name_at(sweep->number, &names), sweep->name) == 0) {
            break;
        }
    }
    const char *near = sweep->number == count ? gm_nearest(sweep->name, count, name_at, &names) : NULL;
    gm_arena_refuse_if(arena, sweep->number == count,
                       "--values: %.60s is not a component or an observable of %s%s%s", sweep->name,
                       scene->name, near ? "; did you mean " : "", near ? near : "");
    const bool has_section = gm_scene_section(scene) < scene->track_count;
    sweep->place = has_section && !is_map(lane) ? GM_AT_SECTION : GM_AT_STEP;
    if (at) {
        size_t place = 0;
        while (place < GM_COUNT(places) && strcmp(places[place], at) != 0) {
            place++;
        }
        gm_arena_refuse_if(arena, place == GM_COUNT(places), "--at %.60s is none of: step, section, maximum",
                           at);
        sweep->place = (enum gm_sweep_place)place;
    }
    gm_arena_refuse_if(arena, sweep->place == GM_AT_SECTION && !has_section,
                       "--at section: %s has no section: in its file", scene->name);
    sweep->at = places[sweep->place];
}

/* Returns the value of a view, of its last member if it is a component. Angles are as they are, within a turn. */
static double value_of(const struct gm_sweep *sweep, const struct gm_view *view)
{
    const size_t components = view->problem->n - 2 * view->problem->passive, m = view->problem->m;
    if (sweep->number < components) {
        return view->state[sweep->number * m + m - 1];
    }
    const struct gm_observable *row = gm_scene_observable_at(sweep->scene, sweep->number - components);
    return row->error ? gm_view_observe(row, view, 0) : gm_observe(row, view);
}

static void record(const struct gm_view *view, double *entry)
{
    memcpy(entry, view->state, gm_active_count(view->problem) * sizeof *entry);
}

struct following {
    const struct gm_sweep *sweep;
    struct gm_drive *drive;
    int64_t steps;
    struct series *series;
    double last[3][2];     /* t and value of the last steps, the newest first */
    struct gm_track track; /* the section, with its passages since the last step */
    struct gm_entries entries;
};

/* gm_event_witness.see: a section may be passed before an event, and be at one. */
static void see_event(void *data, const struct gm_event_part *part)
{
    struct following *following = data;
    struct gm_lane *lane = following->drive->lane;
    struct gm_view before = gm_lane_view(lane), after = before;
    before.state = part->before;
    after.state = part->after;
    before.t = after.t = part->before[before.problem->n];
    gm_entries_event(&following->entries, &following->track, part->event, &before, &after, &lane->behind);
    gm_behind_note(&lane->behind, &after);
}

static void push(const struct following *following, double t, double value)
{
    struct series *series = following->series;
    double *pair = series->pairs + 2 * (series->count++ % following->sweep->kept);
    pair[0] = t;
    pair[1] = value;
}

/* Takes a maximum at the middle of the last three values: of a map that value, else that of the parabola through
   them. */
static void push_maximum(const struct following *following)
{
    const double(*last)[2] = following->last;
    const double left = last[1][1] - last[2][1], right = last[1][1] - last[0][1], h = last[0][0] - last[1][0];
    if (following->drive->lane->run->steps >= 2 && left > 0 && right >= 0) {
        const double from = is_map(following->drive->lane)
                                ? 0
                                : (left - right) / (2 * (left + right)); /* of the middle, in steps */
        push(following, last[1][0] + from * h, last[1][1] + from * (left - right) / 4);
    }
}

/* gm_lane_watch.see: takes the passages of the section. */
static void see_steps(void *data, const struct gm_view *view)
{
    struct following *following = data;
    struct gm_entries *entries = &following->entries;
    struct gm_view there = *view;
    gm_entries_record(entries, &following->track, view, &following->drive->lane->behind);
    for (size_t i = 0; i < entries->count; i++) {
        there.state = entries->values + i * entries->width;
        there.t = entries->times[i];
        push(following, there.t, value_of(following->sweep, &there));
    }
    entries->count = 0;
}

static void follow(struct gm_arena *arena, void *data)
{
    struct following *following = data;
    const struct gm_sweep *sweep = following->sweep;
    struct gm_lane *lane = following->drive->lane;
    char message[GM_MESSAGE];
    struct gm_track *track = &following->track;
    const struct gm_view start = gm_lane_view(lane);
    if (sweep->place == GM_AT_SECTION) {
        *track = sweep->scene->tracks[gm_scene_section(sweep->scene)];
        track->numbers = gm_active_count(&lane->problem);
        track->record = record;
        track->each = false;
        track->bound = PASSAGES;
        gm_entries_open(arena, &following->entries, track, &start, &lane->behind);
        gm_entries_record(&following->entries, track, &start, &lane->behind);
        lane->run->witness = (struct gm_event_witness){see_event, following};
        lane->watch = (struct gm_lane_watch){see_steps, following};
        gm_drive_to(following->drive, following->steps, false, message);
        lane->watch.see = NULL;
        return;
    }
    if (sweep->place == GM_AT_STEP && !lane->scheme->family->adaptive &&
        !(lane->problem.events && lane->problem.events->ends_runs)) {
        gm_drive_to(following->drive, following->steps - (int64_t)sweep->kept, false, message);
    }
    following->last[0][0] = lane->run->t;
    following->last[0][1] = value_of(sweep, &start);
    while (lane->run->status == GM_OK && !gm_interrupted &&
           gm_drive_goes_on(following->drive, following->steps) &&
           gm_drive_to(following->drive, lane->run->steps + 1, false, message) &&
           lane->run->status == GM_OK) {
        const struct gm_view view = gm_lane_view(lane);
        memmove(following->last[1], following->last[0], 2 * sizeof *following->last);
        following->last[0][0] = view.t;
        following->last[0][1] = value_of(sweep, &view);
        if (sweep->place == GM_AT_STEP) {
            push(following, view.t, following->last[0][1]);
        } else {
            push_maximum(following);
        }
    }
}

/* Makes a run, and takes its values; the caller frees the pairs. */
static void follow_values(const struct gm_sweep *sweep, struct gm_drive *drive, int64_t steps,
                          struct series *series)
{
    *series = (struct series){.pairs = calloc(2 * sweep->kept, sizeof *series->pairs)};
    if (series->pairs) { /* else the refusal is noted */
        gm_arena_run_once(
            follow, &(struct following){.sweep = sweep, .drive = drive, .steps = steps, .series = series});
    }
}

/* Reads --values for runs such as the first one or, if that cannot be made, the middle one. */
static void read_values(struct gm_sweep *sweep, const struct gm_sweep_options *options)
{
    char message[GM_MESSAGE];
    struct gm_request *request = gm_arena_take(sweep->arena, 1, sizeof *request);
    gm_arena_keep(sweep->arena, request, gm_request_close);
    gm_arena_refuse_if(sweep->arena, sweep->count < 2,
                       "--values is of several runs: give a key a range, r=2.8..4:400");
    struct gm_lane *lane = NULL;
    for (size_t i = 0; i < 2 && !lane; i++) {
        gm_request_close(request);
        lane = ask(sweep, i == 0 ? 0 : middle_of(sweep), NULL, NULL, request, message)
                   ? gm_request_open_lane(request, 0, message)
                   : NULL;
    }
    open_values(sweep, options->values, options->at, gm_lane_in(sweep->arena, lane, message));
}

void gm_sweep_open(struct gm_arena *arena, struct gm_sweep *sweep, const struct gm_arguments *arguments,
                   const struct gm_sweep_options *options, int *status)
{
    char message[GM_MESSAGE];
    const char *measure = options->measure;
    *status = GM_EXIT_USAGE;
    *sweep = (struct gm_sweep){.arena = arena,
                               .measure = measure ? gm_arena_print(arena, "%s", measure) : NULL,
                               .shard = 1,
                               .shards = 1};
    gm_arena_keep(arena, sweep, close_sweep);
    gm_arena_refuse_if(arena, arguments->count == 0, "sweep of which scene? See geomint list scenes");
    sweep->scene = gm_request_scene(arguments->count, arguments->words, status, message);
    gm_arena_check(
        arena,
        sweep->scene &&
            gm_words_read(&sweep->words, sweep->scene, arguments->count - 1, arguments->words + 1,
                          GM_RUN_SCHEMES, message) &&
            gm_words_count(&sweep->words, SIZE_MAX / 2, &sweep->count, message) &&
            gm_chosen_open(&sweep->chosen, sweep->scene, measure || !options->values ? measure : "", message),
        message);
    check(sweep, status);
    gm_arena_refuse_if(arena, options->at && !options->values, "--at is the place of --values");
    if (options->values) {
        read_values(sweep, options);
    }
    sweep->arguments = gm_arena_keep(arena, gm_words_join(sweep->scene, &sweep->words), free);
    sweep->head = gm_arena_keep(arena, text_of(sweep, 0, write_head), free);
    sweep->status =
        1 + sweep->words.count - (gm_words_find(&sweep->words, "zip") != NULL) + (sweep->values != NULL);
    sweep->index = sweep->values ? sweep->status + GM_SWEEP_COSTS + sweep->chosen.count : 0;
}

size_t gm_sweep_shard_runs(const struct gm_sweep *sweep)
{
    return (sweep->count + sweep->shards - sweep->shard) / sweep->shards;
}

size_t gm_sweep_run(const struct gm_sweep *sweep, size_t k)
{
    return k * sweep->shards + sweep->shard - 1;
}

/* ---- rows ---- */

size_t gm_sweep_front(const struct gm_sweep *sweep, size_t run, const char *line)
{
    char *front = text_of(sweep, run, write_front);
    const size_t length = front ? strlen(front) : 0;
    const bool same = front && strncmp(line, front, length) == 0;
    free(front);
    return same ? length : 0;
}

/* Puts the rows of a run, one for each of its values after the same cells; a run without values has one row. */
static void put_values(const struct gm_sweep *sweep, const char *cells, const struct series *series,
                       FILE *stream)
{
    const size_t count = series->count < sweep->kept ? series->count : sweep->kept;
    for (size_t i = 0; i < count; i++) {
        const double *pair = series->pairs + 2 * ((series->count - count + i) % sweep->kept);
        fprintf(stream, "%s,%zu,%.17g,%.17g\n", cells, i, pair[0], pair[1]);
    }
    if (count == 0) {
        fprintf(stream, "%s%s\n", cells, sweep->values ? ",,," : "");
    }
}

/* Reads the run's words as `geomint run` does, and makes it, unless a status gives a reason against it. */
static void make_row(const struct gm_sweep *sweep, size_t run, const struct gm_request *request,
                     const char *status, struct gm_sweep_row *row)
{
    char message[GM_MESSAGE];
    const unsigned long refusals = gm_memory_refusals();
    struct gm_drive drive = {.request = request,
                             .whole_steps = gm_chosen_follows_steps(&sweep->chosen, sweep->scene)};
    struct series series = {0};
    drive.lane = status ? NULL : gm_request_open_lane(request, 0, message);
    if (drive.lane) {
        drive.lane->unfollowed = gm_chosen_are_of_the_end(&sweep->chosen, sweep->scene);
    }
    if (drive.lane && sweep->values) {
        follow_values(sweep, &drive, request->lanes[0].steps, &series);
    } else if (drive.lane) {
        gm_drive_to(&drive, request->lanes[0].steps, false, message);
    }
    const struct gm_run *ended = drive.lane ? drive.lane->run : NULL;
    const bool interrupted = ended && gm_interrupted && gm_drive_goes_on(&drive, request->lanes[0].steps);
    double *values = interrupted ? NULL : malloc((sweep->chosen.count + 1) * sizeof *values);
    for (size_t i = 0; ended && values && i < sweep->chosen.count; i++) {
        values[i] = gm_lane_observe(drive.lane, sweep->chosen.numbers[i]);
        gm_lane_judge(drive.lane, sweep->chosen.numbers[i], values[i]);
    }
    struct gm_text_stream line = {0}, rows = {0};
    if (!status) {
        const bool lost = gm_memory_refusals() != refusals || !ended;
        status = gm_status_name(lost ? GM_OUT_OF_MEMORY : ended->status);
        row->ok = !lost && ended->status == GM_OK;
    }
    if (row->ok) {
        gm_drive_warning(&drive, row->sentence, GM_MESSAGE);
    }
    if (values && gm_stream_begin(&line)) {
        struct gm_row front = {.stream = line.stream, .form = GM_ROW_CSV};
        put_front(sweep, run, &front);
        put_end(sweep, &drive, status, row->ok ? row->sentence : "", values, &front);
    }
    char *cells = gm_stream_end(&line);
    series.count = row->ok ? series.count : 0;
    if (cells && gm_stream_begin(&rows)) {
        put_values(sweep, cells, &series, rows.stream);
    }
    row->text = gm_stream_end(&rows);
    free(cells);
    free(series.pairs);
    free(values);
    gm_lane_close(drive.lane);
}

void gm_sweep_make(const struct gm_sweep *sweep, size_t run, struct gm_sweep_row *row)
{
    struct gm_request request;
    const unsigned long refusals = gm_memory_refusals();
    *row = (struct gm_sweep_row){0};
    const bool asked = ask(sweep, run, NULL, NULL, &request, row->sentence);
    const bool lost = gm_memory_refusals() != refusals;
    if (asked || lost) {
        row->sentence[0] = '\0';
    }
    make_row(sweep, run, &request, asked ? NULL : lost ? gm_status_name(GM_OUT_OF_MEMORY) : "refused", row);
    gm_request_close(&request);
}

double gm_sweep_total(const struct gm_sweep *sweep,
                      double (*of)(const struct gm_request *request, size_t index))
{
    enum { SAMPLES = 5 };
    const size_t runs = gm_sweep_shard_runs(sweep);
    double sum = 0;
    for (size_t i = 0; i < SAMPLES && runs > 0; i++) {
        char message[GM_MESSAGE];
        struct gm_request request;
        const size_t run = gm_sweep_run(sweep, (runs - 1) / (SAMPLES - 1) * i);
        sum += ask(sweep, run, NULL, NULL, &request, message) ? of(&request, 0) : 0;
        gm_request_close(&request);
    }
    return sum / SAMPLES * (double)runs;
}
