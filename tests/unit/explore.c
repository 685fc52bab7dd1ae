/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The verbs of an exploration in libgeomint, each against a run that gets there without it. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <geomint.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define WORDS(...)                                                                                           \
    sizeof((const char *[]){__VA_ARGS__}) / sizeof(char *), (const char *[])                                 \
    {                                                                                                        \
        __VA_ARGS__                                                                                          \
    }
#define EXPLORE(...) geomint_explore(WORDS("kepler", "dt=0.125", "eccentricity=0.5", __VA_ARGS__))
#define OPEN(...) geomint_open(WORDS("kepler", "dt=0.125", __VA_ARGS__))

enum { N = 4 };

static void expect(int status, geomint *handle, int wanted, const char *part)
{
    if (status != wanted || geomint_status(handle) != wanted || !strstr(geomint_message(handle), part)) {
        fail_msg("status %d, \"%s\" instead of %d, \"%s\"", status, geomint_message(handle), wanted, part);
    }
}

static void good(int status, geomint *handle)
{
    expect(status, handle, GEOMINT_OK, "");
    assert_string_equal(geomint_message(handle), "");
}

static void copy(geomint *handle, size_t lane, double state[N])
{
    size_t n = 0, m = 0;
    const double *now = geomint_state(handle, lane, &n, &m);
    assert_non_null(now);
    assert_int_equal(n * m, N);
    memcpy(state, now, N * sizeof *state);
}

/* Expects two lanes at the same time, with the same bits. */
static void same(geomint *a, size_t i, geomint *b, size_t k)
{
    double x[N], y[N];
    copy(a, i, x);
    copy(b, k, y);
    assert_true(geomint_time(a, i) == geomint_time(b, k));
    assert_memory_equal(x, y, sizeof x);
}

static bool differ(geomint *a, size_t i, geomint *b, size_t k)
{
    double x[N], y[N];
    copy(a, i, x);
    copy(b, k, y);
    return memcmp(x, y, sizeof x) != 0;
}

/* Lanes advance together, as runs that are driven one by one do. */
static void lanes_advance(void **unused)
{
    (void)unused;
    geomint *lab = EXPLORE("scheme=verlet,rk4"), *run = OPEN("eccentricity=0.5", "scheme=verlet,rk4");
    good(geomint_advance(lab, 10), lab);
    assert_true(geomint_time(lab, 1) == 10);
    for (size_t i = 0; i < 2; i++) {
        geomint_step(run, i, 80);
        same(lab, i, run, i);
    }
    good(geomint_forward(lab), lab);
    geomint_step(run, 0, 1);
    geomint_step(run, 1, 1);
    same(lab, 0, run, 0);
    same(lab, 1, run, 1);
    good(geomint_advance(lab, 3), lab); /* it has passed */
    same(lab, 0, run, 0);
    /* numbers and pictures are those of the runs */
    double row[8], other[8], t, error;
    assert_true(geomint_row_size(lab, 1) <= 8 && geomint_row_size(lab, 1) == geomint_row_size(run, 1));
    assert_int_equal(geomint_row(lab, 1, &t, row), GEOMINT_OK);
    assert_int_equal(geomint_row(run, 1, NULL, other), GEOMINT_OK);
    assert_true(t == 10.125);
    assert_memory_equal(row, other, geomint_row_size(lab, 1) * sizeof *row);
    assert_int_equal(geomint_observable(lab, 1, "energy_error", &error), GEOMINT_OK);
    assert_true(error > 0 && error < 1e-2);
    enum { WIDTH = 320, HEIGHT = 200 };
    unsigned char *picture = malloc(4 * WIDTH * HEIGHT), *drawn = malloc(4 * WIDTH * HEIGHT);
    good(geomint_draw(lab, WIDTH, HEIGHT, 1, picture), lab);
    good(geomint_draw(run, WIDTH, HEIGHT, 1, drawn), run);
    assert_memory_equal(picture, drawn, 4 * WIDTH * HEIGHT);
    free(picture);
    free(drawn);
    geomint_close(run);
    geomint_close(lab);
}

