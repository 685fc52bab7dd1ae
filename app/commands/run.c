/* SPDX-License-Identifier: GPL-3.0-or-later */
/* geomint run: numbers, no pictures. */
#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/base/arguments.h"
#include "app/base/interrupt.h"
#include "app/commands/commands.h"
#include "app/data/save.h"
#include "app/native/engine.h"
#include "app/output/folder.h"
#include "app/output/frames.h"
#include "app/output/row.h"
#include "app/output/say.h"
#include "app/words/drive.h"
#include "app/words/names.h"
#include "core/basics.h"
#include "core/memory.h"
#include "core/ode/portrait/portrait.h"
#include "render/clock.h"
#include "render/files/temporary.h"

/* The files that the command writes. */
struct outputs {
    const struct gm_options *options;
    struct gm_chosen chosen; /* the observables to print */
    struct gm_rows rows;
    FILE *csv;   /* NULL: not requested, as for the others */
    int csv_why; /* errno of the row that could not be written; 0: all could */
    struct gm_save *save;
    struct gm_pause *pause;
    struct gm_tracks *tracks;
    /* true if the last checkpoint, the profiles or the tracks could not be written, which was reported */
    bool unkept, unprofiled, untracked;
    char note[GM_MESSAGE]; /* of the lane before */
};

struct outcome {
    struct gm_drive drive;
    double *values;           /* one per observable, at the end */
    double *maxima;           /* one per observable, of largest magnitude; NULL without --max */
    char *front;              /* "scene,lane,scheme" and the keys that differ: how a row of CSV begins */
    char *meta;               /* the last description of the run */
    bool interrupted;         /* before it came to its end */
    struct outputs *outputs;  /* the files that all lanes share */
    struct gm_paused paused;  /* numbers: the maxima */
    char warning[GM_MESSAGE]; /* the warning on an end with status ok, or "" */
};

/* Returns true if the lane's phase portrait was requested; its window holds every step. */
static bool has_portrait(const struct gm_lane *lane)
{
    const struct gm_parameter *row = gm_scene_parameter(lane->scene, "portrait");
    return row && lane->scene->portrait && gm_parameter_get(row, lane->parameters) != 0;
}

static bool is_standard_output(const char *path)
{
    return path && strcmp(path, "-") == 0;
}

/* The printed observable i. */
static const struct gm_observable *told(const struct outcome *outcome, size_t i)
{
    return gm_scene_observable_at(outcome->drive.lane->scene, outcome->outputs->chosen.numbers[i]);
}

static double observe_told(const struct outcome *outcome, size_t i)
{
    return gm_lane_observe(outcome->drive.lane, outcome->outputs->chosen.numbers[i]);
}

/* Returns true if it has a meaning for this run, or was given by --measure. */
static bool is_meant(const struct outcome *outcome, size_t i)
{
    return outcome->outputs->options->measure ||
           gm_lane_measures(outcome->drive.lane, outcome->outputs->chosen.numbers[i]);
}

/* The reason for its missing value, or NULL. */
static const char *missing(const struct outcome *outcome, size_t i)
{
    return !isfinite(outcome->values[i]) && is_meant(outcome, i)
               ? gm_lane_missing(outcome->drive.lane, outcome->outputs->chosen.numbers[i])
               : NULL;
}

/* Evaluates the observables at the lane's end. When out of memory the lane reports it, and the numbers are
   NAN. */
static void observe(struct outcome *outcome)
{
    struct gm_lane *lane = outcome->drive.lane;
    const unsigned long refusals = gm_memory_refusals();
    for (size_t i = 0; i < outcome->outputs->chosen.count; i++) {
        outcome->values[i] = observe_told(outcome, i);
        gm_lane_judge(lane, outcome->outputs->chosen.numbers[i], outcome->values[i]);
    }
    if (!outcome->interrupted) {
        gm_drive_warning(&outcome->drive, outcome->warning, sizeof outcome->warning);
    }
    if (gm_memory_refusals() != refusals) {
        lane->run->status = GM_OUT_OF_MEMORY;
    }
}

/* The lane's status, and a sentence on it, or "". */
static const char *tell_end(const struct outcome *outcome, char *sentence, size_t size)
{
    const struct gm_lane *lane = outcome->drive.lane;
    gm_drive_message(&outcome->drive, sentence, size);
    if (outcome->interrupted) {
        snprintf(sentence, size, "the run was interrupted after t = %.6g", lane->run->t);
        return "interrupted";
    }
    return gm_status_name(lane->run->status);
}

/* Writes "equilibria":[{"at":[x,y],"kind":"saddle","eigenvalues":[[re,im],[re,im]]}, ...]. */
static void print_equilibria(struct gm_row *row, const struct gm_portrait *portrait)
{
    struct gm_row list = gm_row_open(row, "equilibria", ']');
    for (size_t i = 0; i < portrait->count; i++) {
        const struct gm_equilibrium *equilibrium = &portrait->equilibria[i];
        struct gm_row item = gm_row_open(&list, NULL, '}');
        gm_row_list(&item, "at", equilibrium->at, 2);
        gm_row_text(&item, "kind", gm_equilibrium_kind_name(equilibrium->kind));
        struct gm_row values = gm_row_open(&item, "eigenvalues", ']');
        for (size_t k = 0; k < 2; k++) {
            gm_row_list(&values, NULL, equilibrium->eigenvalues[k], 2);
        }
    }
}

