/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Numbers as typed and as written; values of rows. */
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
#include "core/parameter.h"

static void numbers_are_read(void **unused)
{
    (void)unused;
    const struct {
        const char *text;
        double value;
    } good[] = {
        {"1e-3", 1e-3},   {"pi/60", M_PI / 60},   {"2*pi", 2 * M_PI},
        {"-3", -3},       {".5/800", .5 / 800},   {"sqrt(2/3)", sqrt(2. / 3)},
        {" 1 + 2*3 ", 7}, {"(1+2)*3", 9},         {"2*pi/100", 2 * M_PI / 100},
        {"--1", 1},       {"1e308*10", INFINITY}, {"400*pi", 400 * M_PI},
        {"1-2-3", -4},    {"8/4/2", 1},
    };
    for (size_t i = 0; i < GM_COUNT(good); i++) {
        double value = NAN;
        assert_true(gm_number_parse(good[i].text, &value));
        assert_true(value == good[i].value);
    }
    const char *const bad[] = {"",    "abc", "1,5", "1 2", "pi pi", "2pi", "(1",    "1)", "sqrt 2", "0x10",
                               "nan", "inf", "*2",  "1e",  "e",     "1/",  "sqrt(", "%n", "1..2"};
    for (size_t i = 0; i < GM_COUNT(bad); i++) {
        double value = 42;
        if (gm_number_parse(bad[i], &value)) {
            fail_msg("\"%s\" was read as %g", bad[i], value);
        }
        assert_true(value == 42);
    }
    char deep[1000];
    memset(deep, '(', sizeof deep - 1);
    deep[sizeof deep - 1] = '\0';
    double value = 0;
    assert_false(gm_number_parse(deep, &value));
}

static void numbers_are_written_to_be_read_back(void **unused)
{
    (void)unused;
    const struct {
        double value;
        const char *text;
    } expected[] = {{M_PI / 12, "pi/12"},
                    {1.5 * M_PI, "3*pi/2"},
                    {400 * M_PI, "400*pi"},
                    {-M_PI, "-pi"},
                    {0, "0"},
                    {0.02, "0.02"},
                    {1e-6, "1e-6"},
                    {100, "100"},
                    {1e300, "1e300"},
                    {-2.5, "-2.5"}};
    char text[64];
    for (size_t i = 0; i < GM_COUNT(expected); i++) {
        assert_string_equal(gm_number_format(expected[i].value, text, sizeof text), expected[i].text);
    }
    srand(1);
    for (int i = 0; i < 20000; i++) {
        const double value = ldexp((double)rand() / RAND_MAX - 0.5, rand() % 200 - 100) * (i % 3 ? 1 : M_PI);
        double back = NAN;
        assert_true(gm_number_parse(gm_number_format(value, text, sizeof text), &back));
        assert_true(back == value);
    }
}

struct owner {
    double real;
    long whole;
    int choice, yes;
};

static const char *const colours[] = {"red", "green", NULL};
static const struct gm_parameter rows[] = {
    {.key = "real",
     .type = GM_REAL,
     .offset = offsetof(struct owner, real),
     .standard = "pi/2",
     .lowest = -1,
     .highest = 2},
    {.key = "whole",
     .type = GM_INTEGER,
     .offset = offsetof(struct owner, whole),
     .standard = "3",
     .lowest = 1,
     .highest = 10},
    {.key = "choice",
     .type = GM_CHOICE,
     .offset = offsetof(struct owner, choice),
     .standard = "green",
     .choices = colours},
    {.key = "yes", .type = GM_BOOLEAN, .offset = offsetof(struct owner, yes), .standard = "no"},
};

static void rows_store_what_is_valid(void **unused)
{
    (void)unused;
    struct owner owner;
    gm_parameters_reset(rows, 4, &owner);
    assert_true(owner.real == M_PI / 2 && owner.whole == 3 && owner.choice == 1 && owner.yes == 0);
    const struct {
        int row;
        const char *text;
        enum gm_parse result;
        double value;
    } cases[] = {
        {0, "1", GM_PARSED, 1},
        {0, "2.1", GM_OUT_OF_RANGE, 1},
        {0, "1e308*10", GM_OUT_OF_RANGE, 1},
        {0, "nan", GM_NOT_UNDERSTOOD, 1},
        {0, "0/0", GM_OUT_OF_RANGE, 1},
        {1, "10", GM_PARSED, 10},
        {1, "2.5", GM_NOT_UNDERSTOOD, 10},
        {1, "0", GM_OUT_OF_RANGE, 10},
        {1, "1e30", GM_OUT_OF_RANGE, 10},
        {2, "red", GM_PARSED, 0},
        {2, "blue", GM_NOT_UNDERSTOOD, 0},
        {2, "", GM_NOT_UNDERSTOOD, 0},
        {3, "yes", GM_PARSED, 1},
        {3, "1", GM_NOT_UNDERSTOOD, 1},
    };
    for (size_t i = 0; i < GM_COUNT(cases); i++) {
        const struct gm_parameter *row = &rows[cases[i].row];
        assert_int_equal(gm_parameter_set(row, &owner, cases[i].text), cases[i].result);
        assert_true(gm_parameter_get(row, &owner) == cases[i].value);
        char text[64];
        struct owner copy = owner;
        assert_int_equal(gm_parameter_set(row, &copy, gm_parameter_format(row, &owner, text, sizeof text)),
                         GM_PARSED);
        assert_true(gm_parameter_get(row, &copy) == gm_parameter_get(row, &owner));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(numbers_are_read),
        cmocka_unit_test(numbers_are_written_to_be_read_back),
        cmocka_unit_test(rows_store_what_is_valid),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
