/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Backward error: runs of each scheme with each step, looked at now and then. */
#include "app/grid/backward.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/output/csv.h"
#include "app/words/drive.h"
#include "app/words/fitting.h"
#include "app/words/words.h"

enum { LOOKS = 400 /* at a run, at most */ };

/* Below this an error is rounding's. */
static const double above_roundoff = 1e-12;

static double dt_of(const struct gm_lane_spec *spec)
{
    return ((const struct gm_timing *)spec->parameters)->dt;
}

/* Its place among the schemes that the scene prefers; behind them all where it is none. */
static size_t rank_of(const struct gm_scene *scene, const struct gm_scheme *scheme)
{
    size_t rank = 0;
    while (scene->schemes[rank] && strcmp(scene->schemes[rank], scheme->name) != 0) {
        rank++;
    }
    return rank;
}

/* What is usual: how long work-precision runs, five steps around the scene's own, and the first scheme that
   has something to be told of. */
static bool usual_words(const struct gm_scene *scene, char *text, size_t size)
{
    const struct gm_scheme *schemes[GM_FITTING_SCHEMES];
    const size_t count = gm_fitting_schemes(scene, schemes);
    const struct gm_timing *timing = gm_scene_defaults(scene);
    if (!timing) {
        return false;
    }
    const struct gm_scheme *usual = NULL;
    size_t best = SIZE_MAX;
    for (size_t i = 0; i < count; i++) {
        const size_t rank = rank_of(scene, schemes[i]);
        if (rank < best && (schemes[i]->claims & GM_SYMPLECTIC) && schemes[i]->family->coefficients_open) {
            best = rank;
            usual = schemes[i];
        }
    }
    const double dt = timing->dt;
    snprintf(text, size, "%s dt=%.17g,%.17g,%.17g,%.17g,%.17g%s%s", scene->work ? scene->work->arguments : "",
             2 * dt, dt, dt / 2, dt / 4, dt / 8, usual ? " scheme=" : "", usual ? usual->name : "");
    free((void *)timing);
    return true;
}

static struct gm_backward_line *line_of(struct gm_backward_table *table, const struct gm_scheme *scheme)
{
    size_t i = 0;
    while (i < table->count && table->lines[i].scheme != scheme) {
        i++;
    }
    return &table->lines[i];
}

/* A point for every lane, at the scheme's line by falling dt; false where two lanes have the same of both. */
static bool place_points(struct gm_backward_table *table, char *message)
{
    const struct gm_request *request = &table->request;
    for (size_t i = 0; i < request->count; i++) {
        struct gm_backward_line *line = line_of(table, request->lanes[i].scheme);
        if (line == &table->lines[table->count]) {
            table->count++;
            line->scheme = request->lanes[i].scheme;
            line->points = calloc(request->count, sizeof *line->points);
            if (!line->points) {
                return gm_refuse(message, "not enough memory");
            }
        }
        size_t at = line->count++;
        const double dt = dt_of(&request->lanes[i]);
        for (; at > 0 && line->points[at - 1].dt <= dt; at--) {
            if (line->points[at - 1].dt == dt) {
                return gm_refuse(message,
                                 "backward compares steps and schemes: only scheme and dt take lists");
            }
            line->points[at] = line->points[at - 1];
        }
        line->points[at] = (struct gm_backward_point){.dt = dt};
    }
    return true;
}