/* A fork goes where its lane goes with the other scheme, and leaves the lane alone. */
static void forks_and_switches(void **unused)
{
    (void)unused;
    geomint *forked = EXPLORE("scheme=verlet"), *switched = EXPLORE("scheme=verlet"),
            *alone = OPEN("eccentricity=0.5", "scheme=verlet");
    good(geomint_advance(forked, 5), forked);
    good(geomint_advance(switched, 5), switched);
    good(geomint_fork(forked, 0, "rk4"), forked);
    assert_int_equal(geomint_lanes(forked), 2);
    same(forked, 1, switched, 0);
    good(geomint_switch(switched, 0, "rk4"), switched);
    good(geomint_advance(forked, 9), forked);
    good(geomint_advance(switched, 9), switched);
    geomint_step(alone, 0, 72);
    same(forked, 1, switched, 0);
    same(forked, 0, alone, 0);
    assert_true(differ(forked, 0, forked, 1));
    /* a copy with the same scheme stays equal */
    good(geomint_fork(forked, 0, "composition(verlet; 1)"), forked);
    good(geomint_advance(forked, 12), forked);
    double a[N], b[N];
    copy(forked, 0, a);
    copy(forked, 2, b);
    for (int i = 0; i < N; i++) {
        assert_true(fabs(a[i] - b[i]) < 1e-13);
    }
    expect(geomint_switch(forked, 0, "midpiont"), forked, GEOMINT_USAGE, "did you mean midpoint");
    expect(geomint_switch(forked, 7, "midpoint"), forked, GEOMINT_USAGE, "there is no lane 7");
    expect(geomint_fork(forked, 0, "preissmann"), forked, GEOMINT_USAGE, "does not fit");
    expect(geomint_fork(forked, 0, NULL), forked, GEOMINT_USAGE, "scheme is NULL");
    assert_int_equal(geomint_lanes(forked), 3);
    geomint_close(forked);
    geomint_close(switched);
    geomint_close(alone);
}

/* Back is the state before, bit by bit; a stored state is visited; a reversed run of Verlet returns. */
static void time_goes_back(void **unused)
{
    (void)unused;
    geomint *lab = EXPLORE("scheme=verlet"), *run = OPEN("eccentricity=0.5", "scheme=verlet");
    expect(geomint_back(lab), lab, GEOMINT_USAGE, "This is the start");
    geomint_step(run, 0, 24);
    good(geomint_advance(lab, 3), lab);
    good(geomint_forward(lab), lab);
    good(geomint_back(lab), lab);
    same(lab, 0, run, 0);
    good(geomint_advance(lab, 8), lab);
    good(geomint_visit(lab, 3), lab);
    same(lab, 0, run, 0);
    good(geomint_visit(lab, 100), lab); /* later states stay */
    assert_true(geomint_time(lab, 0) == 8);
    good(geomint_reverse(lab), lab);
    good(geomint_advance(lab, 0), lab);
    assert_true(geomint_time(lab, 0) == 0);
    double start[N], now[N];
    copy(lab, 0, now);
    good(geomint_restart(lab), lab);
    copy(lab, 0, start);
    for (int i = 0; i < N; i++) {
        assert_true(fabs(now[i] - start[i]) < 1e-12);
    }
    assert_memory_not_equal(now, start, sizeof now);
    expect(geomint_advance(lab, NAN), lab, GEOMINT_USAGE, "finite");
    good(geomint_switch(lab, 0, "gsl-rk4"), lab);
    expect(geomint_reverse(lab), lab, GEOMINT_USAGE, "only go forwards");
    geomint_close(run);
    geomint_close(lab);
}

