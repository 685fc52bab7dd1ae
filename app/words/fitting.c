/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which schemes fit a scene: a refusal names them, and so do lists and completion. */
#include "app/words/fitting.h"

#include <stdlib.h>

#include "core/schemes.h"

void gm_fitting_add(const struct gm_scheme *scheme, const struct gm_problem *problem,
                    const struct gm_scheme **schemes, size_t *count)
{
    size_t i = 0;
    while (i < *count && schemes[i] != scheme) {
        i++;
    }
    if (i == *count && i < GM_FITTING_SCHEMES && scheme && gm_scheme_fits(scheme, problem)) {
        schemes[(*count)++] = scheme;
    }
}

/* A scene's problem at its defaults. */
struct defaults {
    const struct gm_scene *scene;
    void *parameters;
    struct gm_problem problem;
};

static bool open_defaults(struct defaults *defaults, const struct gm_scene *scene)
{
    char sentence[GM_MESSAGE];
    *defaults = (struct defaults){.scene = scene, .parameters = gm_scene_defaults(scene)};
    const bool good =
        defaults->parameters && scene->setup(defaults->parameters, &defaults->problem, sentence);
    if (!good) {
        free(defaults->parameters);
    }
    return good;
}

static void close_defaults(struct defaults *defaults)
{
    if (defaults->scene->close) {
        defaults->scene->close(&defaults->problem);
    }
    free(defaults->parameters);
}

size_t gm_fitting_schemes(const struct gm_scene *scene, const struct gm_scheme **schemes)
{
    size_t count = 0;
    struct defaults defaults;
    if (open_defaults(&defaults, scene)) {
        for (size_t i = 0; i < gm_scheme_count(); i++) {
            gm_fitting_add(gm_scheme_at(i), &defaults.problem, schemes, &count);
        }
        close_defaults(&defaults);
    }
    return count;
}

void gm_fitting_same(const struct gm_scene *scene, const struct gm_scheme *const *schemes, size_t count,
                     const struct gm_scheme **same)
{
    struct defaults defaults;
    const bool good = open_defaults(&defaults, scene);
    for (size_t i = 0; i < count; i++) {
        same[i] = good ? gm_scheme_same_as(schemes[i], &defaults.problem) : NULL;
    }
    if (good) {
        close_defaults(&defaults);
    }
}

size_t gm_fitting_elsewhere(const struct gm_scene *scene, const struct gm_scheme **schemes)
{
    size_t count = gm_fitting_schemes(scene, schemes);
    for (size_t i = 0; scene->elsewhere && i < gm_scheme_count() && count < GM_FITTING_SCHEMES; i++) {
        if (scene->elsewhere(gm_scheme_at(i))) {
            schemes[count++] = gm_scheme_at(i);
        }
    }
    return count;
}

bool gm_fitting_take(const struct gm_scheme *const *schemes, size_t count, const struct gm_parameter *row)
{
    for (size_t i = 0; i < count; i++) {
        if (gm_scheme_takes(schemes[i], row)) {
            return true;
        }
    }
    return false;
}
