/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Numbers and options of any words: a number that is understood is written so that it reads the same again,
   and an option's value lies in its range or is refused with a sentence. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "app/commands/commands.h"
#include "core/parameter.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void require(bool holds)
{
    if (!holds) {
        abort();
    }
}

static void read_number(const char *text)
{
    double value = 0, back = 0;
    char written[64];
    if (gm_number_parse(text, &value) && isfinite(value)) {
        require(gm_number_parse(gm_number_format(value, written, sizeof written), &back));
        require(back == value);
    }
}

static bool is_number(double value, double low, double high)
{
    return isnan(value) || (value >= low && value <= high);
}

static void read_options(enum gm_command command, int count, char *words[])
{
    char message[GM_MESSAGE] = "";
    struct gm_options options;
    if (gm_options_parse(&options, command, count, words, 0, message)) {
        require(options.look.width >= 64 && options.look.width <= 16384 && options.look.height >= 64 &&
                options.look.height <= 16384);
        const struct gm_pace *pace = &options.pace;
        require(pace->every >= 0 && pace->every <= 1000000000 && pace->frames >= 0 &&
                pace->frames <= 1000000000);
        require(pace->shard <= pace->shards && pace->shards < 1000000);
        require(is_number(pace->fps, 0.01, 1000) && is_number(pace->rate, 0, HUGE_VAL) &&
                !isinf(pace->rate) && !isinf(pace->at) && !isinf(pace->from));
        require(isnan(pace->at) || (pace->frames == 0 && pace->every == 0 && !pace->movie));
    } else {
        require(message[0] != '\0' && strlen(message) < GM_MESSAGE);
    }
    gm_options_close(&options);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    enum { MOST = 16 };
    char *text = malloc(size + 1), *words[MOST], *rest = NULL;
    int count = 0;
    require(text != NULL);
    memcpy(text, data, size);
    text[size] = '\0';
    read_number(text);
    for (char *word = strtok_r(text, "\n", &rest); word && count < MOST; word = strtok_r(NULL, "\n", &rest)) {
        read_number(word);
        words[count++] = word;
    }
    for (size_t i = 0; i < gm_command_count; i++) {
        read_options(gm_commands[i].bit, count, words);
    }
    free(text);
    return 0;
}