/* A parameter that is set is that of a run opened with it. */
static void parameters_are_set(void **unused)
{
    (void)unused;
    geomint *lab = EXPLORE("scheme=verlet"), *run = OPEN("eccentricity=0.25", "scheme=verlet");
    good(geomint_advance(lab, 2), lab);
    good(geomint_set(lab, 0, "dt", "1/4"), lab); /* it is live */
    assert_true(geomint_time(lab, 0) == 2);
    good(geomint_forward(lab), lab);
    assert_true(geomint_time(lab, 0) == 2.25);
    good(geomint_undo(lab), lab);
    good(geomint_forward(lab), lab);
    assert_true(geomint_time(lab, 0) == 2.375);
    good(geomint_set(lab, 0, "eccentricity", "0.25"), lab); /* it is not */
    assert_true(geomint_time(lab, 0) == 0);
    geomint_step(run, 0, 16);
    good(geomint_advance(lab, 2), lab);
    same(lab, 0, run, 0);
    good(geomint_slide(lab, 0, "eccentricity", 0.5), lab);
    assert_non_null(strstr(geomint_view(lab), "{\"key\":\"eccentricity\",\"value\":\"0.5\""));
    good(geomint_undo(lab), lab);
    good(geomint_advance(lab, 2), lab);
    same(lab, 0, run, 0);
    good(geomint_set(lab, 0, "eccentricity", NULL), lab);
    assert_null(strstr(geomint_view(lab), "\"eccentricity\",\"value\":\"0.25\""));
    expect(geomint_set(lab, 0, "eccentricty", "0.5"), lab, GEOMINT_USAGE, "did you mean eccentricity");
    expect(geomint_set(lab, 0, "foo", "1"), lab, GEOMINT_USAGE, "\"foo\"; see geomint list kepler");
    expect(geomint_set(lab, 0, "eccentricity", "2"), lab, GEOMINT_USAGE, "out of range");
    char longest[400]; /* 0.100...e1, which is not 0.1 */
    snprintf(longest, sizeof longest, "0.1%0300de1", 0);
    expect(geomint_set(lab, 0, "eccentricity", longest), lab, GEOMINT_USAGE, "at most 255 letters");
    expect(geomint_set(lab, 1, "eccentricity", "0.5"), lab, GEOMINT_USAGE, "there is no lane 1");
    expect(geomint_set(lab, 0, NULL, "0.5"), lab, GEOMINT_USAGE, "key is NULL");
    expect(geomint_slide(lab, 0, "shape", 0.5), lab, GEOMINT_USAGE, "shape has no range");
    geomint_close(run);
    geomint_close(lab);
}

static void lanes_come_and_go(void **unused)
{
    (void)unused;
    geomint *lab = EXPLORE("scheme=verlet"), *run = OPEN("eccentricity=0.5", "scheme=rk4");
    good(geomint_advance(lab, 2), lab);
    good(geomint_add(lab, 0, "rk4"), lab);
    assert_true(geomint_time(lab, 1) == 0);
    good(geomint_advance(lab, 4), lab); /* the new lane catches up */
    geomint_step(run, 0, 32);
    same(lab, 1, run, 0);
    good(geomint_remove(lab, 0), lab);
    assert_int_equal(geomint_lanes(lab), 1);
    same(lab, 0, run, 0);
    expect(geomint_remove(lab, 0), lab, GEOMINT_USAGE, "The last lane stays");
    expect(geomint_add(lab, 0, "rk44"), lab, GEOMINT_USAGE, "there is no scheme");
    for (int i = 0; i < 5; i++) {
        good(geomint_add(lab, 0, "rk4"), lab);
    }
    expect(geomint_add(lab, 0, "rk4"), lab, GEOMINT_USAGE, "Six lanes");
    geomint_close(run);
    geomint_close(lab);
}

/* A key does what its function does. */
static void keys_are_pressed(void **unused)
{
    (void)unused;
    geomint *lab = EXPLORE("scheme=verlet,rk4"), *other = EXPLORE("scheme=verlet,rk4");
    good(geomint_press(lab, "."), lab);
    good(geomint_forward(other), other);
    same(lab, 0, other, 0);
    good(geomint_press(lab, "."), lab);
    good(geomint_press(lab, ","), lab);
    same(lab, 1, other, 1);
    good(geomint_press(lab, "Home"), lab);
    assert_true(geomint_time(lab, 0) == 0);
    good(geomint_press(lab, "End"), lab);
    same(lab, 0, other, 0);
    good(geomint_press(lab, "tab"), lab); /* selects the second lane */
    assert_non_null(strstr(geomint_view(lab), "\"selected\":1"));
    good(geomint_press(lab, "x"), lab);
    assert_int_equal(geomint_lanes(lab), 1);
    same(lab, 0, other, 0);
    good(geomint_press(lab, "B"), lab);
    good(geomint_press(lab, "."), lab);
    assert_true(geomint_time(lab, 0) == 0);
    expect(geomint_press(lab, "c"), lab, GEOMINT_USAGE, "turn time with B first");
    good(geomint_press(lab, "r"), lab);
    good(geomint_press(lab, "c"), lab);
    assert_int_equal(geomint_lanes(lab), 2);
    good(geomint_set(lab, 0, "dt", "0.5"), lab);
    good(geomint_press(lab, "u"), lab);
    good(geomint_press(lab, "."), lab);
    assert_true(geomint_time(lab, 0) == 0.125);
    expect(geomint_press(lab, "u"), lab, GEOMINT_USAGE, "nothing to undo");
    expect(geomint_press(lab, "space"), lab, GEOMINT_USAGE, "explorer");
    expect(geomint_press(lab, "~"), lab, GEOMINT_USAGE, "no order");
    expect(geomint_press(lab, ""), lab, GEOMINT_USAGE, "no order");
    expect(geomint_press(lab, NULL), lab, GEOMINT_USAGE, "key is NULL");
    geomint_close(other);
    geomint_close(lab);
}

