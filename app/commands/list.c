/* SPDX-License-Identifier: GPL-3.0-or-later */
/* geomint list: scenes, schemes, figures, and the parameters and schemes of one scene. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/base/files.h"
#include "app/commands/commands.h"
#include "app/commands/reference/reference.h"
#include "app/figures/figure.h"
#include "app/output/row.h"
#include "app/output/say.h"
#include "app/output/scheme_json.h"
#include "app/words/names.h"
#include "app/words/system.h"
#include "core/aliases.h"
#include "core/arena.h"
#include "core/basics.h"
#include "core/expression/nearest.h"
#include "core/memory.h"
#include "core/model/system.h"
#include "core/ode/indicators/tangent.h"
#include "core/ode/ode.h"
#include "core/schemes.h"
#include "render/cells/text.h"

/* A row of a list: JSON has its texts with their keys; otherwise the first two, and in a long list the
   next ones, up to number `longer`. */
static void list_texts(const struct gm_options *options, const char *const texts[][2], size_t count,
                       size_t longer, int width)
{
    if (options->json) {
        struct gm_row row = gm_row_begin(stdout);
        for (size_t i = 0; i < count; i++) {
            gm_row_text(&row, texts[i][0], texts[i][1]);
        }
        gm_row_close(&row, "\n");
        return;
    }
    char name[256]; /* it may be a file's */
    snprintf(name, sizeof name, "%s", texts[0][1]);
    gm_print_wrapped(texts[1][1], printf("%-*s ", width, gm_text_tame(name)), width + 1);
    for (size_t i = 2; options->longer && i < longer; i++) {
        gm_print_wrapped(texts[i][1], printf("  "), 2);
    }
}

