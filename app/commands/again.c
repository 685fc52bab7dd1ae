/* SPDX-License-Identifier: GPL-3.0-or-later */
/* geomint again FILE: makes a picture once more from what it tells of itself. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/base/arguments.h"
#include "app/base/interrupt.h"
#include "app/commands/commands.h"
#include "app/output/provenance.h"
#include "app/output/say.h"
#include "app/output/still.h"
#include "app/words/drive.h"
#include "app/words/system.h"
#include "render/pixels/canvas.h"
#include "render/vector/svg.h"

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

/* Opens every lane and drives it to the step that `steps` names for it. */
static bool drive(const struct gm_request *request, struct gm_lane **lanes, const char *steps, char *message)
{
    for (size_t i = 0; i < request->count; i++) {
        char *end = NULL;
        const int64_t step = strtoll(steps, &end, 10);
        if (end == steps || step < 0 || step > GM_MOST_STEPS) {
            return gm_refuse(message, "its steps are damaged");
        }
        steps = end;
        lanes[i] = gm_request_open_lane(request, i, message);
        struct gm_drive one = {.lane = lanes[i], .request = request, .index = i};
        if (!lanes[i] || !gm_drive_to(&one, step, true, message)) {
            return false;
        }
    }
    return true;
}

/* Whether the picture has all the texts of a picture of lanes; a sentence if not. */
static bool is_complete(const char *path, char *const *texts, char *message)
{
    for (size_t i = ARGUMENTS; i < NEEDED; i++) {
        if (!texts[i]) {
            return gm_refuse(message, "%.360s does not tell how it was made (it lacks %s)", path, keys[i]);
        }
    }
    return true;
}

static bool parse(struct gm_request *request, const char *arguments, const char *changes, char *message)
{
    if (!gm_request_recall(request, arguments, message)) {
        return false;
    }
    if (!gm_changes_parse(request, changes)) {
        gm_request_close(request);
        return gm_refuse(message, "its log of changes is damaged");
    }
    return true;
}

/* A room is read from its files, which may be others by now. */
static bool same_room(const struct gm_request *request, const char *told, char *message)
{
    const char *now = request->scene->room ? request->scene->mark : "none";
    return !told || strcmp(told, now) == 0 ||
           gm_refuse(message, "its room is another one now: it was %.100s, and is %.100s", told, now);
}

/* The word that named the system means the text that the picture tells. False: no memory. */
static bool recall_system(char *const *texts)
{
    struct gm_arguments words = {0};
    const char *told = texts[COMMAND] ? texts[COMMAND] : texts[ARGUMENTS];
    bool good = !texts[SYSTEM] || !told || gm_arguments_split(&words, told);
    const int place = texts[COMMAND] ? gm_provenance_scene_place(&words) : 0;
    good = good && (words.count <= place || gm_system_recall(words.words[place], texts[SYSTEM]));
    gm_arguments_close(&words);
    return good;
}

/* NAME-again, with `end` after it; malloc'ed */
static char *output_name(const char *path, const char *end)
{
    const char *slash = strrchr(path, '/');
    const char *base = slash ? slash + 1 : path;
    const char *dot = strrchr(base, '.');
    char *name = NULL;
    const int length = dot ? (int)(dot - base) : (int)strlen(base);
    return asprintf(&name, "%.*s-again%s", length, base, end) < 0 ? NULL : name;
}

/* The command that measures a chart; NULL if there is none of that name. */
static const struct gm_command_row *chart_of(const char *name)
{
    const struct gm_command_row *command = gm_command_find(name);
    return command && command->bit & GM_CHARTS ? command : NULL;
}

/* Measures a chart once more: the run times are those of now. */
static int chart_again(const struct gm_options *options, const char *command)
{
    char message[GM_MESSAGE] = "its command is damaged";
    struct gm_arguments words = {0};
    const bool split = gm_arguments_split(&words, command);
    const struct gm_command_row *chart = split && words.count > 0 ? chart_of(words.words[0]) : NULL;
    struct gm_options again = {0};
    char *name = output_name(options->arguments.words[0], "");
    int status = GM_EXIT_FILE;
    if (name && chart && gm_options_parse(&again, chart->bit, words.count, words.words, 1, message)) {
        again.out = options->out || options->output ? options->out : ".";
        again.output = options->output;
        again.format = options->format;
        again.name = name;
        status = chart->function(&again);
    } else {
        gm_complain("%s cannot be made again: %s", options->arguments.words[0], message);
    }
    gm_options_close(&again);
    gm_arguments_close(&words);
    free(name);
    return status;
}

