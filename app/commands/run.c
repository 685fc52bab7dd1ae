/* SPDX-License-Identifier: GPL-3.0-or-later */
/* geomint run: numbers, no pictures. */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/commands/commands.h"
#include "app/output/folder.h"
#include "app/output/json.h"
#include "app/request/drive.h"
#include "core/memory.h"

struct outcome {
    struct gm_drive drive;
    double *values;            /* one per observable, at the end */
    double *maxima;            /* one per observable, of largest magnitude; NULL without --max */
    char *front;               /* "scene,lane,scheme" and the keys that differ: how a row of CSV begins */
    bool interrupted;          /* before it came to its end */
    char warning[GM_SENTENCE]; /* what is wrong with an end that is called well; "" for nothing */
};

/* Looks at the lane's end. Where there is no memory for that the lane says so, and the number is not one. */
static void observe(struct outcome *outcome)
{
    struct gm_lane *lane = outcome->drive.lane;
    const unsigned long refusals = gm_memory_refusals();
    for (size_t i = 0; i < lane->scene->observable_count; i++) {
        outcome->values[i] = gm_lane_observe(lane, i);
    }
    if (!outcome->interrupted) {
        gm_drive_warning(&outcome->drive, outcome->warning, sizeof outcome->warning);
    }
    if (gm_memory_refusals() != refusals) {
        lane->run->status = GM_OUT_OF_MEMORY;
    }
}

/* How it ended, and a sentence on that, or none. */
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

static void print_json_parameters(const struct gm_lane *lane)
{
    const struct gm_scene *scene = lane->scene;
    char text[GM_TEXT_SIZE];
    printf("\"parameters\":{");
    for (size_t i = 0; i < scene->parameter_count; i++) {
        const struct gm_parameter *row = &scene->parameters[i];
        if (gm_scene_idle(scene, lane->parameters, row->key)) {
            continue;
        }
        printf("%s\"%s\":", i ? "," : "", row->key); /* the first, the step, always has an effect */
        if (row->type == GM_TEXT) {
            gm_json_text(gm_parameter_format(row, lane->parameters, text, sizeof text));
        } else if (row->type == GM_CHOICE || row->type == GM_BOOLEAN) {
            printf("\"%s\"", gm_parameter_format(row, lane->parameters, text, sizeof text));
        } else {
            gm_json_number(gm_parameter_get(row, lane->parameters));
        }
    }
    for (const struct gm_parameter *const *row = lane->scheme->family->parameters; row && *row; row++) {
        printf(",\"%s\":\"%s\"", (*row)->key, gm_parameter_format(*row, &lane->settings, text, sizeof text));
    }
    printf("}");
}

/* Why values are null, where any is. */
static void print_json_reasons(const struct outcome *outcome)
{
    const struct gm_scene *scene = outcome->drive.lane->scene;
    const char *front = ",\"reasons\":{";
    for (size_t i = 0; i < scene->observable_count; i++) {
        const struct gm_observable *observable = &scene->observables[i];
        if (observable->missing && isnan(outcome->values[i])) {
            fputs(front, stdout);
            gm_json_pair(observable->key, observable->missing);
            front = ",";
        }
    }
    fputs(front[1] ? "" : "}", stdout);
}

static void print_json(const struct outcome *outcome, const struct gm_options *options)
{
    const struct gm_lane *lane = outcome->drive.lane;
    const struct gm_run *run = lane->run;
    char sentence[GM_SENTENCE];
    const char *status = tell_end(outcome, sentence, sizeof sentence);
    printf("{\"scene\":\"%s\",\"scheme\":\"%s\",", lane->scene->name, lane->scheme->name);
    print_json_parameters(lane);
    printf(",\"status\":\"%s\",\"message\":\"%s\",\"warning\":\"%s\",\"t\":", status, sentence,
           outcome->warning);
    gm_json_number(run->t);
    printf(",\"steps\":%ld,\"evaluations\":%.0f,\"solves\":%.0f,\"seconds\":%.6g,\"observables\":{",
           run->steps, gm_run_per_member(run, run->evaluations), gm_run_per_member(run, run->solves),
           outcome->drive.seconds);
    for (size_t i = 0; i < lane->scene->observable_count; i++) {
        printf("%s\"%s\":", i ? "," : "", lane->scene->observables[i].key);
        gm_json_number(outcome->values[i]);
    }
    for (size_t i = 0; outcome->maxima && i < lane->scene->observable_count; i++) {
        printf(",\"%s_max\":", lane->scene->observables[i].key);
        gm_json_number(outcome->maxima[i]);
    }
    printf("}");
    print_json_reasons(outcome);
    if (options->state) {
        const double *y = gm_run_state(run);
        printf(",\"layout\":\"y[component * m + member], n = %zu components, m = %zu members\",\"state\":[",
               lane->problem.n, lane->problem.m);
        for (size_t i = 0; i < lane->problem.n * lane->problem.m; i++) {
            fputs(i ? "," : "", stdout);
            gm_json_number(y[i]); /* null: a tracer that was lost */
        }
        printf("]");
    }
    printf("}\n");
}

