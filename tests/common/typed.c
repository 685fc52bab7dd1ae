/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Systems for tests, typed as text. */
#include "tests/common/typed.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

void type(struct typed *typed, const char *text)
{
    struct gm_fault fault;
    if (!gm_equations_open(&typed->system, text, strlen(text), NULL, 0, &fault)) {
        fail_msg("%s: %s", text, fault.sentence);
    }
    typed->start = gm_equations_start(&typed->system, NULL);
    assert_non_null(typed->start);
    assert_true(gm_own_model_open(&typed->model, &typed->system));
    assert_string_equal(gm_own_model_lacks(&typed->model), "");
    assert_true(gm_own_problem_open(&typed->problem, &typed->model, typed->start));
}

void untype(struct typed *typed)
{
    gm_own_problem_close(&typed->problem);
    gm_own_model_close(&typed->model);
    gm_system_close(&typed->system);
    free(typed->start);
}
