/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A click in the picture of somebody's system: the start puts the nearest body there. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "app/words/request.h"

static char path[] = "/tmp/aim-XXXXXX.system";

/* What a click says: "a=1.2 b=0.3", in the order of the rows; "" where it does nothing. */
static const char *click_on(const char *show, const char *lines, double x, double y)
{
    static char said[GM_CHOICES * 64];
    char message[GM_MESSAGE];
    struct gm_request request;
    struct gm_choice choices[GM_CHOICES];
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(lines, file);
    fclose(file);
    char shown[32];
    snprintf(shown, sizeof shown, "show=%s", show);
    char *words[] = {path, shown};
    if (!gm_request_parse(&request, 2, words, 1, message)) {
        fail_msg("%s", message);
    }
    const size_t count = request.scene->point(request.lanes[0].parameters, x, y, choices);
    said[0] = '\0';
    for (size_t i = 0; i < count; i++) {
        snprintf(said + strlen(said), 64, "%s%s=%s", i > 0 ? " " : "", choices[i].key, choices[i].value);
    }
    gm_request_close(&request);
    return said;
}

static const char *click(const char *lines, double x, double y)
{
    return click_on("all", lines, x, y);
}

#define PENDULUM                                                                                             \
    "coordinates: a b\nangle: a b\nparameter: l = 1\nH: (p_a^2 + p_b^2)/2 - cos(a) - cos(b)\n"               \
    "start: a = 0.4, b = 0.6, p_a = 0, p_b = 0\nview: sin(a), -cos(a)\n"                                     \
    "view: sin(a) + l*sin(b), -cos(a) - l*cos(b)\nrod: 0, 0; sin(a), -cos(a)\n"

static void planes(void **unused)
{
    (void)unused;
    const char *plane = "coordinates: q\nmomenta: p\nH: p^2/2 - cos(q)\nstart: q = 1, p = 0\n";
    assert_string_equal(click(plane, 0.25, -1.5), "q=0.25 p=-1.5");
    const char *orbit = "coordinates: x y\nH: (p_x^2 + p_y^2)/2 - 1/sqrt(x^2 + y^2)\nview: x, y\n"
                        "start: x = 1, y = 0, p_x = 0, p_y = 1\n";
    assert_string_equal(click(orbit, 0.25, 2), "x=0.25 y=2");
}

#define TWO                                                                                                  \
    "coordinates: x y\nH: (p_x^2 + p_y^2 + x^2 + 2*y^2)/2\nstart: x = 1, y = 0, p_x = 0.5, p_y = 1\nsection: "

/* A point of a section is a start that lies in it, where it tells which component is 0. */
static void sections(void **unused)
{
    (void)unused;
    assert_string_equal(click_on("section", TWO "x = 0, p_x > 0; y, p_y\n", 0.25, -0.5),
                        "y=0.25 p_y=-0.5 x=0");
    assert_string_equal(click_on("section", TWO "x - y = 0; y, p_y\n", 0.25, -0.5), "y=0.25 p_y=-0.5");
    assert_string_equal(click_on("section", TWO "x = 0; x, p_y\n", 0.25, -0.5), "x=0.25 p_y=-0.5");
    assert_string_equal(click_on("section", TWO "every 2; y, p_y\n", 0.25, -0.5), "y=0.25 p_y=-0.5");
}

/* Both angles turn where the lower bob is to be, the upper one alone where that is nearer and only as far as its rod;
   what is out of reach is met as nearly as can be. */
static void bodies(void **unused)
{
    (void)unused;
    double a, b;
    assert_int_equal(sscanf(click(PENDULUM, 1.2, -1.1), "a=%lf b=%lf", &a, &b), 2);
    assert_float_equal(sin(a) + sin(b), 1.2, 0.01);
    assert_float_equal(-cos(a) - cos(b), -1.1, 0.01);
    assert_string_equal(click(PENDULUM, 0.5, -0.5), "a=0.785");
    assert_int_equal(sscanf(click(PENDULUM, 30, -30), "a=%lf b=%lf", &a, &b), 2);
    assert_float_equal(a, acos(-1) / 4, 0.01);
    assert_float_equal(b, acos(-1) / 4, 0.01);
    const char *three = "coordinates: x[1..3] y[1..3]\nmomenta: u[1..3] v[1..3]\n"
                        "H: sum(i = 1 .. 3, u[i]^2/2 + v[i]^2/2 + x[i]^2 + y[i]^2)\n"
                        "start: x[i] = i, y[i] = 0, u[i] = 0, v[i] = 0\nview: i = 1 .. 3; x[i], y[i]\n";
    assert_string_equal(click(three, 2.25, 0.5), "x[2]=2.25 y[2]=0.5");
}

static void nothing(void **unused)
{
    (void)unused;
    const char *space = "coordinates: x y z\nH: (p_x^2 + p_y^2 + p_z^2)/2 + x^2 + y^2 + z^2\nview: x, y, z\n"
                        "start: x = 1, y = 0, z = 0, p_x = 0, p_y = 1, p_z = 0\n";
    assert_string_equal(click(space, 0.25, 2), "");
    const char *held = "coordinates: x y\nH: (p_x^2 + p_y^2)/2 + y\nconstraint: x^2 + y^2 - 1\nview: x, y\n"
                       "rod: 0, 0; x, y\nstart: x = 1, y = 0, p_x = 0, p_y = 0\n";
    assert_string_equal(click(held, 0.25, 2), "");
    const char *many = "coordinates: x[1..9]\nH: sum(i = 1 .. 9, p_x[i]^2/2 + x[i]^2)\n"
                       "start: x[i] = i, p_x[i] = 0\nview: sum(i = 1 .. 9, x[i]), sum(i = 1 .. 9, i*x[i])\n";
    assert_string_equal(click(many, 1, 2), "");
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(planes), cmocka_unit_test(sections),
                                       cmocka_unit_test(bodies), cmocka_unit_test(nothing)};
    const int file = mkstemps(path, (int)strlen(".system"));
    if (file < 0 || close(file) != 0) {
        return EXIT_FAILURE;
    }
    const int failures = cmocka_run_group_tests_name("aim", tests, NULL, NULL);
    unlink(path);
    return failures;
}