static int list_scenes(const struct gm_options *options)
{
    for (size_t i = 0; i < gm_scene_count(); i++) {
        const struct gm_scene *scene = options->json || options->longer ? gm_scene_at(i) : NULL;
        const char *const texts[][2] = {{"scene", gm_scene_name(i)},
                                        {"title", gm_scene_title(i)},
                                        {"blurb", scene ? scene->blurb : ""},
                                        {"watch", scene ? scene->watch : ""},
                                        {"time_unit", scene ? scene->time : ""}};
        list_texts(options, texts, GM_COUNT(texts), GM_COUNT(texts) - 1, 16);
    }
    return GM_EXIT_OK;
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

/* Returns true if other kinds of problems have schemes with the same name. */
static bool shares_name(const struct gm_scheme *scheme)
{
    for (size_t i = 0; i < gm_scheme_count(); i++) {
        const struct gm_scheme *other = gm_scheme_at(i);
        if (other != scheme && strcmp(other->name, scheme->name) == 0) {
            return true;
        }
    }
    return false;
}

/* The widths of the columns of schemes' names, and up to their titles. */
enum { NAME = 29, TITLE = 42 };

/* `kinds`: rows with the same name give their kinds of problems; `same`: the scheme with the same steps,
   or NULL. */
static void list_scheme(const struct gm_scheme *scheme, const struct gm_options *options, bool kinds,
                        const struct gm_scheme *same)
{
    char letters[GM_CLAIM_COUNT + 1], text[512];
    if (options->json) {
        gm_scheme_put(stdout, scheme);
        printf("\n");
        return;
    }
    const bool several = options->longer || (kinds && shares_name(scheme));
    gm_catalogue_letters(scheme, letters);
    snprintf(text, sizeof text, "%s%s%s%s%s%s", scheme->title, several ? ", for " : "",
             several ? gm_scheme_problems(scheme) : "", same ? "; = " : "", same ? same->name : "",
             same ? " here" : "");
    gm_print_wrapped(text, printf("%-*s %d  %s ", NAME, scheme->name, scheme->order, letters), TITLE);
    if (options->longer) {
        print_formula(scheme->formula);
        const bool equations = scheme->family->kind == &gm_kind_ode;
        snprintf(text, sizeof text, "%s; %s%s%s", scheme->family->title, scheme->reference,
                 equations ? "; derivative of a step: " : "", equations ? gm_tangent_word(scheme) : "");
        gm_print_wrapped(text, printf("  "), 2);
        text[0] = '\0';
        const char *alias;
        for (size_t i = 0; (alias = gm_alias_of(scheme->name, i)); i++) {
            gm_append(text, sizeof text, "%s%s", i == 0 ? "also called " : ", ", alias);
        }
        if (text[0]) {
            gm_print_wrapped(text, printf("  "), 2);
        }
    }
}

/* The meanings of the letters of claims, for all claims that these schemes make. */
static void print_legend(const struct gm_scheme *const *schemes, size_t count)
{
    char text[512] = "claims: ";
    unsigned claims = 0;
    for (size_t i = 0; i < count; i++) {
        claims |= schemes[i]->claims;
    }
    const size_t before = strlen(text);
    gm_catalogue_claims(claims, true, text + before, sizeof text - before);
    printf("\n");
    gm_print_wrapped(text, 0, 8);
}

/* The page of a scheme and of all that have its name, for other kinds of problems; NULL: a list of all schemes. */
static int list_schemes_like(const struct gm_scheme *like, const struct gm_options *options)
{
    const struct gm_scheme *schemes[GM_FITTING_SCHEMES];
    size_t count = 0;
    if (like && like->word) {
        schemes[count++] = like;
    }
    for (size_t i = 0; i < gm_scheme_count() && count < GM_FITTING_SCHEMES; i++) {
        if (!like || strcmp(gm_scheme_at(i)->name, like->name) == 0) {
            schemes[count++] = gm_scheme_at(i);
        }
    }
    struct gm_options longer = *options;
    longer.longer |= like != NULL;
    for (size_t i = 0; i < count; i++) {
        list_scheme(schemes[i], &longer, true, NULL);
    }
    if (!options->json) {
        print_legend(schemes, count);
    }
    return GM_EXIT_OK;
}

static int list_schemes(const struct gm_options *options)
{
    return list_schemes_like(NULL, options);
}

static int list_figures(const struct gm_options *options)
{
    const struct gm_scene *scene;
    const struct gm_figure *figure;
    for (size_t i = 0; (figure = gm_figure_at(i, &scene)); i++) {
        if (options->json) {
            struct gm_row row = gm_row_begin(stdout);
            gm_row_put(&row, "figure %s, scene %s, arguments %s, statement %s", figure->name, scene->name,
                       figure->arguments, figure->statement);
            gm_row_close(&row, "\n");
            continue;
        }
        gm_print_wrapped(figure->statement, printf("%-22s ", figure->name), 23);
        if (options->longer) {
            gm_print_wrapped(figure->arguments, printf("  geomint render %s ", scene->name), 2);
        }
    }
    return GM_EXIT_OK;
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

static void put_parameter(struct gm_row *rows, const struct gm_parameter *parameter)
{
    char range[256];
    struct gm_row row = gm_row_open(rows, NULL, '}');
    gm_row_put(&row, "key %s, default %s, range %s, live %d, help %s", parameter->key, parameter->standard,
               gm_catalogue_range(parameter, range, sizeof range), parameter->live, parameter->help);
}

static void put_keys(struct gm_row *row, const char *key, const struct gm_observable *observables,
                     size_t count)
{
    struct gm_row keys = gm_row_open(row, key, ']');
    for (size_t i = 0; i < count; i++) {
        gm_row_text(&keys, NULL, observables[i].key);
    }
}

/* The default lanes of a command for a scene, given by its name or the path of its file:
   "scheme=rk4,verlet". */
static const char *default_lanes(const struct gm_options *options, const char *name, size_t schemes)
{
    char *words[] = {gm_arena_print(options->arena, "%s", name)};
    const char *lanes = strstr(gm_command_parse(options, 1, words, schemes)->arguments, " scheme=");
    return lanes ? lanes + 1 : "";
}

/* The description of a scene. */
struct entry {
    const struct gm_scene *scene;
    const struct gm_scheme *schemes[GM_FITTING_SCHEMES]; /* the fitting schemes */
    const struct gm_scheme
        *same[GM_FITTING_SCHEMES]; /* the other schemes whose steps are the same here, or NULL */
    size_t scheme_count;
    const struct gm_parameter **rows; /* the parameters of the scene and of its fitting schemes */
    size_t row_count;
    const char *run, *render; /* the default lanes of these commands */
};

static void open_entry(struct entry *entry, const struct gm_scene *scene, const char *name,
                       const struct gm_options *options)
{
    *entry = (struct entry){.scene = scene};
    entry->rows = gm_arena_take(options->arena, scene->parameter_count + gm_settings_parameter_count,
                                sizeof *entry->rows);
    entry->run = default_lanes(options, name, GM_RUN_SCHEMES);
    entry->render = default_lanes(options, name, GM_RENDER_SCHEMES);
    for (size_t i = 0; i < scene->parameter_count; i++) {
        if (gm_row_is_offered(&scene->parameters[i])) {
            entry->rows[entry->row_count++] = &scene->parameters[i];
        }
    }
    entry->scheme_count = gm_fitting_schemes(scene, entry->schemes);
    gm_fitting_same(scene, entry->schemes, entry->scheme_count, entry->same);
    for (size_t i = 0; i < gm_settings_parameter_count; i++) {
        if (gm_fitting_take(entry->schemes, entry->scheme_count, &gm_settings_parameters[i])) {
            entry->rows[entry->row_count++] = &gm_settings_parameters[i];
        }
    }
    /* an incomplete list looks like a complete one */
    gm_arena_need(options->arena, !gm_memory_was_short());
}

static void print_entry(const struct entry *entry, const struct gm_options *options)
{
    const struct gm_scene *scene = entry->scene;
    gm_print_wrapped(scene->title, 0, 0);
    gm_print_wrapped(scene->blurb, 0, 0);
    gm_print_wrapped(scene->watch, 0, 0);
    gm_print_wrapped(gm_arena_print(options->arena, "The unit of time is %s.", scene->time), 0, 0);
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
    printf("\ndefault lanes\n");
    gm_print_wrapped(entry->run, printf("  run     "), 10);
    gm_print_wrapped(entry->render, printf("  render  "), 10);
    printf("\n");
    gm_print_wrapped("order claims", printf("%-*s ", NAME, "schemes that fit"), NAME + 1);
    for (size_t i = 0; i < entry->scheme_count; i++) {
        list_scheme(entry->schemes[i], options, false, entry->same[i]);
    }
    print_legend(entry->schemes, entry->scheme_count);
}

static void print_entry_json(const struct entry *entry, const struct gm_file *file)
{
    const struct gm_scene *scene = entry->scene;
    struct gm_row row = gm_row_begin(stdout);
    gm_row_put(&row, "scene %s, title %s, watch %s, time_unit %s, run %s, render %s", scene->name,
               scene->title, scene->watch, scene->time, entry->run, entry->render);
    struct gm_row parameters = gm_row_open(&row, "parameters", ']');
    for (size_t i = 0; i < entry->row_count; i++) {
        put_parameter(&parameters, entry->rows[i]);
    }
    put_keys(&row, "observables", scene->observables, scene->observable_count);
    put_keys(&row, "asked", scene->asked, scene->asked_count);
    gm_list_put_schemes(&row, entry->schemes, entry->same, entry->scheme_count);
    gm_list_put_file(&row, file, file && file->built_in ? file->built_in->text : scene->room);
    gm_row_close(&row, "\n");
}

/* Returns true if a word means a file: a scene of the program has precedence over a file, unless it is
   built on it. */
static bool find_file(enum gm_file_kind kind, const char *word, struct gm_file *file)
{
    return gm_file_find(kind, word, file) && (file->built_in || !gm_scene_find(word));
}

/* `file`: the scene's file, or NULL. */
static int list_scene(const struct gm_scene *scene, const char *name, const struct gm_file *file,
                      const struct gm_options *options)
{
    struct entry entry;
    struct gm_file system;
    open_entry(&entry, scene, name, options);
    if (options->json) {
        print_entry_json(&entry, file);
    } else {
        print_entry(&entry, options);
        if (options->longer && find_file(GM_FILE_SYSTEM, name, &system)) {
            gm_list_structure(options, &system);
        }
    }
    return GM_EXIT_OK;
}

/* The lists beside those of a scene. */
static const struct list {
    const char *name;
    int (*print)(const struct gm_options *options); /* returns an exit status; NULL: it is one of files */
    const char *word;                               /* the word for one file, in JSON */
    enum gm_file_kind kind;
} lists[] = {{.name = "scenes", .print = list_scenes},
             {.name = "systems", .word = "system", .kind = GM_FILE_SYSTEM},
             {.name = "rooms", .word = "room", .kind = GM_FILE_ROOM},
             {.name = "schemes", .print = list_schemes},
             {.name = "figures", .print = list_figures},
             {.name = "tours", .print = gm_list_tours}};

struct listing {
    const struct list *list;
    const struct gm_options *options;
};

static void list_file(const struct gm_listed *listed, const void *data)
{
    const struct listing *listing = data;
    const char *const texts[][2] = {
        {listing->list->word, listed->name}, {"title", listed->title}, {"about", listed->about}};
    list_texts(listing->options, texts, GM_COUNT(texts), GM_COUNT(texts), 21);
}

static int list_files(const struct list *list, const struct gm_options *options)
{
    char message[GM_MESSAGE];
    const bool listed = gm_files_each(list->kind, list_file, &(const struct listing){list, options}, message);
    return listed ? GM_EXIT_OK : gm_give_up(GM_EXIT_FILE, "%s", message);
}

static const struct list *find_list(const char *word)
{
    for (size_t i = 0; i < GM_COUNT(lists); i++) {
        if (strcmp(lists[i].name, word) == 0) {
            return &lists[i];
        }
    }
    return NULL;
}

static const char *list_name(size_t i, const void *data)
{
    return (void)data, lists[i].name;
}

static int list_markdown(const struct gm_options *options, const char *what)
{
    const bool scenes = strcmp(what, "scenes") == 0;
    gm_command_end_if(options, !scenes && strcmp(what, "schemes") != 0, GM_EXIT_USAGE,
                      "--markdown lists scenes or schemes");
    (scenes ? gm_catalogue_scenes_markdown : gm_catalogue_schemes_markdown)();
    return GM_EXIT_OK;
}

static bool is_figure(const char *word)
{
    const struct gm_scene *scene;
    const struct gm_figure *figure;
    for (size_t i = 0; (figure = gm_figure_at(i, &scene)); i++) {
        if (strcmp(figure->name, word) == 0) {
            return true;
        }
    }
    return false;
}

_Noreturn static void refuse_name(const struct gm_options *options, const char *word)
{
    struct gm_file tour;
    const bool figure = is_figure(word);
    gm_command_end_if(options, figure || gm_file_find(GM_FILE_TOUR, word, &tour), GM_EXIT_USAGE,
                      "%.60s is a %s: geomint %s %.60s", word, figure ? "figure" : "tour",
                      figure ? "figures" : "tour", word);
    char near[GM_NEAR_NAMES], folder[GM_MESSAGE] = "";
    const char *list = gm_nearest(word, GM_COUNT(lists), list_name, NULL);
    const char *found = list                                 ? list
                        : gm_system_near(word, near, folder) ? near
                        : folder[0]                          ? NULL
                                                             : gm_scheme_near(word, NULL, 0);
    gm_command_end_if(options, !found && folder[0], GM_EXIT_FILE, "%s", folder);
    gm_command_end(
        options, GM_EXIT_USAGE,
        "list knows scenes, systems, rooms, schemes, figures, tours and the names of scenes, systems, "
        "rooms and schemes, not \"%.60s\"%s%s",
        word, found ? "; did you mean " : "", found ? found : "");
}

/* Returns false if nothing of that name has a file. */
static bool find_source(const char *word, struct gm_file *file)
{
    enum gm_file_kind kind = GM_FILE_SYSTEM;
    while (kind < GM_FILE_MESH && !find_file(kind, word, file)) {
        kind++;
    }
    return kind < GM_FILE_MESH;
}

/* A scheme may have its word for a file, and an alias has the file of what it means. */
static int list_source(const struct gm_options *options, const char *word)
{
    struct gm_file file;
    char message[GM_MESSAGE] = "";
    size_t length = 0;
    bool unreadable = false, found = find_source(word, &file);
    const struct gm_scheme *scheme = found ? NULL : gm_scheme_named(word, &unreadable, message);
    gm_command_end_if(options, message[0], unreadable ? GM_EXIT_FILE : GM_EXIT_USAGE, "%s", message);
    if (scheme && scheme->word) {
        puts(scheme->word);
        return GM_EXIT_OK;
    }
    const char *meaning = gm_alias_meaning(word);
    found = found || (scheme && find_source(scheme->name, &file)) || (meaning && find_source(meaning, &file));
    gm_command_end_if(options, !found && (scheme || gm_scene_find(word) || find_list(word)), GM_EXIT_USAGE,
                      "%.60s has no file, for it is a part of the program; geomint list %.60s describes it",
                      word, word);
    if (!found) {
        refuse_name(options, word);
    }
    char *text = gm_file_read(&file, GM_LARGEST_SYSTEM, &length, message);
    gm_command_end_if(options, !text, GM_EXIT_FILE, "%s", message);
    fwrite(text, 1, length, stdout);
    free(text);
    return GM_EXIT_OK;
}

/* The scheme that a name, the path of a file or a word means. */
static int list_named_scheme(const char *name, const struct gm_options *options)
{
    char message[GM_MESSAGE];
    bool unreadable;
    const struct gm_scheme *scheme = gm_scheme_named(name, &unreadable, message);
    gm_command_end_if(options, !scheme && message[0], unreadable ? GM_EXIT_FILE : GM_EXIT_USAGE, "%s",
                      message);
    if (!scheme) {
        refuse_name(options, name);
    }
    return list_schemes_like(scheme, options);
}

int gm_command_list(const struct gm_options *options)
{
    struct gm_file file;
    const char *first = options->arguments.count > 0 ? options->arguments.words[0] : "";
    const bool typed = strcmp(first, gm_system_typed) == 0 && options->arguments.count > 1;
    const bool equations =
        options->latex || options->invariants || options->arguments.count > 1 || !gm_scene_find(first);
    const bool is_system = *first && equations && find_file(GM_FILE_SYSTEM, first, &file);
    gm_command_end_if(options, options->degree && !options->invariants, GM_EXIT_USAGE,
                      "--degree is that of --invariants, which is missing");
    if ((is_system || typed) && !options->markdown && !options->source) {
        return gm_list_system(options, typed ? NULL : &file);
    }
    gm_command_end_if(options, options->invariants, GM_EXIT_USAGE,
                      "--invariants are those of a system: list kepler --invariants");
    gm_command_end_if(options, options->latex, GM_EXIT_USAGE,
                      "--latex writes the equations of a system, such as share/systems/toda.system");
    gm_command_end_if(
        options, options->arguments.count > 1, GM_EXIT_USAGE,
        "list takes one name, and values only after the name of a system: list kepler eccentricity=0.3");
    const char *what = options->arguments.count ? options->arguments.words[0] : "scenes";
    if (options->source || options->markdown) {
        return (options->source ? list_source : list_markdown)(options, what);
    }
    const struct list *list = find_list(what);
    if (list) {
        return list->print ? list->print(options) : list_files(list, options);
    }
    const struct gm_scene *scene = gm_scene_called(what);
    const bool room = !scene && gm_file_find(GM_FILE_ROOM, what, &file),
               from_file = room || (scene && (find_file(GM_FILE_SYSTEM, what, &file) ||
                                              find_file(GM_FILE_ROOM, what, &file)));
    if (room) {
        int status;
        char message[GM_MESSAGE];
        scene = gm_system_scene(1, options->arguments.words, &status, message);
        gm_command_end_if(options, !scene, status, "%s", message);
    }
    return scene ? list_scene(scene, what, from_file ? &file : NULL, options)
                 : list_named_scheme(what, options);
}