static void print_json(const struct outcome *outcome, const struct gm_options *options)
{
    const struct gm_lane *lane = outcome->drive.lane;
    const struct gm_run *run = lane->run;
    const size_t count = outcome->outputs->chosen.count;
    char sentence[GM_MESSAGE], key[128];
    const char *status = tell_end(outcome, sentence, sizeof sentence);
    struct gm_row row = gm_row_begin(stdout);
    gm_row_put(&row, "scene %s", lane->scene->name);
    gm_meta_source(&row, lane->scene);
    gm_row_put(&row, "scheme %s", lane->scheme->name);
    if (gm_engine_of(lane)) {
        gm_row_put(&row, "engine %s", gm_engine_of(lane));
    }
    gm_meta_parameters(&row, lane);
    gm_row_put(&row, "status %s, message %s, warning %s, t %.17g", status, sentence, outcome->warning,
               run->t);
    if (lane->problem.events && lane->problem.events->breaks > 0) {
        gm_row_put(&row, "breaks %s", gm_run_locates(run) ? "located" : "ignored");
    }
    if (lane->problem.events && lane->problem.events->ends_runs) {
        gm_row_put(&row, "stopped %d", run->stopped);
    }
    gm_row_put(&row, "steps %.0f, evaluations %.0f, solves %.0f", (double)run->steps,
               gm_run_per_member(run, run->evaluations), gm_run_per_member(run, run->solves));
    if (run->factor_solves > 0) {
        gm_row_put(&row, "factor_solves %.0f", gm_run_per_member(run, run->factor_solves));
    }
    if (run->scheme->family->by_tolerance) {
        gm_row_put(&row, "own_steps %.0f, rejected %.0f", gm_run_per_member(run, run->own_steps),
                   gm_run_per_member(run, run->rejected));
    }
    printf(",\"seconds\":%.6g", outcome->drive.seconds);
    struct gm_row observables = gm_row_open(&row, "observables", '}');
    for (size_t i = 0; i < count; i++) {
        gm_row_number(&observables, told(outcome, i)->key, outcome->values[i], 17);
    }
    for (size_t i = 0; outcome->maxima && i < count; i++) {
        snprintf(key, sizeof key, "%s_max", told(outcome, i)->key);
        gm_row_number(&observables, key, outcome->maxima[i], 17);
    }
    struct gm_portrait portrait;
    const char *none = NULL;
    if (has_portrait(lane) && lane->scene->portrait(lane, &portrait)) {
        print_equilibria(&row, &portrait);
        none = portrait.missing;
        gm_portrait_close(&portrait);
    }
    bool reasoned = none != NULL;
    for (size_t i = 0; i < count; i++) {
        reasoned |= missing(outcome, i) != NULL;
    }
    if (reasoned) { /* the reasons for null values */
        struct gm_row reasons = gm_row_open(&row, "reasons", '}');
        if (none) {
            gm_row_text(&reasons, "equilibria", none);
        }
        for (size_t i = 0; i < count; i++) {
            if (missing(outcome, i)) {
                gm_row_text(&reasons, told(outcome, i)->key, missing(outcome, i));
            }
        }
    }
    if (options->state) {
        char layout[128];
        snprintf(layout, sizeof layout, "y[component * m + member], n = %zu components, m = %zu members",
                 lane->problem.n, lane->problem.m);
        gm_row_put(&row, "layout %s", layout);
        /* null: a lost tracer */
        gm_row_list(&row, "state", gm_run_state(run), lane->problem.n * lane->problem.m);
    }
    gm_row_close(&row, "\n");
}

/* Prints a line for each equilibrium: its place, kind and eigenvalues. */
static void tell_equilibria(const struct gm_lane *lane, int width)
{
    struct gm_portrait portrait;
    if (!lane->scene->portrait(lane, &portrait)) {
        return;
    }
    for (size_t i = 0; i < portrait.count; i++) {
        const struct gm_equilibrium *equilibrium = &portrait.equilibria[i];
        const double(*values)[2] = equilibrium->eigenvalues;
        printf("  %-*s (%.10g, %.10g) %s", width, "equilibrium", equilibrium->at[0], equilibrium->at[1],
               gm_equilibrium_kind_name(equilibrium->kind));
        if (equilibrium->kind == GM_NOT_SMOOTH) {
            printf("\n");
        } else if (values[0][1] == 0) {
            printf(", eigenvalues %.7g, %.7g\n", values[0][0], values[1][0]);
        } else {
            printf(", eigenvalues %.7g ± %.7gi\n", values[0][0], values[0][1]);
        }
    }
    if (portrait.count == 0 || portrait.missing) {
        printf("  %-*s %s\n", width, "equilibrium",
               portrait.missing ? portrait.missing : "none in the window");
    }
    gm_portrait_close(&portrait);
}

