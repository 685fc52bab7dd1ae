/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Names of schemes, observables and scenes: which fit, which are meant, and which are near to a word. */
#include "app/words/names.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/base/arguments.h"
#include "app/base/files.h"
#include "core/expression/nearest.h"
#include "core/schemes.h"
#include "scenes/common/scene.h"

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

bool gm_chosen_refuse(const struct gm_scene *scene, const char *key, char *message)
{
    const size_t count = scene->observable_count + scene->asked_count;
    const char *near = gm_nearest(key, count, gm_scene_observable_key, scene);
    return gm_refuse(message, "scene %s has no observable %.60s%s%s", scene->name, key,
                     near ? "; did you mean " : "", near ? near : "");
}

bool gm_chosen_open(struct gm_chosen *chosen, const struct gm_scene *scene, const char *keys, char *message)
{
    size_t most = scene->observable_count + 1;
    for (const char *at = keys; at && *at; at++) {
        most += *at == ',';
    }
    *chosen = (struct gm_chosen){.numbers = calloc(most, sizeof *chosen->numbers)};
    char *copy = keys ? strdup(keys) : NULL, *rest = NULL;
    bool good = (chosen->numbers && (!keys || copy)) || gm_refuse(message, "not enough memory");
    for (size_t i = 0; good && !keys && i < scene->observable_count; i++) {
        chosen->numbers[chosen->count++] = i;
    }
    for (char *key = good && copy ? strtok_r(copy, ",", &rest) : NULL; good && key;
         key = strtok_r(NULL, ",", &rest)) {
        const int found = gm_scene_observable(scene, key);
        good = found >= 0 || gm_chosen_refuse(scene, key, message);
        for (size_t i = 0; good && i < chosen->count; i++) {
            good = chosen->numbers[i] != (size_t)found || gm_refuse(message, "%.60s is named twice", key);
        }
        chosen->numbers[chosen->count++] = (size_t)found;
    }
    free(copy);
    return good;
}

void gm_chosen_close(struct gm_chosen *chosen)
{
    free(chosen->numbers);
    *chosen = (struct gm_chosen){0};
}

static void add_to(const struct gm_listed *listed, const void *names)
{
    /* one that memory was too short for is not proposed */
    gm_arguments_add(*(struct gm_arguments *const *)names, listed->name);
}

static const char *name_at(size_t i, const void *names)
{
    return ((const struct gm_arguments *)names)->words[i];
}

bool gm_system_near(const char *word, char near[GM_NEAR], char *message)
{
    struct gm_arguments names = {0}, *list = &names;
    message[0] = '\0';
    for (size_t i = 0; i < gm_scene_count(); i++) {
        gm_arguments_add(&names, gm_scene_name(i));
    }
    for (enum gm_file_kind kind = GM_FILE_SYSTEM; kind <= GM_FILE_ROOM; kind++) {
        gm_files_each(kind, add_to, &list, message);
    }
    const char *found = gm_nearest(word, (size_t)names.count, name_at, &names);
    snprintf(near, GM_NEAR, "%s", found ? found : "");
    gm_arguments_close(&names);
    return near[0] != '\0';
}
