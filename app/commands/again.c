/* SPDX-License-Identifier: GPL-3.0-or-later */
/* geomint again FILE: redraws a picture from its stored metadata. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/base/arguments.h"
#include "app/base/interrupt.h"
#include "app/commands/commands.h"
#include "app/output/printer.h"
#include "app/output/provenance.h"
#include "app/output/say.h"
#include "app/words/drive.h"
#include "app/words/system.h"
#include "core/arena.h"
#include "core/expression/lines.h"
#include "core/schemes.h"
#include "render/pixels/canvas.h"
#include "render/vector/vector.h"

/* The texts that it reads. */
enum {
    COMMAND,
    ARGUMENTS,
    CHANGES,
    STEPS,
    PICTURE,
    NEEDED,
    SCALE = NEEDED,
    DPI,
    PAGE,
    TITLE,
    SYSTEM,
    ROOM,
    PAINTER,
    TEXTS
};
static const char *const keys[TEXTS] = {GM_KEY_COMMAND, GM_KEY_ARGUMENTS, GM_KEY_CHANGES, GM_KEY_STEPS,
                                        GM_KEY_PICTURE, GM_KEY_SCALE,     GM_KEY_DPI,     GM_KEY_PAGE,
                                        GM_KEY_TITLE,   GM_KEY_SYSTEM,    GM_KEY_ROOM,    GM_KEY_PAINTER};

_Noreturn static void refuse(const struct gm_options *options, const char *why)
{
    gm_command_end(options, GM_EXIT_FILE, "%s cannot be reproduced: %s", options->arguments.words[0], why);
}

/* Opens every lane and drives it to the step that `steps` names for it. */
static const struct gm_lane *const *drive(const struct gm_options *options, const struct gm_request *request,
                                          const char *steps)
{
    char message[GM_MESSAGE];
    const struct gm_lane **lanes = gm_arena_take(options->arena, request->count, sizeof *lanes);
    for (size_t i = 0; i < request->count; i++) {
        char *end = NULL;
        const int64_t step = strtoll(steps, &end, 10);
        if (end == steps || step < 0 || step > GM_MOST_STEPS) {
            refuse(options, "its steps are damaged");
        }
        steps = end;
        struct gm_lane *lane = gm_request_open_lane(request, i, message);
        if (!lane) {
            refuse(options, message);
        }
        lanes[i] = gm_lane_in(options->arena, lane, message);
        struct gm_drive one = {.lane = lane, .request = request, .index = i};
        if (!gm_drive_to(&one, step, true, message)) {
            refuse(options, message);
        }
    }
    return lanes;
}

/* The word that named the system now means the text stored in the picture. */
static void recall_system(const struct gm_options *options, char *const *texts)
{
    const char *told = texts[COMMAND] ? texts[COMMAND] : texts[ARGUMENTS];
    const struct gm_arguments *words = gm_arguments_of(options->arena, texts[SYSTEM] && told ? told : "");
    const int place = texts[COMMAND] ? gm_provenance_scene_place(words) : 0;
    gm_arena_need(options->arena,
                  words->count <= place || gm_system_recall(words->words[place], texts[SYSTEM]));
}

/* NAME-again, with `end` after it. */
static const char *output_name(const struct gm_options *options, const char *end)
{
    const char *base = basename(options->arguments.words[0]), *dot = strrchr(base, '.');
    const int length = dot ? (int)(dot - base) : (int)strlen(base);
    return gm_arena_print(options->arena, "%.*s-again%s", length, base, end);
}

static const char *print_path(const struct gm_options *options)
{
    const char *end = gm_arena_print(options->arena, ".%s", gm_format_name(options->format));
    return options->output ? options->output
                           : gm_arena_print(options->arena, "%s/%s", options->out ? options->out : ".",
                                            output_name(options, end));
}

/* Repeats a chart's measurement: its run times are new. */
static int chart_again(const struct gm_options *options, const char *command)
{
    char message[GM_MESSAGE] = "its command is damaged";
    struct gm_arguments *words = gm_arguments_of(options->arena, command);
    const struct gm_command_row *chart = words->count > 0 ? gm_command_find(words->words[0]) : NULL;
    /* the chart's command may leave by the arena */
    struct gm_options *again = gm_arena_take(options->arena, 1, sizeof *again);
    gm_arena_keep(options->arena, again, gm_options_close);
    if (chart && chart->bit & (GM_CHARTS | GM_TUI | GM_TOUR) &&
        gm_options_parse(again, chart->bit, words->count, words->words, 1, message)) {
        again->out = options->out || options->output ? options->out : ".";
        again->output = options->output;
        again->format = options->format;
        again->name = output_name(options, "");
        again->terminal.shot = chart->bit & GM_CHARTS ? NULL : print_path(options);
        again->arena = options->arena;
        again->end = options->end;
        return chart->function(again);
    }
    gm_complain("%s cannot be reproduced: %s", options->arguments.words[0], message);
    return GM_EXIT_FILE;
}

/* The painter of the stored PNG is used by default. */
static bool take_painter(const struct gm_options *options, char *painter, char *message)
{
    if (options->painter || options->format != GM_FORMAT_PNG || !painter) {
        return true;
    }
    painter[strcspn(painter, ",")] = '\0'; /* versions follow the painter's name */
    return gm_canvas_choose(painter, message);
}

/* Reads a number of a text within bounds; 0 for no text. Returns false if it is damaged. */
static bool take_number(const char *text, double low, double high, double *number)
{
    *number = 0;
    return !text || (gm_number_parse(text, number) && *number >= low && *number <= high);
}

