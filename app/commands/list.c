/* SPDX-License-Identifier: GPL-3.0-or-later */
/* geomint list: scenes, schemes, figures, and what one scene takes. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/base/files.h"
#include "app/commands/commands.h"
#include "app/commands/reference/catalogue.h"
#include "app/commands/reference/system.h"
#include "app/output/json.h"
#include "app/output/row.h"
#include "app/output/say.h"
#include "app/output/scheme_json.h"
#include "app/output/wrapped.h"
#include "app/words/fitting.h"
#include "app/words/lookup.h"
#include "app/words/room.h"
#include "app/words/system.h"
#include "core/expression/nearest.h"
#include "core/memory.h"
#include "core/model/system.h"
#include "core/ode/indicators/tangent.h"
#include "core/ode/ode.h"
#include "core/schemes.h"
#include "render/files/regular_file.h"

static void list_scenes(const struct gm_options *options)
{
    for (size_t i = 0; i < gm_scene_count(); i++) {
        const struct gm_scene *scene = gm_scene_at(i);
        if (options->json) {
            struct gm_row row = gm_row_begin(stdout);
            gm_row_text(&row, "scene", scene->name);
            gm_row_text(&row, "title", scene->title);
            gm_row_text(&row, "blurb", scene->blurb);
            gm_row_text(&row, "watch", scene->watch);
            gm_row_text(&row, "time_unit", scene->time);
            printf("}\n");
            continue;
        }
        gm_print_wrapped(scene->title, printf("%-16s ", scene->name), 17);
        if (options->longer) {
            gm_print_wrapped(scene->blurb, printf("  "), 2);
            gm_print_wrapped(scene->watch, printf("  "), 2);
        }
    }
}

/* A system or a room by its name, with the word for it in JSON. */
static void list_file(const char *word, const struct gm_listed *listed, const struct gm_options *options)
{
    if (options->json) {
        printf("{");
        gm_json_pair(word, listed->name);
        printf(",");
        gm_json_pair("title", listed->title);
        printf(",");
        gm_json_pair("about", listed->about);
        printf("}\n");
    } else {
        gm_print_wrapped(listed->title, printf("%-21s ", listed->name), 22);
        if (options->longer) {
            gm_print_wrapped(listed->about, printf("  "), 2);
        }
    }
}

static void list_system(const struct gm_listed *listed, const void *options)
{
    list_file("system", listed, options);
}

static void list_room(const struct gm_listed *listed, const void *options)
{
    list_file("room", listed, options);
}

/* Returns an exit status. */
static int list_files(enum gm_file_kind kind, const struct gm_options *options)
{
    char message[GM_MESSAGE];
    const bool good = gm_files_each(kind, kind == GM_FILE_ROOM ? list_room : list_system, options, message);
    if (!good) {
        gm_complain("%s", message);
    }
    return gm_finish(good ? GM_EXIT_OK : GM_EXIT_FILE);
}

static void print_formula(const char *text)
{
    while (*text) {
        char line[512];
        const size_t length = strcspn(text, "\n");
        snprintf(line, sizeof line, "%.*s", (int)length, text);
        gm_print_wrapped(line, printf("  "), 4);
        text += length + (text[length] == '\n');
    }
}

/* The widths of the columns of schemes' names, and up to their titles. */
enum { NAME = 29, TITLE = 42 };