static void print_text(const struct outcome *outcome)
{
    const struct gm_lane *lane = outcome->drive.lane;
    const struct gm_run *run = lane->run;
    const struct gm_shown *shown = &lane->shown;
    gm_say("%s  %s%s%s%s%s", lane->scene->name, lane->scheme->name, shown->panel_name[0] ? "  " : "",
           shown->panel_name, shown->colour_name[0] ? "  " : "", shown->colour_name);
    int width = 0; /* of the names */
    for (size_t i = 0; i < lane->scene->observable_count; i++) {
        const int length = (int)strlen(lane->scene->observables[i].key) + (outcome->maxima ? 4 : 0);
        width = length > width ? length : width;
    }
    width = width > 20 ? width : 20;
    char sentence[GM_SENTENCE];
    printf("  %-*s %s%s\n", width, "status", tell_end(outcome, sentence, sizeof sentence),
           outcome->warning[0] ? " (with a warning)" : "");
    if (outcome->warning[0]) {
        printf("  %-*s %s\n", width, "warning", outcome->warning);
    }
    if (sentence[0]) {
        printf("  %-*s %s\n", width, "message", sentence);
    }
    printf("  %-*s %.10g\n  %-*s %ld\n  %-*s %.0f\n  %-*s %.0f\n  %-*s %.3g\n", width, "t", run->t, width,
           "steps", run->steps, width, "evaluations", gm_run_per_member(run, run->evaluations), width,
           "solves", gm_run_per_member(run, run->solves), width, "seconds", outcome->drive.seconds);
    for (size_t i = 0; i < lane->scene->observable_count; i++) {
        const struct gm_observable *observable = &lane->scene->observables[i];
        if (observable->missing && isnan(outcome->values[i])) {
            printf("  %-*s none: %s\n", width, observable->key, observable->missing);
        } else {
            printf("  %-*s %.10g\n", width, observable->key, outcome->values[i]);
        }
    }
    char name[64];
    for (size_t i = 0; outcome->maxima && i < lane->scene->observable_count; i++) {
        snprintf(name, sizeof name, "%s_max", lane->scene->observables[i].key);
        const bool none = lane->scene->observables[i].missing && isnan(outcome->maxima[i]);
        printf(none ? "  %-*s none\n" : "  %-*s %.10g\n", width, name, outcome->maxima[i]);
    }
}

/* Whether not all lanes have the same value of a parameter: of the scene, or one that schemes bring. */
static bool differs(const struct gm_request *request, const struct gm_parameter *row, bool own)
{
    char first[GM_TEXT_SIZE], other[GM_TEXT_SIZE];
    const struct gm_lane_spec *lanes = request->lanes;
    gm_parameter_format(row, own ? lanes[0].parameters : &lanes[0].settings, first, sizeof first);
    for (size_t i = 1; i < request->count; i++) {
        gm_parameter_format(row, own ? lanes[i].parameters : &lanes[i].settings, other, sizeof other);
        if (strcmp(first, other) != 0) {
            return true;
        }
    }
    return false;
}

/* A parameter's value as a cell of CSV: a number as such, not as "pi/12". */
static void put_cell(FILE *stream, const struct gm_parameter *row, const void *owner)
{
    char text[GM_TEXT_SIZE];
    if (row->type == GM_REAL || row->type == GM_INTEGER) {
        fprintf(stream, ",%.17g", gm_parameter_get(row, owner));
        return;
    }
    gm_parameter_format(row, owner, text, sizeof text);
    const bool quoted = strpbrk(text, ",\"") != NULL;
    fputs(quoted ? ",\"" : ",", stream);
    for (const char *at = text; *at; at++) {
        fputs(*at == '"' ? "\"" : "", stream);
        fputc(*at, stream);
    }
    fputs(quoted ? "\"" : "", stream);
}

/* How every row of CSV of a lane begins, or, without a lane, the names of these columns; malloc'ed, NULL when
   memory is short. */