/* The texts name what there is; a failed lane is reported, and the others continue. */
static void texts_and_failures(void **unused)
{
    (void)unused;
    geomint *lab =
        geomint_explore(WORDS("system", "rate=x = x^2", "x=1", "scheme=rk4,implicit-euler", "dt=0.03"));
    assert_string_equal(geomint_message(lab), "");
    const char *view = geomint_view(lab);
    static const char *const parts[] = {"\"scheme\":\"rk4\"", "\"observables\":[", "\"parameters\":[",
                                        "\"key\":\"dt\",\"value\":\"0.03\"", "\"lanes\":["};
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) {
        assert_non_null(view);
        if (!strstr(view, parts[i])) {
            fail_msg("%s is not in %s", parts[i], view);
        }
    }
    assert_non_null(strstr(geomint_schemes(lab), "{\"scheme\":\"gauss4\""));
    expect(geomint_advance(lab, 100), lab, GEOMINT_NUMERICAL, "");
    assert_true(strlen(geomint_message(lab)) > 10);
    assert_true(geomint_time(lab, 0) < 3);
    expect(geomint_step(lab, 0, 1), lab, GEOMINT_USAGE, "advance together");
    expect(geomint_until(lab, 0, 1), lab, GEOMINT_USAGE, "advance together");
    geomint_close(lab);

    geomint *run = geomint_open(WORDS("kepler"));
    expect(geomint_forward(run), run, GEOMINT_USAGE, "geomint_explore");
    assert_null(geomint_view(run));
    geomint_close(run);
    geomint *wrong = geomint_explore(WORDS("keplr"));
    assert_int_equal(geomint_status(wrong), GEOMINT_USAGE);
    assert_int_equal(geomint_forward(wrong), GEOMINT_USAGE);
    assert_null(geomint_schemes(wrong));
    geomint_close(wrong);

    double t = 1;
    assert_int_equal(geomint_advance(NULL, t), GEOMINT_MEMORY);
    assert_int_equal(geomint_forward(NULL), GEOMINT_MEMORY);
    assert_int_equal(geomint_fork(NULL, 0, "rk4"), GEOMINT_MEMORY);
    assert_int_equal(geomint_set(NULL, 0, "dt", "1"), GEOMINT_MEMORY);
    assert_int_equal(geomint_press(NULL, "."), GEOMINT_MEMORY);
    assert_null(geomint_view(NULL));
    assert_null(geomint_schemes(NULL));
}

