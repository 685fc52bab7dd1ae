/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Elementary functions (core/functions): against MPFR, at special values (C17, F.10), and the same bits for each set
   of instructions. Usage: functions [POINTS]. */
#include <complex.h>
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <mpfr.h>

#include "core/basics.h"
#include "core/functions/complex.h"
#include "core/functions/functions.h"
#include "core/functions/instructions.h"
#include "core/functions/rows.h"

/* x of [low, high] at random, and if its powers are given, of [2^low, 2^high] with any sign */
struct range {
    double low, high;
    bool powers;
};

static const struct function {
    const char *name;
    double (*one)(double), (*two)(double, double);
    int (*mpfr_one)(mpfr_t, const mpfr_t, mpfr_rnd_t),
        (*mpfr_two)(mpfr_t, const mpfr_t, const mpfr_t, mpfr_rnd_t);
    double most; /* units of the last place */
    size_t at;   /* place in the rows */
    struct range ranges[4], of_second[4];
} functions[] = {
#define GM_ONE(name) #name, gm_##name, NULL, mpfr_##name, NULL, 1, offsetof(struct gm_function_rows, name)
#define GM_TWO(name) #name, NULL, gm_##name, NULL, mpfr_##name, 1, offsetof(struct gm_function_rows, name)
#define GM_NEAR                                                                                              \
    {                                                                                                        \
        -1, 1, 0                                                                                             \
    }
#define GM_ALL                                                                                               \
    {                                                                                                        \
        -1074, 1024, 1                                                                                       \
    }
    {GM_ONE(sin), {{-100, 100, 0}, GM_ALL, {-2e6, 2e6, 0}, {-30, 40, 1}}, {{0, 0, 0}}},
    {GM_ONE(cos), {{-100, 100, 0}, GM_ALL, {-2e6, 2e6, 0}, {-30, 40, 1}}, {{0, 0, 0}}},
    {GM_ONE(tan), {{-100, 100, 0}, GM_ALL, {-2e6, 2e6, 0}, {-30, 40, 1}}, {{0, 0, 0}}},
    {GM_ONE(asin), {GM_NEAR, {-1074, 0, 1}, {0.99, 1, 0}, {-30, 0, 1}}, {{0, 0, 0}}},
    {GM_ONE(acos), {GM_NEAR, {-1074, 0, 1}, {0.99, 1, 0}, {-1, -0.99, 0}}, {{0, 0, 0}}},
    {GM_ONE(atan), {GM_NEAR, GM_ALL, {-10, 10, 0}, {-30, 60, 1}}, {{0, 0, 0}}},
    {GM_ONE(exp), {{-746, 710, 0}, {-745.2, -708, 0}, GM_NEAR, {-60, 10, 1}}, {{0, 0, 0}}},
    {GM_ONE(expm1), {{-60, 710, 0}, GM_NEAR, {-3, 3, 0}, {-1074, 10, 1}}, {{0, 0, 0}}},
    {GM_ONE(log), {{0.5, 2, 0}, {0.99, 1.01, 0}, {0, 1e6, 0}, GM_ALL}, {{0, 0, 0}}},
    {GM_ONE(log1p), {{-0.999, 3, 0}, {-0.01, 0.01, 0}, {0, 1e6, 0}, GM_ALL}, {{0, 0, 0}}},
    {GM_ONE(log10), {{0.5, 2, 0}, {0.99, 1.01, 0}, {0, 1e6, 0}, GM_ALL}, {{0, 0, 0}}},
    {GM_ONE(log2), {{0.5, 2, 0}, {0.99, 1.01, 0}, {0, 1e6, 0}, GM_ALL}, {{0, 0, 0}}},
    {GM_ONE(sinh), {{-711, 711, 0}, GM_NEAR, {-30, 30, 0}, {-1074, 10, 1}}, {{0, 0, 0}}},
    {GM_ONE(cosh), {{-711, 711, 0}, GM_NEAR, {-30, 30, 0}, {-1074, 10, 1}}, {{0, 0, 0}}},
    {GM_ONE(tanh), {{-30, 30, 0}, GM_NEAR, {-3, 3, 0}, {-1074, 10, 1}}, {{0, 0, 0}}},
    {"erfc",
     gm_erfc,
     NULL,
     mpfr_erfc,
     NULL,
     6,
     offsetof(struct gm_function_rows, erfc),
     {{-7, 28, 0}, GM_NEAR, {0, 3, 0}, {-1074, 5, 1}},
     {{0, 0, 0}}},
    {GM_TWO(pow),
     {{0, 10, 0}, GM_ALL, {0.9, 1.1, 0}, {0, 1e5, 0}},
     {{-50, 50, 0}, {-20, 10, 1}, {-7000, 7000, 0}, {-5, 5, 0}}},
    {GM_TWO(atan2),
     {GM_NEAR, GM_ALL, {-10, 10, 0}, {-30, 30, 1}},
     {GM_NEAR, GM_ALL, {-0.1, 0.1, 0}, {-30, 30, 1}}},
    {GM_TWO(hypot),
     {GM_NEAR, GM_ALL, {-10, 10, 0}, {-30, 30, 1}},
     {GM_NEAR, GM_ALL, {-0.1, 0.1, 0}, {-30, 30, 1}}},
};

