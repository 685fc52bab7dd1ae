/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "app/options.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/nearest.h"

enum kind { FLAG, TEXT, WHOLE, NUMBER, SIZE, THEME, SHARD };

struct row {
    const char *name;
    enum kind kind;
    unsigned commands;
    size_t offset;
    const char *value, *help;
};

#define AT(member) offsetof(struct gm_options, member)
#define PAINTS (GM_RENDER | GM_FIGURES | GM_WORK_PRECISION | GM_STABILITY | GM_TOUR)
#define EXPLORES (GM_TUI | GM_TERMINAL | GM_TOUR)

static const struct row rows[] = {
    {"--json", FLAG, GM_RUN | GM_LIST | GM_CERTIFY, AT(json), "", "one JSON object a line"},
    {"--long", FLAG, GM_LIST, AT(longer), "", "with formulas and references"},
    {"--markdown", FLAG, GM_LIST, AT(markdown), "", "scenes or schemes as in the documentation"},
    {"--state", FLAG, GM_RUN, AT(state), "", "with the final state (needs --json)"},
    {"--max", FLAG, GM_RUN, AT(maximum), "", "with NAME_max, the maximum over all steps"},
    {"--csv", TEXT, GM_RUN, AT(csv), "FILE", "write the history to FILE"},
    {"--profile", TEXT, GM_RUN, AT(profile), "FILE", "write profiles of the final state to FILE"},
    {"--every", WHOLE, GM_RUN | GM_RENDER, AT(every), "K",
     "run: a row of the history, render: a frame, every K steps"},
    {"--frames", WHOLE, GM_RENDER, AT(frames), "N", "N frames, evenly spaced in model time"},
    {"--fps", NUMBER, GM_RENDER | GM_TOUR, AT(fps), "F", "frames a second of the movie (30)"},
    {"--rate", NUMBER, GM_RENDER, AT(rate), "R", "model time a second of the movie"},
    {"--from", NUMBER, GM_RENDER, AT(from), "T", "first frame at model time T"},
    {"--at", NUMBER, GM_RENDER, AT(at), "T", "one picture at model time T"},
    {"--size", SIZE, PAINTS, AT(width), "WxH", "pixels (1280x720)"},
    {"--theme", THEME, PAINTS & ~(unsigned)(GM_FIGURES | GM_TOUR), AT(theme), "light|dark",
     "colours for paper or for a screen"},
    {"--changes", TEXT, GM_RENDER, AT(changes), "LIST", "LANE:STEP:KEY=VALUE,...: changes in flight (key y)"},
    {"--graphics", TEXT, EXPLORES, AT(graphics), "KIND", "kitty, sixel, braille, quadrants, half or ascii"},
    {"--colours", TEXT, EXPLORES, AT(colours), "HOWMANY", "truecolor, 256, 16 or none"},
    {"--theme", TEXT, EXPLORES, AT(look), "THEME", "light, dark or, in a terminal, mono"},
    {"--out", TEXT, PAINTS | GM_AGAIN, AT(out), "DIR", "folder of the output (here)"},
    {"--movie", TEXT, GM_RENDER | GM_TOUR, AT(movie), "FILE", "write a movie: .mp4, .webm or .gif"},
    {"--shard", SHARD, GM_RENDER, AT(shard), "I/N", "only the I-th of N shares of the frames"},
    {"--strict", FLAG, GM_RENDER, AT(strict), "", "exit 2 if a lane ends in a numerical failure"},
    {"--measure", TEXT, GM_WORK_PRECISION, AT(measure), "KEY", "the observable that is the error"},
    {"--region", TEXT, GM_STABILITY, AT(region), "SCHEME",
     "the linear stability region of a scheme, no scene"},
    {"--list", FLAG, GM_TOUR, AT(listing), "", "what there is; with a tour, its steps"},
    {"--quick", FLAG, GM_FIGURES, AT(quick), "", "shorter runs and smaller pictures; nothing long is judged"},
};
enum { ROWS = sizeof rows / sizeof rows[0] };

static const char *name_at(size_t i, const void *data)
{
    return (void)data, rows[i].name;
}

static bool refuse(char *message, const char *name, const char *value, const char *what)
{
    snprintf(message, GM_MESSAGE, "%s %.60s: %s", name, value, what);
    return false;
}

