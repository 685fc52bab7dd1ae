/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A scheme is certified on the system of a lane, from its start. */
#include "app/grid/grid.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/base/arguments.h"
#include "app/words/request.h"
#include "core/arena.h"
#include "core/field/field.h"
#include "core/memory.h"
#include "core/mesh/moving_mesh.h"
#include "core/ode/user/problem.h"
#include "core/schemes.h"
#include "core/theory/certify.h"

struct kept {
    const struct gm_lane *lane;
    const struct gm_problem *problem; /* the problem of one member */
    const struct gm_observable *row;
    /* the part of `problem` without tangents that is certified; NULL: all */
    const struct gm_user_motion *motion;
};

static double value_of_kept(const void *data, const double *y, const double *memory)
{
    const struct kept *kept = data;
    double *whole = kept->motion ? calloc(kept->problem->n, sizeof *whole) : NULL;
    struct gm_view view = gm_lane_view(kept->lane);
    view.problem = kept->problem;
    for (size_t c = 0; whole && c < kept->motion->problem.n; c++) {
        whole[gm_system_component(kept->motion->whole, c, 0)] = y[c];
    }
    view.start = view.state = kept->motion ? whole : y;
    view.memory = memory;
    view.observable = kept->row;
    const double value = view.state ? kept->row->evaluate(&view) : NAN; /* refused memory is noted */
    free(whole);
    return value;
}

/* The error against the exact solution of the lane's scene. */
static double error_of_lane(const void *data, double t, const double *y)
{
    const struct kept *kept = data;
    struct gm_view view = gm_lane_view(kept->lane);
    view.t = t;
    view.state = y;
    view.memory = NULL;
    view.observable = kept->row;
    return kept->row->evaluate(&view);
}

/* The same field with half the step size on a grid twice as fine; NULL if there is no such grid. */
static struct gm_lane *open_finer(struct gm_arena *arena, const struct gm_lane *lane)
{
    const struct gm_parameter *points = gm_scene_parameter(lane->scene, "points");
    char message[GM_MESSAGE];
    if (!points) {
        return NULL;
    }
    struct gm_timing *timing = gm_arena_keep(arena, gm_parameters_copy(lane->scene, lane->parameters), free);
    /* points between walls are counted with both */
    const double twice = 2 * gm_parameter_get(points, timing) - (lane->problem.line.walls ? 1 : 0);
    timing->dt /= 2;
    struct gm_lane *finer = gm_parameter_put(points, timing, twice) == GM_PARSED
                                ? gm_lane_open(lane->scene, timing, &lane->settings, lane->scheme, message)
                                : NULL;
    return finer ? gm_lane_in(arena, finer, message) : NULL;
}

enum { FINER = 3 }; /* grids beside a field's own */

struct grid {
    const struct gm_lane *lane;
    struct kept error;
    struct gm_certified_system system;
};

/* Opens the finer grids of a field and sets the exact solution on all of them. */
static void refine(struct gm_arena *arena, struct grid grids[1 + FINER])
{
    const struct gm_scene *scene = grids->lane->scene;
    const int measured =
        scene->work && scene->work->measure ? gm_scene_observable(scene, scene->work->measure) : -1;
    for (struct grid *grid = grids; grid; grid++) {
        if (measured >= 0) {
            grid->error = (struct kept){grid->lane, &grid->lane->problem,
                                        gm_scene_observable_at(scene, (size_t)measured), NULL};
            grid->system.error = error_of_lane;
            grid->system.error_data = &grid->error;
        }
        const struct gm_lane *finer = grid < grids + FINER ? open_finer(arena, grid->lane) : NULL;
        if (!finer) {
            return;
        }
        grid[1] = (struct grid){
            .lane = finer,
            .system = {.problem = &finer->problem, .start = finer->start, .dt = finer->run->dt}};
        grid->system.finer = &grid[1].system;
    }
}

