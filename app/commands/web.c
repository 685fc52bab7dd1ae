/* SPDX-License-Identifier: GPL-3.0-or-later */
/* geomint web: a page of HTML for a browser, which contains the program, a view, and the files that it names. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "app/commands/commands.h"
#include "app/grid/grid.h"
#include "app/native/cache.h"
#include "app/output/say.h"
#include "app/tours/tour.h"
#include "app/words/drive.h"
#include "app/words/names.h"
#include "app/words/typed_file.h"
#include "app/words/words.h"
#include "core/arena.h"
#include "core/basics.h"
#include "core/expression/lines.h"
#include "core/linear/cholesky.h"
#include "render/files/regular_file.h"
#include "render/files/temporary.h"
#include "render/message.h"

enum { LARGEST_PAGE = 1 << 26, LARGEST_FILE = 1 << 22 };

struct lesson {
    const struct gm_options *options;
    const char *title;
    const struct gm_tour *tour;
    const struct gm_file *file;       /* of the tour */
    const struct gm_arguments *words; /* of the view */
    struct gm_arguments *files;       /* path, name and text of each */
};

/* The paths of the files that were read for the view. */
static struct gm_arguments *seen;

static void see(const char *path)
{
    gm_arguments_add(seen, path);
}

/* A path without . and .., from where the page begins. */
static char *from_begin(const struct lesson *lesson, const char *path)
{
    struct gm_arena *arena = lesson->options->arena;
    char *name = gm_arena_print(arena, "%s", ""), *end;
    for (size_t length; *path; path += length + strspn(path + length, "/")) {
        length = strcspn(path, "/");
        if (length == 2 && strncmp(path, "..", 2) == 0) {
            end = strrchr(name, '/');
            *(end ? end : name) = '\0';
        } else if (length > 0 && !(length == 1 && *path == '.')) {
            name = gm_arena_print(arena, "%s%s%.*s", name, *name ? "/" : "", (int)length, path);
        }
    }
    return name;
}

/* The length of a path's folders, with the last slash. */
static size_t folders_of(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? (size_t)(slash + 1 - path) : 0;
}

/* The name of a file in the page: with a tour its path from the folder of the tour, which is where the page begins, else
   without folders. */
static const char *name_of(const struct lesson *lesson, const char *path)
{
    const char *tour = lesson->tour ? lesson->file->path : NULL;
    const size_t folders = tour ? folders_of(tour) : folders_of(path);
    return from_begin(lesson, tour && strncmp(path, tour, folders) != 0 ? path : path + folders);
}

static const char *read_text(const struct gm_options *options, const struct gm_file *file)
{
    char message[GM_MESSAGE];
    size_t length;
    char *text = gm_file_read(file, LARGEST_FILE, &length, message);
    gm_command_end_if(options, !text, GM_EXIT_FILE, "%s", message);
    gm_arena_keep(options->arena, text, free);
    gm_command_end_if(options, strlen(text) != length, GM_EXIT_FILE,
                      "%.300s has a zero byte; a page takes texts alone", file->path);
    return text;
}

/* Adds a file to the page by this name there, which it returns. */
static const char *take(const struct lesson *lesson, const struct gm_file *file, const char *name)
{
    const char *text = read_text(lesson->options, file);
    for (int i = 0; i < lesson->files->count; i += 3) {
        if (strcmp(lesson->files->words[i + 1], name) == 0) {
            gm_command_end_if(lesson->options, strcmp(lesson->files->words[i + 2], text) != 0, GM_EXIT_USAGE,
                              "two different files are called %.200s; rename one of them", name);
            return name;
        }
    }
    gm_arguments_add(lesson->files, file->path);
    gm_arguments_add(lesson->files, name);
    gm_arguments_add(lesson->files, text);
    return name;
}

/* The word as the page has it: with the name that its file has there, which is added to the page. */
static const char *take_file(const struct lesson *lesson, enum gm_file_kind kind, const char *word)
{
    /* there a name without a path is looked up in a page */
    static const char home[] = "home/web_user/.config/geomint";
    struct gm_arena *arena = lesson->options->arena;
    struct gm_file file;
    if (!gm_file_find(kind, word, &file) || file.built_in) {
        return word;
    }
    /* the text of a tour, which the page reads again, names it in this way */
    if (lesson->tour && !gm_word_ends(word, gm_file_endings[kind])) {
        take(lesson, &file, gm_arena_print(arena, "%s/%s", home, basename(file.path)));
        return word;
    }
    return take(lesson, &file, name_of(lesson, file.path));
}

