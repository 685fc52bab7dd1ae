/* SPDX-License-Identifier: GPL-3.0-or-later */
/* geomint complete WORD ...: the completions of the last word, one per line, with a tab and a few words on
   each. The shells' completions call it, so that they follow the tables. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "app/base/arguments.h"
#include "app/base/files.h"
#include "app/commands/commands.h"
#include "app/commands/reference/reference.h"
#include "app/figures/figure.h"
#include "app/grid/sweep.h"
#include "app/words/names.h"
#include "app/words/system.h"
#include "app/words/typed_file.h"
#include "app/words/words.h"
#include "core/aliases.h"
#include "core/basics.h"
#include "core/schemes.h"
#include "render/cells/text.h"

/* The word being typed: the part that stays, and the beginning of the candidates. */
struct stem {
    char front[256];
    const char *begin;
};

static void offer(const struct stem *stem, const char *candidate, const char *help)
{
    if (strncmp(candidate, stem->begin, strlen(stem->begin)) == 0) {
        printf("%s%s\t%s\n", stem->front, candidate, help);
    }
}

/* The stem is the text after the last of these characters, the front is the rest. */
static struct stem behind_last(const char *word, const char *breaks)
{
    struct stem stem = {.begin = word};
    for (const char *at = word; *at; at++) {
        if (strchr(breaks, *at)) {
            stem.begin = at + 1;
        }
    }
    snprintf(stem.front, sizeof stem.front, "%.*s", (int)(stem.begin - word), word);
    return stem;
}

static void offer_file(const struct gm_listed *listed, const void *stem)
{
    char title[128];
    snprintf(title, sizeof title, "%s", listed->title);
    if (!gm_text_is_plain(listed->name)) {
        return; /* a terminal would obey it */
    }
    offer(stem, listed->name, gm_text_tame(title));
}

/* A system or a room, unless it is offered as a scene. */
static void offer_other(const struct gm_listed *listed, const void *stem)
{
    if (gm_scene_number(listed->name) == gm_scene_count()) {
        offer_file(listed, stem);
    }
}

/* An unreadable folder is ignored here; `geomint list` reports it. */
static void offer_files(const struct stem *stem, enum gm_file_kind kind)
{
    char message[GM_MESSAGE];
    gm_files_each(kind, kind == GM_FILE_TOUR ? offer_file : offer_other, stem, message);
}

static void offer_scenes(const struct stem *stem)
{
    for (size_t i = 0; i < gm_scene_count(); i++) {
        offer(stem, gm_scene_name(i), gm_scene_title(i));
    }
    offer_files(stem, GM_FILE_SYSTEM);
    offer_files(stem, GM_FILE_ROOM);
}

/* The schemes, and once a letter is typed their aliases. */
static void offer_schemes(const struct stem *stem, const struct gm_scene *scene)
{
    const struct gm_scheme *fitting[GM_FITTING_SCHEMES];
    const size_t count = scene ? gm_fitting_elsewhere(scene, fitting) : gm_scheme_count();
    for (size_t i = 0; i < count; i++) {
        const struct gm_scheme *scheme = scene ? fitting[i] : gm_scheme_at(i);
        const char *alias = stem->begin[0] ? gm_alias_of(scheme->name, 0) : NULL;
        offer(stem, scheme->name, scheme->title);
        for (size_t k = 1; alias; alias = gm_alias_of(scheme->name, k++)) {
            if (scene || gm_scheme_find(alias) == scheme) { /* a scheme of that very name has precedence */
                offer(stem, alias, scheme->name);
            }
        }
    }
}

static void offer_observables(const struct stem *stem, const struct gm_scene *scene)
{
    const struct gm_observable *observable;
    for (size_t i = 0; scene && (observable = gm_scene_observable_at(scene, i)) != NULL; i++) {
        char title[GM_MESSAGE];
        offer(stem, observable->key, gm_observable_title(observable, title, sizeof title));
        if (observable->group && !gm_scene_observable_at(scene, i + 1)) {
            offer(stem, observable->group, "all Lyapunov exponents");
        }
    }
}

/* The values that an option's help names: "truecolor, 256, 16 or none", or "png|svg|pdf". */
static void offer_named(const struct stem *stem, const char *names)
{
    char copy[128], *rest = NULL;
    snprintf(copy, sizeof copy, "%s", names);
    for (char *name = strtok_r(copy, ", |", &rest); name; name = strtok_r(NULL, ", |", &rest)) {
        if (strcmp(name, "or") != 0) {
            offer(stem, name, "");
        }
    }
}

