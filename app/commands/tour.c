/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The commands around the explorer: geomint tui, geomint tour, which also lists and renders tours, geomint grade,
   which repeats an answer to an exercise, and geomint terminal, which reports the terminal's abilities. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/base/files.h"
#include "app/base/interrupt.h"
#include "app/commands/commands.h"
#include "app/explorer/explorer.h"
#include "app/output/row.h"
#include "app/output/say.h"
#include "app/tours/tour.h"
#include "core/arena.h"
#include "core/basics.h"
#include "core/expression/number.h"

int gm_list_tours(const struct gm_options *options)
{
    char message[GM_MESSAGE];
    size_t count = 0;
    struct gm_tour *tours = gm_tours_read(&count, message);
    for (size_t i = 0; i < count; i++) {
        if (options->json) {
            struct gm_row row = gm_row_begin(stdout);
            gm_row_put(&row, "tour %s, title %s, about %s, steps %i", tours[i].name, tours[i].title,
                       tours[i].about ? tours[i].about : "", (int)tours[i].count);
            gm_row_close(&row, "\n");
            continue;
        }
        gm_say("%-16s %s (%zu step%s)", tours[i].name, tours[i].title, tours[i].count,
               gm_plural((double)tours[i].count));
        printf("%-16s %s\n", "", tours[i].about ? tours[i].about : "");
    }
    gm_tours_close(tours, count);
    if (message[0]) {
        gm_complain("%s", message);
    }
    return message[0] ? GM_EXIT_FILE : GM_EXIT_OK;
}

static void print_text(const char *word, const char *text)
{
    if (text) {
        printf("   %-7s %s\n", word, text);
    }
}

static int list_steps(const struct gm_tour *tour)
{
    printf("%s\n%s\n", tour->title, tour->about ? tour->about : "");
    for (size_t i = 0; i < tour->count; i++) {
        const struct gm_tour_step *step = &tour->steps[i];
        printf("\n%zu. %s\n", i + 1, step->title);
        print_text("", step->say);
        print_text("ask", step->ask);
        for (size_t k = 0; k < step->expectation_count; k++) {
            print_text("expect", step->expectations[k].text);
        }
        print_text("hint", step->hint);
        print_text("answer", step->answer);
        print_text("watch", step->watch);
        print_text("try", step->attempt);
        if (step->show) {
            printf("   %-7s geomint %s\n", "shows", step->show);
        }
        for (size_t k = 0; k < step->change_count; k++) {
            print_text("at", step->changes[k].line);
        }
    }
    return GM_EXIT_OK;
}

/* A movie has light or dark paper. */
static int make_movie(const struct gm_tour *tour, const struct gm_options *options)
{
    const bool dark = options->terminal.theme && strcmp(options->terminal.theme, "dark") == 0;
    gm_command_end_if(options,
                      options->terminal.theme && !dark && strcmp(options->terminal.theme, "light") != 0,
                      GM_EXIT_USAGE, "--theme %.60s is none of: light, dark", options->terminal.theme);
    struct gm_tour_output output = {.movie = options->pace.movie,
                                    .folder = options->out,
                                    .fps = isnan(options->pace.fps) ? 30 : options->pace.fps,
                                    .look = options->look};
    output.look.theme = dark ? GM_THEME_DARK : GM_THEME_LIGHT;
    gm_catch_interrupts();
    return gm_tour_render(tour, &output);
}