/* The word with the names of its schemes' files, which are added to the page. */
static const char *take_schemes(const struct lesson *lesson, const char *word)
{
    struct gm_arena *arena = lesson->options->arena;
    const char *value = gm_word_after(word, "scheme"), *taken = value ? "scheme=" : word;
    for (size_t length; value; value = value[length] ? value + length + 1 : NULL) {
        char message[GM_MESSAGE];
        bool unreadable;
        length = gm_word_first(value);
        const char *name = gm_arena_print(arena, "%.*s", (int)length, value);
        const struct gm_scheme *scheme = gm_scheme_named(name, &unreadable, message);
        name = scheme && scheme->word ? take_file(lesson, GM_FILE_SCHEME, name) : name;
        taken = gm_arena_print(arena, "%s%s%s", taken, name, value[length] ? "," : "");
    }
    return taken;
}

/* Writes words as a list, with their files added to the page. */
static void put_words(const struct lesson *lesson, struct gm_row *row, const char *key,
                      const struct gm_arguments *words)
{
    struct gm_row list = gm_row_open(row, key, ']');
    for (int i = 0; i < words->count; i++) {
        const char *word = words->words[i];
        gm_row_text(&list, NULL,
                    i > 0 ? take_schemes(lesson, word) : take_file(lesson, GM_FILE_SYSTEM, word));
    }
}

/* The words of a study's command, with the names that its files have in the page. */
static const char *tell_study(const struct lesson *lesson, const char *study, const char *words)
{
    struct gm_arena *arena = lesson->options->arena;
    const struct gm_arguments *list = gm_arguments_of(arena, words);
    const char *text = study;
    for (int i = 0; i < list->count; i++) {
        const char *word = list->words[i],
                   *taken = i > 0 ? take_schemes(lesson, word) : take_file(lesson, GM_FILE_SYSTEM, word);
        struct gm_text_stream writing;
        FILE *stream = gm_stream_begin(&writing);
        gm_arena_need(arena, stream);
        gm_arguments_put_shell(stream, taken);
        const char *quoted = gm_arena_keep(arena, gm_stream_end(&writing), free);
        text = gm_arena_print(arena, "%s %s", text, quoted);
    }
    return text;
}

/* Refuses a tour that names a file by a path of this machine, which leads nowhere in a page. */
static void check_paths(const struct gm_options *options, const char *text)
{
    static const char *const with_words[] = {"show", "at", "study"};
    struct gm_text_line line;
    struct gm_fault fault;
    for (size_t at = 0; gm_lines_next(text, strlen(text), &at, &line, &fault);) {
        bool has_words = false;
        for (size_t i = 0; i < GM_COUNT(with_words); i++) {
            has_words = has_words || gm_span_is(text, line.word, with_words[i]);
        }
        const size_t length = has_words ? line.value.end - line.value.begin : 0;
        const char *value = gm_arena_print(options->arena, "%.*s", (int)length, text + line.value.begin);
        const struct gm_arguments *words = gm_arguments_of(options->arena, value);
        for (int i = 0; i < words->count; i++) {
            const char *word = words->words[i];
            gm_command_end_if(
                options, word[0] == '/' || strstr(word, "=/") || strstr(word, ",/"), GM_EXIT_USAGE,
                "a page does not have the folders of %.200s: its tour names files by paths from "
                "its own folder",
                word);
        }
    }
}

static void put_tour(const struct lesson *lesson, struct gm_row *view)
{
    const char *name = lesson->tour->name;
    if (!lesson->file->built_in) {
        name = take(lesson, lesson->file, name_of(lesson, lesson->file->path));
        check_paths(lesson->options, lesson->files->words[lesson->files->count - 1]);
    }
    gm_row_put(view, "tour %s", name);
    struct gm_row steps = gm_row_open(view, "steps", ']');
    for (size_t i = 0; i < lesson->tour->count; i++) {
        const struct gm_tour_step *step = &lesson->tour->steps[i];
        struct gm_row row = gm_row_open(&steps, NULL, '}');
        gm_row_put(&row, "title %s, say %s, ask %s, exercise %d, hint %s, answer %s", step->title, step->say,
                   step->ask, step->expectation_count > 0, step->hint, step->answer);
        gm_row_put(&row, "watch %s, try %s, until %.17g, seconds %.17g", step->watch, step->attempt,
                   step->until, step->seconds);
        if (step->study) {
            const char *study = gm_study_rows[step->study]->name;
            gm_row_put(&row, "study %s", tell_study(lesson, study, step->study_words));
        }
        if (step->show) {
            put_words(lesson, &row, "show", gm_arguments_of(lesson->options->arena, step->show));
        }
        struct gm_row changes = gm_row_open(&row, "changes", ']');
        for (size_t k = 0; k < step->change_count; k++) {
            const struct gm_tour_change *change = &step->changes[k];
            struct gm_row one = gm_row_open(&changes, NULL, '}');
            gm_row_put(&one, "t %.17g, lane %.0f, text %s", change->t, (double)change->lane,
                       take_schemes(lesson, change->text));
        }
    }
}