/* The command line of a picture draws the lanes as they are, with their changes. */
static void pictures(void **unused)
{
    (void)unused;
    enum { WIDTH = 320, HEIGHT = 200, SIZE = 4 * WIDTH * HEIGHT };
    unsigned char *light = malloc(SIZE), *dark = malloc(SIZE), *again = malloc(SIZE);
    assert_int_equal(setenv("GEOMINT_PAINTER", "own", 1), 0);
    geomint *lab = EXPLORE("scheme=verlet", "until=100");
    for (int i = 0; i < 8; i++) {
        good(geomint_forward(lab), lab);
    }
    good(geomint_switch(lab, 0, "rk4"), lab);
    good(geomint_forward(lab), lab);
    assert_non_null(strstr(geomint_commands(lab), "\"picture\":\"geomint render kepler scheme=verlet"));
    assert_non_null(strstr(geomint_commands(lab), "steps=9 --changes 0:8:scheme=rk4 --theme light\""));
    assert_non_null(strstr(geomint_commands(lab), "\"explorer\":\"geomint kepler scheme=rk4"));

    geomint *run = OPEN("scheme=verlet", "eccentricity=0.5", "steps=9");
    good(geomint_change(run, 0, 8, "scheme=rk4"), run);
    expect(geomint_change(run, 0, 10, "scheme=rk4"), run, GEOMINT_USAGE, "comes too late");
    expect(geomint_change(run, 1, 1, "scheme=rk4"), run, GEOMINT_USAGE, "no lane 1");
    expect(geomint_change(run, 0, 9, "scheme=nothing"), run, GEOMINT_USAGE, "nothing");
    good(geomint_step(run, 0, 9), run);
    expect(geomint_change(run, 0, 8, "scheme=rk4"), run, GEOMINT_USAGE, "has made this step");
    expect(geomint_change(lab, 0, 20, "scheme=rk4"), lab, GEOMINT_USAGE, "geomint_switch");
    same(lab, 0, run, 0);

    expect(geomint_point(lab, 1, 1), lab, GEOMINT_USAGE, "no picture");
    good(geomint_draw(lab, WIDTH, HEIGHT, 1, light), lab);
    expect(geomint_theme(lab, "grey"), lab, GEOMINT_USAGE, "light or dark");
    good(geomint_theme(lab, "dark"), lab);
    good(geomint_draw(lab, WIDTH, HEIGHT, 1, dark), lab);
    assert_true(light[0] > 200 && dark[0] < 50);
    good(geomint_theme(lab, "light"), lab);
    good(geomint_draw(lab, WIDTH, HEIGHT, 1, again), lab);
    assert_memory_equal(light, again, SIZE);
    geomint_close(run);
    geomint_close(lab);

    lab = geomint_explore(WORDS("system", "H=p^2/2 - cos(q)", "q=1", "p=0", "scheme=verlet", "show=q:p"));
    good(geomint_draw(lab, WIDTH, HEIGHT, 1, light), lab);
    double before[2], after[2];
    memcpy(before, geomint_state(lab, 0, NULL, NULL), sizeof before);
    good(geomint_point(lab, 1, 1), lab);
    memcpy(after, geomint_state(lab, 0, NULL, NULL), sizeof after);
    assert_memory_equal(before, after, sizeof before);
    good(geomint_point(lab, WIDTH / 3., HEIGHT / 2.), lab);
    memcpy(after, geomint_state(lab, 0, NULL, NULL), sizeof after);
    assert_true(before[0] != after[0]);
    geomint_close(lab);

    lab = geomint_explore(WORDS("couette"));
    good(geomint_draw(lab, WIDTH, HEIGHT, 1, light), lab);
    expect(geomint_point(lab, 1, 1), lab, GEOMINT_USAGE, "no points");
    geomint_close(lab);

    assert_int_equal(geomint_look(NULL, 1, 1, 1), GEOMINT_MEMORY);
    assert_int_equal(geomint_point(NULL, 1, 1), GEOMINT_MEMORY);
    assert_int_equal(geomint_theme(NULL, "dark"), GEOMINT_MEMORY);
    assert_int_equal(geomint_change(NULL, 0, 1, "dt=1"), GEOMINT_MEMORY);
    assert_null(geomint_commands(NULL));
    free(light);
    free(dark);
    free(again);
}

