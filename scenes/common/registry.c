/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The items of a scene, by their keys. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "scenes/common/scene.h"

const char *gm_observable_title(const struct gm_observable *observable, char *text, size_t size)
{
    const char *x = observable->symbol, *scale = observable->scale_text;
    if (!observable->error) {
        snprintf(text, size, "%s", observable->title);
    } else {
        snprintf(text, size, scale ? "%s  |%s − %s₀| / max(|%s₀|, %s)" : "%s  |%s − %s₀| / |%s₀|",
                 observable->title, x, x, x, scale);
    }
    return text;
}

static bool is_largest_of(const char *key, const char *other)
{
    const size_t length = strlen(other);
    return strncmp(key, other, length) == 0 && strcmp(key + length, "_max") == 0;
}

bool gm_observables_clash(const char *key, const char *other)
{
    return strcmp(key, other) == 0 || is_largest_of(key, other) || is_largest_of(other, key);
}

double gm_observe(const struct gm_observable *observable, const struct gm_view *view)
{
    struct gm_view asked = *view;
    asked.observable = observable;
    return observable->evaluate(&asked);
}

double gm_observable_scale(const struct gm_observable *observable, const struct gm_view *view)
{
    struct gm_view asked = *view;
    asked.observable = observable;
    const double natural = observable->scale ? observable->scale(&asked) : observable->least;
    const bool cancels = observable->terms && view->cancelled;
    return fmax(natural, cancels ? view->cancelled[observable - view->scene->observables] : 0);
}

void *gm_scene_defaults(const struct gm_scene *scene)
{
    const unsigned long refusals = gm_memory_refusals();
    void *parameters = calloc(1, scene->size);
    if (parameters) {
        if (scene->initial) {
            memcpy(parameters, scene->initial, scene->size);
        }
        gm_parameters_reset(scene->parameters, scene->parameter_count, parameters);
    }
    if (gm_memory_refusals() != refusals) { /* an unreadable default is another number */
        free(parameters);
        return NULL;
    }
    return parameters;
}

double gm_scene_t0(const struct gm_scene *scene, const void *parameters)
{
    return scene->t0 ? scene->t0(parameters) : 0;
}

const char *gm_scene_idle(const struct gm_scene *scene, const void *parameters, const char *key)
{
    return scene->idle ? scene->idle(parameters, key) : NULL;
}

const struct gm_parameter *gm_scene_parameter(const struct gm_scene *scene, const char *key)
{
    for (size_t i = 0; i < scene->parameter_count; i++) {
        if (scene->parameters[i].key[0] == key[0] && strcmp(scene->parameters[i].key, key) == 0) {
            return &scene->parameters[i];
        }
    }
    return NULL;
}

size_t gm_scene_section(const struct gm_scene *scene)
{
    size_t found = 0;
    while (found < scene->track_count && !scene->tracks[found].section) {
        found++;
    }
    return found;
}

int gm_scene_observable(const struct gm_scene *scene, const char *key)
{
    for (size_t i = 0; gm_scene_observable_at(scene, i); i++) {
        if (strcmp(gm_scene_observable_at(scene, i)->key, key) == 0) {
            return (int)i;
        }
    }
    return -1;
}

const struct gm_observable *gm_scene_observable_at(const struct gm_scene *scene, size_t number)
{
    if (number < scene->observable_count) {
        return &scene->observables[number];
    }
    number -= scene->observable_count;
    return number < scene->asked_count ? &scene->asked[number] : NULL;
}

const char *gm_scene_observable_key(size_t number, const void *scene)
{
    return gm_scene_observable_at(scene, number)->key;
}

void gm_choose(struct gm_choice *choice, const char *key, double value)
{
    choice->key = key;
    snprintf(choice->value, sizeof choice->value, "%.3g", value == 0 ? 0.0 : value);
}

bool gm_is_given(const char *key, const char *const *keys, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        if (strcmp(keys[i], key) == 0) {
            return true;
        }
    }
    return false;
}