static void print_text(const struct outcome *outcome)
{
    const struct gm_lane *lane = outcome->drive.lane;
    const struct gm_run *run = lane->run;
    const struct gm_shown *shown = &lane->shown;
    gm_say("%s  %s%s%s%s%s", lane->scene->name, lane->scheme->name, shown->panel_name[0] ? "  " : "",
           shown->panel_name, shown->colour_name[0] ? "  " : "", shown->colour_name);
    int width = 0; /* the width of the names, in columns */
    for (size_t i = 0; i < outcome->outputs->chosen.count; i++) {
        const int length = (int)strlen(told(outcome, i)->key) + (outcome->maxima ? 4 : 0);
        width = length > width ? length : width;
    }
    width = width > 20 ? width : 20;
    char sentence[GM_MESSAGE];
    printf("  %-*s %s%s\n", width, "status", tell_end(outcome, sentence, sizeof sentence),
           outcome->warning[0] ? " (with a warning)" : "");
    if (outcome->warning[0]) {
        printf("  %-*s %s\n", width, "warning", outcome->warning);
    }
    if (sentence[0]) {
        printf("  %-*s %s\n", width, "message", sentence);
    }
    printf("  %-*s %.10g\n  %-*s %" PRId64 "\n  %-*s %.0f\n  %-*s %.0f\n  %-*s %.3g\n", width, "t", run->t,
           width, "steps", run->steps, width, "evaluations", gm_run_per_member(run, run->evaluations), width,
           "solves", gm_run_per_member(run, run->solves), width, "seconds", outcome->drive.seconds);
    for (size_t i = 0; i < outcome->outputs->chosen.count; i++) {
        const char *reason = missing(outcome, i);
        if (!is_meant(outcome, i)) {
            continue;
        }
        if (reason) {
            printf("  %-*s none: %s\n", width, told(outcome, i)->key, reason);
        } else {
            printf("  %-*s %.10g\n", width, told(outcome, i)->key, outcome->values[i]);
        }
    }
    for (size_t i = 0; outcome->maxima && i < outcome->outputs->chosen.count; i++) {
        const char *key = told(outcome, i)->key;
        const int left = width - (int)strlen(key);
        const bool none = isnan(outcome->maxima[i]) && missing(outcome, i);
        if (!is_meant(outcome, i)) {
            continue;
        }
        printf(none ? "  %s%-*s none\n" : "  %s%-*s %.10g\n", key, left > 0 ? left : 0, "_max",
               outcome->maxima[i]);
    }
    if (has_portrait(lane)) {
        tell_equilibria(lane, width);
    }
}

/* Returns true if the lanes differ in a parameter of the scene or of schemes. */
static bool differs(const struct gm_request *request, const struct gm_parameter *row)
{
    char first[GM_TEXT_SIZE], other[GM_TEXT_SIZE];
    gm_parameter_format(row, gm_lane_owner(&request->lanes[0], row), first, sizeof first);
    for (size_t i = 1; i < request->count; i++) {
        gm_parameter_format(row, gm_lane_owner(&request->lanes[i], row), other, sizeof other);
        if (strcmp(first, other) != 0) {
            return true;
        }
    }
    return false;
}

/* The front of every CSV row of a lane or, as a head, the names of its columns; malloc'ed. Returns NULL when out of
   memory. */
static char *front_of(const struct gm_request *request, size_t lane, enum gm_row_form form)
{
    struct gm_text_stream writing;
    const struct gm_scene *scene = request->scene;
    struct gm_lane_spec *spec = &request->lanes[lane];
    FILE *stream = gm_stream_begin(&writing);
    if (!stream) {
        return NULL;
    }
    struct gm_row cells = {.stream = stream, .form = form};
    gm_row_put(&cells, "scene %s, lane %.0f, scheme %s", scene->name, (double)lane, spec->scheme->name);
    for (size_t i = 0; i < scene->parameter_count + gm_settings_parameter_count; i++) {
        const struct gm_parameter *row = i < scene->parameter_count
                                             ? &scene->parameters[i]
                                             : &gm_settings_parameters[i - scene->parameter_count];
        if (!differs(request, row)) {
            continue;
        }
        if (gm_is_setting(row) && !gm_scheme_takes(spec->scheme, row)) {
            gm_row_number(&cells, row->key, NAN, 17); /* an empty cell */
        } else {
            gm_meta_parameter(&cells, row, gm_lane_owner(spec, row));
        }
    }
    return gm_stream_end(&writing);
}