/* Adds the meshes that were read for the view, beside the files that name them by paths from their own folders. */
static void take_meshes(const struct lesson *lesson)
{
    const int count = lesson->files->count;
    for (int i = 0; i < seen->count; i++) {
        struct gm_file file = {0};
        const char *mesh = seen->words[i], *of = NULL;
        size_t most = 0;
        for (int k = 0; k < count; k += 3) {
            const char *path = lesson->files->words[k];
            const size_t folders = folders_of(path);
            if (strncmp(mesh, path, folders) == 0 && (folders > 0 || mesh[0] != '/') &&
                (!of || folders > most)) {
                of = lesson->files->words[k + 1];
                most = folders;
            }
        }
        if (of && gm_word_ends(mesh, ".msh")) {
            snprintf(file.path, sizeof file.path, "%s", mesh);
            take(lesson, &file,
                 from_begin(lesson, gm_arena_print(lesson->options->arena, "%.*s%s", (int)folders_of(of), of,
                                                   mesh + most)));
        }
    }
}

static void drop_stream(void *writing)
{
    free(gm_stream_end(writing));
}

/* The view as JSON. A < is written as its number, since </script> would end the element of the page. */
static const char *print_view(const struct lesson *lesson)
{
    struct gm_arena *arena = lesson->options->arena;
    struct gm_text_stream *writing = gm_arena_take(arena, 1, sizeof *writing);
    FILE *stream = gm_stream_begin(writing);
    gm_arena_need(arena, stream);
    gm_arena_keep(arena, writing, drop_stream); /* words may be refused while it is open */
    struct gm_row view = gm_row_begin(stream);
    gm_row_put(&view, "version %s, title %s", GM_VERSION, lesson->title);
    put_words(lesson, &view, "words", lesson->words);
    if (lesson->tour) {
        put_tour(lesson, &view);
    }
    take_meshes(lesson);
    struct gm_row files = gm_row_open(&view, "files", '}');
    for (int i = 0; i < lesson->files->count; i += 3) {
        gm_row_text(&files, lesson->files->words[i + 1], lesson->files->words[i + 2]);
    }
    gm_row_close(&view, "");
    const char *text = gm_arena_keep(arena, gm_stream_end(writing), free);
    stream = gm_stream_begin(writing);
    gm_arena_need(arena, text && stream);
    for (; *text; text++) {
        fputs(*text == '<' ? "\\u003c" : (char[]){*text, '\0'}, stream);
    }
    text = gm_arena_keep(arena, gm_stream_end(writing), free);
    gm_arena_need(arena, text);
    return text;
}

/* The page that the build for the browser made. */
static const char *read_page(const struct gm_options *options)
{
    char kernel[GM_CACHE_PATH], reason[GM_REGULAR_REASON];
    const char *given = getenv("GEOMINT_WEB");
    size_t size;
    gm_kernel_folder(kernel, sizeof kernel);
    const char *path =
        given && *given ? given : gm_arena_print(options->arena, "%s/../web/page.html", kernel);
    see(path);
    char *page = gm_regular_read(path, LARGEST_PAGE, &size, reason);
    gm_command_end_if(options, !page, GM_EXIT_FILE,
                      "%.200s could not be read: %s; ./geomint setup web builds the part for the browser",
                      path, reason);
    return gm_arena_keep(options->arena, page, free);
}

static void find_tour(const struct gm_options *options, struct gm_file *file)
{
    char message[GM_MESSAGE];
    bool unreadable = false;
    gm_command_end_if(options, !gm_tour_find(options->tour, file, &unreadable, message),
                      unreadable ? GM_EXIT_FILE : GM_EXIT_USAGE, "%s", message);
}

static void read_tour(const struct gm_options *options, const struct gm_file *file, struct gm_tour *tour)
{
    char message[GM_MESSAGE];
    gm_command_end_if(options, !gm_tour_read(tour, file, message), GM_EXIT_FILE, "%s", message);
    gm_arena_keep(options->arena, tour, gm_tour_close);
}