static bool store(struct gm_options *options, const struct row *row, const char *value, char *message)
{
    char *place = (char *)options + row->offset;
    double number = NAN;
    switch (row->kind) {
    case FLAG:
        memcpy(place, &(int){1}, sizeof(int));
        return true;
    case TEXT:
        if (!*value) {
            return refuse(message, row->name, value, "is empty");
        }
        memcpy(place, &value, sizeof value);
        return true;
    case WHOLE: {
        if (!gm_number_parse(value, &number) || !(number >= 1 && number <= 1e9) || number != floor(number)) {
            return refuse(message, row->name, value, "is not a whole number from 1 to 1e9");
        }
        long whole = (long)number;
        memcpy(place, &whole, sizeof whole);
        return true;
    }
    case NUMBER:
        if (!gm_number_parse(value, &number) || !isfinite(number) || number < 0) {
            return refuse(message, row->name, value, "is not a number from 0 on");
        }
        memcpy(place, &number, sizeof number);
        return true;
    case SIZE: {
        int width = 0, height = 0, used = 0;
        if (sscanf(value, "%5dx%5d%n", &width, &height, &used) != 2 || value[used] || width < 64 ||
            height < 64 || width > 16384 || height > 16384) {
            return refuse(message, row->name, value, "is not WIDTHxHEIGHT, each from 64 to 16384");
        }
        options->width = width;
        options->height = height;
        options->sized = true;
        return true;
    }
    case SHARD: {
        long shard = 0, shards = 0;
        int used = 0;
        if (sscanf(value, "%6ld/%6ld%n", &shard, &shards, &used) != 2 || value[used] || shard < 1 ||
            shard > shards) {
            return refuse(message, row->name, value, "is not I/N, with I from 1 to N");
        }
        options->shard = shard;
        options->shards = shards;
        return true;
    }
    case THEME:
        options->theme = strcmp(value, "dark") == 0 ? GM_THEME_DARK : GM_THEME_LIGHT;
        return strcmp(value, "dark") == 0 || strcmp(value, "light") == 0 ||
               refuse(message, row->name, value, "is none of: light, dark");
    }
    return false;
}

/* The row of this command, or else one of the same name that others have. */
static const struct row *find(const char *word, size_t length, enum gm_command command)
{
    const struct row *found = NULL;
    for (size_t i = 0; i < ROWS; i++) {
        if (strlen(rows[i].name) == length && strncmp(rows[i].name, word, length) == 0 &&
            (!found || rows[i].commands & command)) {
            found = &rows[i];
        }
    }
    return found;
}

bool gm_options_parse(struct gm_options *options, enum gm_command command, int argc, char *argv[], int first,
                      char *message)
{
    *options = (struct gm_options){.fps = NAN,
                                   .rate = NAN,
                                   .from = NAN,
                                   .at = NAN,
                                   .width = 1280,
                                   .height = 720,
                                   .theme = GM_THEME_LIGHT};
    options->words = calloc((size_t)argc + 1, sizeof *options->words);
    if (!options->words) {
        snprintf(message, GM_MESSAGE, "not enough memory");
        return false;
    }
    for (int i = first; i < argc; i++) {
        const char *word = argv[i];
        if (strncmp(word, "--", 2) != 0) {
            options->words[options->word_count++] = argv[i];
            continue;
        }
        const char *equals = strchr(word, '=');
        const struct row *row = find(word, equals ? (size_t)(equals - word) : strlen(word), command);
        if (!row || !(row->commands & command)) {
            const char *near = row ? NULL : gm_nearest(word, ROWS, name_at, NULL);
            snprintf(message, GM_MESSAGE, "%s option %.60s%s%s", row ? "this command has no" : "there is no",
                     word, near ? "; did you mean " : "", near ? near : "");
            return false;
        }
        const char *value = "";
        if (row->kind == FLAG && equals) {
            snprintf(message, GM_MESSAGE, "%s takes no value", row->name);
            return false;
        }
        if (row->kind != FLAG) {
            value = equals ? equals + 1 : i + 1 < argc ? argv[++i] : NULL;
            if (!value) {
                snprintf(message, GM_MESSAGE, "%s needs a value: %s", row->name, row->value);
                return false;
            }
        }
        if (!store(options, row, value, message)) {
            return false;
        }
    }
    return true;
}

bool gm_options_have(const struct gm_options *options, const char *word)
{
    const size_t length = strcspn(word, "=") + 1;
    for (int i = 0; i < options->word_count; i++) {
        if (strncmp(options->words[i], word, length) == 0) {
            return true;
        }
    }
    return false;
}

void gm_options_close(struct gm_options *options)
{
    free(options->words);
    options->words = NULL;
}

size_t gm_option_count(void)
{
    return ROWS;
}

struct gm_option gm_option_at(size_t index)
{
    const struct row *row = &rows[index];
    return (struct gm_option){row->name, row->value, row->help, row->commands};
}

void gm_options_help(enum gm_command command)
{
    for (size_t i = 0; i < ROWS; i++) {
        if (rows[i].commands & command) {
            char left[40];
            snprintf(left, sizeof left, "%s %s", rows[i].name, rows[i].value);
            printf("      %-20s %s\n", left, rows[i].help);
        }
    }
}
