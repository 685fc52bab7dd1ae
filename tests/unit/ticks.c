/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Ticks of axes: round values, of any range three to six, whose labels differ. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "core/basics.h"
#include "render/layout/panel.h"

#define PI 3.14159265358979323846

/* All labels of an axis with at most `max` ticks, separated by blanks. */
static const char *labels(enum gm_scale scale, double low, double high, size_t max)
{
    static char all[512];
    const struct gm_axis axis = {.label = "", .scale = scale, .low = low, .high = high};
    double values[GM_TICK_MAX];
    const size_t count = gm_ticks(&axis, max, values);
    double step = 0.0;
    if (count > 1) {
        step = scale == GM_LOG ? log10(values[1] / values[0]) : values[1] - values[0];
    }
    all[0] = '\0';
    for (size_t i = 0; i < count; i++) {
        char text[64];
        gm_tick_format(scale, values[i], step, text, sizeof text);
        snprintf(all + strlen(all), sizeof all - strlen(all), i > 0 ? " %s" : "%s", text);
    }
    return all;
}

static void linear_axes_have_round_values(void **state)
{
    (void)state;
    assert_string_equal(labels(GM_LINEAR, 0, 10, 6), "0 2 4 6 8 10");
    assert_string_equal(labels(GM_LINEAR, 0, 12, 6), "0 3 6 9 12");
    assert_string_equal(labels(GM_LINEAR, -1, 1, 6), "−1.0 −0.5 0 0.5 1.0");
    assert_string_equal(labels(GM_LINEAR, 0, 2, 6), "0 0.5 1.0 1.5 2.0");
    assert_string_equal(labels(GM_LINEAR, 0, 420, 6), "0 100 200 300 400");
    assert_string_equal(labels(GM_LINEAR, 0.001, 0.0035, 6), "0.0010 0.0015 0.0020 0.0025 0.0030 0.0035");
    assert_string_equal(labels(GM_LINEAR, 0, 2e5, 6), "0 5×10⁴ 1.0×10⁵ 1.5×10⁵ 2.0×10⁵");
    assert_string_equal(labels(GM_LINEAR, -3e-6, 3e-6, 4), "−3×10⁻⁶ 0 3×10⁻⁶");
    assert_string_equal(labels(GM_LINEAR, 1.7, 2.2, 1), "2"); /* where there is room for one alone */
}

/* Where an axis says where its ticks stand they do, as long as there are no more than have room. */
static void ticks_of_ones_own(void **state)
{
    (void)state;
    static const double own[] = {1, 2, 4};
    const struct gm_axis axis = {
        .label = "", .scale = GM_LOG, .low = 1, .high = 4, .ticks = own, .tick_count = GM_COUNT(own)};
    double values[GM_TICK_MAX];
    assert_int_equal(gm_ticks(&axis, 6, values), 3);
    assert_memory_equal(values, own, sizeof own);
    assert_int_not_equal(gm_ticks(&axis, 2, values), 3);
}

/* Cells around values reach half a cell beyond them, but there is no value. */
static void ticks_within_what_there_is(void **state)
{
    (void)state;
    struct gm_axis axis = {.label = "", .scale = GM_LINEAR, .low = -0.15, .high = 1.05};
    double values[GM_TICK_MAX];
    size_t count = gm_ticks(&axis, 6, values);
    assert_true(values[count - 1] > 0.9);
    axis.largest_tick = 0.9;
    count = gm_ticks(&axis, 6, values);
    assert_true(count >= 3 && values[0] == 0 && values[count - 1] > 0.5 && values[count - 1] <= 0.9 + 1e-9);
    axis.low = 0.95; /* nothing of it is shown */
    assert_int_not_equal(gm_ticks(&axis, 6, values), 0);
}

static void pi_axes_have_fractions_and_multiples(void **state)
{
    (void)state;
    assert_string_equal(labels(GM_PI, 0, 1.5 * PI, 6), "0 π/2 π 3π/2");
    assert_string_equal(labels(GM_PI, -PI, PI, 6), "−π −π/2 0 π/2 π");
    assert_string_equal(labels(GM_PI, 0, PI / 2, 6), "0 π/8 π/4 3π/8 π/2");
    assert_string_equal(labels(GM_PI, 0, 10 * PI, 6), "0 2π 4π 6π 8π 10π");
    assert_string_equal(labels(GM_PI, 0, 50 * PI, 6), "0 10π 20π 30π 40π 50π");
    assert_string_equal(labels(GM_PI, 0, 2000 * PI, 6), "0 500π 1000π 1500π 2000π");
    assert_string_equal(labels(GM_PI, 0, PI, 2), "0 π"); /* no step makes three */
    assert_string_equal(labels(GM_PI, 0, 0.5, 6), "0 0.1 0.2 0.3 0.4 0.5");
}