/* A row of the history, unless one before it could not be written. */
static void write_row(struct outcome *outcome)
{
    const struct gm_lane *lane = outcome->drive.lane;
    FILE *csv = outcome->outputs->csv;
    char sentence[GM_MESSAGE];
    if (outcome->outputs->csv_why != 0) {
        return;
    }
    fprintf(csv, "%s,%.17g,%s", outcome->front, lane->run->t, tell_end(outcome, sentence, sizeof sentence));
    for (size_t i = 0; i < outcome->outputs->chosen.count; i++) {
        const double value = observe_told(outcome, i);
        fprintf(csv, ",%.17g", isnan(value) ? fabs(value) : value); /* a NaN has no sign */
    }
    fputc('\n', csv);
    outcome->outputs->csv_why = ferror(csv) ? errno : 0;
}

static void take_maxima(struct outcome *outcome)
{
    for (size_t i = 0; outcome->maxima && i < outcome->outputs->chosen.count; i++) {
        const double value = observe_told(outcome, i);
        if (!(fabs(value) <= fabs(outcome->maxima[i])) && !isnan(value)) { /* the maximum is NaN at first */
            outcome->maxima[i] = value;
        }
    }
}

static bool write_rows(struct outcome *outcome, char *message)
{
    const struct outputs *outputs = outcome->outputs;
    outcome->paused.last_row = outcome->drive.lane->run->steps;
    if (outputs->csv) {
        write_row(outcome);
    }
    return !outputs->save || gm_save_row(outputs->save, outcome->drive.lane->run, message);
}

/* Saves the state. The rows that a checkpoint counts are on disk before it. Returns false with a sentence
   if they cannot be written; a failed checkpoint does not end the run. */
static bool keep_state(struct outcome *outcome, char *message)
{
    struct outputs *outputs = outcome->outputs;
    const struct gm_drive *drive = &outcome->drive;
    const char *path = outputs->options->checkpoint;
    outcome->paused.seconds = drive->seconds;
    outcome->paused.rows = 0;
    outcome->paused.saved = outputs->save ? gm_save_identity(outputs->save) : 0;
    outcome->paused.spacing[0] = (double)outputs->rows.every;
    outcome->paused.spacing[1] = outputs->rows.interval;
    if (outputs->save && !gm_save_sync(outputs->save, &outcome->paused.rows, message)) {
        return false;
    }
    const bool told = outputs->unkept;
    outputs->unkept = gm_pause_note(outputs->pause, drive->index, drive->lane, &outcome->paused)
                          ? !gm_pause_write(outputs->pause, path, message)
                          : !gm_temporary_refuse(message, path, "not enough memory");
    if (outputs->unkept && !told) {
        gm_complain("%s", message);
    } else if (!outputs->unkept && outputs->save) {
        gm_save_keep(outputs->save);
    }
    return true;
}

/* The clock of checkpoints: the number of steps until the time is checked again. */
struct pace {
    int64_t steps;
    double looked, kept;
};

static bool keep_pace(struct outcome *outcome, struct pace *pace, char *message)
{
    const double now = gm_clock_seconds(), often = 0.1, interval = 5, share = 20;
    pace->steps = now - pace->looked < often ? 2 * pace->steps : pace->steps / 2 + 1;
    pace->steps = pace->steps < GM_MOST_STEPS ? pace->steps : GM_MOST_STEPS;
    pace->looked = now;
    if (now < pace->kept + interval) {
        return true;
    }
    const bool kept = keep_state(outcome, message);
    pace->looked = gm_clock_seconds();
    /* a saved state may be large: saving takes a small part of the time */
    pace->kept = pace->looked + fmax(0, share * (pace->looked - now) - interval);
    return kept;
}

/* Returns true if steps are observed only for saving; steps and rows are then made in blocks. */
static bool only_saves(const struct outcome *outcome)
{
    const struct outputs *outputs = outcome->outputs;
    return outputs->save && !outputs->csv && !outputs->tracks && !outcome->maxima &&
           gm_save_takes_many(outputs->save) && gm_rows_all(&outputs->rows, outcome->drive.lane->run);
}

enum { TRACED = 1024 /* steps at once */ };

static size_t row_width(const struct outcome *outcome)
{
    return 1 + outcome->drive.lane->problem.n;
}

/* Makes steps up to `stop`, TRACED at most, with a row each. */
static bool make_rows(struct outcome *outcome, int64_t stop, double *trace, char *message)
{
    struct gm_drive *drive = &outcome->drive;
    const int64_t most = drive->lane->run->steps + TRACED;
    drive->trace = trace;
    const bool driven = gm_drive_to(drive, stop < most ? stop : most, false, message);
    const size_t count = (size_t)(drive->trace - trace) / row_width(outcome);
    drive->trace = NULL;
    outcome->paused.last_row = drive->lane->run->steps;
    return driven && gm_save_rows(outcome->outputs->save, drive->lane->run, trace, count, message);
}