/* `kinds`: rows of one name say which kind of problem each is for. */
static void list_scheme(const struct gm_scheme *scheme, const struct gm_options *options, bool kinds)
{
    char letters[GM_CLAIM_COUNT + 1], text[512];
    gm_catalogue_letters(scheme, letters);
    if (!options->json) {
        const bool several = options->longer || (kinds && gm_catalogue_shares_name(scheme));
        snprintf(text, sizeof text, "%s%s%s", scheme->title, several ? ", for " : "",
                 several ? gm_scheme_problems(scheme) : "");
        gm_print_wrapped(text, printf("%-*s %d  %s ", NAME, scheme->name, scheme->order, letters), TITLE);
        if (options->longer) {
            print_formula(scheme->formula);
            const bool equations = scheme->family->kind == &gm_kind_ode;
            snprintf(text, sizeof text, "%s; %s%s%s", scheme->family->title, scheme->reference,
                     equations ? "; derivative of a step: " : "", equations ? gm_tangent_word(scheme) : "");
            gm_print_wrapped(text, printf("  "), 2);
        }
        return;
    }
    gm_scheme_put(stdout, scheme);
    printf("\n");
}

/* What the letters of claims mean, of all that these schemes have. */
static void print_legend(const struct gm_scheme *const *schemes, size_t count)
{
    char text[512] = "claims:";
    unsigned claims = 0;
    for (size_t i = 0; i < count; i++) {
        claims |= schemes[i]->claims;
    }
    const char *comma = " ";
    for (unsigned bit = 0; bit < GM_CLAIM_COUNT; bit++) {
        const size_t used = strlen(text);
        if (claims >> bit & 1) {
            snprintf(text + used, sizeof text - used, "%s%s %s", comma, gm_claim_letter(bit),
                     gm_claim_word(bit));
            comma = ", ";
        }
    }
    printf("\n");
    gm_print_wrapped(claims ? text : "claims: none", 0, 8);
}

static void list_schemes(const struct gm_options *options)
{
    const struct gm_scheme *schemes[GM_FITTING_SCHEMES];
    size_t count = 0;
    for (; count < gm_scheme_count() && count < GM_FITTING_SCHEMES; count++) {
        schemes[count] = gm_scheme_at(count);
        list_scheme(schemes[count], options, true);
    }
    if (!options->json) {
        print_legend(schemes, count);
    }
}

static void list_figures(const struct gm_options *options)
{
    for (size_t s = 0; s < gm_scene_count(); s++) {
        const struct gm_scene *scene = gm_scene_at(s);
        for (size_t f = 0; f < scene->figure_count; f++) {
            const struct gm_figure *figure = &scene->figures[f];
            if (options->json) {
                struct gm_row row = gm_row_begin(stdout);
                gm_row_text(&row, "figure", figure->name);
                gm_row_text(&row, "scene", scene->name);
                gm_row_text(&row, "arguments", figure->arguments);
                gm_row_text(&row, "statement", figure->statement);
                printf("}\n");
            } else {
                gm_print_wrapped(figure->statement, printf("%-22s ", figure->name), 23);
                if (options->longer) {
                    gm_print_wrapped(figure->arguments, printf("  geomint render %s ", scene->name), 2);
                }
            }
        }
    }
}

/* The widths of the columns of parameters' keys and defaults. */
enum { KEY = 14, DEFAULT = 12 };

static void print_parameter(const struct gm_parameter *row)
{
    char range[256], text[512];
    gm_catalogue_range(row, range, sizeof range);
    snprintf(text, sizeof text, "%s%s%s [%s]", row->help, row->unit[0] ? ", in " : "", row->unit, range);
    const int before = printf("  %-*s %s", KEY, row->key, row->standard);
    const bool fits = before < KEY + DEFAULT + 4;
    gm_print_wrapped(text, printf(fits ? " " : "\n") + (fits ? before : -1), KEY + DEFAULT + 4);
}

static void print_parameter_json(const struct gm_parameter *parameter)
{
    char range[256];
    struct gm_row row = gm_row_begin(stdout);
    gm_row_text(&row, "key", parameter->key);
    gm_row_text(&row, "default", parameter->standard);
    gm_row_text(&row, "range", gm_catalogue_range(parameter, range, sizeof range));
    gm_row_flag(&row, "live", parameter->live);
    gm_row_text(&row, "help", parameter->help);
    gm_row_close(&row);
}

