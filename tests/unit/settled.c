/* SPDX-License-Identifier: GPL-3.0-or-later */
/* When iterations are at their end: each term of the rules, by the changes that it is for. */
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
#include "core/linear/differences.h"
#include "core/linear/settled.h"
#include "core/ode/kernel/stages.h"

/* At which of the changes an iteration of 3 unknowns ends, counted from 1; 0: at none. */
static size_t newton_ends(const double *changes, size_t count, double scale, double rounding)
{
    double previous = INFINITY;
    for (size_t i = 0; i < count; i++) {
        if (gm_newton_is_settled(3, changes[i], scale, rounding, &previous)) {
            return i + 1;
        }
    }
    return 0;
}

static size_t other_ends(const double *changes, size_t count, double roundoff)
{
    double previous = INFINITY;
    for (size_t i = 0; i < count; i++) {
        if (gm_is_settled(changes[i], roundoff, &previous)) {
            return i + 1;
        }
    }
    return 0;
}

static void newton_has_a_floor(void **unused)
{
    (void)unused;
    /* Robertson's system: a rounding less every time, and none of it counts */
    const double falling[] = {2.2e-3, 3.1e-9, 2.2e-19, 6.17e-21};
    assert_int_equal(newton_ends(falling, GM_COUNT(falling), 2, 0), 3);
    /* what comes to rest among the smallest numbers, where the state is as small as the change */
    const double least[] = {1e-300, 1e-307};
    assert_int_equal(newton_ends(least, GM_COUNT(least), 1e-307, 0), 2);
}

static void newton_knows_the_rounding_of_slopes(void **unused)
{
    (void)unused;
    /* h J of 1e8: no change is below the rounding of h f */
    const double standing[] = {1, 1e-9, 2e-9};
    assert_int_equal(newton_ends(standing, GM_COUNT(standing), 2, 1e8), 3);
    assert_int_equal(newton_ends(standing, GM_COUNT(standing), 2, 1), 0);
    /* but a first guess is no solution because its terms are large */
    const double guess[] = {1e-3, 1e-3};
    assert_int_equal(newton_ends(guess, GM_COUNT(guess), 2, 1e16), 0);
    /* changes that are halved still fall, those that stand within a tenth do not */
    const double halved[] = {8e-14, 4e-14, 2e-14}, near[] = {1.0e-14, 0.95e-14};
    assert_int_equal(newton_ends(halved, GM_COUNT(halved), 10, 0), 0);
    assert_int_equal(newton_ends(near, GM_COUNT(near), 10, 0), 2);
}

static void sweeps_end_where_the_next_is_negligible(void **unused)
{
    (void)unused;
    const double negligible = 0x1p-60, roundoff = 1e-15, least = GM_LEAST_CHANGE(2);
    assert_true(GM_SWEEPS_ARE_SETTLED(1e-16, 1e-16, negligible, roundoff, least));
    assert_true(GM_SWEEPS_ARE_SETTLED(1e-16, 1e-13, negligible, roundoff, least));
    assert_false(GM_SWEEPS_ARE_SETTLED(9e-16, 1.1e-15, negligible / 1e6, roundoff, least));
    assert_false(GM_SWEEPS_ARE_SETTLED(1e-14, 1e-14, negligible, roundoff, least));
    assert_true(GM_SWEEPS_ARE_SETTLED(4e-308, 1e-300, 0.0, 0.0, least));
    assert_false(GM_SWEEPS_ARE_SETTLED(NAN, 1e-300, 0.0, 0.0, least));
    assert_true(GM_SWEEPS_CONTRACT(0.2, 1.0, roundoff));
    assert_false(GM_SWEEPS_CONTRACT(2.0, 1.0, roundoff));
    assert_true(GM_SWEEPS_CONTRACT(1e-16, 1e-16, roundoff));
    assert_false(GM_SWEEPS_CONTRACT(NAN, 1.0, roundoff));
}

static void others_end_far_below_their_level(void **unused)
{
    (void)unused;
    const double falling[] = {1e-4, 1e-17, 1e-20}, standing[] = {1e-4, 1e-14, 1e-14}, large[] = {1, 1},
                 least[] = {1e-200, 1e-302};
    assert_int_equal(other_ends(falling, GM_COUNT(falling), 1e-13), 3);
    assert_int_equal(other_ends(standing, GM_COUNT(standing), 1e-13), 3);
    assert_int_equal(other_ends(large, GM_COUNT(large), 1e-13), 0);
    assert_int_equal(other_ends(least, GM_COUNT(least), 0), 2);
}

