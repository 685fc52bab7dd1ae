/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The operations that a kernel may use (core/functions): a lane does what a double does, bit for bit,
   and both are the function that the name says, against long double. */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "core/basics.h"
#include "core/ode/kernel/loops.h"

#define GM_PASS_SCALAR
#include "core/functions/lanes.h"

#include "core/functions/pass.h"
#undef GM_PASS_SCALAR
#include "core/functions/lanes.h"

#include "core/functions/pass.h"

static const struct operation {
    double (*of_double)(double x);
    gm_lanes (*of_lanes)(gm_lanes x);
    long double (*reference)(long double x);
    double low, high; /* the range that is scanned */
} operations[] = {
    {root_scalar, root_lanes, sqrtl, 0, 1e10},     {sin_scalar, sin_lanes, sinl, -100, 100},
    {cos_scalar, cos_lanes, cosl, -100, 100},      {tan_scalar, tan_lanes, tanl, -100, 100},
    {asin_scalar, asin_lanes, asinl, -1, 1},       {acos_scalar, acos_lanes, acosl, -1, 1},
    {atan_scalar, atan_lanes, atanl, -3, 3},       {exp_scalar, exp_lanes, expl, -746, 710},
    {expm1_scalar, expm1_lanes, expm1l, -60, 710}, {sinh_scalar, sinh_lanes, sinhl, -711, 711},
    {cosh_scalar, cosh_lanes, coshl, -711, 711},   {tanh_scalar, tanh_lanes, tanhl, -25, 25},
    {log_scalar, log_lanes, logl, 0, 10},          {log1p_scalar, log1p_lanes, log1pl, -1, 10},
    {log10_scalar, log10_lanes, log10l, 0, 10},    {log2_scalar, log2_lanes, log2l, 0, 10},
};
enum { OPERATIONS = GM_COUNT(operations) };

/* The distance from a reference, in units of the last place of the double next to it. */
static double ulps(double value, long double reference)
{
    const double nearest = (double)reference;
    if (isnan(nearest) || isinf(nearest) || isnan(value) || isinf(value)) {
        return (isnan(nearest) && isnan(value)) || nearest == value ? 0 : INFINITY;
    }
    int exponent;
    frexp(nearest, &exponent);
    const double place = ldexp(1, (exponent < DBL_MIN_EXP ? DBL_MIN_EXP : exponent) - DBL_MANT_DIG);
    return (double)(fabsl(value - reference) / place);
}

/* Correct to the last place, and a zero with its sign. */
static void hold(const struct operation *operation, double x)
{
    const double value = operation->of_double(x);
    const long double reference = operation->reference(x);
    if (!(ulps(value, reference) <= 1) || (value == 0 && signbit(value) != signbit((double)reference))) {
        fail_msg("row %zu at %a: %a, not %La", (size_t)(operation - operations), x, value, reference);
    }
    for (int at = 0; at < GM_WIDTH; at++) {
        gm_lanes lanes = constant_lanes(0.5);
        lanes[at] = x;
        const double lane = operation->of_lanes(lanes)[at];
        assert_true((isnan(lane) && isnan(value)) || memcmp(&lane, &value, sizeof lane) == 0);
    }
}

static void ranges(void **unused)
{
    (void)unused;
    enum { POINTS = 100000 };
    for (size_t i = 0; i < OPERATIONS; i++) {
        for (int k = 0; k <= POINTS; k++) {
            hold(&operations[i],
                 operations[i].low + (operations[i].high - operations[i].low) * ((double)k / POINTS));
        }
    }
}

static void every_size_of_number(void **unused)
{
    (void)unused;
    for (int power = DBL_MIN_EXP - DBL_MANT_DIG; power <= DBL_MAX_EXP; power++) {
        for (int k = 0; k < 16; k++) {
            const double x = ldexp(0.5 + k / 32.0, power);
            for (size_t i = 0; i < OPERATIONS; i++) {
                hold(&operations[i], x);
                hold(&operations[i], -x);
            }
        }
    }
}

static void corners(void **unused)
{
    (void)unused;
    static const double list[] = {
        0,
        -0.0,
        1,
        -1,
        INFINITY,
        -INFINITY,
        NAN,
        DBL_MAX,
        -DBL_MAX,
        DBL_MIN,
        -DBL_MIN,
        4.9406564584124654e-324,
        -4.9406564584124654e-324, /* the least that is not 0 */
        709.782712893384,
        709.7827128933841, /* exp is the largest double, and beyond it */
        -708.3964185322641,
        -708.3964185322642,
        -745.1332191019411,
        -745.1332191019412, /* ... the least normal, and 0 */
        1 - DBL_EPSILON / 2,
        1 + DBL_EPSILON, /* the logarithm is smallest */
    };
    for (size_t k = 0; k < GM_COUNT(list); k++) {
        for (size_t i = 0; i < OPERATIONS; i++) {
            hold(&operations[i], list[k]);
        }
    }
    assert_true(exp_scalar(0) == 1 && exp_scalar(-INFINITY) == 0);
    assert_true(isinf(exp_scalar(709.7827128933841)) && isfinite(exp_scalar(709.782712893384)));
    assert_true(exp_scalar(-745.1332191019411) > 0 && exp_scalar(-745.1332191019412) == 0);
    assert_true(log_scalar(0) == -INFINITY && log_scalar(-0.0) == -INFINITY);
    assert_true(isnan(log_scalar(-1)) && isnan(log_scalar(NAN)) && isnan(exp_scalar(NAN)));
    assert_true(log_scalar(1) == 0 && log_scalar(INFINITY) == INFINITY);
}

int main(void)
{
    if (GM_WIDTH > 2 << gm_isa_best()) {
        return 77; /* the registers of another machine: skipped */
    }
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ranges),
        cmocka_unit_test(every_size_of_number),
        cmocka_unit_test(corners),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
