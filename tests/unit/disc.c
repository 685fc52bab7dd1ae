/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The disc: area and energy against what is known in closed form. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "core/basics.h"
#include "core/schemes.h"
#include "tests/common/lane.h"

static struct gm_lane *open_lane(const char *arguments)
{
    char words[256];
    snprintf(words, sizeof words, "disc %s", arguments);
    return test_lane(words);
}

static void expect_area_factor(const char *arguments, double factor_per_step, long steps, double tolerance)
{
    struct gm_lane *lane = open_lane(arguments);
    const double before = test_observed(lane, "area");
    double expected = 1;
    for (long n = 1; n <= steps; n++) {
        assert_int_equal(gm_run_advance(lane->run, 1), GM_OK);
        expected *= factor_per_step;
        const double factor = test_observed(lane, "area") / before;
        if (!(fabs(factor / expected - 1) <= tolerance)) {
            fail_msg("%s: area factor %.17g after %ld steps, expected %.17g", arguments, factor, n, expected);
        }
        assert_true(fabs(test_observed(lane, "area_tangent") / expected - 1) <= tolerance);
    }
    gm_lane_close(lane);
}

static void explicit_euler_grows(void **unused)
{
    (void)unused;
    const double dt = M_PI / 12;
    expect_area_factor("scheme=explicit-euler", 1 + dt * dt, 300, 1e-12);
    expect_area_factor("scheme=explicit-euler dt=0.5", 1.25, 100, 1e-12);
}

static void implicit_euler_shrinks(void **unused)
{
    (void)unused;
    const double dt = M_PI / 12;
    expect_area_factor("scheme=implicit-euler", 1 / (1 + dt * dt), 300, 1e-12);
}

/* Heun's factor on the oscillator is 1 + dt^4/4, that of RK4 1 - dt^6/72 + dt^8/576 (the modulus squared of
   the stability function at i dt). */
static void runge_kutta_changes_it_slowly(void **unused)
{
    (void)unused;
    const double dt = M_PI / 12, d2 = dt * dt;
    expect_area_factor("scheme=rk2", 1 + d2 * d2 / 4, 300, 1e-12);
    expect_area_factor("scheme=rk4", 1 - d2 * d2 * d2 / 72 + d2 * d2 * d2 * d2 / 576, 300, 1e-12);
}

static void symplectic_schemes_keep_it(void **unused)
{
    (void)unused;
    size_t seen = 0;
    struct gm_lane *any = open_lane("scheme=rk4");
    for (size_t i = 0; i < gm_scheme_count(); i++) {
        const struct gm_scheme *scheme = gm_scheme_at(i);
        if (!(scheme->claims & GM_SYMPLECTIC) || !gm_scheme_fits(scheme, &any->problem)) {
            continue;
        }
        char arguments[64];
        snprintf(arguments, sizeof arguments, "scheme=%s", scheme->name);
        expect_area_factor(arguments, 1, 300, 1e-12);
        seen++;
    }
    gm_lane_close(any);
    assert_true(seen >= 6);
}

static void energy_of_explicit_euler(void **unused)
{
    (void)unused;
    struct gm_lane *lane = open_lane("scheme=explicit-euler dt=0.02 until=5");
    assert_int_equal(gm_run_advance(lane->run, 250), GM_OK);
    const double error = test_observed(lane, "energy_error");
    assert_true(fabs(error - (pow(1.0004, 250) - 1)) < 1e-13);
    assert_true(fabs(error - 0.105) < 5e-4);
    gm_lane_close(lane);
}

/* The pendulum's energy passes zero: its error is told in units of m g l there, and of |H0| where that is
   more; the oscillator's in units of its own. */
static void energy_is_told_in_natural_units(void **unused)
{
    (void)unused;
    static const struct {
        const char *arguments;
        bool pendulum;
        double least;
    } rows[] = {
        {"system=pendulum scheme=rk2 q0=pi/2 p0=0.02 dt=0.3", true, 1},
        {"system=pendulum scheme=rk2 q0=0 p0=4 dt=0.3", true, 1},
        {"scheme=rk2 q0=1e-3 p0=0 dt=0.3", false, 0},
    };
    for (size_t i = 0; i < GM_COUNT(rows); i++) {
        struct gm_lane *lane = open_lane(rows[i].arguments);
        const size_t m = lane->problem.m, half = lane->problem.n / 2;
        double energy[2];
        for (int k = 0; k < 2; k++) {
            const double *y = gm_run_state(lane->run), q = y[m - 1], p = y[half * m + m - 1];
            energy[k] = p * p / 2 + (rows[i].pendulum ? -cos(q) : q * q / 2);
            assert_int_equal(gm_run_advance(lane->run, k ? 0 : 20), GM_OK);
        }
        const double error = fabs(energy[1] - energy[0]) / fmax(fabs(energy[0]), rows[i].least);
        assert_true(error > 1e-4);
        assert_true(fabs(test_observed(lane, "energy_error") - error) <= 1e-9 * error);
        gm_lane_close(lane);
    }
    /* at rest in the middle there is no energy to divide by */
    struct gm_lane *lane = open_lane("scheme=rk2 q0=0 p0=0");
    assert_int_equal(gm_run_advance(lane->run, 20), GM_OK);
    assert_true(test_observed(lane, "energy_error") == 0);
    gm_lane_close(lane);
}