static void levels_that_are_given_hold(void **unused)
{
    (void)unused;
    double previous = 1e-13;
    assert_false(gm_is_settled_within(2e-15, 1e-15, 1e-12, &previous)); /* it still falls */
    assert_true(gm_is_settled_within(1e-15, 1e-15, 1e-12, &previous));
    previous = 5e-12;
    assert_false(gm_is_settled_within(5e-12, 1e-15, 1e-12, &previous)); /* it stands too high */
    previous = 5e-13;
    assert_true(gm_is_settled_within(5e-13, 1e-15, 1e-12, &previous));
}

/* Where the rounding of slopes is said not to decide, no value of it changes the end. */
static void rounding_is_asked_where_it_decides(void **unused)
{
    (void)unused;
    for (int power = -70; power < 2; power++) {
        const double previous = ldexp(1, power);
        for (double ratio = 0.25; ratio < 4 && !gm_rounding_decides(1, previous); ratio *= 1.1) {
            double one = previous, other = previous;
            assert_int_equal(gm_newton_is_settled(3, ratio * previous, 1, 0, &one),
                             gm_newton_is_settled(3, ratio * previous, 1, 1e300, &other));
        }
    }
    assert_true(gm_rounding_decides(1, 0x1p-28));
}

static void obstacles_of_elimination(void **unused)
{
    (void)unused;
    double zeros[] = {0, 0, 0, 0}, none[] = {1, NAN, 2, NAN}, right[2] = {1, 1};
    assert_false(gm_eliminate(2, zeros, right));
    assert_int_equal(gm_obstacle_of(4, zeros), GM_SINGULAR);
    assert_false(gm_eliminate(2, none, right));
    assert_int_equal(gm_obstacle_of(4, none), GM_NOT_FINITE);
}

/* z = h A f: the step of Gauss's method is made of z by -sqrt 3 and sqrt 3, that of Radau's is z_2. */
static void weights_of_stages(void **unused)
{
    (void)unused;
    const double r = sqrt(3) / 6, half[] = {0.5, 0.5}, radau_b[] = {0.75, 0.25};
    const double gauss[2][GM_TABLEAU_STAGES] = {{0.25, 0.25 - r}, {0.25 + r, 0.25}};
    const double radau[2][GM_TABLEAU_STAGES] = {{5. / 12, -1. / 12}, {0.75, 0.25}};
    const double kicks[2][GM_TABLEAU_STAGES] = {{0.5, 0}, {0.5, 0}};
    double weights[2];
    assert_true(gm_weights_of_stages(2, gauss, half, weights));
    assert_true(fabs(weights[0] + sqrt(3)) < 1e-14 && fabs(weights[1] - sqrt(3)) < 1e-14);
    assert_true(gm_weights_of_stages(2, radau, radau_b, weights));
    assert_true(weights[0] == 0 && weights[1] == 1);
    assert_false(gm_weights_of_stages(2, kicks, half, weights));
}

/* h a J = -2 and 3 in one stage of two components, y + z = (1, -4) */
static void rounding_of_stages(void **unused)
{
    (void)unused;
    const double matrix[] = {3, -3, 0, 1}, y[] = {0.5, -3}, z[] = {0.5, -1};
    assert_true(gm_rounding_of_stages(2, 2, matrix, y, z) == 2 + 12);
}

/* x^2 = 2 and y = x / 4: by sweeps of Heron's rule, and by Newton's method. */
static bool heron(void *data, const double *z, double *next, double *scale)
{
    ++*(int *)data;
    next[0] = (z[0] + 2 / z[0]) / 2;
    next[1] = z[0] / 4;
    *scale += fabs(z[0]) + fabs(z[1]);
    return true;
}

static bool squares(void *data, const double *z, double *residual, double *matrix, double *scale)
{
    ++*(int *)data;
    residual[0] = 2 - z[0] * z[0];
    residual[1] = z[0] / 4 - z[1];
    matrix[0] = 2 * z[0];
    matrix[1] = 0;
    matrix[2] = -0.25;
    matrix[3] = 1;
    *scale += fabs(z[0]) + fabs(z[1]);
    return true;
}