/* The appearance that the texts describe; its title is one of them. */
static bool take_look(struct gm_appearance *look, char *const *texts)
{
    char theme[8] = "";
    if (sscanf(texts[PICTURE], "%5dx%5d %7s", &look->width, &look->height, theme) != 3 ||
        look->width < GM_LEAST_SIDE || look->height < GM_LEAST_SIDE || look->width > GM_MOST_SIDE ||
        look->height > GM_MOST_SIDE) {
        return false;
    }
    look->theme = strcmp(theme, "dark") == 0 ? GM_THEME_DARK : GM_THEME_LIGHT;
    look->title = texts[TITLE];
    if (texts[PAGE] && (sscanf(texts[PAGE], "%lfx%lf", &look->page_width, &look->page_height) != 2 ||
                        !(look->page_width > 0) || !(look->page_height > 0))) {
        return false;
    }
    return take_number(texts[SCALE], GM_LEAST_SCALE, GM_MOST_SCALE, &look->scale) &&
           take_number(texts[DPI], GM_LEAST_DPI, GM_MOST_DPI, &look->dpi);
}

/* Reports schemes that were given by names of earlier versions. */
static void tell_aliases(const struct gm_options *options, const char *arguments)
{
    static const char key[] = "scheme=";
    const struct gm_arguments *words = gm_arguments_of(options->arena, arguments);
    for (int i = 1; i < words->count; i++) {
        const char *list = words->words[i];
        struct gm_span rest = {sizeof key - 1, strlen(list)}, name;
        while (strncmp(list, key, sizeof key - 1) == 0 && gm_span_take(list, &rest, ",", &name)) {
            const char *typed =
                gm_arena_print(options->arena, "%.*s", (int)(name.end - name.begin), list + name.begin);
            const struct gm_scheme *scheme = gm_scheme_find(typed);
            if (scheme && !scheme->word && strcmp(scheme->name, typed) != 0) {
                gm_complain("%s is %s", typed, scheme->name);
            }
        }
    }
}

static int picture_again(const struct gm_options *options, char *const *texts)
{
    char message[GM_MESSAGE];
    struct gm_print print = {.path = print_path(options), .format = options->format};
    struct gm_request *request = gm_arena_take(options->arena, 1, sizeof *request);
    for (size_t i = ARGUMENTS; i < NEEDED; i++) {
        gm_command_end_if(options, !texts[i], GM_EXIT_FILE,
                          "%.360s does not record how it was made (it lacks %s)", options->arguments.words[0],
                          keys[i]);
    }
    if (!take_look(&print.look, texts)) {
        refuse(options, "its size is damaged");
    }
    gm_arena_keep(options->arena, request, gm_request_close);
    const bool recalled = gm_request_recall(request, NULL, texts[ARGUMENTS], message);
    gm_command_end_if(options, !recalled && gm_request_refusal(request) == GM_EXIT_USAGE, GM_EXIT_FILE,
                      "%s cannot be redrawn from the words of an earlier version, \"%.300s\"; "
                      "render them without the refused one: %s",
                      options->arguments.words[0], texts[ARGUMENTS], message);
    if (!recalled) {
        refuse(options, message);
    }
    if (!gm_changes_parse(request, texts[CHANGES])) {
        refuse(options, "its log of changes is damaged");
    }
    tell_aliases(options, texts[ARGUMENTS]);
    gm_catch_interrupts();
    gm_printer_expect(print.format);
    /* a room is read from its files, which may be others by now */
    const char *now = request->scene->room ? request->scene->mark : "none";
    if (texts[ROOM] && strcmp(texts[ROOM], now) != 0) {
        gm_refuse(message, "its room is another one now: it was %.100s, and is %.100s", texts[ROOM], now);
        refuse(options, message);
    }
    const struct gm_lane *const *lanes = drive(options, request, texts[STEPS]);
    int status = GM_EXIT_OK;
    if (gm_interrupted) {
        status = GM_EXIT_INTERRUPTED;
    } else if (!gm_still_write(&print, request, lanes, message)) {
        status = gm_printer_fail(print.path, message);
    } else {
        gm_printer_report(&print, "");
    }
    return status;
}

int gm_command_again(const struct gm_options *options)
{
    if (options->arguments.count > 1) {
        return gm_give_up(GM_EXIT_USAGE, "again makes one picture as it was made; \"%.60s\" is too much",
                          options->arguments.words[1]);
    }
    gm_command_end_if(options, options->arguments.count == 0, GM_EXIT_USAGE,
                      "again which picture? A PNG or SVG file that geomint made");
    char message[GM_MESSAGE], *texts[TEXTS];
    const char *path = options->arguments.words[0];
    enum gm_format format = GM_FORMAT_PNG;
    const bool drawn = gm_format_of(path, &format) && format == GM_FORMAT_SVG;
    gm_command_end_if(options, format == GM_FORMAT_PDF, GM_EXIT_FILE,
                      "again reads PNG and SVG files; a PDF, such as %.300s, does not record how it was made",
                      path);
    gm_command_end_if(options,
                      !(drawn ? gm_svg_read_texts : gm_png_read_texts)(path, keys, texts, TEXTS, message),
                      GM_EXIT_FILE, "%s", message);
    for (size_t i = 0; i < TEXTS; i++) {
        if (texts[i]) {
            gm_arena_keep(options->arena, texts[i], free);
        }
    }
    gm_command_end_if(options, !drawn && !take_painter(options, texts[PAINTER], message), GM_EXIT_USAGE,
                      "%.300s cannot be reproduced: %s", path, message);
    recall_system(options, texts);
    return texts[COMMAND] ? chart_again(options, texts[COMMAND]) : picture_again(options, texts);
}