static char *front_of(const struct gm_request *request, const struct gm_lane *lane, size_t index)
{
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    if (!stream) {
        return NULL;
    }
    fprintf(stream, lane ? "%s,%zu,%s" : "scene,lane,scheme", request->scene->name, index,
            lane ? lane->scheme->name : "");
    for (size_t own = 2; own-- > 0;) {
        const struct gm_parameter *rows = own ? request->scene->parameters : gm_settings_parameters;
        const size_t count = own ? request->scene->parameter_count : gm_settings_parameter_count;
        for (size_t i = 0; i < count; i++) {
            if (!differs(request, &rows[i], own)) {
                continue;
            }
            if (!lane) {
                fprintf(stream, ",%s", rows[i].key);
            } else if (own || gm_scheme_takes(lane->scheme, &rows[i])) {
                put_cell(stream, &rows[i], own ? lane->parameters : &lane->settings);
            } else {
                fputc(',', stream);
            }
        }
    }
    if (fclose(stream) != 0) {
        free(text);
        return NULL;
    }
    return text;
}

static void write_row(FILE *csv, const struct outcome *outcome)
{
    const struct gm_lane *lane = outcome->drive.lane;
    char sentence[GM_SENTENCE];
    fprintf(csv, "%s,%.17g,%s", outcome->front, lane->run->t, tell_end(outcome, sentence, sizeof sentence));
    for (size_t i = 0; i < lane->scene->observable_count; i++) {
        fprintf(csv, ",%.17g", gm_lane_observe(lane, i));
    }
    fputc('\n', csv);
}

static void take_maxima(struct outcome *outcome)
{
    for (size_t i = 0; outcome->maxima && i < outcome->drive.lane->scene->observable_count; i++) {
        const double value = gm_lane_observe(outcome->drive.lane, i);
        if (!(fabs(value) <= fabs(outcome->maxima[i])) && !isnan(value)) { /* the maximum is NaN at first */
            outcome->maxima[i] = value;
        }
    }
}

/* Drives one lane to its end. Looks at every step only where that is asked for. */
static bool drive_lane(struct outcome *outcome, long steps, const struct gm_options *options, FILE *csv,
                       char *message)
{
    struct gm_drive *drive = &outcome->drive;
    const struct gm_run *run = drive->lane->run;
    const long every = outcome->maxima ? 1 : options->every ? options->every : 1;
    const long row = options->every ? options->every : 1;
    if (csv) {
        write_row(csv, outcome);
    }
    take_maxima(outcome);
    if (!csv && !outcome->maxima) {
        return gm_drive_to(drive, steps, false, message);
    }
    while (run->steps < steps && run->status == GM_OK && !gm_interrupted && !gm_drive_is_over(drive)) {
        const long next = run->steps + every < steps ? run->steps + every : steps;
        const long before = run->steps;
        if (!gm_drive_to(drive, next, false, message)) {
            return false;
        }
        if (run->steps == before) {
            break;
        }
        take_maxima(outcome);
        if (csv && run->status == GM_OK && (run->steps % row == 0 || run->steps == steps)) {
            write_row(csv, outcome);
        }
    }
    return true;
}

/* Runs one lane; how it ended, if not well, is the last row of its history. */
static bool run_lane(struct outcome *outcome, long steps, const struct gm_options *options, FILE *csv,
                     char *message)
{
    const struct gm_run *run = outcome->drive.lane->run;
    if (!drive_lane(outcome, steps, options, csv, message)) {
        return false;
    }
    outcome->interrupted =
        gm_interrupted && run->status == GM_OK && run->steps < steps && !gm_drive_is_over(&outcome->drive);
    if (csv && (outcome->interrupted || run->status != GM_OK)) {
        write_row(csv, outcome);
    }
    return true;
}

static bool is_standard_output(const char *path)
{
    return path && strcmp(path, "-") == 0;
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
        snprintf(message, GM_MESSAGE, "%.360s could not be written: %s", path, strerror(errno));
    }
    return stream;
}

static bool close_csv(FILE *csv)
{
    const bool failed = ferror(csv) != 0;
    if (csv == stdout) {
        return !failed;
    }
    return fclose(csv) == 0 && !failed;
}