/* What painted the PNG paints it again, unless somebody says otherwise. */
static bool take_painter(const struct gm_options *options, char *painter, char *message)
{
    if (options->painter || options->format != GM_FORMAT_PNG || !painter) {
        return true;
    }
    painter[strcspn(painter, ",")] = '\0'; /* what else it tells are versions */
    return gm_canvas_choose(painter, message);
}

/* A number of a text within bounds; 0 for no text. False where it is damaged. */
static bool take_number(const char *text, double low, double high, double *number)
{
    *number = 0;
    return !text || (gm_number_parse(text, number) && *number >= low && *number <= high);
}

/* The look that the texts tell of; its title is one of them. */
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

/* Where the picture goes; malloc'ed. */
static char *print_path(const struct gm_options *options)
{
    char end[8], *name = NULL;
    if (options->output) {
        return strdup(options->output);
    }
    snprintf(end, sizeof end, ".%s", gm_format_name(options->format));
    char *base = output_name(options->arguments.words[0], end);
    if (!base || asprintf(&name, "%s/%s", options->out ? options->out : ".", base) < 0) {
        name = NULL;
    }
    free(base);
    return name;
}

/* Draws a picture of lanes once more. */
static int picture_again(const struct gm_options *options, char *const *texts)
{
    const char *path = options->arguments.words[0];
    char message[GM_MESSAGE] = "not enough memory";
    struct gm_request request = {0};
    struct gm_lane **lanes = NULL;
    char *name = print_path(options);
    struct gm_print print = {.path = name, .format = options->format};
    int status = GM_EXIT_FILE;
    if (!name || !is_complete(path, texts, message)) {
        gm_complain("%s", message);
    } else if (!take_look(&print.look, texts)) {
        gm_complain("%s cannot be made again: its size is damaged", path);
    } else if (!parse(&request, texts[ARGUMENTS], texts[CHANGES], message)) {
        gm_complain("%s cannot be made again: %s", path, message);
    } else {
        gm_catch_interrupts();
        gm_printer_expect(print.format);
        lanes = calloc(request.count, sizeof *lanes);
        if (!lanes || !same_room(&request, texts[ROOM], message) ||
            !drive(&request, lanes, texts[STEPS], message)) {
            gm_complain("%s cannot be made again: %s", path, message);
        } else if (gm_interrupted) {
            status = GM_EXIT_INTERRUPTED;
        } else if (!gm_still_write(&print, &request, (const struct gm_lane *const *)lanes, message)) {
            status = gm_printer_fail(print.path, message);
        } else {
            gm_printer_report(&print, "");
            status = GM_EXIT_OK;
        }
    }
    for (size_t i = 0; lanes && i < request.count; i++) {
        gm_lane_close(lanes[i]);
    }
    free(lanes);
    gm_request_close(&request);
    free(name);
    return gm_finish(status);
}

int gm_command_again(const struct gm_options *options)
{
    if (options->arguments.count > 1) {
        return gm_give_up(GM_EXIT_USAGE, "again makes one picture as it was made; \"%.60s\" is too much",
                          options->arguments.words[1]);
    }
    if (options->arguments.count == 0) {
        return gm_give_up(GM_EXIT_USAGE, "again which picture? A PNG or SVG file that geomint made");
    }
    char message[GM_MESSAGE], *texts[TEXTS];
    const char *path = options->arguments.words[0];
    enum gm_format format = GM_FORMAT_PNG;
    const bool drawn = gm_format_of(path, &format) && format == GM_FORMAT_SVG;
    if (format == GM_FORMAT_PDF) {
        return gm_give_up(GM_EXIT_FILE,
                          "again reads PNG and SVG files; a PDF, as %.300s, does not tell how it was made",
                          path);
    }
    if (!(drawn ? gm_svg_read_texts : gm_png_read_texts)(path, keys, texts, TEXTS, message)) {
        return gm_give_up(GM_EXIT_FILE, "%s", message);
    }
    int status = GM_EXIT_USAGE;
    if (!drawn && !take_painter(options, texts[PAINTER], message)) {
        gm_complain("%.300s cannot be made again: %s", path, message);
    } else {
        status = !recall_system(texts) ? GM_EXIT_MEMORY
                 : texts[COMMAND]      ? chart_again(options, texts[COMMAND])
                                       : picture_again(options, texts);
    }
    for (size_t i = 0; i < TEXTS; i++) {
        free(texts[i]);
    }
    return status;
}
