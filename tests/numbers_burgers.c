/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The tables of what Burgers' front and shock are to give, scheme by scheme and frame by frame. Where the
   printed Crank-Nicolson forms grow at the front (h/nu = 4) the result depends on rounding: there the test
   asks only that it is bad. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#include "tests/field_runs.h"

struct row {
    const char *words;
    double sup, l1; /* NaN: not asked for */
    double blow_up; /* the time, or NaN */
};

static void expect_row(const char *common, const struct row *row)
{
    char words[256];
    snprintf(words, sizeof words, "%s %s", common, row->words);
    struct field_run run = field_run_make(words, -1);
    if (isnan(row->blow_up)) {
        assert_int_equal(run.lane->run->status, GM_OK);
        expect_within(words, field_run_value(&run, "sup_error"), row->sup, 0.03);
        if (!isnan(row->l1)) {
            /* printed with two digits */
            expect_within("  in the mean", field_run_value(&run, "l1_error"), row->l1, 0.05);
        }
    } else {
        assert_int_equal(run.lane->run->status, GM_BLOW_UP);
        expect_within(words, run.lane->run->t, row->blow_up, 0.06);
    }
    field_run_close(&run);
}

static void the_front_from_moving_frames(void **unused)
{
    (void)unused;
    static const struct row rows[] = {
        {"scheme=ftcs form=printed lambda=0", 1.07, .055, NAN},
        {"scheme=ftcs form=printed lambda=.5", NAN, NAN, .42},
        {"scheme=ftcs form=printed lambda=1", NAN, NAN, .41},
        {"scheme=ftcs lambda=0", .036, .0015, NAN},
        {"scheme=ftcs lambda=.5", NAN, NAN, .81},
        {"scheme=ftcs lambda=1", NAN, NAN, .175},
        {"scheme=lax-wendroff lambda=0", .033, .0013, NAN},
        {"scheme=lax-wendroff lambda=.5", .039, .0016, NAN},
        {"scheme=lax-wendroff lambda=1", NAN, NAN, .32},
        {"scheme=crank-nicolson form=printed lambda=1", 1.16, .065, NAN},
        {"scheme=crank-nicolson form=printed lambda=2", .69, NAN, NAN},
        {"scheme=crank-nicolson form=printed lambda=3", .77, NAN, NAN},
        {"scheme=crank-nicolson lambda=0", .036, .0015, NAN},
        {"scheme=crank-nicolson lambda=.5", .141, .011, NAN},
        {"scheme=crank-nicolson lambda=1", .318, .024, NAN},
        {"scheme=crank-nicolson lambda=2", .41, NAN, NAN},
        {"scheme=crank-nicolson lambda=3", .61, NAN, NAN},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        expect_row("burgers frame=fixed dx=.02 courant=.5 until=1", &rows[i]);
    }
    struct field_run run =
        field_run_make("burgers frame=fixed dx=.02 form=printed scheme=crank-nicolson lambda=0", -1);
    assert_true(run.lane->run->status != GM_OK || field_run_value(&run, "sup_error") > 1);
    field_run_close(&run);
}

static void invariant_schemes_do_not_see_the_frame(void **unused)
{
    (void)unused;
    static const char *const lambdas[] = {"0", "0.5", "1", "2", "3"};
    static const struct {
        const char *scheme;
        double sup, l1, overshoot;
    } rows[] = {{"ftcs-invariant", .434, .0247, .40}, {"lax-wendroff-invariant", .0538, .0022, 0}};
    for (size_t s = 0; s < 2; s++) {
        for (size_t k = 0; k < 5; k++) {
            char words[160];
            snprintf(words, sizeof words, "burgers frame=moving dx=.02 scheme=%s lambda=%s", rows[s].scheme,
                     lambdas[k]);
            struct field_run run = field_run_make(words, -1);
            assert_int_equal(run.lane->run->status, GM_OK);
            expect_within(words, field_run_value(&run, "sup_error"), rows[s].sup, 0.01);
            expect_within("  in the mean", field_run_value(&run, "l1_error"), rows[s].l1, 0.03);
            assert_true(fabs(field_run_value(&run, "overshoot") - rows[s].overshoot) < 0.01);
            assert_true(field_run_value(&run, "galilean_defect") <= 1e-9);
            assert_true(field_run_value(&run, "projection_defect") < 1e-15);
            field_run_close(&run);
        }
    }
}

static void the_self_similar_shock(void **unused)
{
    (void)unused;
    static const struct row rows[] = {
        {"scheme=ftcs offset=0", .257, .034, NAN},
        {"scheme=ftcs offset=.5", NAN, NAN, 1.27},
        {"scheme=ftcs-invariant offset=0", .0466, .0055, NAN},
        {"scheme=ftcs-invariant offset=.5", .0325, .0037, NAN},
        {"scheme=lax-wendroff offset=0", .033, .0044, NAN},
        {"scheme=lax-wendroff offset=.5", .039, NAN, NAN},
        {"scheme=lax-wendroff-invariant offset=0", NAN, NAN, 1.22},
        {"scheme=lax-wendroff-invariant offset=.5", NAN, NAN, 1.18},
        {"scheme=crank-nicolson offset=0", .28, NAN, NAN},
        {"scheme=crank-nicolson-invariant offset=0", .22, NAN, NAN},
    };
    const char *common = "burgers test=shock viscosity=.01 dx=.05 courant=1 form=printed until=2";
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        expect_row(common, &rows[i]);
    }
    static const struct row conservative[] = {
        {"scheme=crank-nicolson offset=0 form=conservative", .0115, NAN, NAN},
        {"scheme=crank-nicolson offset=.5 form=conservative", .032, NAN, NAN},
    };
    for (size_t i = 0; i < 2; i++) {
        expect_row("burgers test=shock viscosity=.01 dx=.05 courant=1 until=2", &conservative[i]);
    }
}

static void standard_schemes_do_not_commute(void **unused)
{
    (void)unused;
    static const char *const names[] = {"burgers scheme=ftcs", "burgers scheme=lax-wendroff"};
    for (size_t i = 0; i < 2; i++) {
        struct field_run run = field_run_make(names[i], 0);
        assert_true(field_run_value(&run, "projection_defect") > 1e-6);
        field_run_close(&run);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_front_from_moving_frames),
        cmocka_unit_test(invariant_schemes_do_not_see_the_frame),
        cmocka_unit_test(the_self_similar_shock),
        cmocka_unit_test(standard_schemes_do_not_commute),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