/* Makes steps up to the next that is looked at, `stop` at most, and the row of that. */
static bool make_steps(struct outcome *outcome, int64_t stop, char *message)
{
    const struct outputs *outputs = outcome->outputs;
    const struct gm_run *run = outcome->drive.lane->run;
    const bool has_rows = outputs->csv || outputs->save;
    const int64_t row = has_rows ? gm_rows_next(&outputs->rows, run) : stop;
    const int64_t next = outcome->maxima ? run->steps + 1 : row;
    const double before = run->t;
    const int64_t steps = run->steps;
    /* a lane that follows each step takes it into its tracks without a record of all observables */
    const bool record =
        (outputs->tracks || has_portrait(outcome->drive.lane)) && outcome->drive.lane->scene->follow != 1;
    if (!gm_drive_to(&outcome->drive, next < stop ? next : stop, record, message)) {
        return false;
    }
    if (run->steps == steps) {
        return true;
    }
    take_maxima(outcome);
    const bool due = has_rows && run->status == GM_OK && gm_rows_due(&outputs->rows, run, before);
    return !due || write_rows(outcome, message);
}

/* Returns true if the reader of standard output is gone and no file is requested. */
static bool is_in_vain(const struct outputs *outputs)
{
    const struct gm_options *options = outputs->options;
    const bool makes_file = options->save || options->tracks || options->checkpoint ||
                            (options->profile && !is_standard_output(options->profile)) ||
                            (options->csv && !is_standard_output(options->csv));
    return !makes_file && ferror(stdout);
}

/* Drives one lane to its end, and observes every step only if that is requested. */
static bool drive_lane(struct outcome *outcome, int64_t steps, char *message)
{
    const bool keeps = outcome->outputs->options->checkpoint != NULL;
    const struct gm_run *run = outcome->drive.lane->run;
    struct pace pace = {.steps = 1, .looked = gm_clock_seconds(), .kept = gm_clock_seconds()};
    /* without memory for it, step by step */
    double *trace = only_saves(outcome) ? malloc(TRACED * row_width(outcome) * sizeof *trace) : NULL;
    bool driven = true;
    for (int64_t before = -1; driven && gm_drive_goes_on(&outcome->drive, steps) && !gm_interrupted &&
                              run->steps != before && !is_in_vain(outcome->outputs);) {
        before = run->steps;
        const int64_t stop = keeps && pace.steps < steps - before ? before + pace.steps : steps;
        driven = trace ? make_rows(outcome, stop, trace, message) : make_steps(outcome, stop, message);
        driven = driven && (!keeps || keep_pace(outcome, &pace, message));
    }
    free(trace);
    gm_interrupts_seen();
    return driven;
}

/* A description of the run, as JSON; the outcome frees it. Returns NULL when out of memory. */
static const char *meta_of(struct outcome *outcome)
{
    char sentence[GM_MESSAGE];
    const char *status = tell_end(outcome, sentence, sizeof sentence);
    free(outcome->meta);
    return outcome->meta = gm_meta_text(outcome->drive.lane, status, sentence);
}

/* Begins a lane's rows with its start, or appends them to the existing rows of a resumed lane. */
static bool begin_rows(struct outcome *outcome, int64_t steps, char *message)
{
    const struct outputs *outputs = outcome->outputs;
    const struct gm_run *run = outcome->drive.lane->run;
    const uint64_t rows = outcome->paused.rows;
    if (outputs->save) {
        const char *meta = meta_of(outcome);
        const struct gm_save_size size = {
            .rows = rows,
            .expected = gm_rows_expected(&outputs->rows, run, gm_drive_end(&outcome->drive, steps)),
            .meta = meta ? strlen(meta) : 0};
        if (!gm_save_begin(outputs->save, outcome->drive.index, run, &size, message)) {
            return false;
        }
    }
    if (outputs->save && rows > 0) {
        if (outputs->csv) {
            write_row(outcome);
        }
        return true;
    }
    return !(outputs->csv || outputs->save) || write_rows(outcome, message);
}

/* Ends a lane's rows with the last good state. The history of a failed lane gives its status. */
static bool end_rows(struct outcome *outcome, char *message)
{
    const struct outputs *outputs = outcome->outputs;
    const struct gm_lane *lane = outcome->drive.lane;
    const bool cut = outcome->interrupted || lane->run->status != GM_OK;
    const bool missing = outcome->paused.last_row != lane->run->steps;
    if (outputs->csv && (cut || missing)) {
        write_row(outcome);
    }
    if (!outputs->save) {
        return true;
    }
    if (missing && !gm_save_row(outputs->save, lane->run, message)) {
        return false;
    }
    const char *meta = meta_of(outcome);
    return meta ? gm_save_end(outputs->save, meta, message) : gm_refuse(message, "not enough memory");
}

static bool save_tracks(struct outcome *outcome, char *message)
{
    const char *meta = meta_of(outcome);
    return meta ? gm_tracks_add(outcome->outputs->tracks, outcome->drive.index, outcome->drive.lane, meta,
                                message)
                : gm_refuse(message, "not enough memory");
}

/* Ends incomplete rows, mostly after a lack of memory: the saved rows remain, even if the reason cannot be
   stored. */
