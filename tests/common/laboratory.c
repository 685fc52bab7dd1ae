/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Runs to their end, for what tests measure of them. */
#include "tests/common/laboratory.h"
#include "core/basics.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

enum { MOST_WORDS = 24, MOST_TEXT = 400 };

static int split(char *text, char *words[MOST_WORDS])
{
    int count = 0;
    char *rest = NULL;
    for (char *word = strtok_r(text, " ", &rest); word && count < MOST_WORDS;
         word = strtok_r(NULL, " ", &rest)) {
        words[count++] = word;
    }
    return count;
}

const char *gm_trial_refusal(const char *words, char *message)
{
    char text[MOST_TEXT], *list[MOST_WORDS];
    struct gm_request request;
    snprintf(text, sizeof text, "%s", words);
    message[0] = '\0';
    if (gm_request_parse(&request, split(text, list), list, 1, message)) {
        gm_request_close(&request);
        message[0] = '\0';
    }
    return message;
}

static void take(struct gm_trial *trial)
{
    for (size_t i = 0; i < trial->request.scene->observable_count; i++) {
        trial->maxima[i] = fmax(trial->maxima[i], gm_lane_observe(trial->drive.lane, i));
    }
}

void gm_trial_run(struct gm_trial *trial, const char *words, bool maximum)
{
    char text[MOST_TEXT], *list[MOST_WORDS], message[GM_MESSAGE];
    snprintf(text, sizeof text, "%s", words);
    if (!gm_request_parse(&trial->request, split(text, list), list, 1, message)) {
        fail_msg("%s: %s", words, message);
    }
    assert_int_equal(trial->request.count, 1);
    trial->drive = (struct gm_drive){.lane = gm_request_open_lane(&trial->request, 0, message),
                                     .request = &trial->request};
    assert_non_null(trial->drive.lane);
    const struct gm_run *run = trial->drive.lane->run;
    const long steps = trial->request.lanes[0].steps;
    for (size_t i = 0; i < GM_COUNT(trial->maxima); i++) {
        trial->maxima[i] = -INFINITY;
    }
    if (!maximum) {
        assert_true(gm_drive_to(&trial->drive, steps, false, message));
        return;
    }
    take(trial);
    while (gm_drive_goes_on(&trial->drive, steps)) {
        assert_true(gm_drive_to(&trial->drive, run->steps + 1, false, message));
        take(trial);
    }
}

void gm_trial_close(struct gm_trial *trial)
{
    gm_lane_close(trial->drive.lane);
    gm_request_close(&trial->request);
}

static size_t index_of(const struct gm_trial *trial, const char *key)
{
    const struct gm_scene *scene = trial->request.scene;
    for (size_t i = 0; i < scene->observable_count; i++) {
        if (strcmp(scene->observables[i].key, key) == 0) {
            return i;
        }
    }
    fail_msg("%s has no observable %s", scene->name, key);
    return 0;
}

double gm_trial_end(const struct gm_trial *trial, const char *key)
{
    return gm_lane_observe(trial->drive.lane, index_of(trial, key));
}

double gm_trial_max(const struct gm_trial *trial, const char *key)
{
    return trial->maxima[index_of(trial, key)];
}

void gm_trial_expect_warning(const struct gm_scene *scene, const char *words, bool expected)
{
    char text[MOST_TEXT], *list[MOST_WORDS], message[GM_MESSAGE];
    struct gm_request request;
    snprintf(text, sizeof text, "%s %s", scene->name, words);
    if (!gm_request_parse(&request, split(text, list), list, 1, message)) {
        fail_msg("%s %s: %s", scene->name, words, message);
    }
    bool warned = false;
    for (size_t i = 0; i < request.count; i++) {
        struct gm_drive drive = {
            .lane = gm_request_open_lane(&request, i, message), .request = &request, .index = i};
        assert_non_null(drive.lane);
        assert_true(gm_drive_to(&drive, request.lanes[i].steps, false, message));
        gm_lane_warning(drive.lane, message, sizeof message);
        warned |= message[0] != 0;
        if (message[0] && !expected) {
            fail_msg("%s scheme=%s %s: %s", scene->name, drive.lane->scheme->name, words, message);
        }
        gm_lane_close(drive.lane);
    }
    if (expected && !warned) {
        fail_msg("%s %s: no warning", scene->name, words);
    }
    gm_request_close(&request);
}
