/* SPDX-License-Identifier: GPL-3.0-or-later */
/* From the words of a command line to the lines and cells of a grid: what all kinds share, and how stability and
   modified energies lay out theirs. */
#include "app/grid/hooks.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/words/fitting.h"
#include "app/words/words.h"
#include "core/expression/number.h"

/* ---- what all kinds share ---- */

struct gm_timing *gm_grid_timing(const struct gm_grid *grid)
{
    return grid->request.lanes[0].parameters;
}

bool gm_axis_open(struct gm_grid_axis *axis, size_t most, char *message)
{
    axis->values = calloc(most + 1, sizeof *axis->values);
    return axis->values || gm_refuse(message, "not enough memory");
}

void gm_axis_add(struct gm_grid_axis *axis, double value)
{
    for (size_t i = 0; i < axis->count; i++) {
        if (axis->values[i] == value) {
            return;
        }
    }
    axis->values[axis->count++] = value;
}

bool gm_grid_lines(struct gm_grid *grid, size_t count, char *message)
{
    grid->lines = calloc(count + 1, sizeof *grid->lines);
    return grid->lines || gm_refuse(message, "not enough memory");
}

struct gm_grid_line *gm_grid_add(struct gm_grid *grid, const struct gm_scheme *scheme, size_t most,
                                 char *message)
{
    struct gm_grid_line *line = &grid->lines[grid->count];
    *line = (struct gm_grid_line){.scheme = scheme, .cells = calloc(most + 1, sizeof *line->cells)};
    if (!line->cells) {
        gm_refuse(message, "not enough memory");
        return NULL;
    }
    grid->count++;
    return line;
}

static bool read_words(struct gm_grid *grid, const struct gm_arguments *typed, struct gm_arguments *words,
                       char *message)
{
    const struct gm_study_row *row = grid->row;
    if (typed->count == 0) {
        return gm_refuse(message, "%s", row->which);
    }
    const struct gm_scene *scene =
        gm_request_scene(typed->count, typed->words, &grid->request.refusal, message);
    if (!scene) {
        return false;
    }
    gm_refuse(message, "not enough memory");
    char *usual = row->usual(scene, message);
    const bool good = usual && gm_words_complete(words, scene, typed, usual);
    free(usual);
    return good && (!row->edit || row->edit(grid, words, message)) &&
           gm_request_parse(&grid->request, words->count, words->words, row->schemes, message);
}

bool gm_cells_open(struct gm_grid *grid, const struct gm_arguments *typed, const char *measure, char *message)
{
    struct gm_arguments words = {0};
    const bool good =
        read_words(grid, typed, &words, message) && grid->row->lay_out(grid, &words, typed, measure, message);
    gm_arguments_close(&words);
    if (!good) {
        const int refusal = grid->request.refusal;
        gm_cells_close(grid);
        grid->request.refusal = refusal;
    }
    return good;
}

void gm_cells_close(struct gm_grid *grid)
{
    for (size_t i = 0; i < grid->count; i++) {
        free(grid->lines[i].cells);
        free(grid->lines[i].credited);
        for (size_t cost = 0; cost < GM_COST_COUNT; cost++) {
            free(grid->lines[i].front[cost]);
        }
    }
    gm_lane_close(grid->finer);
    free(grid->solution);
    free(grid->lines);
    free(grid->steps.values);
    free(grid->values.values);
    gm_request_close(&grid->request);
    *grid = (struct gm_grid){0};
}

/* ---- stability ---- */

char *gm_stability_usual(const struct gm_scene *scene, char *message)
{
    enum { MOST = 6 }; /* of the scene's schemes, where the plan names none */
    if (!scene->stability) {
        gm_refuse(message, "scene %s has no stability map: %s", scene->name,
                  scene->no_stability ? scene->no_stability
                                      : "stability --region SCHEME shows the limit of a scheme");
        return NULL;
    }
    const bool planned = scene->stability->schemes != NULL;
    const char *const *schemes = planned ? scene->stability->schemes : scene->schemes;
    char list[512] = "", *text = NULL;
    for (size_t i = 0; schemes[i] && (planned || i < MOST); i++) {
        const size_t used = strlen(list);
        snprintf(list + used, sizeof list - used, "%s%s", i ? "," : "", schemes[i]);
    }
    return asprintf(&text, "%s scheme=%s", scene->stability->arguments, list) < 0 ? NULL : text;
}

/* "accurate=1e-2"; the parsed scene has to have an error. */
static bool read_judge(struct gm_grid *grid, const char *judge, char *message)
{
    static const char accurate[] = "accurate";
    const size_t length = strlen(accurate);
    grid->accuracy = INFINITY;
    if (!judge || strcmp(judge, "bounded") == 0) {
        return true;
    }
    if (strncmp(judge, accurate, length) != 0 || (judge[length] && judge[length] != '=')) {
        return gm_refuse(message, "--judge %.60s is none of: bounded, accurate, accurate=ERROR", judge);
    }
    grid->accuracy = 0.1;
    if (judge[length] && (!gm_number_parse(judge + length + 1, &grid->accuracy) ||
                          !(grid->accuracy > 0 && grid->accuracy < INFINITY))) {
        return gm_refuse(message, "--judge %.60s needs an error above 0, such as accurate=1e-2", judge);
    }
    return grid->plan->error ||
           gm_refuse(message, "scene %s has no error to be accurate by; take --judge bounded",
                     grid->request.scene->name);
}