bool gm_backward_open(struct gm_backward_table *table, const struct gm_arguments *arguments, char *message)
{
    *table = (struct gm_backward_table){0};
    if (arguments->count == 0) {
        return gm_refuse(message, "backward error of which scene?");
    }
    const struct gm_scene *scene =
        gm_request_scene(arguments->count, arguments->words, &table->request.refusal, message);
    if (!scene) {
        return false;
    }
    if (!scene->asked_shown) {
        return gm_refuse(message, "scene %s has no modified energy: it has no canonical Hamiltonian",
                         scene->name);
    }
    struct gm_arguments words = {0};
    char usual[512];
    bool good =
        (usual_words(scene, usual, sizeof usual) && gm_words_complete(&words, scene, arguments, usual)) ||
        gm_refuse(message, "not enough memory");
    good = good && gm_request_parse(&table->request, words.count, words.words, 1, message);
    gm_arguments_close(&words);
    if (!good) {
        return false;
    }
    table->lines = calloc(table->request.count + 1, sizeof *table->lines);
    good = (table->lines || gm_refuse(message, "not enough memory")) &&
           gm_request_ends_together(&table->request, message) && place_points(table, message);
    if (!good) {
        gm_backward_close(table);
    }
    return good;
}

void gm_backward_close(struct gm_backward_table *table)
{
    for (size_t i = 0; table->lines && i <= table->count; i++) {
        free(table->lines[i].points);
    }
    free(table->lines);
    gm_request_close(&table->request);
    *table = (struct gm_backward_table){0};
}

/* The terms of H~ in the lane's state, of its last member. */
static void look(const struct gm_lane *lane, struct gm_modified_energy *energy, double *y, double *terms)
{
    const double *state = gm_run_state(lane->run);
    const size_t m = lane->problem.m;
    for (size_t i = 0; i < lane->problem.n; i++) {
        y[i] = state[i * m + m - 1];
    }
    gm_modified_energy_terms(energy, y, terms);
}

/* From the last two terms that are there, |dt^k H_k| = C k! (dt / gamma)^k. */
static double gamma_of(const struct gm_backward_point *point)
{
    int last = GM_MODIFIED_POWER;
    while (last > 0 && !(point->terms[last] > 0)) {
        last--;
    }
    int before = last - 1;
    while (before > 0 && !(point->terms[before] > 0)) {
        before--;
    }
    if (before < 1) {
        return NAN;
    }
    double factorials = 1;
    for (int k = before + 1; k <= last; k++) {
        factorials *= k;
    }
    return point->dt * pow(factorials * point->terms[before] / point->terms[last], 1. / (last - before));
}

/* Runs a lane; `terms` and `y` are scratch. */
static void run(struct gm_lane *lane, int64_t steps, struct gm_modified_energy *energy, double *y,
                const struct gm_listener *listener, struct gm_backward_point *point)
{
    double first[GM_BACKWARD_POWERS], terms[GM_BACKWARD_POWERS];
    const int plain = gm_scene_observable(lane->scene, "energy_error");
    const double divisor = plain >= 0 ? gm_lane_divisor(lane, (size_t)plain) : 1;
    const int64_t looks = steps < LOOKS ? steps : LOOKS;
    const double until = ((const struct gm_timing *)lane->parameters)->until;
    double each = 0;
    look(lane, energy, y, first);
    for (int64_t i = 0; i <= looks && lane->run->status == GM_OK && !gm_listener_stops(listener); i++) {
        if (i > 0) {
            const int64_t step = looks == steps ? i : (int64_t)((double)steps * (double)i / (double)looks);
            while (gm_run_goes_on(lane->run, step, until) && !gm_lane_stopped(lane) &&
                   !gm_listener_stops(listener)) {
                gm_lane_burst(lane, step, until, &each);
            }
            /* by a shorter step, whose H~ is another one; or on the way */
            if (gm_lane_stopped(lane) || gm_listener_stops(listener)) {
                break;
            }
        }
        look(lane, energy, y, terms);
        double difference = 0, power = 1;
        for (int k = 0; k < GM_BACKWARD_POWERS; k++, power *= point->dt) {
            difference += power * (terms[k] - first[k]);
            const double error = fabs(difference) / divisor;
            point->errors[k] = isnan(error) || isnan(point->errors[k]) ? NAN : fmax(point->errors[k], error);
            point->terms[k] = fmax(point->terms[k], fabs(power * terms[k]) / divisor);
        }
    }
    point->status = lane->run->status;
    point->t = lane->run->t;
    for (int k = 1; k < GM_BACKWARD_POWERS; k++) {
        point->best = point->errors[k] < point->errors[point->best] ? k : point->best;
    }
    point->gamma = gamma_of(point);
    point->tried = true;
}