static void log_axes_have_powers_of_ten(void **state)
{
    (void)state;
    assert_string_equal(labels(GM_LOG, 1e-16, 10, 6), "10⁻¹⁵ 10⁻¹² 10⁻⁹ 10⁻⁶ 10⁻³ 1");
    assert_string_equal(labels(GM_LOG, 1e-2, 1e3, 6), "10⁻² 10⁻¹ 1 10 10² 10³");
    assert_string_equal(labels(GM_LOG, 1e-300, 1, 6), "10⁻³⁰⁰ 10⁻²⁰⁰ 10⁻¹⁰⁰ 1");
    assert_string_equal(labels(GM_LOG, 0.25, 4, 6), "0.3 1 3");
    assert_string_equal(labels(GM_LOG, 1, 10, 6), "1 3 10");
    assert_string_equal(labels(GM_LOG, 0.98, 1.02, 6), "0.98 0.99 1 1.01 1.02");
    assert_string_equal(labels(GM_LOG, 2e-8, 2e-7, 6), "2×10⁻⁸ 5×10⁻⁸ 10⁻⁷ 2×10⁻⁷");
}

/* Pseudo-random ranges, the same in every run. */
static double uniform(uint64_t *seed)
{
    *seed = *seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (double)(*seed >> 11) / 9007199254740992.0;
}

static void check_range(struct gm_axis axis, size_t max)
{
    double values[GM_TICK_MAX];
    char last[64] = "";
    const size_t count = gm_ticks(&axis, max, values);
    assert_true(count >= 3 && count <= max);
    for (size_t i = 0; i < count; i++) {
        char text[64];
        const double room = axis.scale == GM_LOG ? 1e-5 * values[i] : 1e-5 * (axis.high - axis.low);
        assert_true(values[i] >= axis.low - room && values[i] <= axis.high + room);
        assert_true(i == 0 || values[i] > values[i - 1]);
        const double step = axis.scale == GM_LOG ? log10(values[1] / values[0]) : values[1] - values[0];
        gm_tick_format(axis.scale, values[i], step, text, sizeof text);
        assert_true(strlen(text) > 0);
        assert_string_not_equal(text, last);
        strcpy(last, text);
    }
}

static void any_range_has_three_to_six_different_ticks(void **state)
{
    (void)state;
    uint64_t seed = 1;
    for (int i = 0; i < 20000; i++) {
        const double size = pow(10.0, 16.0 * uniform(&seed) - 8.0), place = 20.0 * (uniform(&seed) - 0.5);
        check_range((struct gm_axis){.scale = GM_LINEAR, .low = size * place, .high = size * (place + 1.0)},
                    6);
        check_range((struct gm_axis){.scale = GM_PI, .low = size * place, .high = size * (place + 1.0)}, 6);
        const double low = pow(10.0, 200.0 * (uniform(&seed) - 0.5));
        const double high = low * pow(10.0, 0.1 + 60.0 * pow(uniform(&seed), 3.0));
        check_range((struct gm_axis){.scale = GM_LOG, .low = low, .high = high}, 6);
    }
}

static void odd_ranges_do_no_harm(void **state)
{
    (void)state;
    static const double bounds[] = {0,      -0.0,     1,         -1,  1e-310,   1e308,
                                    -1e308, INFINITY, -INFINITY, NAN, 1 + 1e-15};
    const size_t n = GM_COUNT(bounds);
    for (size_t i = 0; i < n * n * 3; i++) {
        const struct gm_axis axis = {.label = "",
                                     .scale = (enum gm_scale)(i % 3),
                                     .low = bounds[i / 3 % n],
                                     .high = bounds[i / 3 / n]};
        for (size_t max = 0; max <= 100; max += 5) {
            double values[GM_TICK_MAX];
            const size_t count = gm_ticks(&axis, max, values);
            assert_true(count <= max && count <= GM_TICK_MAX);
            for (size_t k = 0; k < count; k++) {
                assert_true(isfinite(values[k]));
            }
        }
    }
    char text[4] = "";
    gm_tick_format(GM_LINEAR, -123456.0, 1.0, text, sizeof text);
    assert_int_equal(strlen(text), 3); /* the minus sign alone: no half characters */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(linear_axes_have_round_values),
        cmocka_unit_test(pi_axes_have_fractions_and_multiples),
        cmocka_unit_test(ticks_of_ones_own),
        cmocka_unit_test(ticks_within_what_there_is),
        cmocka_unit_test(log_axes_have_powers_of_ten),
        cmocka_unit_test(any_range_has_three_to_six_different_ticks),
        cmocka_unit_test(odd_ranges_do_no_harm),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
