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
#include "core/arena.h"
#include "core/expression/number.h"

/* ---- what all kinds share ---- */

struct gm_timing *gm_grid_timing(const struct gm_grid *grid)
{
    return grid->request.lanes[0].parameters;
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

struct gm_grid_line *gm_grid_find(const struct gm_grid *grid, const struct gm_scheme *scheme)
{
    for (size_t i = 0; i < grid->count; i++) {
        if (grid->lines[i].scheme == scheme) {
            return &grid->lines[i];
        }
    }
    return NULL;
}

struct gm_grid_line *gm_grid_add(struct gm_grid *grid, const struct gm_scheme *scheme, size_t most)
{
    struct gm_grid_line *line = &grid->lines[grid->count++];
    *line = (struct gm_grid_line){.scheme = scheme,
                                  .cells = gm_arena_take(grid->arena, most, sizeof *line->cells)};
    return line;
}

static void close_request(void *request)
{
    gm_request_close(request);
}

void gm_cells_open(struct gm_grid *grid, const struct gm_arguments *typed, const char *measure)
{
    char message[GM_MESSAGE];
    const struct gm_study_row *row = grid->row;
    if (typed->count == 0) {
        gm_arena_refuse(grid->arena, "%s", row->which);
    }
    const struct gm_scene *scene =
        gm_request_scene(typed->count, typed->words, &grid->request.refusal, message);
    if (!scene) {
        gm_arena_refuse(grid->arena, "%s", message);
    }
    struct gm_arguments *words = gm_arguments_in(grid->arena);
    gm_arena_need(grid->arena, gm_words_complete(words, scene, typed, row->usual(grid, scene)));
    if (row->edit) {
        row->edit(grid, words);
    }
    if (!gm_request_parse(&grid->request, words->count, words->words, row->schemes, message)) {
        gm_arena_refuse(grid->arena, "%s", message);
    }
    gm_arena_keep(grid->arena, &grid->request, close_request);
    row->lay_out(grid, words, typed, measure);
}

/* ---- stability ---- */

const char *gm_stability_usual(struct gm_grid *grid, const struct gm_scene *scene)
{
    enum { MOST = 6 }; /* of the scene's schemes, where the plan names none */
    if (!scene->stability) {
        gm_arena_refuse(grid->arena, "scene %s has no stability map: %s", scene->name,
                        scene->no_stability ? scene->no_stability
                                            : "stability --region SCHEME shows the limit of a scheme");
    }
    const bool planned = scene->stability->schemes != NULL;
    const char *const *schemes = planned ? scene->stability->schemes : scene->schemes;
    char list[512] = "";
    for (size_t i = 0; schemes[i] && (planned || i < MOST); i++) {
        const size_t used = strlen(list);
        snprintf(list + used, sizeof list - used, "%s%s", i ? "," : "", schemes[i]);
    }
    return gm_arena_print(grid->arena, "%s scheme=%s", scene->stability->arguments, list);
}

/* "accurate=1e-2"; the parsed scene has to have an error. */
static void read_judge(struct gm_grid *grid, const char *judge)
{
    static const char accurate[] = "accurate";
    const size_t length = strlen(accurate);
    grid->accuracy = INFINITY;
    if (!judge || strcmp(judge, "bounded") == 0) {
        return;
    }
    if (strncmp(judge, accurate, length) != 0 || (judge[length] && judge[length] != '=')) {
        gm_arena_refuse(grid->arena, "--judge %.60s is none of: bounded, accurate, accurate=ERROR", judge);
    }
    grid->accuracy = 0.1;
    if (judge[length] && (!gm_number_parse(judge + length + 1, &grid->accuracy) ||
                          !(grid->accuracy > 0 && grid->accuracy < INFINITY))) {
        gm_arena_refuse(grid->arena, "--judge %.60s needs an error above 0, such as accurate=1e-2", judge);
    }
    if (!grid->plan->error) {
        gm_arena_refuse(grid->arena, "scene %s has no error to be accurate by; take --judge bounded",
                        grid->request.scene->name);
    }
}

static struct gm_grid_axis axis_of(struct gm_grid *grid, const double *values, size_t count)
{
    struct gm_grid_axis axis = {.values = gm_arena_take(grid->arena, count, sizeof *values)};
    for (size_t i = 0; i < count; i++) {
        gm_axis_add(&axis, values[i]);
    }
    return axis;
}

void gm_stability_lay_out(struct gm_grid *grid, const struct gm_arguments *words,
                          const struct gm_arguments *typed, const char *judge)
{
    (void)words, (void)typed;
    const struct gm_request *request = &grid->request;
    const struct gm_stability *plan = grid->plan = request->scene->stability;
    grid->parameter = gm_scene_parameter(request->scene, plan->parameter);
    read_judge(grid, judge);
    grid->steps = axis_of(grid, plan->steps, plan->step_count);
    grid->values = axis_of(grid, plan->values, plan->value_count);
    grid->lines = gm_arena_take(grid->arena, request->count, sizeof *grid->lines);
    for (size_t i = 0; i < request->count; i++) {
        if (gm_grid_find(grid, request->lanes[i].scheme)) {
            gm_arena_refuse(grid->arena, "stability varies dt and %s itself: only scheme takes a list",
                            plan->parameter);
        }
        struct gm_grid_line *line =
            gm_grid_add(grid, request->lanes[i].scheme, grid->steps.count * grid->values.count);
        for (size_t s = 0; s < grid->steps.count; s++) {
            for (size_t v = 0; v < grid->values.count; v++) {
                line->cells[line->count++] = (struct gm_grid_cell){.spec = &request->lanes[i],
                                                                   .step = grid->steps.values[s],
                                                                   .value = grid->values.values[v]};
            }
        }
    }
    grid->begun = grid->count;
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
const char *gm_backward_usual(struct gm_grid *grid, const struct gm_scene *scene)
{
    if (!scene->asked_shown) {
        gm_arena_refuse(grid->arena, "scene %s has no modified energy: it has no canonical Hamiltonian",
                        scene->name);
    }
    const struct gm_scheme *schemes[GM_FITTING_SCHEMES], *usual = NULL;
    const size_t count = gm_fitting_schemes(scene, schemes);
    const struct gm_timing *timing = gm_arena_keep(grid->arena, gm_scene_defaults(scene), free);
    size_t best = SIZE_MAX;
    for (size_t i = 0; i < count; i++) {
        const size_t rank = rank_of(scene, schemes[i]);
        if (rank < best && (schemes[i]->claims & GM_SYMPLECTIC) && schemes[i]->family->coefficients_open) {
            best = rank;
            usual = schemes[i];
        }
    }
    const double dt = timing->dt;
    return gm_arena_print(grid->arena, "%s dt=%.17g,%.17g,%.17g,%.17g,%.17g%s%s",
                          scene->work ? scene->work->arguments : "", 2 * dt, dt, dt / 2, dt / 4, dt / 8,
                          usual ? " scheme=" : "", usual ? usual->name : "");
}

/* A cell for every lane, at the scheme's line by falling dt. */
void gm_backward_lay_out(struct gm_grid *grid, const struct gm_arguments *words,
                         const struct gm_arguments *typed, const char *measure)
{
    (void)words, (void)typed, (void)measure;
    char message[GM_MESSAGE];
    const struct gm_request *request = &grid->request;
    if (!gm_request_ends_together(request, message)) {
        gm_arena_refuse(grid->arena, "%s", message);
    }
    grid->lines = gm_arena_take(grid->arena, request->count, sizeof *grid->lines);
    for (size_t i = 0; i < request->count; i++) {
        const struct gm_lane_spec *spec = &request->lanes[i];
        struct gm_grid_line *line = gm_grid_find(grid, spec->scheme);
        line = line ? line : gm_grid_add(grid, spec->scheme, request->count);
        const double dt = ((const struct gm_timing *)spec->parameters)->dt;
        size_t at = line->count++;
        for (; at > 0 && line->cells[at - 1].step <= dt; at--) {
            if (line->cells[at - 1].step == dt) {
                gm_arena_refuse(grid->arena,
                                "backward compares steps and schemes: only scheme and dt take lists");
            }
            line->cells[at] = line->cells[at - 1];
        }
        line->cells[at] = (struct gm_grid_cell){.spec = spec, .step = dt};
    }
    grid->begun = grid->count;
}
