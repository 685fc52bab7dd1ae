/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lanes for tests, opened by a request's words. */
#include "tests/common/lane.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/words/request.h"

static void end_test(const char *what, const char *why)
{
    fprintf(stderr, "%s: %s\n", what, why);
    abort();
}

struct gm_lane *test_lane(const char *arguments)
{
    char text[512], message[GM_MESSAGE] = "";
    char *words[32], *rest = NULL;
    int count = 0;
    snprintf(text, sizeof text, "%s", arguments);
    for (char *word = strtok_r(text, " ", &rest); word && count < 32; word = strtok_r(NULL, " ", &rest)) {
        words[count++] = word;
    }
    struct gm_request request;
    if (!gm_request_parse(&request, count, words, 1, message)) {
        end_test(arguments, message);
    }
    struct gm_lane *lane = gm_request_open_lane(&request, 0, message);
    gm_request_close(&request);
    if (!lane) {
        end_test(arguments, message);
    }
    return lane;
}

double test_observed(const struct gm_lane *lane, const char *key)
{
    const int observable = gm_scene_observable(lane->scene, key);
    if (observable >= 0) {
        return gm_lane_observe(lane, (size_t)observable);
    }
    end_test(key, "there is no such observable");
    return NAN;
}