/* Opens the explorer, or draws it into a file together with the command that repeats it. */
static int explore(const struct gm_options *options, const char *command, const struct gm_request *request,
                   const struct gm_tour *tour)
{
    struct gm_overrides terminal = options->terminal;
    struct gm_arguments *words = gm_arguments_in(options->arena);
    const char *const more[][2] = {{"--keys", terminal.keys},
                                   {"--graphics", terminal.graphics},
                                   {"--colours", terminal.colours},
                                   {"--theme", terminal.theme}};
    if (!terminal.shot) {
        return terminal.keys || terminal.screen
                   ? gm_give_up(GM_EXIT_USAGE, "--keys and --screen need --shot FILE")
                   : gm_explorer(request, tour, &terminal);
    }
    gm_arguments_append(words, options->arguments.words, options->arguments.count);
    for (size_t i = 0; i < GM_COUNT(more); i++) {
        gm_arguments_append(words, (char **)more[i], more[i][1] ? 2 : 0);
    }
    gm_arena_need(options->arena, !words->failed);
    terminal.words = gm_arena_keep(options->arena, gm_arguments_join(command, words), free);
    return gm_explorer(request, tour, &terminal);
}

int gm_command_tour(const struct gm_options *options)
{
    char message[GM_MESSAGE];
    struct gm_file file;
    struct gm_tour *tour = gm_arena_take(options->arena, 1, sizeof *tour);
    bool unreadable = false;
    gm_command_end_if(options, options->arguments.count > 1, GM_EXIT_USAGE,
                      "tour takes one name; put a name of several words in quotation marks");
    gm_command_end_if(options, options->arguments.count == 0 && (options->pace.movie || options->out),
                      GM_EXIT_USAGE, "which tour? geomint tour lists them");
    if (options->arguments.count == 0) {
        return gm_list_tours(options);
    }
    const bool found = gm_tour_find(options->arguments.words[0], &file, &unreadable, message);
    gm_command_end_if(options, !found || !gm_tour_read(tour, &file, message),
                      found || unreadable ? GM_EXIT_FILE : GM_EXIT_USAGE, "%s", message);
    gm_arena_keep(options->arena, tour, gm_tour_close);
    if (options->listing) {
        return list_steps(tour);
    }
    const bool moving = options->pace.movie || options->out;
    return moving ? make_movie(tour, options) : explore(options, "tour", NULL, tour);
}

int gm_command_grade(const struct gm_options *options)
{
    enum { MOST_BYTES = 1 << 16, MOST_SECONDS = 60 };
    char message[GM_MESSAGE], exercise[GM_MESSAGE];
    char *const *words = options->arguments.words;
    struct gm_file file = {0};
    size_t size = 0;
    gm_command_end_if(
        options, options->arguments.count < 1 || options->arguments.count > 2, GM_EXIT_USAGE,
        "grade takes a file that S in an exercise of `geomint tour` has saved, and the tour if it is "
        "not the file's own");
    snprintf(file.path, sizeof file.path, "%s", words[0]);
    char *text = gm_file_read(&file, MOST_BYTES, &size, message);
    gm_command_end_if(options, !text, GM_EXIT_FILE, "%s", message);
    gm_arena_keep(options->arena, text, free);
    gm_catch_interrupts();
    gm_interrupts_limit(MOST_SECONDS,
                        "geomint: the answer needs more than a minute of CPU time, so it has no "
                        "verdict; take fewer steps or a scheme that needs less\n");
    const int status = gm_answer_grade(text, size, words[1], exercise, message);
    if (gm_interrupted) {
        return GM_EXIT_INTERRUPTED;
    }
    if (status != GM_EXIT_OK && status != GM_EXIT_CLAIM) {
        return gm_give_up(status, "%.200s: %s", words[0], message);
    }
    printf("%s\n%s\n", exercise, message);
    return status;
}

int gm_command_terminal(const struct gm_options *options)
{
    gm_command_end_if(options, options->arguments.count > 0, GM_EXIT_USAGE, "terminal takes no arguments");
    return gm_terminal_report(&options->terminal);
}

int gm_command_tui(const struct gm_options *options)
{
    const struct gm_arguments *words = &options->arguments;
    const struct gm_request *request =
        words->count > 0 ? gm_command_parse(options, words->count, words->words, GM_RENDER_SCHEMES) : NULL;
    return explore(options, "tui", request, NULL);
}
