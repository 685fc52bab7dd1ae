/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The disc's numbers: area after a turn, energy errors at t = 5 and over t = 60, for the steps that
   Razafindralandy, Hamdouni & Chhay (2018) use; each to the digits given. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#include "core/basics.h"
#include "tests/common/lane.h"

static void expect(const char *what, double value, double expected, double relative)
{
    if (!(fabs(value - expected) <= relative * fabs(expected))) {
        fail_msg("%s: %.6g, expected %.6g", what, value, expected);
    }
}

static void area_after_a_turn(void **unused)
{
    (void)unused;
    static const int parts[3] = {6, 12, 36};
    const struct {
        const char *scheme;
        double ratio[3];
    } table[] = {
        {"explicit-euler", {18.309, 4.9087, 1.7267}},
        {"implicit-euler", {.05462, .20372, .57913}},
        {"rk2", {1.2503, 1.02857, 1.001044}},
        {"rk4", {.99669, .999894, .99999956}},
        {"symplectic-euler", {1, 1, 1}},
        {"symplectic-euler-adjoint", {1, 1, 1}},
        {"midpoint", {1, 1, 1}},
        {"verlet", {1, 1, 1}},
        {"rk4sym", {1, 1, 1}},
        {"gauss4", {1, 1, 1}},
    };
    for (size_t i = 0; i < GM_COUNT(table); i++) {
        for (int k = 0; k < 3; k++) {
            char words[128];
            snprintf(words, sizeof words, "disc scheme=%s dt=pi/%d until=2*pi", table[i].scheme, parts[k]);
            struct gm_lane *lane = test_lane(words);
            const double before = test_observed(lane, "area");
            assert_int_equal(gm_run_advance(lane->run, 2L * parts[k]), GM_OK);
            /* half a unit of the last digit given, of which there are at least four */
            const double relative = table[i].ratio[k] == 1               ? 1e-13
                                    : fabs(table[i].ratio[k] - 1) < 1e-5 ? 1e-8
                                                                         : 5e-5;
            expect(words, test_observed(lane, "area") / before, table[i].ratio[k], relative);
            gm_lane_close(lane);
        }
    }
}

/* The error at the end, or the largest on the way. */
static double energy_error(const char *scheme, double dt, double until, bool largest)
{
    char words[128];
    snprintf(words, sizeof words, "disc points=3 scheme=%s dt=%g until=%g compensated=yes", scheme, dt,
             until);
    struct gm_lane *lane = test_lane(words);
    double most = 0;
    for (long n = 0; n < lround(until / dt); n++) {
        assert_int_equal(gm_run_advance(lane->run, 1), GM_OK);
        most = fmax(most, test_observed(lane, "energy_error"));
    }
    const double end = test_observed(lane, "energy_error");
    gm_lane_close(lane);
    return largest ? most : end;
}

static const double steps[3] = {.1, .06, .02};

static void energy_errors(void **unused)
{
    (void)unused;
    const struct {
        const char *scheme;
        double until;
        bool largest;
        double error[3];
        double relative;
    } table[] = {
        {"explicit-euler", 5, false, {.645, .348, .1051}, 2e-3},
        {"implicit-euler", 5, false, {.392, .258, .0951}, 2e-3},
        {"symplectic-euler", 60, true, {.0526, .0309, .0101}, 4e-3},
        {"verlet", 60, true, {2.5e-3, 9.0e-4, 1.0e-4}, 2e-2},
        {"rk4", 60, false, {8.3e-6, 6.5e-7, 2.7e-9}, 2e-2},
    };
    for (size_t i = 0; i < GM_COUNT(table); i++) {
        for (int k = 0; k < 3; k++) {
            expect(table[i].scheme, energy_error(table[i].scheme, steps[k], table[i].until, table[i].largest),
                   table[i].error[k], table[i].relative);
        }
    }
}

/* with compensated summation; without it round-off gathers to a few 1e-15 */
static void energy_at_round_off(void **unused)
{
    (void)unused;
    const char *const names[] = {"midpoint", "rk4sym", "gauss4"};
    for (size_t i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++) {
            const double error = energy_error(names[i], steps[k], 60, true);
            if (!(error <= 7e-16)) {
                fail_msg("%s: energy error %.2e", names[i], error);
            }
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(area_after_a_turn),
        cmocka_unit_test(energy_errors),
        cmocka_unit_test(energy_at_round_off),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
