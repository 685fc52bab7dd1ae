/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_TESTS_COMMON_LABORATORY_H
#define GM_TESTS_COMMON_LABORATORY_H

#include "app/words/drive.h"

/* A lane run to its end as `geomint run` does it: words such as "kepler", "scheme=rk4", "dt=pi/100". */
struct gm_trial {
    struct gm_request request;
    struct gm_drive drive;
    double maxima[32]; /* of the observables over all steps, if asked for */
};

/* Runs the one lane that the words make, separated by blanks; fails the test on any refusal. */
void gm_trial_run(struct gm_trial *trial, const char *words, bool maximum);
void gm_trial_close(struct gm_trial *trial);
/* The observable of that key at the end; its maximum. */
double gm_trial_end(const struct gm_trial *trial, const char *key);
double gm_trial_max(const struct gm_trial *trial, const char *key);

/* Runs all lanes that the words make; fails the test where one warns of having lost what the exact motion
   keeps, or, if that is expected, where none does. */
void gm_trial_expect_warning(const struct gm_scene *scene, const char *words, bool expected);

/* The sentence that refuses these words; "" if they are accepted. */
const char *gm_trial_refusal(const char *words, char *message);

#endif