static size_t points = 100000;
static uint64_t state = 88172645463325252U;

/* in [0, 1) (Marsaglia's xorshift) */
static double random_number(void)
{
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    return (double)(state >> 11) * 0x1p-53;
}

static double within(struct range range)
{
    const double x = range.low + (range.high - range.low) * random_number();
    return range.powers ? ldexp((1 + random_number()) * (random_number() < 0.5 ? -1 : 1), (int)floor(x)) : x;
}

/* The distance from a reference of 120 bits, in units of the last place of the double next to it. */
static double units(double value, mpfr_t reference)
{
    const double nearest = mpfr_get_d(reference, MPFR_RNDN);
    if (isnan(nearest) || isinf(nearest) || isnan(value) || isinf(value)) {
        return (isnan(nearest) && isnan(value)) || nearest == value ? 0 : INFINITY;
    }
    int exponent;
    frexp(nearest, &exponent);
    mpfr_sub_d(reference, reference, value, MPFR_RNDN);
    mpfr_mul_2si(reference, reference, 53 - (exponent < -1021 ? -1021 : exponent), MPFR_RNDN);
    return fabs(mpfr_get_d(reference, MPFR_RNDN));
}

static double value_of(const struct function *function, double x, double y)
{
    return function->one ? function->one(x) : function->two(x, y);
}

static void errors_are_small(void **unused)
{
    (void)unused;
    mpfr_t a, b, value;
    mpfr_inits2(53, a, b, NULL);
    mpfr_init2(value, 120);
    for (size_t f = 0; f < GM_COUNT(functions); f++) {
        const struct function *function = &functions[f];
        double largest = 0, at = 0, and_at = 0;
        for (size_t i = 0; i < points; i++) {
            const double x = within(function->ranges[i % 4]),
                         y = function->two ? within(function->of_second[i % 4]) : 0;
            mpfr_set_d(a, x, MPFR_RNDN);
            mpfr_set_d(b, y, MPFR_RNDN);
            if (function->one) {
                function->mpfr_one(value, a, MPFR_RNDN);
            } else {
                function->mpfr_two(value, a, b, MPFR_RNDN);
            }
            const double error = units(value_of(function, x, y), value);
            if (!(error <= largest)) {
                largest = error, at = x, and_at = y;
            }
        }
        print_message("%-5s %.3f units at most\n", function->name, largest);
        if (!(largest <= function->most)) {
            fail_msg("%s: %.3f units at %a, %a", function->name, largest, at, and_at);
        }
    }
    mpfr_clears(a, b, value, NULL);
    mpfr_free_cache();
}

/* pow, atan2 and hypot at every pair of special numbers, against the C library, which follows F.10 too. */
static void special_values_are_those_of_the_standard(void **unused)
{
    (void)unused;
    static const double list[] = {0,        0.5,    1,         1.5,       2,
                                  3,        4,      0x1p52,    0x1p53,    0x1p60,
                                  1e300,    1e-300, 0x1p-1022, 0x1p-1074, 0x1.fffffffffffffp1023,
                                  INFINITY, NAN};
    for (size_t f = 0; f < GM_COUNT(functions); f++) {
        const struct function *function = &functions[f];
        double (*of_library)(double, double) = function->two == gm_pow     ? pow
                                               : function->two == gm_atan2 ? atan2
                                                                           : hypot;
        for (size_t k = 0; function->two && k < 4 * GM_COUNT(list) * GM_COUNT(list); k++) {
            const size_t pair = k / 4;
            const double x = (k & 1 ? -1 : 1) * list[pair % GM_COUNT(list)],
                         y = (k & 2 ? -1 : 1) * list[pair / GM_COUNT(list)];
            const double value = function->two(x, y), reference = of_library(x, y);
            const bool same = isnan(reference) ? isnan(value)
                              : isinf(reference) || reference == 0
                                  ? memcmp(&value, &reference, sizeof value) == 0
                                  : fabs(value - reference) <= fmax(3e-16 * fabs(reference), 0x1p-1074);
            if (!same) {
                fail_msg("%s(%a, %a) = %a, not %a", function->name, x, y, value, reference);
            }
        }
    }
}