/* What a command takes where nothing is said but the scene, by its name or the path of its file:
   "scheme=rk4,verlet"; malloc'ed, NULL with a sentence, or when memory is short. */
static char *default_lanes(const char *name, size_t schemes, char *message)
{
    char *words[] = {strdup(name)}, *text = NULL;
    struct gm_request request;
    if (words[0] && gm_request_parse(&request, 1, words, schemes, message)) {
        const char *lanes = strstr(request.arguments, " scheme=");
        text = strdup(lanes ? lanes + 1 : "");
        gm_request_close(&request);
    }
    free(words[0]);
    return text;
}

/* All that is known of a scene. */
struct entry {
    const struct gm_scene *scene;
    const struct gm_scheme *schemes[GM_FITTING_SCHEMES]; /* those that fit */
    size_t scheme_count;
    const struct gm_parameter **rows; /* those of the scene, and those that a fitting scheme brings */
    size_t row_count;
    char *run, *render; /* their lanes */
};

static bool open_entry(struct entry *entry, const struct gm_scene *scene, const char *name, char *message)
{
    *entry = (struct entry){.scene = scene};
    entry->rows = calloc(scene->parameter_count + gm_settings_parameter_count, sizeof *entry->rows);
    entry->run = default_lanes(name, GM_RUN_SCHEMES, message);
    entry->render = entry->run ? default_lanes(name, GM_RENDER_SCHEMES, message) : NULL;
    if (!entry->rows) {
        return gm_refuse(message, "not enough memory");
    }
    for (size_t i = 0; i < scene->parameter_count; i++) {
        entry->rows[entry->row_count++] = &scene->parameters[i];
    }
    entry->scheme_count = gm_fitting_schemes(scene, entry->schemes);
    for (size_t i = 0; i < gm_settings_parameter_count; i++) {
        if (gm_fitting_take(entry->schemes, entry->scheme_count, &gm_settings_parameters[i])) {
            entry->rows[entry->row_count++] = &gm_settings_parameters[i];
        }
    }
    /* half a list would be taken for a whole one */
    if (gm_memory_was_short()) {
        return gm_refuse(message, "not enough memory");
    }
    return entry->render != NULL;
}

static void close_entry(struct entry *entry)
{
    free(entry->rows);
    free(entry->run);
    free(entry->render);
}

static void print_entry(const struct entry *entry, const struct gm_options *options)
{
    const struct gm_scene *scene = entry->scene;
    gm_print_wrapped(scene->title, 0, 0);
    gm_print_wrapped(scene->blurb, 0, 0);
    gm_print_wrapped(scene->watch, 0, 0);
    char unit[GM_MESSAGE];
    snprintf(unit, sizeof unit, "The unit of time is %s.", scene->time);
    gm_print_wrapped(unit, 0, 0);
    printf("\n");
    gm_print_wrapped("meaning [range]", printf("%-*s default ", KEY + 2, "parameter"), KEY + DEFAULT + 4);
    for (size_t i = 0; i < entry->row_count; i++) {
        print_parameter(entry->rows[i]);
    }
    const struct gm_observable *observable;
    for (size_t i = 0; (observable = gm_scene_observable_at(scene, i)) != NULL; i++) {
        char title[GM_MESSAGE];
        fputs(i == 0 ? "\nobservables\n" : "", stdout);
        fputs(i == scene->observable_count ? "computed when asked for by --measure\n" : "", stdout);
        gm_print_wrapped(gm_observable_title(observable, title, sizeof title),
                         printf("  %s ", observable->key), KEY + 11);
    }
    printf("\nlanes, where nothing more is said\n");
    gm_print_wrapped(entry->run, printf("  run     "), 10);
    gm_print_wrapped(entry->render, printf("  render  "), 10);
    printf("\n");
    gm_print_wrapped("order claims", printf("%-*s ", NAME, "schemes that fit"), NAME + 1);
    for (size_t i = 0; i < entry->scheme_count; i++) {
        list_scheme(entry->schemes[i], options, false);
    }
    print_legend(entry->schemes, entry->scheme_count);
}