static void equations_are_solved(void **unused)
{
    (void)unused;
    int calls = 0;
    struct gm_implicit_equations equations = {.size = 2,
                                              .data = &calls,
                                              .sweep = heron,
                                              .counted = 2,
                                              .least = 0x1p-52,
                                              .roundoff = 8 * GM_EPSILON};
    double scratch[10], z[2] = {1, 0};
    struct gm_progress progress = {0};
    assert_int_equal(gm_newton_scratch(2), GM_COUNT(scratch));
    assert_true(gm_sweeps_solve(&equations, scratch, z, &progress));
    assert_float_equal(z[0], M_SQRT2, 4e-16);
    assert_float_equal(z[1], M_SQRT2 / 4, 4e-16);
    assert_int_equal(progress.iterations, calls);
    assert_int_equal(progress.solves, 0);
    equations.linear = squares;
    for (int halved = 0; halved < 2; halved++) {
        equations.halved = halved;
        calls = 0;
        progress = (struct gm_progress){0};
        z[0] = 1;
        z[1] = 0;
        assert_true(gm_newton_solve(&equations, scratch, z, &progress));
        assert_float_equal(z[0], M_SQRT2, 4e-16);
        assert_float_equal(z[1], M_SQRT2 / 4, 4e-16);
        assert_int_equal(progress.iterations, calls);
        assert_int_equal(progress.solves, calls);
    }
}

static void failures_say_why(void **unused)
{
    (void)unused;
    int calls = 0;
    struct gm_implicit_equations equations = {.size = 2,
                                              .data = &calls,
                                              .linear = squares,
                                              .counted = 2,
                                              .least = 0x1p-52,
                                              .roundoff = 8 * GM_EPSILON};
    struct gm_progress progress = {0};
    double scratch[10], flat[2] = {0, 0}, nowhere[2] = {NAN, 0};
    assert_false(gm_newton_solve(&equations, scratch, flat, &progress));
    assert_int_equal(progress.unsolved.obstacle, GM_SINGULAR);
    assert_false(gm_newton_solve(&equations, scratch, nowhere, &progress));
    assert_int_equal(progress.unsolved.obstacle, GM_NOT_FINITE);
    /* a change that no sweep comes back from */
    double z[2] = {1e200, 0};
    equations.sweep = heron;
    equations.linear = NULL;
    assert_false(gm_sweeps_solve(&equations, scratch, z, &progress));
    assert_int_equal(progress.unsolved.obstacle, GM_NOT_FINITE);
}

static void several_right_sides_are_eliminated(void **unused)
{
    (void)unused;
    double a[] = {0, 2, 4, 1}, r[] = {2, 5, 4, 6};
    assert_true(gm_eliminate_columns(2, a, 2, r));
    assert_float_equal(r[0], 1, 0);
    assert_float_equal(r[1], 1, 0);
    assert_float_equal(r[2], 1, 0);
    assert_float_equal(r[3], 2, 0);
    double flat[] = {1, 2, 2, 4}, right[] = {1, 1};
    assert_false(gm_eliminate(2, flat, right));
}

static int images;

static bool grow(const void *context, const double *from, double *to)
{
    (void)context;
    images++;
    to[0] = exp(from[0]);
    to[1] = exp(-2 * from[0]);
    return true;
}

/* Four distances, and every extrapolation takes a power of them away: what is left of a smooth map is rounding, and no
   shorter distances are tried. */
static void smooth_maps_are_differentiated_at_once(void **unused)
{
    (void)unused;
    const struct gm_map map = {grow, NULL, 1, 2};
    double slope[2];
    assert_true(gm_differentiate(&map, &(double){0.5}, &(double){1}, slope));
    assert_int_equal(images, 8);
    assert_float_equal(slope[0], exp(0.5), 2e-12);
    assert_float_equal(slope[1], -2 * exp(-1), 2e-12);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(smooth_maps_are_differentiated_at_once),
        cmocka_unit_test(equations_are_solved),
        cmocka_unit_test(failures_say_why),
        cmocka_unit_test(several_right_sides_are_eliminated),
        cmocka_unit_test(newton_has_a_floor),
        cmocka_unit_test(newton_knows_the_rounding_of_slopes),
        cmocka_unit_test(sweeps_end_where_the_next_is_negligible),
        cmocka_unit_test(others_end_far_below_their_level),
        cmocka_unit_test(levels_that_are_given_hold),
        cmocka_unit_test(rounding_is_asked_where_it_decides),
        cmocka_unit_test(obstacles_of_elimination),
        cmocka_unit_test(weights_of_stages),
        cmocka_unit_test(rounding_of_stages),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