static void check(struct gm_arena *arena, const struct gm_lane *lane)
{
    const struct gm_kind *kind = lane->problem.kind;
    gm_arena_refuse_if(
        arena, !kind->certify_on,
        "--on takes ordinary differential equations and waves on a line or on moving meshes; %s is none of these",
        lane->scene->name);
    gm_arena_refuse_if(arena, lane->problem.n > kind->most_certified || lane->problem.passive > 0,
                       "--on takes systems of at most %zu components, all of which move each other",
                       kind->most_certified);
}

static struct gm_certificate certify(struct gm_arena *arena, const struct gm_lane *lane)
{
    const struct gm_scene *scene = lane->scene;
    struct gm_problem problem = lane->problem;
    const unsigned long refusals = gm_memory_refusals();
    problem.m = 1;
    const bool written = problem.kind == &gm_kind_ode && gm_ode_of(&problem)->written;
    const struct gm_user_motion *motion = written ? gm_user_problem_motion(arena, &problem) : NULL;
    const struct gm_problem alone = motion ? motion->problem : problem;
    double *start = gm_arena_take(arena, problem.n, sizeof *start);
    struct kept *data = gm_arena_take(arena, scene->observable_count, sizeof *data);
    struct gm_kept *kept = gm_arena_take(arena, scene->observable_count, sizeof *kept);
    struct grid grids[1 + FINER] = {
        {.lane = lane, .system = {.problem = &alone, .start = start, .dt = lane->run->dt, .kept = kept}}};
    for (size_t c = 0; c < alone.n; c++) {
        start[c] = lane->start[(motion ? gm_system_component(motion->whole, c, 0) : c) * lane->problem.m];
    }
    for (size_t i = 0; i < scene->observable_count; i++) {
        const struct gm_observable *row = &scene->observables[i];
        data[i] = (struct kept){lane, &problem, row, motion};
        if (row->kept && isfinite(value_of_kept(&data[i], start, NULL))) {
            kept[grids->system.kept_count++] =
                (struct gm_kept){.name = row->key, .value = value_of_kept, .data = &data[i]};
        }
    }
    if (problem.kind == &gm_kind_field) {
        refine(arena, grids);
    }
    const struct gm_certificate certificate = gm_certify_on(lane->scheme, &grids->system);
    /* measurements without memory would give wrong results */
    gm_arena_need(arena, gm_memory_refusals() == refusals);
    return certificate;
}

static const struct gm_request *ask(struct gm_arena *arena, const char *system,
                                    const struct gm_arguments *typed, int *status)
{
    char message[GM_MESSAGE];
    const struct gm_scheme *scheme = gm_scheme_find(typed->words[0]);
    struct gm_request *request = gm_arena_take(arena, 1, sizeof *request);
    struct gm_arguments *words = gm_arguments_in(arena);
    gm_arguments_add(words, system);
    gm_arguments_print(words, "scheme=%s", typed->words[0]);
    gm_arguments_append(words, typed->words + 1, typed->count - 1);
    /* a mesh has the number of nodes on which all claims are measured, by default */
    const bool few = scheme && scheme->family->kind == &gm_kind_mesh && !gm_arguments_have(words, "points=");
    if (few) {
        gm_arguments_add(words, "points=3");
    }
    gm_arena_need(arena, !words->failed);
    bool parsed = gm_request_parse(request, words->count, words->words, 1, message);
    /* places that are listed have their number */
    if (!parsed && few && strcmp(request->refused, "points") == 0) {
        parsed = gm_request_parse(request, words->count - 1, words->words, 1, message);
    }
    if (!parsed) {
        *status = gm_request_refusal(request);
        gm_arena_refuse(arena, "%s", message);
    }
    gm_arena_keep(arena, request, gm_request_close);
    gm_arena_refuse_if(arena, request->count != 1,
                       "a certificate on a system takes one scheme and one value of each key");
    return request;
}

struct gm_certificate gm_certify_words(struct gm_arena *arena, const char *system,
                                       const struct gm_arguments *typed, int *status)
{
    char message[GM_MESSAGE];
    *status = GM_EXIT_USAGE;
    const struct gm_lane *lane =
        gm_lane_in(arena, gm_request_open_lane(ask(arena, system, typed, status), 0, message), message);
    check(arena, lane);
    return certify(arena, lane);
}