/* An exercise is graded as `geomint grade` does it. */
static void exercises_are_graded(void **unused)
{
    (void)unused;
    geomint *lab = geomint_explore(WORDS("disc", "scheme=rk4", "dt=1"));
    good(geomint_advance(lab, 62), lab);
    expect(geomint_grade(lab, "exercises", 1), lab, GEOMINT_CLAIM,
           "Not passed: RK4 misses area_error < 1e-10");
    good(geomint_forward(lab), lab);
    expect(geomint_grade(lab, "exercises", 1), lab, GEOMINT_CLAIM, "is at t = 63");
    good(geomint_back(lab), lab);
    good(geomint_back(lab), lab);
    good(geomint_switch(lab, 0, "verlet"), lab);
    expect(geomint_grade(lab, "exercises", 1), lab, GEOMINT_CLAIM,
           "Verlet, after RK4 has made no step since");
    good(geomint_forward(lab), lab);
    expect(geomint_grade(lab, "exercises", 1), lab, GEOMINT_CLAIM, "Verlet, after RK4 misses");
    assert_non_null(strstr(geomint_answer(lab, "exercises", 1), "change: 0 61 scheme=verlet\n"));
    good(geomint_restart(lab), lab);
    expect(geomint_grade(lab, "exercises", 1), lab, GEOMINT_CLAIM, "is at t = 0");
    good(geomint_advance(lab, 62), lab);
    expect(geomint_grade(lab, "exercises", 1), lab, GEOMINT_OK, "Passed with Verlet");
    assert_non_null(strstr(geomint_answer(lab, "exercises", 1), "steps: 62\n"));
    expect(geomint_grade(lab, "exercises", 5), lab, GEOMINT_USAGE, "is a step");
    expect(geomint_grade(lab, "area", 1), lab, GEOMINT_USAGE, "is a step");
    expect(geomint_grade(lab, "/nowhere/x.tour", 1), lab, GEOMINT_FILE, "x.tour");
    expect(geomint_grade(lab, NULL, 1), lab, GEOMINT_USAGE, "tour is NULL");
    assert_null(geomint_answer(lab, "exercises", 0));
    assert_int_equal(geomint_grade(NULL, "exercises", 1), GEOMINT_MEMORY);
    geomint_close(lab);
    lab = geomint_explore(WORDS("vortices", "scheme=rk4"));
    expect(geomint_grade(lab, "exercises", 1), lab, GEOMINT_USAGE,
           "the exercise is about disc, and the answer about vortices");
    assert_null(geomint_answer(lab, "exercises", 1));
    geomint_close(lab);

    /* steps of several lengths end alike when many are made together */
    lab = geomint_explore(WORDS("kepler", "scheme=logh-kahan-li8", "eccentricity=0.9", "dt=0.1"));
    good(geomint_advance(lab, 20 * M_PI), lab);
    expect(geomint_grade(lab, "exercises", 3), lab, GEOMINT_OK, "Passed with logarithmic");
    assert_non_null(strstr(geomint_answer(lab, "exercises", 3), "steps: 623\n"));
    good(geomint_forward(lab), lab);
    expect(geomint_grade(lab, "exercises", 3), lab, GEOMINT_CLAIM, "is at t = 62.7767");
    good(geomint_back(lab), lab);
    expect(geomint_grade(lab, "exercises", 3), lab, GEOMINT_OK, "Passed with logarithmic");
    geomint_close(lab);

    /* a setting is told with the scheme that takes it, also a later one */
    lab = geomint_explore(WORDS("kepler", "scheme=dopri5", "eccentricity=0.9", "tolerance=1e-4"));
    assert_non_null(strstr(geomint_answer(lab, "exercises", 3), "tolerance="));
    good(geomint_switch(lab, 0, "verlet"), lab);
    good(geomint_restart(lab), lab);
    assert_null(strstr(geomint_answer(lab, "exercises", 3), "tolerance="));
    assert_null(strstr(geomint_commands(lab), "tolerance="));
    good(geomint_forward(lab), lab);
    good(geomint_switch(lab, 0, "dopri5"), lab);
    assert_non_null(strstr(geomint_answer(lab, "exercises", 3),
                           "change: 0 1 tolerance=0.0001\nchange: 0 1 scheme=dopri5\n"));
    assert_non_null(strstr(geomint_commands(lab), "0:1:tolerance=0.0001,0:1:scheme=dopri5"));
    good(geomint_switch(lab, 0, "verlet"), lab);
    assert_null(strstr(geomint_commands(lab), "geomint kepler scheme=verlet tolerance"));
    geomint_close(lab);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lanes_advance),      cmocka_unit_test(forks_and_switches),
        cmocka_unit_test(time_goes_back),     cmocka_unit_test(parameters_are_set),
        cmocka_unit_test(lanes_come_and_go),  cmocka_unit_test(keys_are_pressed),
        cmocka_unit_test(texts_and_failures), cmocka_unit_test(exercises_are_graded),
        cmocka_unit_test(pictures),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