static void print_entry_json(const struct entry *entry, const struct gm_file *file)
{
    const struct gm_scene *scene = entry->scene;
    struct gm_row row = gm_row_begin(stdout);
    gm_row_text(&row, "scene", scene->name);
    gm_row_text(&row, "title", scene->title);
    gm_row_text(&row, "watch", scene->watch);
    gm_row_text(&row, "time_unit", scene->time);
    gm_row_text(&row, "run", entry->run);
    gm_row_text(&row, "render", entry->render);
    printf(",\"parameters\":[");
    for (size_t i = 0; i < entry->row_count; i++) {
        printf("%s", i ? "," : "");
        print_parameter_json(entry->rows[i]);
    }
    printf("],\"observables\":[");
    for (size_t i = 0; i < scene->observable_count; i++) {
        printf("%s\"%s\"", i ? "," : "", scene->observables[i].key);
    }
    printf("],\"asked\":[");
    for (size_t i = 0; i < scene->asked_count; i++) {
        printf("%s\"%s\"", i ? "," : "", scene->asked[i].key);
    }
    printf("],\"schemes\":[");
    for (size_t i = 0; i < entry->scheme_count; i++) {
        printf("%s\"%s\"", i ? "," : "", entry->schemes[i]->name);
    }
    printf("]");
    const char *source = file && file->built_in ? file->built_in->text : entry->scene->room;
    gm_list_file_json(file, source);
    printf("}\n");
}

/* `file`: that of the scene; NULL: it has none. */
static bool list_scene(const struct gm_scene *scene, const char *name, const struct gm_file *file,
                       const struct gm_options *options)
{
    char message[GM_MESSAGE];
    struct entry entry;
    const bool good = open_entry(&entry, scene, name, message);
    if (!good) {
        gm_complain("%s", message);
    } else if (options->json) {
        print_entry_json(&entry, file);
    } else {
        print_entry(&entry, options);
    }
    close_entry(&entry);
    return good;
}

/* The lists beside those of a scene. */
enum { LISTS = 6 };

static int list_markdown(const char *what)
{
    if (strcmp(what, "scenes") == 0) {
        gm_catalogue_scenes_markdown();
    } else if (strcmp(what, "schemes") == 0) {
        gm_catalogue_schemes_markdown();
    } else {
        gm_complain("--markdown lists scenes or schemes");
        return GM_EXIT_USAGE;
    }
    return gm_finish(GM_EXIT_OK);
}

static const char *list_name(size_t i, const void *data)
{
    static const char *const lists[LISTS] = {"scenes", "systems", "rooms", "schemes", "figures", "tours"};
    return (void)data, lists[i];
}

static int refuse_name(const char *word)
{
    char near[GM_NEAR], folder[GM_MESSAGE] = "";
    const char *list = gm_nearest(word, LISTS, list_name, NULL);
    const bool found = list || gm_system_near(word, near, folder);
    if (!found && folder[0]) {
        gm_complain("%s", folder);
        return GM_EXIT_FILE;
    }
    gm_complain(
        "list knows scenes, systems, rooms, schemes, figures, tours and the names of scenes, systems and "
        "rooms, not \"%.60s\"%s%s",
        word, found ? "; did you mean " : "",
        list    ? list
        : found ? near
                : "");
    return GM_EXIT_USAGE;
}

/* Whether a word means a file: a scene of the program hides a file of its name, unless it is made of it. */
static bool find_file(enum gm_file_kind kind, const char *word, struct gm_file *file)
{
    return gm_file_find(kind, word, file) && (file->built_in || !gm_scene_find(word));
}