static void expect_energy_below(const char *arguments, long steps, double bound)
{
    struct gm_lane *lane = open_lane(arguments);
    double largest = 0;
    for (long n = 0; n < steps; n++) {
        assert_int_equal(gm_run_advance(lane->run, 1), GM_OK);
        largest = fmax(largest, test_observed(lane, "energy_error"));
    }
    if (!(largest < bound)) {
        fail_msg("%s: energy error %.3g, not below %.3g", arguments, largest, bound);
    }
    assert_true(largest > 0); /* round-off there is; none would mean that nothing moved */
    gm_lane_close(lane);
}

static void energy_of_the_midpoint_rule(void **unused)
{
    (void)unused;
    expect_energy_below("scheme=midpoint points=3", 100000, 5e-13);
    expect_energy_below("scheme=midpoint points=3 compensated=yes", 100000, 1e-13);
}

/* On the pendulum a polygon of the same points is off by 3e-3 at t = 5 and by 11 at t = 20, where it is no longer a
   measure of the area: there is no number then, and nothing is lost. */
static void pendulum_wound_up(void **unused)
{
    (void)unused;
    const char *const names[] = {"verlet", "midpoint", "gauss4", "symplectic-euler"};
    for (size_t i = 0; i < GM_COUNT(names); i++) {
        char arguments[64];
        snprintf(arguments, sizeof arguments, "system=pendulum p0=1.9 dt=0.1 scheme=%s", names[i]);
        struct gm_lane *lane = open_lane(arguments);
        const int error = gm_scene_observable(lane->scene, "area_error");
        assert_int_equal(gm_run_advance(lane->run, 50), GM_OK);
        assert_true(test_observed(lane, "area_error") < 2e-13);
        for (int n = 50; n < 300; n += 5) {
            assert_int_equal(gm_run_advance(lane->run, 5), GM_OK);
            const double value = test_observed(lane, "area_error");
            assert_true(isnan(value) || value < 1e-6);
        }
        assert_true(fabs(test_observed(lane, "area_tangent") - 1) < 1e-9);
        assert_true(isnan(test_observed(lane, "area_error")));
        assert_string_equal(gm_lane_missing(lane, (size_t)error), "the loop is not resolved with 256 points");
        assert_int_equal(gm_lane_lost(lane), -1);
        gm_lane_close(lane);
    }
}

/* The members of a system carry no tangents. Fewer than five points of an edge are an ellipse, whatever it is. */
static void members_of_a_system(void **unused)
{
    (void)unused;
    static const struct {
        const char *members;
        double t, most; /* NaN: there is no number */
    } rows[] = {
        {"5", 0, NAN},     {"6", 0, 1e-15}, {"65", 5, 1e-8},    {"257", 5, 1e-12},
        {"66", 5.1, 1e-8}, {"65", 20, NAN}, {"1200", 5, 1e-12},
    };
    for (size_t i = 0; i < GM_COUNT(rows); i++) {
        char words[160];
        snprintf(words, sizeof words,
                 "system H=p^2/2-cos(q) q=0 p=1.9 spread=0.2 dt=0.1 scheme=midpoint members=%s",
                 rows[i].members);
        struct gm_lane *lane = test_lane(words);
        assert_int_equal(gm_run_to(lane->run, lround(rows[i].t / 0.1), INFINITY), GM_OK);
        const double error = test_observed(lane, "area_error");
        if (!(isnan(rows[i].most) ? isnan(error) : error <= rows[i].most)) {
            fail_msg("%s members at t = %g: area error %.3g", rows[i].members, rows[i].t, error);
        }
        assert_int_equal(gm_lane_lost(lane), -1);
        gm_lane_close(lane);
    }
}

static void shapes_are_remembered(void **unused)
{
    (void)unused;
    struct gm_lane *lane = open_lane("scheme=verlet");
    size_t track = 0;
    while (strcmp(lane->scene->tracks[track].key, "shapes") != 0) {
        assert_true(++track < lane->scene->track_count);
    }
    const struct gm_entries *shapes = &lane->entries[track];
    for (int n = 0; n < 18; n++) {
        gm_run_advance(lane->run, 1);
        gm_lane_record(lane);
    }
    /* every pi/6 is every second step: the start and nine more */
    assert_int_equal(shapes->count, 10);
    for (size_t i = 0; i < shapes->count; i++) {
        assert_true(fabs(shapes->times[i] - M_PI / 6 * (double)i) < 1e-12);
    }
    for (int n = 0; n < 5000; n++) {
        gm_run_advance(lane->run, 1);
        gm_lane_record(lane);
    }
    assert_true(shapes->count <= 96 && shapes->count >= 48);
    assert_true(shapes->times[0] == 0);
    assert_true(lane->history.count <= GM_HISTORY_BINS && lane->history.count > GM_HISTORY_BINS / 2 - 1);
    gm_lane_close(lane);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(explicit_euler_grows),          cmocka_unit_test(implicit_euler_shrinks),
        cmocka_unit_test(runge_kutta_changes_it_slowly), cmocka_unit_test(symplectic_schemes_keep_it),
        cmocka_unit_test(energy_of_explicit_euler),      cmocka_unit_test(energy_is_told_in_natural_units),
        cmocka_unit_test(energy_of_the_midpoint_rule),   cmocka_unit_test(pendulum_wound_up),
        cmocka_unit_test(members_of_a_system),           cmocka_unit_test(shapes_are_remembered),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
