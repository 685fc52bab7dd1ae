/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every scheme against states computed elsewhere. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "core/problems/problems.h"
#include "core/run.h"
#include "tests/reference_ode.h"

enum { CASES = sizeof reference_ode / sizeof reference_ode[0] };

static void expect_state(const double *y, const double *reference, double tolerance, size_t row)
{
    const double scale = fmax(fabs(reference[0]), fabs(reference[1]));
    const double error = fmax(fabs(y[0] - reference[0]), fabs(y[1] - reference[1]));
    if (!(error <= tolerance * scale)) {
        fail_msg("%s on the %s: error %.2e, tolerance %.2e", reference_ode[row].scheme,
                 reference_ode[row].problem, error / scale, tolerance);
    }
}

static void states_agree(void **unused)
{
    (void)unused;
    for (size_t i = 0; i < CASES; i++) {
        const bool pendulum = strcmp(reference_ode[i].problem, "pendulum") == 0;
        const struct gm_problem problem = pendulum ? gm_problem_pendulum : gm_problem_oscillator;
        const struct gm_scheme *scheme = gm_scheme_find(reference_ode[i].scheme);
        assert_non_null(scheme);
        for (int compensated = 0; compensated < 2; compensated++) {
            const struct gm_settings settings = {.compensated = compensated};
            struct gm_run *run =
                gm_run_open(&problem, scheme, &settings, 0, reference_ode[i].dt, reference_ode[i].start);
            assert_non_null(run);
            assert_int_equal(gm_run_advance(run, 1), GM_OK);
            expect_state(gm_run_state(run), reference_ode[i].after_one_step, 1e-14, i);
            assert_int_equal(gm_run_advance(run, reference_ode[i].steps - 1), GM_OK);
            expect_state(gm_run_state(run), reference_ode[i].end, reference_ode[i].tolerance, i);
            double energy = 0;
            problem.hamiltonian->energy(&problem, gm_run_state(run), &energy, 1);
            assert_true(fabs(energy - reference_ode[i].energy) <= 10 * reference_ode[i].tolerance);
            gm_run_close(run);
        }
    }
}

static void every_scheme_has_a_reference(void **unused)
{
    (void)unused;
    for (size_t s = 0; s < gm_scheme_count(); s++) {
        size_t found = 0;
        if (gm_scheme_at(s)->needs & GM_NEEDS_MOVING_MESH) {
            continue; /* unit_mesh has theirs */
        }
        for (size_t i = 0; i < CASES; i++) {
            found += strcmp(reference_ode[i].scheme, gm_scheme_at(s)->name) == 0;
        }
        if (found == 0) {
            fail_msg("%s has no reference", gm_scheme_at(s)->name);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(states_agree),
        cmocka_unit_test(every_scheme_has_a_reference),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