bool gm_stability_lay_out(struct gm_grid *grid, const struct gm_arguments *words,
                          const struct gm_arguments *typed, const char *judge, char *message)
{
    (void)words, (void)typed;
    const struct gm_request *request = &grid->request;
    const struct gm_stability *plan = grid->plan = request->scene->stability;
    grid->parameter = gm_scene_parameter(request->scene, plan->parameter);
    bool good = read_judge(grid, judge, message) && gm_axis_open(&grid->steps, plan->step_count, message) &&
                gm_axis_open(&grid->values, plan->value_count, message) &&
                gm_grid_lines(grid, request->count, message);
    for (size_t i = 0; good && i < plan->step_count; i++) {
        gm_axis_add(&grid->steps, plan->steps[i]);
    }
    for (size_t i = 0; good && i < plan->value_count; i++) {
        gm_axis_add(&grid->values, plan->values[i]);
    }
    for (size_t i = 0; good && i < request->count; i++) {
        for (size_t k = 0; k < i; k++) {
            if (request->lanes[k].scheme == request->lanes[i].scheme) {
                return gm_refuse(message, "stability varies dt and %s itself: only scheme takes a list",
                                 plan->parameter);
            }
        }
        struct gm_grid_line *line =
            gm_grid_add(grid, request->lanes[i].scheme, grid->steps.count * grid->values.count, message);
        good = line != NULL;
        for (size_t s = 0; good && s < grid->steps.count; s++) {
            for (size_t v = 0; v < grid->values.count; v++) {
                line->cells[line->count++] = (struct gm_grid_cell){.spec = &request->lanes[i],
                                                                   .step = grid->steps.values[s],
                                                                   .value = grid->values.values[v]};
            }
        }
    }
    grid->begun = grid->count;
    return good;
}

/* ---- modified energies ---- */

/* Its place among the schemes that the scene prefers; behind them all where it is none. */
static size_t rank_of(const struct gm_scene *scene, const struct gm_scheme *scheme)
{
    size_t rank = 0;
    while (scene->schemes[rank] && strcmp(scene->schemes[rank], scheme->name) != 0) {
        rank++;
    }
    return rank;
}

/* How long work-precision runs, five steps around the scene's own, and the first scheme with a modified energy. */
char *gm_backward_usual(const struct gm_scene *scene, char *message)
{
    if (!scene->asked_shown) {
        gm_refuse(message, "scene %s has no modified energy: it has no canonical Hamiltonian", scene->name);
        return NULL;
    }
    const struct gm_scheme *schemes[GM_FITTING_SCHEMES], *usual = NULL;
    const size_t count = gm_fitting_schemes(scene, schemes);
    struct gm_timing *timing = gm_scene_defaults(scene);
    char *text = NULL;
    size_t best = SIZE_MAX;
    for (size_t i = 0; i < count; i++) {
        const size_t rank = rank_of(scene, schemes[i]);
        if (rank < best && (schemes[i]->claims & GM_SYMPLECTIC) && schemes[i]->family->coefficients_open) {
            best = rank;
            usual = schemes[i];
        }
    }
    const double dt = timing ? timing->dt : 0;
    if (timing &&
        asprintf(&text, "%s dt=%.17g,%.17g,%.17g,%.17g,%.17g%s%s", scene->work ? scene->work->arguments : "",
                 2 * dt, dt, dt / 2, dt / 4, dt / 8, usual ? " scheme=" : "", usual ? usual->name : "") < 0) {
        text = NULL;
    }
    free(timing);
    return text;
}

/* A cell for every lane, at the scheme's line by falling dt. */
bool gm_backward_lay_out(struct gm_grid *grid, const struct gm_arguments *words,
                         const struct gm_arguments *typed, const char *measure, char *message)
{
    (void)words, (void)typed, (void)measure;
    const struct gm_request *request = &grid->request;
    if (!gm_request_ends_together(request, message) || !gm_grid_lines(grid, request->count, message)) {
        return false;
    }
    for (size_t i = 0; i < request->count; i++) {
        const struct gm_lane_spec *spec = &request->lanes[i];
        size_t k = 0;
        while (k < grid->count && grid->lines[k].scheme != spec->scheme) {
            k++;
        }
        struct gm_grid_line *line =
            k < grid->count ? &grid->lines[k] : gm_grid_add(grid, spec->scheme, request->count, message);
        if (!line) {
            return false;
        }
        const double dt = ((const struct gm_timing *)spec->parameters)->dt;
        size_t at = line->count++;
        for (; at > 0 && line->cells[at - 1].step <= dt; at--) {
            if (line->cells[at - 1].step == dt) {
                return gm_refuse(message,
                                 "backward compares steps and schemes: only scheme and dt take lists");
            }
            line->cells[at] = line->cells[at - 1];
        }
        line->cells[at] = (struct gm_grid_cell){.spec = spec, .step = dt};
    }
    grid->begun = grid->count;
    return true;
}
