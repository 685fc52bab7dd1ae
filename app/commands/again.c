/* SPDX-License-Identifier: GPL-3.0-or-later */
/* geomint again FILE.png: makes a picture once more from what it tells of itself. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/commands/commands.h"
#include "app/output/folder.h"
#include "app/output/provenance.h"
#include "app/output/still.h"
#include "app/request/drive.h"

/* The texts that it reads. */
enum { COMMAND, ARGUMENTS, CHANGES, STEPS, PICTURE, TEXTS };
static const char *const keys[TEXTS] = {GM_KEY_COMMAND, GM_KEY_ARGUMENTS, GM_KEY_CHANGES, GM_KEY_STEPS,
                                        GM_KEY_PICTURE};

/* Opens every lane and drives it to the step that `steps` names for it. */
static bool drive(const struct gm_request *request, struct gm_lane **lanes, const char *steps, char *message)
{
    for (size_t i = 0; i < request->count; i++) {
        char *end = NULL;
        const long step = strtol(steps, &end, 10);
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
    for (size_t i = ARGUMENTS; i < TEXTS; i++) {
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
    return command && command->bit & (GM_WORK_PRECISION | GM_STABILITY | GM_SWEEP) ? command : NULL;
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
        again.out = options->out;
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

/* Draws a picture of lanes once more. */
static int picture_again(const struct gm_options *options, char *const *texts)
{
    const char *path = options->arguments.words[0];
    char message[GM_MESSAGE] = "not enough memory";
    struct gm_request request = {0};
    struct gm_lane **lanes = NULL;
    char *base = output_name(path, ".png"), *name = NULL;
    if (!base || asprintf(&name, "%s/%s", options->out ? options->out : ".", base) < 0) {
        name = NULL;
    }
    free(base);
    int width = 0, height = 0, status = GM_EXIT_FILE;
    char theme[8] = "";
    if (!name || !is_complete(path, texts, message)) {
        gm_complain("%s", message);
    } else if (sscanf(texts[PICTURE], "%5dx%5d %7s", &width, &height, theme) != 3 || width < 64 ||
               height < 64 || width > 16384 || height > 16384) {
        gm_complain("%s cannot be made again: its size is damaged", path);
    } else if (!parse(&request, texts[ARGUMENTS], texts[CHANGES], message)) {
        gm_complain("%s cannot be made again: %s", path, message);
    } else {
        gm_catch_interrupts();
        lanes = calloc(request.count, sizeof *lanes);
        const enum gm_theme shade = strcmp(theme, "dark") == 0 ? GM_THEME_DARK : GM_THEME_LIGHT;
        if (!lanes || !drive(&request, lanes, texts[STEPS], message)) {
            gm_complain("%s cannot be made again: %s", path, message);
        } else if (gm_interrupted) {
            status = GM_EXIT_INTERRUPTED;
        } else if (!gm_folder_make(options->out, message) ||
                   !gm_still_write(name, width, height, shade, &request, (const struct gm_lane *const *)lanes,
                                   message)) {
            gm_complain("%s", message);
        } else {
            gm_complain("wrote %s", name);
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

static int command_again(const struct gm_options *options)
{
    if (options->arguments.count != 1) {
        gm_complain("again which picture? A PNG file that geomint made");
        return GM_EXIT_USAGE;
    }
    char message[GM_MESSAGE], *texts[TEXTS];
    if (!gm_png_read_texts(options->arguments.words[0], keys, texts, TEXTS, message)) {
        gm_complain("%s", message);
        return GM_EXIT_FILE;
    }
    const int status = texts[COMMAND] ? chart_again(options, texts[COMMAND]) : picture_again(options, texts);
    for (size_t i = 0; i < TEXTS; i++) {
        free(texts[i]);
    }
    return status;
}

const struct gm_command_row gm_command_again = {
    .name = "again",
    .synopsis = "FILE.png",
    .help = "make a picture once more from what it tells of itself",
    .bit = GM_AGAIN,
    .function = command_again,
};
