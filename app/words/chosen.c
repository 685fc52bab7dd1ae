/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Keys of observables, as options hold them. */
#include "app/words/chosen.h"

#include <stdlib.h>
#include <string.h>

#include "core/expression/nearest.h"

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
