/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The table of commands, and the confirmation of runs that take very long. */
#include "app/commands/commands.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "app/output/say.h"
#include "app/words/drive.h"
#include "app/words/system.h"
#include "core/arena.h"
#include "core/basics.h"

const struct gm_command_row gm_commands[] = {
#define GM_COMMAND(bit, function, ...) {bit, gm_command_##function, __VA_ARGS__},
#include "app/commands/commands.def"
#undef GM_COMMAND
};
const size_t gm_command_count = GM_COUNT(gm_commands);

const struct gm_command_row *gm_command_find(const char *word)
{
    for (size_t i = 0; i < gm_command_count; i++) {
        if (strcmp(gm_commands[i].name, word) == 0) {
            return &gm_commands[i];
        }
    }
    return gm_scene_called(word) || gm_system_is(word) ? &gm_commands[0] : NULL;
}

void gm_command_end(const struct gm_options *options, int status, const char *format, ...)
{
    char sentence[GM_MESSAGE];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(sentence, sizeof sentence, format, arguments);
    va_end(arguments);
    *options->end = status;
    gm_arena_refuse(options->arena, "%s", sentence);
}

void gm_command_end_if(const struct gm_options *options, bool wrong, int status, const char *format, ...)
{
    char sentence[GM_MESSAGE];
    va_list arguments;
    va_start(arguments, format);
    if (wrong) { /* else what it quotes may not be written */
        vsnprintf(sentence, sizeof sentence, format, arguments);
        va_end(arguments);
        gm_command_end(options, status, "%s", sentence);
    }
    va_end(arguments);
}

/* ---- long runs ---- */

const double gm_many_steps = 1e11;

void gm_put_duration(double seconds, char *text, size_t size)
{
    static const struct {
        double seconds;
        const char *name;
    } units[] = {
        {365.25 * 86400, "years"}, {86400, "days"}, {3600, "hours"}, {60, "minutes"}, {1, "seconds"}};
    size_t unit = 0;
    while (unit + 1 < GM_COUNT(units) && seconds < 2 * units[unit].seconds) {
        unit++;
    }
    const double count = seconds / units[unit].seconds;
    snprintf(text, size, count < 1e5 ? "%.*f %s" : "%.*g %s", count < 9.5 ? 1 : 0, count, units[unit].name);
}

struct gm_request *gm_command_parse(const struct gm_options *options, int count, char *const words[],
                                    size_t schemes)
{
    char message[GM_MESSAGE];
    struct gm_request *request = gm_arena_take(options->arena, 1, sizeof *request);
    gm_arena_keep(options->arena, request, gm_request_close);
    if (!gm_request_parse(request, count, words, schemes, message)) {
        gm_command_end(options, gm_request_refusal(request), "%s", message);
    }
    return request;
}

void gm_command_note(const struct gm_lane *lane, char *last)
{
    char note[GM_MESSAGE];
    gm_lane_note(lane, note);
    if (note[0] && strcmp(note, last) != 0) {
        gm_complain("%s", note);
    }
    snprintf(last, GM_MESSAGE, "%s", note);
}

void gm_command_confirm(const struct gm_options *options, const struct gm_request *request)
{
    double steps = 0, seconds = 0;
    for (size_t i = 0; i < request->count; i++) {
        steps += gm_request_steps(request, i);
    }
    if (options->yes || steps <= gm_many_steps) {
        return;
    }
    for (size_t i = 0; i < request->count; i++) {
        seconds += gm_drive_seconds(request, i);
    }
    char duration[64];
    gm_put_duration(seconds, duration, sizeof duration);
    gm_command_end(options, GM_EXIT_USAGE, "these are %.3g steps, which take about %s; --yes makes them",
                   steps, duration);
}
