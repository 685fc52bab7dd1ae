/* SPDX-License-Identifier: GPL-3.0-or-later */
/* geomint again FILE.png: makes a picture once more from what it tells of itself. */
#include <libgen.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/commands.h"
#include "app/drive.h"
#include "app/provenance.h"
#include "app/still.h"

enum { MOST_WORDS = 64 };

/* Opens every lane and drives it to the step that `steps` names for it. */
static bool drive(const struct gm_request *request, struct gm_lane **lanes, const char *steps, char *message)
{
    for (size_t i = 0; i < request->count; i++) {
        char *end = NULL;
        const long step = strtol(steps, &end, 10);
        if (end == steps || step < 0) {
            snprintf(message, GM_MESSAGE, "its steps are damaged");
            return false;
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

/* Reads one text; false with a sentence if the file lacks it. */
static bool need(const char *path, const char *key, char **text, char *message)
{
    message[0] = '\0';
    *text = gm_png_read_text(path, key, message);
    if (!*text && !message[0]) {
        snprintf(message, GM_MESSAGE, "%s does not tell how it was made (it lacks %s)", path, key);
    }
    return *text != NULL;
}

/* Cuts text at its blanks. */
static int split(char *text, char *words[MOST_WORDS])
{
    char *rest = NULL;
    int count = 0;
    for (char *word = strtok_r(text, " ", &rest); word && count < MOST_WORDS;
         word = strtok_r(NULL, " ", &rest)) {
        words[count++] = word;
    }
    return count;
}

static bool parse(struct gm_request *request, char *arguments, const char *changes, char *message)
{
    char *words[MOST_WORDS];
    const int count = split(arguments, words);
    if (!gm_request_parse(request, count, words, 1, message)) {
        return false;
    }
    if (!gm_changes_parse(request, changes)) {
        gm_request_close(request);
        snprintf(message, GM_MESSAGE, "its log of changes is damaged");
        return false;
    }
    return true;
}

/* NAME-again, with `end` after it; malloc'ed */
static char *output_name(const char *path, const char *end)
{
    char *copy = strdup(path), *name = NULL;
    if (!copy) {
        return NULL;
    }
    char *base = basename(copy);
    char *dot = strrchr(base, '.');
    if (dot) {
        *dot = '\0';
    }
    if (asprintf(&name, "%s-again%s", base, end) < 0) {
        name = NULL;
    }
    free(copy);
    return name;
}

static const struct chart {
    const char *name;
    enum gm_command bit;
    int (*function)(const struct gm_options *options);
} charts[] = {
    {"work-precision", GM_WORK_PRECISION, gm_command_work_precision},
    {"stability", GM_STABILITY, gm_command_stability},
};

static const struct chart *chart_of(const char *name)
{
    for (size_t i = 0; i < sizeof charts / sizeof charts[0]; i++) {
        if (strcmp(charts[i].name, name) == 0) {
            return &charts[i];
        }
    }
    return NULL;
}

/* Measures a chart once more: the run times are those of now. */
static int chart_again(const struct gm_options *options, char *command)
{
    char *words[MOST_WORDS], message[GM_MESSAGE] = "its command is damaged";
    const int count = split(command, words);
    const struct chart *chart = count > 0 ? chart_of(words[0]) : NULL;
    struct gm_options again = {0};
    char *name = output_name(options->words[0], "");
    int status = GM_EXIT_FILE;
    if (name && chart && gm_options_parse(&again, chart->bit, count, words, 1, message)) {
        again.out = options->out;
        again.name = name;
        status = chart->function(&again);
    } else {
        gm_complain("%s cannot be made again: %s", options->words[0], message);
    }
    gm_options_close(&again);
    free(name);
    return status;
}

/* Draws a picture of lanes once more. */
static int picture_again(const struct gm_options *options)
{
    const char *path = options->words[0];
    char message[GM_MESSAGE] = "";
    char *arguments = NULL, *changes = NULL, *steps = NULL, *kind = NULL;
    struct gm_request request = {0};
    struct gm_lane **lanes = NULL;
    char *base = output_name(path, ".png"), *name = NULL;
    if (!base || asprintf(&name, "%s/%s", options->out ? options->out : ".", base) < 0) {
        name = NULL;
    }
    free(base);
    int width = 0, height = 0, status = GM_EXIT_FILE;
    char theme[8] = "";
    if (!name || !need(path, GM_KEY_ARGUMENTS, &arguments, message) ||
        !need(path, GM_KEY_CHANGES, &changes, message) || !need(path, GM_KEY_STEPS, &steps, message) ||
        !need(path, GM_KEY_PICTURE, &kind, message)) {
        gm_complain("%s", message);
    } else if (sscanf(kind, "%5dx%5d %7s", &width, &height, theme) != 3 || width < 64 || height < 64 ||
               width > 16384 || height > 16384 || !parse(&request, arguments, changes, message)) {
        gm_complain("%s cannot be made again: %s", path, message[0] ? message : "its size is damaged");
    } else {
        gm_catch_interrupts();
        lanes = calloc(request.count, sizeof *lanes);
        const enum gm_theme shade = strcmp(theme, "dark") == 0 ? GM_THEME_DARK : GM_THEME_LIGHT;
        if (!lanes || !drive(&request, lanes, steps, message)) {
            gm_complain("%s cannot be made again: %s", path, message);
        } else if (gm_interrupted) {
            status = GM_EXIT_INTERRUPTED;
        } else if (!gm_still_write(name, width, height, shade, &request, (const struct gm_lane *const *)lanes,
                                   message)) {
            gm_complain("%s", message);
        } else {
            printf("%s\n", name);
            status = GM_EXIT_OK;
        }
    }
    for (size_t i = 0; lanes && i < request.count; i++) {
        gm_lane_close(lanes[i]);
    }
    free(lanes);
    gm_request_close(&request);
    free(arguments);
    free(changes);
    free(steps);
    free(kind);
    free(name);
    return gm_finish(status);
}

int gm_command_again(const struct gm_options *options)
{
    if (options->word_count != 1) {
        gm_complain("again which picture? A PNG file that geomint made");
        return GM_EXIT_USAGE;
    }
    char message[GM_MESSAGE];
    char *command = gm_png_read_text(options->words[0], GM_KEY_COMMAND, message);
    const int status = command ? chart_again(options, command) : picture_again(options);
    free(command);
    return status;
}