/* Refuses lanes that need sparse equations for a step, which the page could not make. */
static void try_lanes(const struct gm_options *options, const struct gm_request *request)
{
    char message[GM_MESSAGE];
    for (size_t i = 0; i < request->count; i++) {
        struct gm_lane *lane = gm_lane_in(options->arena, gm_request_open_lane(request, i, message), message);
        gm_drive_to(&(struct gm_drive){.lane = lane, .request = request, .index = i}, 1, false, message);
        gm_command_end_if(options, lane->run->status == GM_OUT_OF_MEMORY, GM_EXIT_USAGE,
                          "the sparse equations of %.60s are solved by SuiteSparse: %s", lane->schemes,
                          gm_cholesky_missing());
    }
}

/* Refuses a view for which a file was read that the page does not have. */
static void check_files(const struct lesson *lesson)
{
    for (int i = 0, k; i < seen->count; i++) {
        for (k = 0;
             k < lesson->files->count && !gm_command_same_file(lesson->files->words[k], seen->words[i]);) {
            k += 3;
        }
        gm_command_end_if(
            lesson->options, k == lesson->files->count, GM_EXIT_USAGE,
            "a page takes files of systems, schemes and tours along, and meshes whose names end in .msh, but not %.200s",
            seen->words[i]);
    }
}

int gm_command_web(const struct gm_options *options)
{
    char slot[GM_PAGE_SLOT];
    struct lesson lesson = {
        .options = options, .words = &options->arguments, .files = gm_arguments_in(options->arena)};
    struct gm_tour *tour = gm_arena_take(options->arena, 1, sizeof *tour);
    const struct gm_scene *scene = NULL;
    const char *path = options->lesson ? options->lesson : "lesson.html", *dot = strrchr(basename(path), '.');
    gm_command_end_if(options, !dot || (strcasecmp(dot, ".html") != 0 && strcasecmp(dot, ".htm") != 0),
                      GM_EXIT_USAGE, "a page is HTML: its name ends in .html or .htm, but not %.200s", path);
    gm_command_end_if(options, options->tour && lesson.words->count > 0, GM_EXIT_USAGE,
                      "web takes a scene or --tour, which has scenes of its own");
    struct gm_file file;
    if (options->tour) { /* all tours are looked through, also those that a browser does not have */
        find_tour(options, &file);
    }
    seen = gm_arguments_in(options->arena);
    gm_cholesky_do_without("a browser does not have it");
    gm_regular_watch = see;
    const struct gm_request *request = NULL;
    if (options->tour) {
        read_tour(options, &file, tour);
        lesson.tour = tour;
        lesson.file = &file;
    } else if (lesson.words->count > 0) {
        request = gm_command_parse(options, lesson.words->count, lesson.words->words, GM_RENDER_SCHEMES);
        scene = request->scene;
    }
    gm_regular_watch = NULL;
    for (size_t i = 0; i < tour->count; i++) {
        try_lanes(options, &tour->steps[i].request);
    }
    if (request) {
        try_lanes(options, request);
    }
    lesson.title = options->look.title ? options->look.title
                   : lesson.tour       ? tour->title
                   : scene             ? scene->title
                                       : "geomint";
    const char *view = print_view(&lesson);
    check_files(&lesson);
    const char *page = read_page(options);
    for (int i = 0; i < seen->count; i++) {
        gm_command_end_if(options, gm_command_same_file(path, seen->words[i]), GM_EXIT_USAGE,
                          "--output would overwrite %.300s, which is read", seen->words[i]);
    }
    struct gm_text_stream writing;
    FILE *stream = gm_stream_begin(&writing);
    gm_arena_need(options->arena, stream);
    int slots = 0;
    for (; gm_page_next(stream, &page, slot); slots++) {
        fputs(view, stream);
    }
    char *text = gm_arena_keep(options->arena, gm_stream_end(&writing), free);
    gm_arena_need(options->arena, text);
    gm_command_end_if(options, slots != 1, GM_EXIT_FILE,
                      "the page that GEOMINT_WEB names is not one of ./geomint setup web");
    const int problem = gm_temporary_write(path, text, strlen(text));
    gm_command_end_if(options, problem, GM_EXIT_FILE, "%.300s could not be written: %s", path,
                      strerror(problem));
    gm_complain("wrote %s", path);
    return GM_EXIT_OK;
}