/* The slopes, and which powers there are. */
static void conclude(struct gm_backward_line *line)
{
    line->shown[0] = true;
    for (int k = 0; k < GM_BACKWARD_POWERS; k++) {
        const struct gm_backward_point *fine = NULL, *coarse = NULL;
        for (size_t i = line->count; i-- > 0 && !coarse;) {
            const struct gm_backward_point *point = &line->points[i];
            line->shown[k] |= point->tried && point->terms[k] > 0;
            if (point->tried && point->status == GM_OK && point->errors[k] > above_roundoff) {
                coarse = fine ? point : NULL;
                fine = fine ? fine : point;
            }
        }
        line->orders[k] =
            coarse ? log(coarse->errors[k] / fine->errors[k]) / log(coarse->dt / fine->dt) : NAN;
    }
}

static bool measure_lane(struct gm_backward_table *table, size_t index, const struct gm_listener *listener,
                         char *message)
{
    const struct gm_lane_spec *spec = &table->request.lanes[index];
    struct gm_backward_line *line = line_of(table, spec->scheme);
    struct gm_lane *lane = gm_request_open_lane(&table->request, index, message);
    if (!lane) {
        return false;
    }
    struct gm_backward_point *point = line->points;
    while (point->dt != dt_of(spec)) {
        point++;
    }
    double *y = malloc(lane->problem.n * sizeof *y);
    struct gm_modified_energy *energy =
        gm_modified_energy_open(&lane->problem, spec->scheme, GM_MODIFIED_POWER, line->why);
    const bool good = y && (energy || line->why[0]);
    if (good && energy) {
        run(lane, spec->steps, energy, y, listener, point);
    }
    gm_modified_energy_close(energy);
    free(y);
    gm_lane_close(lane);
    return good || gm_refuse(message, "not enough memory");
}

bool gm_backward_measure(struct gm_backward_table *table, const struct gm_listener *listener, char *message)
{
    for (size_t i = 0; i < table->request.count && !gm_listener_stops(listener); i++) {
        gm_listener_hears(listener, table->request.lanes[i].scheme->name, i, table->request.count);
        if (!measure_lane(table, i, listener, message)) {
            return false;
        }
        conclude(line_of(table, table->request.lanes[i].scheme));
    }
    bool any = false;
    for (size_t i = 0; i < table->count; i++) {
        any |= table->lines[i].why[0] == '\0';
    }
    return any || gm_refuse(message, "%s", table->lines[0].why);
}

bool gm_backward_write(const struct gm_backward_table *table, const char *path)
{
    FILE *csv = fopen(path, "w");
    if (!csv) {
        return false;
    }
    fprintf(csv, "scene,scheme,dt,status,t,power,error,term,gamma\n");
    for (size_t i = 0; i < table->count; i++) {
        const struct gm_backward_line *line = &table->lines[i];
        for (size_t p = 0; p < line->count; p++) {
            const struct gm_backward_point *point = &line->points[p];
            for (int k = 0; point->tried && k < GM_BACKWARD_POWERS; k++) {
                fprintf(csv, "%s,", table->request.scene->name);
                gm_csv_put_text(csv, line->scheme->name);
                fprintf(csv, ",%.17g,%s,%.17g,%d,%.9g,%.9g,", point->dt, gm_status_name(point->status),
                        point->t, k, point->errors[k], point->terms[k]);
                fprintf(csv, isfinite(point->gamma) ? "%.9g\n" : "\n", point->gamma);
            }
        }
    }
    const bool failed = ferror(csv) != 0;
    return fclose(csv) == 0 && !failed;
}
