/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_TESTS_NUMBERS_FIELD_RUNS_H
#define GM_TESTS_NUMBERS_FIELD_RUNS_H

#include "app/words/request.h"

/* One run as a user asks for it, "burgers scheme=ftcs lambda=1": made up to its end or failure. */
struct field_run {
    struct gm_request request;
    struct gm_lane *lane;
};

/* Fails the test if the words are refused. steps < 0: all. */
struct field_run field_run_make(const char *words, long steps);
/* Continues until the observable is above `bound` or the run has ended; the time, or infinity. */
double field_run_until(struct field_run *run, const char *observable, double bound);
double field_run_value(const struct field_run *run, const char *observable);
/* The largest value over all steps from the start: makes the steps itself (make the run with steps = 0). */
double field_run_largest(struct field_run *run, const char *observable);
void field_run_close(struct field_run *run);

/* |value - expected| <= part * expected */
void expect_within(const char *what, double value, double expected, double part);

#endif