static FILE *open_csv(const char *path, const struct gm_request *request, char *message)
{
    FILE *csv = open_stream(path, "w", message);
    if (!csv) {
        return NULL;
    }
    char *names = front_of(request, NULL, 0);
    if (!names) { /* rows without a head tell nothing */
        snprintf(message, GM_MESSAGE, "not enough memory");
        close_csv(csv);
        return NULL;
    }
    fprintf(csv, "%s,t,status", names);
    for (size_t i = 0; i < request->scene->observable_count; i++) {
        fprintf(csv, ",%s", request->scene->observables[i].key);
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
    char *names = front_of(outcome->drive.request, NULL, 0), *front = NULL;
    const bool told = names && asprintf(&front, "%s,%.17g", outcome->front, lane->run->t) >= 0;
    if (told && first) {
        fprintf(stream, "%s,t," GM_PROFILE_COLUMNS "\n", names);
    }
    if (told) {
        const struct gm_view view = gm_lane_view(lane);
        lane->scene->profile(&view, front, stream);
        free(front);
    }
    free(names);
    if (!close_csv(stream) || !told) {
        snprintf(message, GM_MESSAGE, "%.360s could not be written: %s", path,
                 told ? strerror(errno) : "not enough memory");
        return false;
    }
    return true;
}

/* What one lane's run has to say, where it is asked for. False with a sentence if a file could not be
 * written. */
static bool tell(const struct outcome *outcome, const struct gm_options *options, char *message)
{
    char sentence[GM_SENTENCE];
    const char *status = tell_end(outcome, sentence, sizeof sentence);
    if (options->json) {
        print_json(outcome, options);
    } else if (!is_standard_output(options->csv) && !is_standard_output(options->profile)) {
        print_text(outcome);
    } else if (sentence[0] && !ferror(stdout)) {
        gm_complain("%s: %s: %s", outcome->drive.lane->scheme->name, status, sentence);
    }
    return !options->profile || write_profile(options->profile, outcome, message);
}

/* Standard output goes to one reader. */
static bool check_options(const struct gm_options *options)
{
    if (options->state && !options->json) {
        gm_complain("--state needs --json");
        return false;
    }
    if (is_standard_output(options->csv) + is_standard_output(options->profile) + (options->json != 0) > 1) {
        gm_complain("standard output takes one of --csv -, --profile - and --json");
        return false;
    }
    return true;
}

static void tell_written(const char *path)
{
    if (path && !is_standard_output(path)) {
        gm_complain("wrote %s", path);
    }
}

static int command_run(const struct gm_options *options)
{
    char message[GM_MESSAGE];
    struct gm_request request;
    if (!check_options(options)) {
        return GM_EXIT_USAGE;
    }
    if (!gm_request_parse(&request, options->arguments.count, options->arguments.words, GM_RUN_SCHEMES,
                          message)) {
        gm_complain("%s", message);
        return gm_request_refusal(&request);
    }
    if (options->profile && !request.scene->profile) {
        gm_complain("scene %s has no profiles", request.scene->name);
        gm_request_close(&request);
        return GM_EXIT_USAGE;
    }
    gm_catch_interrupts();
    FILE *csv = NULL;
    int status = GM_EXIT_OK;
    if (options->csv && !(csv = open_csv(options->csv, &request, message))) {
        gm_complain("%s", message);
        status = GM_EXIT_FILE;
    }
    for (size_t i = 0; i < request.count && status != GM_EXIT_FILE && !gm_interrupted; i++) {
        struct outcome outcome = {.drive = {.request = &request, .index = i}};
        const size_t observables = request.scene->observable_count;
        outcome.drive.lane = gm_request_open_lane(&request, i, message);
        outcome.front = outcome.drive.lane ? front_of(&request, outcome.drive.lane, i) : NULL;
        outcome.values = malloc(2 * observables * sizeof(double));
        const bool good = outcome.front && outcome.values;
        if (outcome.drive.lane && !good) {
            snprintf(message, sizeof message, "not enough memory");
        }
        if (good && options->maximum) {
            outcome.maxima = outcome.values + observables;
            for (size_t k = 0; k < observables; k++) {
                outcome.maxima[k] = NAN;
            }
        }
        if (!good || !run_lane(&outcome, request.lanes[i].steps, options, csv, message)) {
            gm_complain("%s", message);
            status = GM_EXIT_USAGE;
        } else {
            observe(&outcome);
            if (!tell(&outcome, options, message)) {
                gm_complain("%s", message);
                status = GM_EXIT_FILE;
            }
            const bool doubtful = options->strict && outcome.warning[0] != '\0';
            if ((outcome.drive.lane->run->status != GM_OK || doubtful) && status == GM_EXIT_OK) {
                status =
                    outcome.drive.lane->run->status == GM_OUT_OF_MEMORY ? GM_EXIT_MEMORY : GM_EXIT_NUMERICAL;
            }
        }
        free(outcome.front);
        free(outcome.values);
        gm_lane_close(outcome.drive.lane);
        if (csv && ferror(csv)) {
            break;
        }
    }
    if (csv && !close_csv(csv) && csv != stdout) {
        gm_complain("%s could not be written: %s", options->csv, strerror(errno));
        status = GM_EXIT_FILE;
    }
    if (status != GM_EXIT_FILE && status != GM_EXIT_USAGE) {
        tell_written(options->csv);
        tell_written(options->profile);
    }
    gm_request_close(&request);
    return gm_finish(gm_interrupted ? GM_EXIT_INTERRUPTED : status);
}

const struct gm_command_row gm_command_run = {
    .name = "run",
    .synopsis = "SCENE [key=value ...]",
    .help = "numbers",
    .bit = GM_RUN,
    .function = command_run,
};