/* The values of an option; files and numbers have no list. */
static void offer_values(const struct gm_option *option, const struct stem *stem,
                         const struct gm_scene *scene)
{
    static const struct {
        const char *option, *value, *help;
        unsigned commands;
    } rows[] = {
        {"--judge", "bounded", "what is conserved stays within a factor of two", ~0U},
        {"--judge", "accurate", "the error is at most 0.1", ~0U},
        {"--judge", "accurate=1e-2", "or an error of yours", ~0U},
        {"--engine", "auto", "compiled if that is faster", ~0U},
        {"--engine", "interpreted", "at once, everywhere", ~0U},
        {"--engine", "native", "compiled first", ~0U},
        {"--theme", "light", "for paper", ~0U},
        {"--theme", "dark", "for a screen", ~0U},
        {"--theme", "mono", "without colours", GM_TUI},
    };
    for (size_t i = 0; i < GM_COUNT(rows); i++) {
        if (strcmp(option->name, rows[i].option) == 0 && option->commands & rows[i].commands) {
            offer(stem, rows[i].value, rows[i].help);
        }
    }
    if (strcmp(option->name, "--measure") == 0) {
        const char *comma = option->commands & (GM_SWEEP | GM_RUN) ? strrchr(stem->begin, ',') : NULL;
        struct stem last = *stem;
        if (comma) { /* a list is completed at its last value */
            gm_append(last.front, sizeof last.front, "%.*s", (int)(comma + 1 - stem->begin), stem->begin);
            last.begin = comma + 1;
        }
        offer_observables(&last, scene);
    } else if (strcmp(option->name, "--tour") == 0) {
        offer_files(stem, GM_FILE_TOUR);
    } else if (strcmp(option->name, "--retry") == 0) {
        offer_named(stem, gm_sweep_statuses);
    } else if (strcmp(option->name, "--region") == 0) {
        offer_schemes(stem, NULL);
    } else if (strcmp(option->name, "--on") == 0) {
        offer_scenes(stem);
    } else if (strcmp(option->name, "--format") == 0 ||
               (strcmp(option->name, "--at") == 0 && option->commands & GM_SWEEP)) {
        offer_named(stem, option->value);
    } else if (strcmp(option->name, "--graphics") == 0 || strcmp(option->name, "--colours") == 0) {
        offer_named(stem, option->help);
    }
}

static void offer_key(const struct stem *stem, const char *key, const char *help)
{
    char text[80];
    snprintf(text, sizeof text, "%s=", key);
    offer(stem, text, help);
}

static void offer_keys(const struct stem *stem, const struct gm_scene *scene)
{
    for (size_t i = 0; i < scene->parameter_count; i++) {
        if (gm_row_is_offered(&scene->parameters[i])) {
            offer_key(stem, scene->parameters[i].key, scene->parameters[i].help);
        }
    }
    for (size_t i = 0; i < gm_common_key_count; i++) {
        offer_key(stem, gm_common_keys[i].name, gm_common_keys[i].help);
    }
    const struct gm_scheme *fitting[GM_FITTING_SCHEMES];
    const size_t count = gm_fitting_schemes(scene, fitting);
    for (size_t i = 0; i < gm_settings_parameter_count; i++) {
        const struct gm_parameter *row = &gm_settings_parameters[i];
        if (!gm_scene_parameter(scene, row->key) && gm_fitting_take(fitting, count, row)) {
            offer_key(stem, row->key, row->help);
        }
    }
}

/* All values of a parameter as a range, which is easily edited into another one. */
static void offer_range(const struct stem *stem, const struct gm_parameter *row)
{
    enum { FEW = 20 };
    char low[40], high[40], text[128];
    const bool whole = row->type == GM_INTEGER, equal_factors = row->logarithmic && row->lowest > 0 && !whole;
    const double count = whole ? row->highest - row->lowest + 1 : 11;
    if (!isfinite(row->lowest) || !isfinite(row->highest) || !(count > 1 && count <= FEW)) {
        return;
    }
    gm_number_format(row->lowest, low, sizeof low);
    gm_number_format(row->highest, high, sizeof high);
    snprintf(text, sizeof text, "%s..%s:%s%.0f", low, high, equal_factors ? "log" : "", count);
    offer(stem, text, equal_factors ? "a range, by equal factors" : "a range, evenly");
}

/* key=value; the value may be a list. */
static void offer_assignment(const char *word, const struct gm_scene *scene, bool sweeps)
{
    const struct stem stem = behind_last(word, "=,");
    char key[64];
    snprintf(key, sizeof key, "%.*s", (int)strcspn(word, "="), word);
    const struct gm_common_key *common = gm_common_key_find(key);
    const struct gm_parameter *row = gm_word_parameter(scene, key);
    if (strcmp(key, "scheme") == 0) {
        offer_schemes(&stem, scene);
    } else if (common) {
        for (size_t i = 0; common->choices[i]; i++) {
            offer(&stem, common->choices[i], common->help);
        }
    } else if (row && row->type == GM_BOOLEAN) {
        offer(&stem, "no", "");
        offer(&stem, "yes", "");
    } else if (row && row->choices) {
        for (size_t i = 0; row->choices[i]; i++) {
            offer(&stem, row->choices[i], row->help);
        }
    } else if (row && stem.begin[0] == '\0' && !row->file) { /* the shells know the files */
        char range[128];
        snprintf(range, sizeof range, "the default; ");
        gm_catalogue_range(row, range + strlen(range), sizeof range - strlen(range));
        offer(&stem, row->standard, range);
        if (sweeps && (row->type == GM_REAL || row->type == GM_INTEGER)) {
            offer_range(&stem, row);
        }
    }
}

