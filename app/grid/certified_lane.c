/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A scheme is certified on the system of a lane, from its start. */
#include "app/grid/certified_lane.h"

#include <math.h>
#include <stdlib.h>

#include "app/base/arguments.h"
#include "app/words/request.h"
#include "core/field/field.h"
#include "core/memory.h"
#include "core/mesh/moving_mesh.h"
#include "core/ode/ode.h"
#include "core/schemes.h"

enum { MOST_WITH_TANGENTS = 8 }; /* components */

struct kept {
    const struct gm_lane *lane;
    const struct gm_problem *problem; /* the problem of one member */
    const struct gm_observable *row;
    /* the part of `problem` without tangents that is certified; NULL: all */
    const struct gm_problem *motion;
};

/* The place among the components with tangents of one of the motion alone. */
static size_t place_of(const struct gm_problem *motion, size_t n, size_t component)
{
    const size_t half = motion->n / 2;
    return component < half ? component : n / 2 + component - half;
}

static double value_of_kept(const void *data, const double *y, const double *memory)
{
    const struct kept *kept = data;
    double whole[MOST_WITH_TANGENTS] = {0};
    struct gm_view view = gm_lane_view(kept->lane);
    view.problem = kept->problem;
    for (size_t c = 0; kept->motion && c < kept->motion->n; c++) {
        whole[place_of(kept->motion, kept->problem->n, c)] = y[c];
    }
    view.start = view.state = kept->motion ? whole : y;
    view.memory = memory;
    view.observable = kept->row;
    return kept->row->evaluate(&view);
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

/* The same field with half the step size on a grid twice as fine; NULL if there is no such grid, or when
   out of memory. */
static struct gm_lane *open_finer(const struct gm_lane *lane)
{
    const struct gm_parameter *points = gm_scene_parameter(lane->scene, "points");
    struct gm_timing *timing = points ? gm_parameters_copy(lane->scene, lane->parameters) : NULL;
    struct gm_lane *finer = NULL;
    char unused[GM_MESSAGE];
    if (timing) {
        /* points between walls are counted with both */
        const double twice = 2 * gm_parameter_get(points, timing) - (lane->problem.line.walls ? 1 : 0);
        timing->dt /= 2;
        if (gm_parameter_put(points, timing, twice) == GM_PARSED) {
            finer = gm_lane_open(lane->scene, timing, &lane->settings, lane->scheme, unused);
        }
    }
    free(timing);
    return finer;
}

enum { FINER = 3 }; /* grids beside a field's own */

struct grid {
    struct gm_lane *lane;
    struct kept error;
    struct gm_certified_system system;
};

/* Opens the finer grids of a field and sets the exact solution on all of them; `first` is the lane's grid. */
static void refine(const struct gm_lane *lane, struct grid first[1 + FINER])
{
    const struct gm_scene *scene = lane->scene;
    const int measured =
        scene->work && scene->work->measure ? gm_scene_observable(scene, scene->work->measure) : -1;
    for (size_t k = 0; k <= FINER; k++) {
        struct grid *grid = &first[k];
        const struct gm_lane *self = k > 0 ? grid->lane : lane;
        if (measured >= 0) {
            grid->error =
                (struct kept){self, &self->problem, gm_scene_observable_at(scene, (size_t)measured), NULL};
            grid->system.error = error_of_lane;
            grid->system.error_data = &grid->error;
        }
        struct gm_lane *finer = k < FINER ? open_finer(self) : NULL;
        if (!finer) {
            break;
        }
        first[k + 1].lane = finer;
        first[k + 1].system = (struct gm_certified_system){
            .problem = &finer->problem, .start = finer->start, .dt = finer->run->dt};
        grid->system.finer = &first[k + 1].system;
    }
}

static bool certify_lane(const struct gm_lane *lane, struct gm_certificate *certificate, char *message)
{
    const struct gm_scene *scene = lane->scene;
    const struct gm_kind *kind = lane->problem.kind;
    struct gm_problem problem = lane->problem;
    const size_t n = problem.n;
    const unsigned long refusals = gm_memory_refusals();
    if (!kind->certify_on) {
        return gm_refuse(
            message,
            "--on takes ordinary differential equations and waves on a line or on moving meshes; %s is none of these",
            scene->name);
    }
    if (n > kind->most_certified || problem.passive > 0) {
        return gm_refuse(message,
                         "--on takes systems of at most %zu components, all of which move each other",
                         kind->most_certified);
    }
    problem.m = 1;
    const struct gm_problem *const motion = kind == &gm_kind_ode ? gm_ode_of(&problem)->motion : NULL;
    struct gm_problem alone = motion ? *motion : problem;
    alone.parameters = problem.parameters;
    double *start = malloc(n * sizeof *start);
    struct kept *data = calloc(scene->observable_count + 1, sizeof *data);
    struct gm_kept *kept = calloc(scene->observable_count + 1, sizeof *kept);
    struct grid grids[1 + FINER] = {
        {.system = {.problem = &alone, .start = start, .dt = lane->run->dt, .kept = kept}}};
    const bool good = start && data && kept;
    for (size_t c = 0; good && c < alone.n; c++) {
        start[c] = lane->start[(motion ? place_of(motion, n, c) : c) * lane->problem.m];
    }
    for (size_t i = 0; good && i < scene->observable_count; i++) {
        const struct gm_observable *row = &scene->observables[i];
        data[i] = (struct kept){lane, &problem, row, motion};
        if (row->kept && isfinite(value_of_kept(&data[i], start, NULL))) {
            kept[grids->system.kept_count++] =
                (struct gm_kept){.name = row->key, .value = value_of_kept, .data = &data[i]};
        }
    }
    if (good) {
        if (kind == &gm_kind_field) {
            refine(lane, grids);
        }
        *certificate = gm_certify_on(lane->scheme, &grids->system);
    }
    for (size_t k = 1; k <= FINER; k++) {
        gm_lane_close(grids[k].lane);
    }
    free(start);
    free(data);
    free(kept);
    /* measurements without memory would give wrong results */
    return gm_memory_refusals() == refusals || gm_refuse(message, "not enough memory");
}

/* The request of these words. */
static bool ask(const char *scheme, const char *system, int count, const char *const words[],
                struct gm_request *request, int *status, char *message)
{
    struct gm_arguments typed = {0};
    char *choice = gm_text("scheme=%s", scheme);
    bool good = choice && gm_arguments_add(&typed, system) && gm_arguments_add(&typed, choice);
    for (int i = 0; good && i < count; i++) {
        good = gm_arguments_add(&typed, words[i]);
    }
    /* a mesh has the number of nodes on which all claims are measured, by default */
    const struct gm_scheme *row = gm_scheme_find(scheme);
    if (good && row && row->family->kind == &gm_kind_mesh && !gm_arguments_have(&typed, "points=")) {
        good = gm_arguments_add(&typed, "points=3");
    }
    if (!good) {
        gm_refuse(message, "not enough memory");
        *status = GM_EXIT_MEMORY;
    } else if (!gm_request_parse(request, typed.count, typed.words, 1, message)) {
        *status = gm_request_refusal(request);
        good = false;
    } else if (request->count != 1) {
        *status = GM_EXIT_USAGE;
        good = gm_refuse(message, "a certificate on a system takes one scheme and one value of each key");
    }
    free(choice);
    gm_arguments_close(&typed);
    return good;
}

bool gm_certify_words(const char *scheme, const char *system, int count, const char *const words[],
                      struct gm_certificate *certificate, int *status, char *message)
{
    struct gm_request request = {0};
    bool good = ask(scheme, system, count, words, &request, status, message);
    if (good) {
        struct gm_lane *lane = gm_request_open_lane(&request, 0, message);
        good = lane && certify_lane(lane, certificate, message);
        *status = good ? GM_EXIT_OK : gm_memory_was_short() ? GM_EXIT_MEMORY : GM_EXIT_USAGE;
        gm_lane_close(lane);
    }
    gm_request_close(&request);
    return good;
}
