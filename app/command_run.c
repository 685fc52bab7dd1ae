/* SPDX-License-Identifier: GPL-3.0-or-later */
/* geomint run: numbers, no pictures. */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/commands.h"
#include "app/drive.h"
#include "app/json.h"

struct outcome {
    struct gm_drive drive;
    double *maxima; /* one per observable; NULL without --max */
};

static void print_json_parameters(const struct gm_lane *lane)
{
    const struct gm_scene *scene = lane->scene;
    char text[GM_TEXT_SIZE];
    printf("\"parameters\":{");
    for (size_t i = 0; i < scene->parameter_count; i++) {
        const struct gm_parameter *row = &scene->parameters[i];
        printf("%s\"%s\":", i ? "," : "", row->key);
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

static void print_json(const struct outcome *outcome, const struct gm_options *options)
{
    const struct gm_lane *lane = outcome->drive.lane;
    const struct gm_run *run = lane->run;
    char sentence[GM_SENTENCE];
    gm_failure_sentence(lane, sentence, sizeof sentence);
    printf("{\"scene\":\"%s\",\"scheme\":\"%s\",", lane->scene->name, lane->scheme->name);
    print_json_parameters(lane);
    printf(",\"status\":\"%s\",\"message\":\"%s\",\"t\":", gm_status_name(run->status), sentence);
    gm_json_number(run->t);
    printf(",\"steps\":%ld,\"evaluations\":%.0f,\"solves\":%.0f,\"seconds\":%.6g,\"observables\":{",
           run->steps, gm_run_per_member(run, run->evaluations), gm_run_per_member(run, run->solves),
           outcome->drive.seconds);
    for (size_t i = 0; i < lane->scene->observable_count; i++) {
        printf("%s\"%s\":", i ? "," : "", lane->scene->observables[i].key);
        gm_json_number(gm_lane_observe(lane, i));
    }
    for (size_t i = 0; outcome->maxima && i < lane->scene->observable_count; i++) {
        printf(",\"%s_max\":", lane->scene->observables[i].key);
        gm_json_number(outcome->maxima[i]);
    }
    printf("}");
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
    printf("%s  %s%s%s%s%s\n", lane->scene->name, lane->scheme->name, shown->panel_name[0] ? "  " : "",
           shown->panel_name, shown->colour_name[0] ? "  " : "", shown->colour_name);
    int width = 0; /* of the names */
    for (size_t i = 0; i < lane->scene->observable_count; i++) {
        const int length = (int)strlen(lane->scene->observables[i].key) + (outcome->maxima ? 4 : 0);
        width = length > width ? length : width;
    }
    width = width > 20 ? width : 20;
    printf("  %-*s %s\n", width, "status", gm_status_name(run->status));
    char sentence[GM_SENTENCE];
    gm_failure_sentence(lane, sentence, sizeof sentence);
    if (sentence[0]) {
        printf("  %-*s %s\n", width, "message", sentence);
    }
    printf("  %-*s %.10g\n  %-*s %ld\n  %-*s %.0f\n  %-*s %.0f\n  %-*s %.3g\n", width, "t", run->t, width,
           "steps", run->steps, width, "evaluations", gm_run_per_member(run, run->evaluations), width,
           "solves", gm_run_per_member(run, run->solves), width, "seconds", outcome->drive.seconds);
    for (size_t i = 0; i < lane->scene->observable_count; i++) {
        printf("  %-*s %.10g\n", width, lane->scene->observables[i].key, gm_lane_observe(lane, i));
    }
    char name[64];
    for (size_t i = 0; outcome->maxima && i < lane->scene->observable_count; i++) {
        snprintf(name, sizeof name, "%s_max", lane->scene->observables[i].key);
        printf("  %-*s %.10g\n", width, name, outcome->maxima[i]);
    }
}

static void write_row(FILE *csv, const struct gm_lane *lane, size_t index)
{
    fprintf(csv, "%s,%zu,%s,%.17g", lane->scene->name, index, lane->scheme->name, lane->run->t);
    for (size_t i = 0; i < lane->scene->observable_count; i++) {
        fprintf(csv, ",%.17g", gm_lane_observe(lane, i));
    }
    fputc('\n', csv);
}

static void take_maxima(struct outcome *outcome)
{
    for (size_t i = 0; outcome->maxima && i < outcome->drive.lane->scene->observable_count; i++) {
        outcome->maxima[i] = fmax(outcome->maxima[i], gm_lane_observe(outcome->drive.lane, i));
    }
}

/* Runs one lane to its end. Looks at every step only where that is asked for. */
static bool run_lane(struct outcome *outcome, long steps, const struct gm_options *options, FILE *csv,
                     char *message)
{
    struct gm_drive *drive = &outcome->drive;
    const struct gm_run *run = drive->lane->run;
    const long every = outcome->maxima ? 1 : options->every ? options->every : 1;
    const long row = options->every ? options->every : 1;
    if (csv) {
        write_row(csv, drive->lane, drive->index);
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
        if (csv && (run->steps % row == 0 || run->steps == steps || run->status != GM_OK)) {
            write_row(csv, drive->lane, drive->index);
        }
    }
    return true;
}

static FILE *open_csv(const char *path, const struct gm_scene *scene)
{
    FILE *csv = strcmp(path, "-") == 0 ? stdout : fopen(path, "w");
    if (!csv) {
        return NULL;
    }
    fputs("scene,lane,scheme,t", csv);
    for (size_t i = 0; i < scene->observable_count; i++) {
        fprintf(csv, ",%s", scene->observables[i].key);
    }
    fputc('\n', csv);
    return csv;
}

static bool close_csv(FILE *csv)
{
    const bool failed = ferror(csv) != 0;
    if (csv == stdout) {
        return !failed;
    }
    return fclose(csv) == 0 && !failed;
}

/* The profiles of a lane's final state; the first lane writes the columns' names. */
static bool write_profile(const char *path, const struct gm_lane *lane, size_t index)
{
    FILE *stream = strcmp(path, "-") == 0 ? stdout : fopen(path, index == 0 ? "w" : "a");
    if (!stream) {
        return false;
    }
    char front[256];
    snprintf(front, sizeof front, "%s,%zu,%s,%.17g", lane->scene->name, index, lane->scheme->name,
             lane->run->t);
    if (index == 0) {
        fputs("scene,lane,scheme,t," GM_PROFILE_COLUMNS "\n", stream);
    }
    const struct gm_view view = gm_lane_view(lane);
    lane->scene->profile(&view, front, stream);
    return close_csv(stream);
}

int gm_command_run(const struct gm_options *options)
{
    char message[GM_MESSAGE];
    struct gm_request request;
    if (options->state && !options->json) {
        gm_complain("--state needs --json");
        return GM_EXIT_USAGE;
    }
    if (!gm_request_parse(&request, options->word_count, options->words, 1, message)) {
        gm_complain("%s", message);
        return GM_EXIT_USAGE;
    }
    if (options->profile && !request.scene->profile) {
        gm_complain("scene %s has no profiles", request.scene->name);
        gm_request_close(&request);
        return GM_EXIT_USAGE;
    }
    gm_catch_interrupts();
    FILE *csv = NULL;
    int status = GM_EXIT_OK;
    if (options->csv && !(csv = open_csv(options->csv, request.scene))) {
        gm_complain("%s could not be written: %s", options->csv, strerror(errno));
        status = GM_EXIT_FILE;
    }
    for (size_t i = 0; i < request.count && status != GM_EXIT_FILE && !gm_interrupted; i++) {
        struct outcome outcome = {.drive = {.request = &request, .index = i}};
        outcome.drive.lane = gm_request_open_lane(&request, i, message);
        if (outcome.drive.lane && options->maximum) {
            outcome.maxima = malloc(request.scene->observable_count * sizeof(double));
            for (size_t k = 0; outcome.maxima && k < request.scene->observable_count; k++) {
                outcome.maxima[k] = NAN; /* fmax passes over it */
            }
        }
        if (!outcome.drive.lane || !run_lane(&outcome, request.lanes[i].steps, options, csv, message)) {
            gm_complain("%s", message);
            status = GM_EXIT_USAGE;
        } else {
            if (options->json) {
                print_json(&outcome, options);
            } else {
                print_text(&outcome);
            }
            if (options->profile && !write_profile(options->profile, outcome.drive.lane, i)) {
                gm_complain("%s could not be written: %s", options->profile, strerror(errno));
                status = GM_EXIT_FILE;
            }
            if (outcome.drive.lane->run->status != GM_OK && status == GM_EXIT_OK) {
                status = GM_EXIT_NUMERICAL;
            }
        }
        free(outcome.maxima);
        gm_lane_close(outcome.drive.lane);
        if (csv && ferror(csv)) {
            break;
        }
    }
    if (csv && !close_csv(csv) && csv != stdout) {
        gm_complain("%s could not be written: %s", options->csv, strerror(errno));
        status = GM_EXIT_FILE;
    }
    gm_request_close(&request);
    return gm_finish(gm_interrupted ? GM_EXIT_INTERRUPTED : status);
}