static void end_cut(struct outcome *outcome)
{
    char message[GM_MESSAGE], sentence[GM_MESSAGE];
    struct gm_run *run = outcome->drive.lane->run;
    outcome->interrupted = !gm_memory_was_short();
    run->status = outcome->interrupted ? run->status : GM_OUT_OF_MEMORY;
    snprintf(message, sizeof message,
             "no more rows could be written: the run came to t = %.6g, those of the file end before", run->t);
    char *meta = gm_meta_text(outcome->drive.lane, tell_end(outcome, sentence, sizeof sentence), message);
    gm_save_end(outcome->outputs->save, meta ? meta : "{}", message);
    free(meta);
}

/* Returns true if a saved run can be resumed, with rows of the same spacing; else false with a sentence. */
static bool fits_saved(const struct outcome *outcome, char *message)
{
    const struct outputs *outputs = outcome->outputs;
    const double *before = outcome->paused.spacing, interval = outputs->rows.interval;
    if (!outputs->save || outcome->paused.rows == 0) {
        return true;
    }
    if (before[0] != (double)outputs->rows.every ||
        (before[1] != interval && !(isnan(before[1]) && isnan(interval)))) {
        return gm_refuse(message, "the saved rows are spaced otherwise: resume with the same --every or "
                                  "--interval, or save to another file");
    }
    return outcome->paused.saved == gm_save_identity(outputs->save) ||
           gm_refuse(message, "%.200s.part is of another run than %.200s: save to another file",
                     outputs->options->save, outputs->options->from_checkpoint);
}

/* Runs one lane; the status of a failed run is the last row of its history. */
static bool run_lane(struct outcome *outcome, int64_t steps, char *message)
{
    outcome->paused = (struct gm_paused){.last_row = -1, .numbers = outcome->maxima};
    if (outcome->outputs->pause && !gm_pause_restore(outcome->outputs->pause, outcome->drive.index,
                                                     outcome->drive.lane, &outcome->paused, message)) {
        return false;
    }
    if (!fits_saved(outcome, message)) {
        return false;
    }
    outcome->drive.seconds = outcome->paused.seconds;
    take_maxima(outcome);
    const bool keeps = outcome->outputs->options->checkpoint != NULL;
    if (!begin_rows(outcome, steps, message) || !drive_lane(outcome, keeps ? steps - 1 : steps, message)) {
        return false;
    }
    const bool rests = gm_drive_rest(&outcome->drive) != 0; /* a checkpoint has whole steps only */
    if (!rests && !drive_lane(outcome, steps, message)) {
        return false;
    }
    if ((keeps && !keep_state(outcome, message)) || (rests && !make_steps(outcome, steps, message))) {
        return false;
    }
    outcome->interrupted = gm_interrupted && gm_drive_goes_on(&outcome->drive, steps);
    return end_rows(outcome, message);
}

/* The file, or standard output; NULL with a sentence. */
static FILE *open_stream(const char *path, const char *mode, char *message)
{
    if (is_standard_output(path)) {
        return stdout;
    }
    if (!gm_folder_make_for(path, message)) {
        return NULL;
    }
    FILE *stream = fopen(path, mode);
    if (!stream) {
        gm_refuse(message, "%.360s could not be written: %s", path, strerror(errno));
    }
    return stream;
}

/* Returns false with errno; `why`: the errno of an earlier failed write, or 0. */
static bool close_csv(FILE *csv, int why)
{
    const bool failed = ferror(csv) != 0, closed = csv == stdout || fclose(csv) == 0;
    errno = failed && why != 0 ? why : errno;
    return closed && !failed;
}

static FILE *open_csv(const char *path, const struct gm_request *request, const struct gm_chosen *chosen,
                      char *message)
{
    FILE *csv = open_stream(path, "w", message);
    if (!csv) {
        return NULL;
    }
    char *names = front_of(request, 0, GM_ROW_HEAD);
    if (!names) { /* rows need their head */
        gm_refuse(message, "not enough memory");
        close_csv(csv, 0);
        return NULL;
    }
    fprintf(csv, "%s,t,status", names);
    for (size_t i = 0; i < chosen->count; i++) {
        fprintf(csv, ",%s", gm_scene_observable_at(request->scene, chosen->numbers[i])->key);
    }
    fputc('\n', csv);
    free(names);
    return csv;
}

/* The profiles of a lane's final state; the first lane writes the columns' names. */
static bool write_profile(const char *path, const struct outcome *outcome, char *message)
{
    const struct gm_lane *lane = outcome->drive.lane;
    const bool first = outcome->drive.index == 0;
    FILE *stream = open_stream(path, first ? "w" : "a", message);
    if (!stream) {
        return false;
    }
    char *names = front_of(outcome->drive.request, 0, GM_ROW_HEAD), *front = NULL;
    bool told = names && asprintf(&front, "%s,%.17g", outcome->front, lane->run->t) >= 0;
    if (told && first) {
        fprintf(stream, "%s,t,", names);
        if (lane->scene->profile) {
            fputs(GM_PROFILE_COLUMNS, stream);
        } else {
            gm_profile_columns(lane->run, stream);
        }
        fputc('\n', stream);
    }
    if (told && lane->scene->profile) {
        const struct gm_view view = gm_lane_view(lane);
        lane->scene->profile(&view, front, stream);
    } else if (told) {
        told = gm_profile_write(lane->run, front, stream);
    }
    free(front);
    free(names);
    if (!close_csv(stream, 0) || !told) {
        return gm_refuse(message, "%.360s could not be written: %s", path,
                         told ? strerror(errno) : "not enough memory");
    }
    return true;
}