static const struct gm_option *option_of(const struct gm_command_row *command, const char *word)
{
    const struct gm_option *option = gm_option_find(gm_option_name(word), command->bit);
    return option && option->commands & command->bit ? option : NULL;
}

static void offer_options(const struct gm_command_row *command, const char *word,
                          const struct gm_scene *scene)
{
    if (strchr(word, '=')) {
        const struct gm_option *option = option_of(command, word);
        const struct stem value = behind_last(word, "=");
        if (option) {
            offer_values(option, &value, scene);
        }
        return;
    }
    const struct stem stem = {.begin = word};
    for (size_t i = 0; i < gm_option_count; i++) {
        if (gm_option_rows[i].commands & command->bit) {
            offer(&stem, gm_option_rows[i].name, gm_option_rows[i].help);
        }
    }
}

/* The words of a command that do not begin with --. */
static void offer_words(const struct gm_command_row *command, const char *word, const struct gm_scene *scene)
{
    static const char *const lists[] = {"scenes", "systems", "rooms", "schemes", "figures", "tours"};
    static const unsigned of_scenes =
        GM_TUI | GM_RUN | GM_RENDER | GM_WEB | (GM_CHARTS & ~(unsigned)GM_CERTIFY);
    const struct stem stem = {.begin = word};
    const struct gm_scene *of;
    const struct gm_figure *figure;
    for (size_t i = 0; command->bit == GM_LIST && i < GM_COUNT(lists); i++) {
        offer(&stem, lists[i], "");
    }
    for (size_t i = 0; command->bit == GM_FIGURES && (figure = gm_figure_at(i, &of)); i++) {
        offer(&stem, figure->name, figure->statement);
    }
    if (command->bit == GM_CERTIFY) {
        offer(&stem, "all", "every scheme");
    } else if (command->bit == GM_TOUR) {
        offer_files(&stem, GM_FILE_TOUR);
    }
    if (command->bit & (GM_LIST | GM_CERTIFY)) {
        offer_schemes(&stem, NULL);
    }
    const bool takes_scene = command->bit & of_scenes;
    if (command->bit == GM_LIST || (takes_scene && !scene)) {
        offer_scenes(&stem);
    } else if (takes_scene && strchr(word, '=')) {
        offer_assignment(word, scene, command->bit == GM_SWEEP);
    } else if (takes_scene) {
        offer_keys(&stem, scene);
    }
}

/* The keys of a system's formulas; a file's scene has the keys of its formulas. */
static void offer_formulas(const char *word, const char *system, const struct gm_scene *scene)
{
    const struct stem stem = {.begin = word};
    struct gm_arguments formulas = {0};
    if (gm_file_is(GM_FILE_ROOM, system)) {
        return; /* it has its lines in the file alone */
    }
    const bool known = scene && gm_typed_file_formulas(scene->text, &formulas);
    const bool typed = strcmp(system, gm_system_typed) == 0;
    for (const char *const *key = typed ? gm_typed_keys : gm_replacing_keys; *key; key++) {
        char assignment[32];
        snprintf(assignment, sizeof assignment, "%s=", *key);
        if (!known || gm_arguments_have(&formulas, assignment)) {
            offer_key(&stem, *key, "a formula of the system");
        }
    }
    gm_arguments_close(&formulas);
}

static void offer_commands(const char *word)
{
    const struct stem stem = {.begin = word};
    for (size_t i = 0; i < gm_command_count; i++) {
        offer(&stem, gm_commands[i].name, gm_commands[i].help);
    }
    offer_scenes(&stem);
    offer(&stem, "--help", "commands and options");
    offer(&stem, "--version", "version and libraries");
}

int gm_command_complete(const struct gm_options *options)
{
    const int count = options->arguments.count;
    char *const *words = options->arguments.words;
    const char *last = count > 0 ? words[count - 1] : "";
    if (count <= 1) {
        offer_commands(last);
        return GM_EXIT_OK;
    }
    const struct gm_command_row *command = gm_command_find(words[0]);
    const struct gm_scene *scene = NULL;
    const char *system = NULL;
    char message[GM_MESSAGE];
    int status;
    for (int i = 0; i < count - 1 && !scene; i++) {
        scene = gm_scene_find(words[i]);
        if (!scene && gm_system_is(words[i])) {
            system = system ? system : words[i];
            scene = gm_system_scene(count - 1 - i, words + i, &status, message);
        }
    }
    if (!command) {
        return GM_EXIT_OK;
    }
    const struct gm_option *option =
        count > 2 && !strchr(words[count - 2], '=') ? option_of(command, words[count - 2]) : NULL;
    if (option && option->value[0]) {
        const struct stem stem = {.begin = last};
        offer_values(option, &stem, scene);
    } else if (last[0] == '-') {
        offer_options(command, last, scene);
    } else {
        if (system && !strchr(last, '=')) {
            offer_formulas(last, system, scene);
        }
        if (scene || !system) {
            offer_words(command, last, scene);
        }
    }
    return GM_EXIT_OK;
}
