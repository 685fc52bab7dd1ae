/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A scheme is certified on the system of a lane, from its start. */
#include "app/studies/certified_lane.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "app/ground/arguments.h"
#include "app/request/request.h"
#include "core/mesh/moving_mesh.h"
#include "core/schemes.h"

struct kept {
    const struct gm_lane *lane;
    const struct gm_problem *problem; /* of one member */
    const struct gm_observable *row;
};

static double value_of_kept(const void *data, const double *y)
{
    const struct kept *kept = data;
    struct gm_view view = gm_lane_view(kept->lane);
    view.problem = kept->problem;
    view.start = view.state = y;
    view.observable = kept->row;
    return kept->row->evaluate(&view);
}

bool gm_certify_lane(const struct gm_lane *lane, struct gm_certificate *certificate, char *message)
{
    const struct gm_scene *scene = lane->scene;
    const struct gm_kind *kind = lane->problem.kind;
    struct gm_problem problem = lane->problem;
    const size_t n = problem.n;
    if (!kind->certify_on) {
        return gm_refuse(
            message,
            "--on takes ordinary differential equations and waves on moving meshes; %s is none of these",
            scene->name);
    }
    if (n > kind->most_certified || problem.passive > 0) {
        return gm_refuse(message,
                         "--on takes systems of at most %zu components, all of which move each other",
                         kind->most_certified);
    }
    problem.m = 1;
    double *start = malloc(n * sizeof *start);
    struct kept *data = calloc(scene->observable_count + 1, sizeof *data);
    struct gm_kept *kept = calloc(scene->observable_count + 1, sizeof *kept);
    struct gm_certified_system system = {
        .problem = &problem, .start = start, .dt = lane->run->dt, .kept = kept};
    const bool good = start && data && kept;
    for (size_t c = 0; good && c < n; c++) {
        start[c] = lane->start[c * lane->problem.m];
    }
    for (size_t i = 0; good && i < scene->observable_count; i++) {
        const struct gm_observable *row = &scene->observables[i];
        data[i] = (struct kept){lane, &problem, row};
        if (row->kept && isfinite(value_of_kept(&data[i], start))) {
            kept[system.kept_count++] =
                (struct gm_kept){.name = row->key, .value = value_of_kept, .data = &data[i]};
        }
    }
    if (good) {
        *certificate = gm_certify_on(lane->scheme, &system);
    }
    free(start);
    free(data);
    free(kept);
    return good || gm_refuse(message, "not enough memory");
}

/* The request of these words. */
static bool ask(const char *scheme, const char *system, int count, const char *const words[],
                struct gm_request *request, int *status, char *message)
{
    struct gm_arguments typed = {0};
    char *choice = NULL;
    bool good = asprintf(&choice, "scheme=%s", scheme) >= 0 && gm_arguments_add(&typed, system) &&
                gm_arguments_add(&typed, choice);
    for (int i = 0; good && i < count; i++) {
        good = gm_arguments_add(&typed, words[i]);
    }
    /* on a mesh of as few nodes as all claims are measured on, where nothing is said of it */
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
        good = lane && gm_certify_lane(lane, certificate, message);
        *status = good ? GM_EXIT_OK : GM_EXIT_USAGE;
        gm_lane_close(lane);
    }
    gm_request_close(&request);
    return good;
}