static void tell(const struct outcome *outcome, const struct gm_options *options)
{
    struct outputs *outputs = outcome->outputs;
    char sentence[GM_MESSAGE], message[GM_MESSAGE];
    const char *status = tell_end(outcome, sentence, sizeof sentence);
    if (options->json) {
        print_json(outcome, options);
    } else if (!is_standard_output(options->csv) && !is_standard_output(options->profile)) {
        print_text(outcome);
    } else if (sentence[0] && !ferror(stdout)) {
        gm_complain("%s: %s: %s", outcome->drive.lane->scheme->name, status, sentence);
    }
    if (options->profile && !outputs->unprofiled) {
        outputs->unprofiled = !write_profile(options->profile, outcome, message);
        if (outputs->unprofiled && !is_standard_output(options->profile)) {
            gm_complain("%s", message); /* faults of standard output are reported at the end */
        }
    }
}

/* Standard output goes to one reader. */
static void check_options(const struct gm_options *options)
{
    gm_command_end_if(options, options->state && !options->json, GM_EXIT_USAGE, "--state needs --json");
    gm_command_end_if(
        options,
        is_standard_output(options->csv) + is_standard_output(options->profile) + (options->json != 0) > 1,
        GM_EXIT_USAGE, "standard output takes one of --csv -, --profile - and --json");
    gm_command_end_if(
        options, (options->pace.every > 0 || !isnan(options->interval)) && !options->csv && !options->save,
        GM_EXIT_USAGE, "--%s selects the steps that have a row: it needs --csv or --save",
        options->pace.every > 0 ? "every" : "interval");
}

/* Returns true if the scene has its own profiles, or its states have nodes on a line. */
static bool has_profile(const struct gm_request *request)
{
    char message[GM_MESSAGE];
    struct gm_lane *lane = request->scene->profile ? NULL : gm_request_open_lane(request, 0, message);
    const bool has = request->scene->profile || !lane || gm_profile_is_there(lane->run);
    gm_lane_close(lane);
    return has; /* a lane that cannot be opened gives its reason later */
}

/* Returns true if a checkpoint can resume these lanes; else false with a sentence. */
static bool can_pause(const struct gm_request *request, char *message)
{
    if (gm_checkpoint_fits(request)) {
        return true;
    }
    for (size_t i = 0; i < request->count; i++) {
        if (request->lanes[i].scheme->family->not_resumable) { /* its library does not give its state */
            return gm_refuse(message, "a run with %s cannot be resumed from a checkpoint",
                             request->lanes[i].scheme->name);
        }
    }
    return gm_refuse(message, "a run with changes cannot be resumed from a checkpoint");
}

/* Opens the requested files. Returns the exit status, with a sentence unless it is 0. */
static int open_outputs(struct outputs *outputs, const struct gm_request *request, char *message)
{
    const struct gm_options *options = outputs->options;
    const bool pauses = options->checkpoint || options->from_checkpoint;
    if (!gm_chosen_open(&outputs->chosen, request->scene, options->measure, message) ||
        (options->profile && !has_profile(request) &&
         !gm_refuse(message, "scene %s has no profiles", request->scene->name)) ||
        (options->save && !gm_save_fits(options->save, request, message)) ||
        (pauses && !can_pause(request, message)) ||
        (options->tracks && !gm_tracks_knows(options->tracks, request->scene, message))) {
        return GM_EXIT_USAGE;
    }
    const size_t numbers = options->maximum ? outputs->chosen.count : 0;
    const bool opened =
        (!pauses || (outputs->pause = gm_pause_open(request, numbers, options->from_checkpoint, message))) &&
        (!options->checkpoint || (gm_folder_make_for(options->checkpoint, message) &&
                                  gm_temporary_can_replace(options->checkpoint, message))) &&
        (!options->csv || (outputs->csv = open_csv(options->csv, request, &outputs->chosen, message))) &&
        (!options->tracks || (outputs->tracks = gm_tracks_open(options->tracks, request->count, message))) &&
        (!options->save ||
         (outputs->save = gm_save_open(options->save, request->count, gm_pause_has_rows(outputs->pause),
                                       outputs->pause != NULL, message)));
    return opened ? GM_EXIT_OK : GM_EXIT_FILE;
}