/* Rows of each set of instructions give what single numbers give. */
static void rows_have_the_same_bits(void **unused)
{
    (void)unused;
    static const struct gm_function_rows *const rows[GM_ISA_COUNT] = {
        &gm_function_rows_baseline,
#ifdef GM_LOOPS_X86
        &gm_function_rows_avx2,
        &gm_function_rows_avx512,
#endif
    };
    for (int isa = 0; isa <= (int)gm_isa_best(); isa++) {
        for (size_t f = 0; f < GM_COUNT(functions); f++) {
            const struct function *function = &functions[f];
            gm_function_row *row;
            memcpy(&row, (const char *)rows[isa] + function->at, sizeof row);
            for (size_t i = 0; i < points / 23; i++) {
                double x[23], y[23], values[23];
                const size_t count = 1 + i % 23;
                for (size_t k = 0; k < count; k++) {
                    x[k] = within(function->ranges[(i + k) % 4]);
                    y[k] = within(function->of_second[(i + k) % 4]);
                }
                const bool one_x = i % 5 == 0, one_y = i % 7 == 0;
                row(values, x, one_x, y, one_y, count);
                for (size_t k = 0; k < count; k++) {
                    const double value = value_of(function, x[one_x ? 0 : k], y[one_y ? 0 : k]);
                    assert_memory_equal(&value, &values[k], sizeof value);
                }
            }
        }
    }
}

/* The difference from a value of more digits, relative to its magnitude. */
static double apart(double complex found, long double complex wanted)
{
    return (double)(cabsl((long double complex)found - wanted) / cabsl(wanted));
}

/* Complex functions against those of the C library in more digits, with parts between the smallest normal number and the
   largest one, and quotients of smaller ones, too; a quotient that a number can hold neither vanishes on its way nor
   overflows, whatever the divisor. */
static void complex_functions(void **unused)
{
    (void)unused;
    static const double sizes[] = {0, 1e-310, DBL_MIN, 1e-200, 1e-30,       0.75,
                                   1, 3,      1e30,    1e200,  DBL_MAX / 2, DBL_MAX};
    enum { COUNT = sizeof sizes / sizeof *sizes, ALL = COUNT * COUNT };
    for (size_t i = 1; i < ALL; i++) {
        const double a = sizes[i % COUNT] * (i % 2 ? 1 : -1), b = sizes[i / COUNT] * (i % 3 ? 1 : -1);
        const double complex x = a + I * b;
        if (gm_cabs(x) >= DBL_MIN && gm_cabs(x) < DBL_MAX / 4) {
            assert_true(apart(gm_csqrt(x), csqrtl(x)) < 5e-16);
            assert_true(apart(gm_csqrt(x) + 1, csqrtl(x) + 1) < 5e-16); /* the same of the two roots */
        }
        for (size_t k = 1; k < ALL; k++) {
            const double complex y = sizes[k % COUNT] - I * sizes[k / COUNT];
            if (fmax(fabs(a), fabs(b)) > DBL_MAX / 4 && fmax(creal(y), -cimag(y)) < DBL_MAX / 4) {
                continue; /* the two parts of the dividend are added */
            }
            const long double complex wanted = (long double complex)x / y;
            const long double p = fabsl(creall(wanted)), q = fabsl(cimagl(wanted));
            if (fmaxl(p, q) < DBL_MAX / 4 && fmaxl(p, q) > 4 * DBL_MIN &&
                !(apart(gm_cdivide(x, y), wanted) < 2e-15)) {
                fail_msg("(%g, %g) / (%g, %g)", a, b, creal(y), cimag(y));
            }
        }
    }
    assert_true(gm_csqrt(0) == 0);
    for (int i = -20; i <= 20; i++) {
        const double complex z = (i + 0.25) / 3 + I * (7 - i) / 2.;
        assert_true(apart(gm_cexp(z), cexpl(z)) < 1e-15 && fabs(gm_carg(z) - carg(z)) < 1e-15);
        assert_true(apart(gm_cpow(z, 5), (long double complex)z * z * z * z * z) < 2e-14);
    }
}

int main(int argc, char **argv)
{
    points = argc > 1 ? (size_t)atol(argv[1]) : points;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(errors_are_small),
        cmocka_unit_test(special_values_are_those_of_the_standard),
        cmocka_unit_test(rows_have_the_same_bits),
        cmocka_unit_test(complex_functions),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