/* The text of the file that a word means. */
static int list_source(const char *word)
{
    struct gm_file file;
    char reason[GM_REGULAR_REASON];
    size_t length = 0;
    enum gm_file_kind kind = GM_FILE_SYSTEM;
    while (kind < GM_FILE_MESH && !find_file(kind, word, &file)) {
        kind++;
    }
    bool known = gm_scene_find(word) || gm_scheme_find(word);
    for (size_t i = 0; i < LISTS; i++) {
        known |= strcmp(word, list_name(i, NULL)) == 0;
    }
    if (kind == GM_FILE_MESH && known) {
        gm_complain("%.60s has no file", word);
        return GM_EXIT_USAGE;
    }
    if (kind == GM_FILE_MESH) {
        return refuse_name(word);
    }
    char *text = gm_file_read(&file, GM_LARGEST_SYSTEM, &length, reason);
    if (!text) {
        gm_complain("%.300s could not be read: %s", file.path, reason);
        return GM_EXIT_FILE;
    }
    fwrite(text, 1, length, stdout);
    free(text);
    return gm_finish(GM_EXIT_OK);
}

static int command_list(const struct gm_options *options)
{
    struct gm_file file;
    const char *first = options->arguments.count > 0 ? options->arguments.words[0] : "";
    const bool typed = strcmp(first, gm_system_typed) == 0 && options->arguments.count > 1;
    const bool is_system =
        *first && (options->latex || !gm_scene_find(first)) && find_file(GM_FILE_SYSTEM, first, &file);
    if ((is_system || typed) && !options->markdown && !options->source) {
        const enum gm_telling telling = options->json     ? GM_TELL_JSON
                                        : options->latex  ? GM_TELL_LATEX
                                        : options->longer ? GM_TELL_ALL
                                                          : GM_TELL_SHORT;
        return gm_list_system(&options->arguments, typed ? NULL : &file, telling);
    }
    if (options->latex) {
        gm_complain("--latex writes the equations of a system, such as share/systems/toda.system");
        return GM_EXIT_USAGE;
    }
    if (options->arguments.count > 1) {
        gm_complain(
            "list takes one name: scenes, systems, rooms, schemes, figures, tours, a scene, a system or a room");
        return GM_EXIT_USAGE;
    }
    const char *what = options->arguments.count ? options->arguments.words[0] : "scenes";
    if (options->source) {
        return list_source(what);
    }
    if (options->markdown) {
        return list_markdown(what);
    }
    const struct gm_scene *scene = gm_scene_find(what);
    const bool room = !scene && gm_file_find(GM_FILE_ROOM, what, &file),
               from_file = room || (scene && (find_file(GM_FILE_SYSTEM, what, &file) ||
                                              find_file(GM_FILE_ROOM, what, &file)));
    if (room) {
        int status;
        char message[GM_MESSAGE];
        scene = gm_room_scene(what, &status, message);
        if (!scene) {
            gm_complain("%s", message);
            return status;
        }
    }
    if (strcmp(what, "scenes") == 0) {
        list_scenes(options);
    } else if (strcmp(what, "systems") == 0) {
        return list_files(GM_FILE_SYSTEM, options);
    } else if (strcmp(what, "rooms") == 0) {
        return list_files(GM_FILE_ROOM, options);
    } else if (strcmp(what, "schemes") == 0) {
        list_schemes(options);
    } else if (strcmp(what, "figures") == 0) {
        list_figures(options);
    } else if (strcmp(what, "tours") == 0) {
        return gm_list_tours(options->json);
    } else if (!scene) {
        return refuse_name(what);
    } else if (!list_scene(scene, what, from_file ? &file : NULL, options)) {
        return GM_EXIT_USAGE;
    }
    return gm_finish(GM_EXIT_OK);
}

const struct gm_command_row gm_command_list = {
    .name = "list",
    .synopsis = "[scenes|systems|rooms|schemes|figures|tours|SCENE|SYSTEM|ROOM]",
    .help = "what there is",
    .bit = GM_LIST,
    .function = command_list,
};
