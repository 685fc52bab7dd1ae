/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Systems for tests, typed as text. */
#include "tests/common/typed.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "core/schemes.h"

void type(struct typed *typed, const char *text)
{
    struct gm_fault fault;
    if (!gm_equations_open(&typed->system, text, strlen(text), NULL, 0, &fault)) {
        fail_msg("%s: %s", text, fault.sentence);
    }
    typed->start = gm_equations_start(&typed->system, NULL);
    assert_non_null(typed->start);
    assert_true(gm_user_model_open(&typed->model, &typed->system));
    assert_string_equal(gm_user_model_lacks(&typed->model), "");
    assert_true(gm_user_problem_open(&typed->problem, &typed->model, typed->start));
}

void untype(struct typed *typed)
{
    gm_user_problem_close(&typed->problem);
    gm_system_close(&typed->system);
    free(typed->start);
}

void typed_advance(const struct typed *typed, const struct gm_settings *settings, const char *name, double dt,
                   long steps, double *end)
{
    const struct gm_scheme *scheme = gm_scheme_find_for(name, &typed->problem);
    assert_true(scheme && gm_scheme_fits(scheme, &typed->problem));
    struct gm_run *run = gm_run_open(&typed->problem, scheme, settings, 0, dt, typed->start);
    assert_non_null(run);
    assert_int_equal(gm_run_advance(run, steps), GM_OK);
    memcpy(end, gm_run_state(run), typed->problem.n * sizeof *end);
    gm_run_close(run);
}

double typed_apart(const double *a, const double *b, size_t n)
{
    double largest = 0;
    for (size_t i = 0; i < n; i++) {
        largest = fmax(largest, isfinite(a[i]) ? fabs(a[i] - b[i]) : INFINITY);
    }
    return largest;
}
