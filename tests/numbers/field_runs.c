/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Fields run by words, for published numbers. */
#include "tests/numbers/field_runs.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

struct field_run field_run_make(const char *words, long steps)
{
    enum { MOST = 24 };
    char text[512], message[GM_MESSAGE], *word[MOST];
    int count = 0;
    snprintf(text, sizeof text, "%s", words);
    for (char *at = strtok(text, " "); at && count < MOST; at = strtok(NULL, " ")) {
        word[count++] = at;
    }
    struct field_run run = {.lane = NULL};
    if (!gm_request_parse(&run.request, count, word, 1, message)) {
        fail_msg("%s: %s", words, message);
    }
    run.lane = gm_request_open_lane(&run.request, 0, message);
    if (!run.lane) {
        fail_msg("%s: %s", words, message);
    }
    gm_run_advance(run.lane->run, steps < 0 ? run.request.lanes[0].steps : steps);
    return run;
}

static size_t index_of(const struct gm_scene *scene, const char *key)
{
    for (size_t i = 0; i < scene->observable_count; i++) {
        if (strcmp(scene->observables[i].key, key) == 0) {
            return i;
        }
    }
    fail_msg("%s has no observable %s", scene->name, key);
    return 0;
}

double field_run_value(const struct field_run *run, const char *observable)
{
    return gm_lane_observe(run->lane, index_of(run->lane->scene, observable));
}

double field_run_until(struct field_run *run, const char *observable, double bound)
{
    const size_t index = index_of(run->lane->scene, observable);
    struct gm_run *steps = run->lane->run;
    while (steps->steps < run->request.lanes[0].steps && gm_run_advance(steps, 1) == GM_OK) {
        if (gm_lane_observe(run->lane, index) > bound) {
            return steps->t;
        }
    }
    return INFINITY;
}

double field_run_largest(struct field_run *run, const char *observable)
{
    const size_t index = index_of(run->lane->scene, observable);
    struct gm_run *steps = run->lane->run;
    double largest = gm_lane_observe(run->lane, index);
    while (steps->steps < run->request.lanes[0].steps && gm_run_advance(steps, 1) == GM_OK) {
        largest = fmax(largest, gm_lane_observe(run->lane, index));
    }
    return largest;
}

void field_run_close(struct field_run *run)
{
    gm_lane_close(run->lane);
    gm_request_close(&run->request);
}

void expect_within(const char *what, double value, double expected, double part)
{
    printf("%-78s %.4g (%.4g)\n", what, value, expected);
    if (!(fabs(value - expected) <= part * fabs(expected))) {
        fail_msg("%s: %.6g is not %.6g", what, value, expected);
    }
}
