/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Names of schemes, observables and scenes: which fit, which are meant, and which are near to a word. */
#include "app/words/names.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/base/arguments.h"
#include "app/base/files.h"
#include "core/aliases.h"
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
    if (defaults->parameters && scene->setup(defaults->parameters, &defaults->problem, sentence)) {
        return true;
    }
    free(defaults->parameters);
    return false;
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
    const bool opened = open_defaults(&defaults, scene);
    for (size_t i = 0; i < count; i++) {
        same[i] = opened ? gm_scheme_same_as(schemes[i], &defaults.problem) : NULL;
    }
    if (opened) {
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

bool gm_row_is_offered(const struct gm_parameter *row)
{
    char sentence[GM_MESSAGE];
    return row->type != GM_BOOLEAN || !row->admits || row->admits(row, "yes", sentence);
}

/* Adds the observables with this key, or with this group of keys. Returns false with a sentence. */
static bool add_chosen(struct gm_chosen *chosen, const struct gm_scene *scene, const char *key, char *message)
{
    const struct gm_observable *observable;
    bool found = false;
    for (size_t i = 0; (observable = gm_scene_observable_at(scene, i)); i++) {
        if (strcmp(observable->key, key) != 0 &&
            !(observable->group && strcmp(observable->group, key) == 0)) {
            continue;
        }
        for (size_t k = 0; k < chosen->count; k++) {
            if (chosen->numbers[k] == i) {
                return gm_refuse(message, "%.60s is named twice", observable->key);
            }
        }
        chosen->numbers[chosen->count++] = i;
        found = true;
    }
    return found || gm_chosen_refuse(scene, key, message);
}

bool gm_chosen_open(struct gm_chosen *chosen, const struct gm_scene *scene, const char *keys, char *message)
{
    const size_t most = scene->observable_count + scene->asked_count;
    *chosen = (struct gm_chosen){.numbers = calloc(most + 1, sizeof *chosen->numbers)};
    if (!chosen->numbers) {
        return gm_refuse(message, "not enough memory");
    }
    for (size_t i = 0; !keys && i < scene->observable_count; i++) {
        chosen->numbers[chosen->count++] = i;
    }
    for (const char *at = keys; at && *(at += strspn(at, ",")); at += strcspn(at, ",")) {
        char key[GM_TEXT_SIZE];
        snprintf(key, sizeof key, "%.*s", (int)strcspn(at, ","), at);
        if (!add_chosen(chosen, scene, key, message)) {
            return false;
        }
    }
    return true;
}

void gm_chosen_close(void *self)
{
    struct gm_chosen *chosen = self;
    free(chosen->numbers);
    *chosen = (struct gm_chosen){0};
}

bool gm_chosen_follows_steps(const struct gm_chosen *chosen, const struct gm_scene *scene)
{
    bool follows = false;
    for (size_t i = 0; i < chosen->count; i++) {
        follows = follows || gm_scene_observable_at(scene, chosen->numbers[i])->whole_steps;
    }
    return follows;
}

bool gm_chosen_are_of_the_end(const struct gm_chosen *chosen, const struct gm_scene *scene)
{
    bool end = true;
    for (size_t i = 0; i < chosen->count; i++) {
        const struct gm_observable *observable = gm_scene_observable_at(scene, chosen->numbers[i]);
        end = end && !observable->recalls && observable->period == 0;
    }
    return end;
}

/* ---- unknown words ---- */

const char *gm_scheme_own_name(const struct gm_scene *scene, const char *word)
{
    const struct gm_scheme *scheme = gm_scheme_find(word);
    struct defaults defaults;
    if (!scheme || scheme->word) {
        return word;
    }
    if (strcmp(scheme->name, word) != 0) {
        return gm_file_is(GM_FILE_SCHEME, word) ? word : scheme->name;
    }
    if (gm_alias_meaning(word) && open_defaults(&defaults, scene)) {
        const struct gm_scheme *fitting = gm_scheme_find_for(word, &defaults.problem);
        scheme = gm_scheme_fits(fitting, &defaults.problem) ? fitting : scheme;
        close_defaults(&defaults);
    }
    return scheme->name;
}

bool gm_scheme_refuse_among(const struct gm_scheme *const *fitting, size_t count, const char *word,
                            const char *otherwise, char *message)
{
    const struct gm_near *row = gm_near_find(GM_NEAR_SCHEME, word, 0);
    const char *meant = gm_scheme_near(word, fitting, count);
    if (row && meant == row->meant) {
        return gm_refuse(message, "%.40s is not here; %s", word, row->why);
    }
    return gm_refuse(message, "there is no scheme \"%.60s\"; %s%s", word, meant ? "did you mean " : "",
                     meant ? meant : otherwise);
}

bool gm_scheme_refuse(const struct gm_scene *scene, const char *word, char *message)
{
    const struct gm_scheme *fitting[GM_FITTING_SCHEMES];
    const size_t count = scene ? gm_fitting_elsewhere(scene, fitting) : 0;
    char list[256] = "see geomint list schemes";
    if (scene) {
        const size_t front = strlen("see geomint list ");
        gm_arguments_tell_scene(scene, list + front, sizeof list - front);
    }
    return gm_scheme_refuse_among(scene ? fitting : NULL, count, word, list, message);
}

/* Names of scenes and files for an unknown word. */
struct names {
    const char *word;
    struct gm_arguments list, containing; /* all of them, and those whose name or title contains the word */
};

static void add_name(struct names *names, const char *name, const char *title)
{
    /* one that memory was too short for is not proposed */
    gm_arguments_add(&names->list, name);
    if (gm_word_is_part(names->word, name) || gm_word_is_part(names->word, title)) {
        gm_arguments_add(&names->containing, name);
    }
}

static void add_file(const struct gm_listed *listed, const void *names)
{
    add_name(*(struct names *const *)names, listed->name, listed->title);
}

static const char *name_at(size_t i, const void *names)
{
    return ((const struct gm_arguments *)names)->words[i];
}

/* Adds the first scene that has the word as a value, as "disc system=pendulum". */
static void add_value(struct names *names)
{
    for (size_t i = 0; i < gm_scene_count() && names->containing.count == 0; i++) {
        const struct gm_scene *scene = gm_scene_at(i);
        for (size_t k = 0; k < scene->parameter_count && names->containing.count == 0; k++) {
            const struct gm_parameter *row = &scene->parameters[k];
            for (size_t c = 0; row->choices && row->choices[c]; c++) {
                char text[GM_NEAR_NAMES];
                snprintf(text, sizeof text, "%s %s=%s", scene->name, row->key, row->choices[c]);
                if (strcmp(row->choices[c], names->word) == 0) {
                    gm_arguments_add(&names->containing, text);
                }
            }
        }
    }
}

bool gm_system_near(const char *word, char near[GM_NEAR_NAMES], char *message)
{
    enum { MOST = 5 };
    struct names names = {.word = word}, *all = &names;
    message[0] = near[0] = '\0';
    add_value(&names);
    for (size_t i = 0; i < gm_scene_count(); i++) {
        add_name(&names, gm_scene_name(i), gm_scene_title(i));
    }
    for (enum gm_file_kind kind = GM_FILE_SYSTEM; kind <= GM_FILE_ROOM; kind++) {
        gm_files_each(kind, add_file, &all, message);
    }
    const char *found = gm_nearest(word, (size_t)names.list.count, name_at, &names.list);
    snprintf(near, GM_NEAR_NAMES, "%s", found ? found : "");
    for (int i = 0; !found && i < names.containing.count && i < MOST; i++) {
        gm_append(near, GM_NEAR_NAMES, "%s%s", i > 0 ? ", " : "", names.containing.words[i]);
    }
    gm_arguments_close(&names.list);
    gm_arguments_close(&names.containing);
    return near[0] != '\0';
}
