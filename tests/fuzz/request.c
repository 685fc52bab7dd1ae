/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The parameter parser against any words: it reads them or gives a sentence; what it has read is written so
   that it reads the same again. So do the commands that measure, with their lists of values. */
#include "app/grid/grid.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { MOST_WORDS = 64 };

static int split(char *text, char *words[MOST_WORDS])
{
    int count = 0;
    char *rest = NULL;
    for (char *word = strtok_r(text, "\n ", &rest); word && count < MOST_WORDS;
         word = strtok_r(NULL, "\n ", &rest)) {
        words[count++] = word;
    }
    return count;
}

static void require(bool holds)
{
    if (!holds) {
        abort();
    }
}

/* The words of a measuring command, which plans its runs or gives a sentence. */
static void read_study(enum gm_study_kind kind, const char *text)
{
    char message[GM_MESSAGE] = "";
    struct gm_arguments words = {0};
    struct gm_grid grid;
    require(gm_arguments_split(&words, text));
    if (gm_grid_open(&grid, kind, &words, NULL, message)) {
        require(grid.count > 0);
        gm_grid_close(&grid);
    } else {
        require(message[0] != '\0' && strlen(message) < GM_MESSAGE);
    }
    gm_arguments_close(&words);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char *text = malloc(size + 1), *words[MOST_WORDS], message[GM_MESSAGE] = "";
    require(text != NULL);
    memcpy(text, data, size);
    text[size] = '\0';

    struct gm_request request;
    if (gm_request_parse(&request, split(text, words), words, 3, message)) {
        require(request.count > 0);
        char *once = gm_request_format(&request), *copy = strdup(once);
        struct gm_request again;
        require(gm_request_parse(&again, split(copy, words), words, 3, message));
        char *twice = gm_request_format(&again);
        require(strcmp(once, twice) == 0);
        gm_request_close(&again);
        free(copy);
        free(once);
        free(twice);
    } else {
        require(message[0] != '\0' && strlen(message) < GM_MESSAGE);
    }
    gm_request_close(&request);

    char disc[] = "disc";
    memcpy(text, data, size);
    words[0] = disc;
    require(gm_request_parse(&request, 1, words, 3, message));
    gm_changes_parse(&request, text);
    gm_request_close(&request);
    for (enum gm_study_kind kind = GM_STUDY_WORK; kind < GM_STUDY_COUNT; kind++) {
        read_study(kind, text);
    }
    free(text);
    return 0;
}