/* Finishes the opened files and reports each one; returns the exit status. */
static int close_outputs(struct outputs *outputs, bool opened, int status)
{
    char history[GM_MESSAGE] = "", states[GM_MESSAGE] = "", tracks[GM_MESSAGE] = "";
    const struct gm_options *options = outputs->options;
    const bool complete = opened && status != GM_EXIT_FILE;
    /* the files of a resumable run are protected from mistakes */
    const bool keeps = options->checkpoint || (options->from_checkpoint && !complete);
    if (outputs->csv && !close_csv(outputs->csv, outputs->csv_why) && outputs->csv != stdout) {
        gm_refuse(history, "%.360s could not be written: %s", options->csv, strerror(errno));
    }
    if (outputs->save) {
        gm_save_close(outputs->save, complete, keeps, states);
    }
    if (outputs->tracks) {
        gm_tracks_close(outputs->tracks, complete && !outputs->untracked, tracks);
    }
    gm_pause_close(outputs->pause);
    gm_chosen_close(&outputs->chosen);
    const struct {
        const char *path, *why;
        bool failed; /* true if its failure was reported at once */
    } files[] = {{options->csv, history, false},
                 {options->profile, "", outputs->unprofiled},
                 {options->save, states, false},
                 {options->tracks, tracks, outputs->untracked},
                 {options->checkpoint, "", outputs->unkept}};
    for (size_t i = 0; i < GM_COUNT(files); i++) {
        if (files[i].why[0]) {
            gm_complain("%s", files[i].why);
        } else if (complete && files[i].path && !files[i].failed && !is_standard_output(files[i].path)) {
            gm_complain("wrote %s", files[i].path);
        }
        status = files[i].why[0] || files[i].failed ? GM_EXIT_FILE : status;
    }
    return status;
}

/* Opens and runs lane `index` and reports its result; returns the exit status. */
static int make_lane(struct outputs *outputs, const struct gm_request *request, size_t index)
{
    char message[GM_MESSAGE];
    const struct gm_options *options = outputs->options;
    const size_t observables = outputs->chosen.count;
    struct gm_lane *lane = gm_request_open_lane(request, index, message);
    struct outcome outcome = {
        .drive = {.lane = lane,
                  .request = request,
                  .index = index,
                  .whole_steps = gm_chosen_follows_steps(&outputs->chosen, request->scene)},
        .front = lane ? front_of(request, index, GM_ROW_CSV) : NULL,
        .values = malloc(2 * observables * sizeof(double)),
        .outputs = outputs};
    int status = GM_EXIT_OK;
    const bool ready = outcome.front && outcome.values;
    if (lane && options->checkpoint && lane->scheme->family->adaptive) {
        outcome.drive.whole_steps = true; /* a later end is reached by the same steps */
    }
    if (lane) { /* sections and paths are for files that hold them */
        lane->unfollowed = !outputs->tracks && !options->checkpoint && !has_portrait(lane) &&
                           gm_chosen_are_of_the_end(&outputs->chosen, request->scene);
    }
    if (lane) {
        gm_command_note(lane, outputs->note);
    }
    outcome.maxima = ready && options->maximum ? outcome.values + observables : NULL;
    for (size_t k = 0; outcome.maxima && k < observables; k++) {
        outcome.maxima[k] = NAN;
    }
    if (!ready) {
        status = gm_give_up(GM_EXIT_USAGE, "%s", lane ? "not enough memory" : message);
    } else if (!run_lane(&outcome, request->lanes[index].steps, message)) {
        if (outputs->save && gm_save_is_cut(outputs->save)) {
            end_cut(&outcome);
            observe(&outcome);
            tell(&outcome, options);
        } else {
            gm_complain("%s", message);
        }
        status = GM_EXIT_FILE;
    } else {
        observe(&outcome);
        tell(&outcome, options);
        if (outputs->tracks && !outputs->untracked && !save_tracks(&outcome, message)) {
            gm_complain("%s", message);
            outputs->untracked = true;
        }
        const bool doubtful = options->strict && outcome.warning[0] != '\0';
        if (lane->run->status != GM_OK || doubtful) {
            status = lane->run->status == GM_OUT_OF_MEMORY ? GM_EXIT_MEMORY : GM_EXIT_NUMERICAL;
        }
    }
    free(outcome.front);
    free(outcome.meta);
    free(outcome.values);
    gm_lane_close(lane);
    return status;
}

int gm_command_run(const struct gm_options *options)
{
    char message[GM_MESSAGE];
    check_options(options);
    struct gm_request *request =
        gm_command_parse(options, options->arguments.count, options->arguments.words, GM_RUN_SCHEMES);
    gm_command_confirm(options, request);
    gm_catch_interrupts();
    struct outputs outputs = {.options = options,
                              .rows = {.every = options->pace.every, .interval = options->interval}};
    int status = open_outputs(&outputs, request, message);
    const bool opened = status == GM_EXIT_OK;
    if (!opened) {
        gm_complain("%s", message);
    }
    for (size_t i = 0;
         i < request->count && opened && status != GM_EXIT_FILE && !gm_interrupted && !is_in_vain(&outputs);
         i++) {
        const int lane = make_lane(&outputs, request, i);
        status = lane == GM_EXIT_FILE || lane == GM_EXIT_USAGE || status == GM_EXIT_OK ? lane : status;
    }
    status = close_outputs(&outputs, opened, status);
    errno = outputs.csv_why != 0 ? outputs.csv_why : errno;
    return gm_interrupted ? GM_EXIT_INTERRUPTED : status;
}
