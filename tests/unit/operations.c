/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The operations that a kernel may use (core/ode/kernel/simd.h, formula.h): a lane does what a double does, bit for bit,
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

/* The functions of a formula's operations, of one number. */
#define OF_ONE(name, constant)                                                                               \
    static real K(name)(real x)                                                                              \
    {                                                                                                        \
        return K(value_##constant)(x, x);                                                                    \
    }
#define GM_PASS_SCALAR
#include "core/ode/kernel/simd.h"

#include "core/ode/kernel/formula.h"

OF_ONE(sine, SIN)
OF_ONE(cosine, COS)
OF_ONE(exponential, EXP)
OF_ONE(logarithm, LOG)
#undef GM_PASS_SCALAR
#undef real
#undef mask
#undef GM_LANES
#undef K
#include "core/ode/kernel/simd.h"

#include "core/ode/kernel/formula.h"

OF_ONE(sine, SIN)
OF_ONE(cosine, COS)
OF_ONE(exponential, EXP)
OF_ONE(logarithm, LOG)

static const struct operation {
    double (*of_double)(double x);
    gm_lanes (*of_lanes)(gm_lanes x);
    long double (*reference)(long double x);
    double low, high; /* the range that is scanned */
} operations[] = {
    {root_scalar, root_lanes, sqrtl, 0, 1e10},
    {sine_scalar, sine_lanes, sinl, -100, 100},
    {cosine_scalar, cosine_lanes, cosl, -100, 100},
    {exponential_scalar, exponential_lanes, expl, -746, 710},
    {logarithm_scalar, logarithm_lanes, logl, 0, 10},
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

/* Correct to the last place: glibc's own bound is 0.52 of it, and 1 is what other libraries keep. */
static void hold(const struct operation *operation, double x)
{
    const double value = operation->of_double(x);
    assert_true(ulps(value, operation->reference(x)) <= 1);
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
    assert_true(exponential_scalar(0) == 1 && exponential_scalar(-INFINITY) == 0);
    assert_true(isinf(exponential_scalar(709.7827128933841)) &&
                isfinite(exponential_scalar(709.782712893384)));
    assert_true(exponential_scalar(-745.1332191019411) > 0 && exponential_scalar(-745.1332191019412) == 0);
    assert_true(logarithm_scalar(0) == -INFINITY && logarithm_scalar(-0.0) == -INFINITY);
    assert_true(isnan(logarithm_scalar(-1)) && isnan(logarithm_scalar(NAN)) &&
                isnan(exponential_scalar(NAN)));
    assert_true(logarithm_scalar(1) == 0 && logarithm_scalar(INFINITY) == INFINITY);
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
