/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Steps that follow the motion: what they keep over long times beside an ordinary control of the error, in what
   phase space they are symplectic, a monitor that was typed, and where they end. dopri5 against an independent
   implementation. */
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
#include "core/model/equations.h"
#include "core/ode/user/problem.h"
#include "core/run.h"
#include "core/schemes.h"
#include "tests/common/typed.h"
#include "tests/problems/problems.h"

static const struct gm_settings settings = {0};

static struct gm_run *open_run(const struct gm_problem *problem, const char *name, double dt,
                               const double *start)
{
    const struct gm_scheme *scheme = gm_scheme_find_for(name, problem);
    assert_non_null(scheme);
    if (!gm_scheme_fits(scheme, problem)) {
        fail_msg("%s does not fit: it lacks %s", name, gm_scheme_lacks(scheme, problem));
    }
    struct gm_run *run = gm_run_open(problem, scheme, &settings, 0, dt, start);
    assert_non_null(run);
    return run;
}

/* Kepler's orbit of semi-major axis 1 from its nearest point. */
static void nearest_point(double eccentricity, double *y)
{
    y[0] = 1 - eccentricity;
    y[1] = y[2] = 0;
    y[3] = sqrt((1 + eccentricity) / (1 - eccentricity));
}

static double energy_of(const double *y)
{
    return (y[2] * y[2] + y[3] * y[3]) / 2 - 1 / hypot(y[0], y[1]);
}

/* The mean of the energy's error, with its sign, over the steps of so many periods. */
static double mean_error(struct gm_run *run, double periods)
{
    const double until = run->t + periods * 2 * M_PI;
    double sum = 0;
    long count = 0;
    while (run->t < until) {
        assert_int_equal(gm_run_advance(run, 1), GM_OK);
        sum += energy_of(gm_run_state(run)) + 0.5;
        count++;
    }
    return sum / (double)count;
}

/* The energy of a reversible or a symplectic scheme oscillates, that of an ordinary control of the error runs
   away, though its steps are as many. */
static void energy_over_a_thousand_periods(void **unused)
{
    (void)unused;
    static const struct {
        const char *scheme;
        double least, most; /* of what the mean moves by, from the first ten periods to the last */
    } lines[] = {{"error-controlled-verlet", 0.1, INFINITY},
                 {"controlled-verlet2", 0, 1e-4},
                 {"controlled-blanes-moan4", 0, 1e-6},
                 {"controlled-gauss4", 0, 1e-6},
                 {"poincare-midpoint2", 0, 1e-4},
                 {"poincare-gauss4", 0, 1e-6},
                 {"logh-kahan-li8", 0, 1e-10}};
    double start[4];
    nearest_point(0.9, start);
    for (size_t i = 0; i < GM_COUNT(lines); i++) {
        struct gm_run *run = open_run(&gm_problem_kepler, lines[i].scheme, 2 * M_PI / 200, start);
        const double first = mean_error(run, 10);
        assert_int_equal(gm_run_until(run, 990 * 2 * M_PI), GM_OK);
        const double moved = fabs(mean_error(run, 10) - first);
        if (!(moved >= lines[i].least && moved <= lines[i].most)) {
            fail_msg("%s: the mean energy moved by %.2e", lines[i].scheme, moved);
        }
        gm_run_close(run);
    }
}

enum { EXTENDED = 6 }; /* q1 q2 p1 p2 t E */

/* The map of so many steps in the phase space extended by the time and the energy E of the memory. */
static void extended_map(const char *name, const double *from, double *to)
{
    struct gm_run *run = open_run(&gm_problem_kepler, name, 0.2, from);
    double memory[3];
    memcpy(memory, gm_run_memory(run), sizeof memory);
    if (strncmp(name, "poincare", strlen("poincare")) == 0) {
        memory[0] = from[5];
    } else if (strncmp(name, "logh", strlen("logh")) == 0) {
        memory[0] = -from[5];
    }
    gm_run_set_state(run, from, memory);
    assert_int_equal(gm_run_advance(run, 5), GM_OK);
    memcpy(to, gm_run_state(run), 4 * sizeof *to);
    to[4] = from[4] + run->t;
    to[5] = from[5];
    gm_run_close(run);
}

/* The largest entry of M' J M - J, where J is that of dq dp + dt d(-E); by central differences of order 4. */
static double symplectic_defect(const char *name)
{
    static const double h = 2e-3, weights[] = {1. / 12, -8. / 12, 8. / 12, -1. / 12};
    static const int at[] = {-2, -1, 1, 2};
    double start[EXTENDED] = {0.8, 0.1, -0.2, 1.2, 0, 0}, M[EXTENDED][EXTENDED] = {{0}}, largest = 0;
    start[5] = energy_of(start) + 0.01; /* the law holds beside K = 0, too */
    for (int j = 0; j < EXTENDED; j++) {
        for (size_t k = 0; k < GM_COUNT(at); k++) {
            double from[EXTENDED], to[EXTENDED];
            memcpy(from, start, sizeof from);
            from[j] += at[k] * h;
            extended_map(name, from, to);
            for (int i = 0; i < EXTENDED; i++) {
                M[i][j] += weights[k] * to[i] / h;
            }
        }
    }
    static const int pairs[][2] = {{0, 2}, {1, 3}, {5, 4}}; /* t and -E, turned round */
    for (int i = 0; i < EXTENDED; i++) {
        for (int j = 0; j < EXTENDED; j++) {
            double sum = 0, form = 0;
            for (size_t k = 0; k < GM_COUNT(pairs); k++) {
                const int a = pairs[k][0], b = pairs[k][1];
                sum += M[a][i] * M[b][j] - M[b][i] * M[a][j];
                form += (i == a && j == b) - (i == b && j == a);
            }
            largest = fmax(largest, fabs(sum - form));
        }
    }
    return largest;
}

static void symplectic_in_the_extended_phase_space(void **unused)
{
    (void)unused;
    static const char *const symplectic[] = {
        "poincare-midpoint2", "poincare-gauss4", "poincare-gauss6", "poincare-gauss8",          "logh2",
        "logh-suzuki4",       "logh-kahan-li6",  "logh-kahan-li8",  "logh-sofroniou-spaletta10"};
    for (size_t i = 0; i < GM_COUNT(symplectic); i++) {
        const double defect = symplectic_defect(symplectic[i]);
        if (!(defect < 1e-7)) {
            fail_msg("%s: %.2e", symplectic[i], defect);
        }
    }
    /* steps of any length by a symplectic method are no symplectic map */
    assert_true(symplectic_defect("controlled-gauss4") > 1e-3);
}

/* Of a typed problem that is Kepler's: to the same place and time as the built-in one. */
static void moves_as_kepler(const char *text, const char *scheme, double dt, long steps)
{
    struct typed typed;
    type(&typed, text);
    struct gm_run *own = open_run(&typed.problem, scheme, dt, typed.start);
    struct gm_run *built_in = open_run(&gm_problem_kepler, scheme, dt, typed.start);
    assert_int_equal(gm_run_advance(own, steps), GM_OK);
    assert_int_equal(gm_run_advance(built_in, steps), GM_OK);
    assert_float_equal(own->t, built_in->t, 1e-11);
    for (size_t c = 0; c < 4; c++) {
        assert_float_equal(gm_run_state(own)[c], gm_run_state(built_in)[c], 1e-11);
    }
    gm_run_close(own);
    gm_run_close(built_in);
    untype(&typed);
}

static void a_typed_monitor(void **unused)
{
    (void)unused;
    static const char *const schemes[] = {"controlled-verlet2", "controlled-kahan-li8", "controlled-gauss4",
                                          "poincare-gauss6"};
    /* of places, where q' = p; with masses; and one that could hold momenta */
    static const char *const texts[] = {
        "coordinates: x y\nH: (p_x^2 + p_y^2)/2 - 1/r\nlet: r = sqrt(x^2 + y^2)\nmonitor: 1/r^1.5\n"
        "start: x = 0.5, y = 0, p_x = 0, p_y = sqrt(3)\n",
        "coordinates: x y\nparameter: m = 1\nH: (p_x^2 + p_y^2)/(2*m) - 1/r\nlet: r = sqrt(x^2 + y^2)\n"
        "monitor: 1/r^1.5\nstart: x = 0.5, y = 0, p_x = 0, p_y = sqrt(3)\n",
        "coordinates: x y\nparameter: k = 0\nH: (p_x^2 + p_y^2)/2 - 1/r\nlet: r = sqrt(x^2 + y^2)\n"
        "monitor: 1/r^1.5 + k*p_x^2\nstart: x = 0.5, y = 0, p_x = 0, p_y = sqrt(3)\n"};
    struct typed typed;
    for (size_t i = 0; i < GM_COUNT(schemes) * GM_COUNT(texts); i++) {
        moves_as_kepler(texts[i / GM_COUNT(schemes)], schemes[i % GM_COUNT(schemes)], 0.05, 1000);
    }
    type(&typed, "coordinates: x\nH: p_x^2/2 + x^4/4\nstart: x = 1, p_x = 0\n");
    const struct gm_scheme *scheme = gm_scheme_find_for("controlled-verlet2", &typed.problem);
    assert_false(gm_scheme_fits(scheme, &typed.problem));
    assert_string_equal(gm_scheme_lacks(scheme, &typed.problem), "a monitor, the density of steps");
    untype(&typed);
    /* a monitor that falls to 0 ends the run where it does */
    type(&typed, "coordinates: x\nH: p_x^2/2 + x^2/2\nmonitor: x - 0.5\nstart: x = 1, p_x = 0\n");
    for (size_t i = 0; i < GM_COUNT(schemes); i++) {
        struct gm_run *run = open_run(&typed.problem, schemes[i], 0.001, typed.start);
        assert_int_equal(gm_run_until(run, 100), GM_STEP_COLLAPSE);
        assert_true(run->t < acos(0.5) && run->t > 0.9);
        assert_true(gm_run_state(run)[0] > 0.5);
        gm_run_close(run);
    }
    untype(&typed);
}

/* The logarithmic Hamiltonian of whatever attracts: masses change nothing, and a place where V is not negative
   is one that no step leads to. */
static void a_typed_attraction(void **unused)
{
    (void)unused;
    static const char *const texts[] = {
        "coordinates: x y\nparameter: m = 1\nH: (p_x^2 + p_y^2)/(2*m) - 1/r\nlet: r = sqrt(x^2 + y^2)\n"
        "start: x = 0.5, y = 0, p_x = 0, p_y = sqrt(3)\n",
        "coordinates: x y\nL: (v_x^2 + v_y^2)/2 + 1/sqrt(x^2 + y^2)\n"
        "start: x = 0.5, y = 0, p_x = 0, p_y = sqrt(3)\n"};
    struct typed typed;
    for (size_t i = 0; i < GM_COUNT(texts); i++) {
        moves_as_kepler(texts[i], "logh-kahan-li6", 0.1, 500);
    }
    type(&typed, "coordinates: x\nH: p_x^2/2 + x^4/4\nstart: x = 1, p_x = 0\n");
    const struct gm_scheme *scheme = gm_scheme_find_for("logh2", &typed.problem);
    assert_false(gm_scheme_fits(scheme, &typed.problem));
    assert_string_equal(gm_scheme_lacks(scheme, &typed.problem),
                        "a potential V(q) < 0 of a Hamiltonian T(p) + V(q), T(0) = 0");
    untype(&typed);
    type(&typed, "coordinates: x\nH: p_x^2/2 - cos(x)\nstart: x = 0, p_x = 1.9\n");
    struct gm_run *run = open_run(&typed.problem, "logh-kahan-li8", 0.01, typed.start);
    assert_int_equal(gm_run_until(run, 100), GM_STEP_COLLAPSE);
    assert_true(fabs(gm_run_state(run)[0]) < M_PI / 2 && run->t < 2);
    gm_run_close(run);
    untype(&typed);
}

/* The last step is the one that reaches the time, whether steps are made together or one by one. */
static void where_they_end(void **unused)
{
    (void)unused;
    static const char *const schemes[] = {"controlled-blanes-moan-nystrom6", "error-controlled-verlet",
                                          "poincare-gauss4", "logh2"};
    double start[4];
    nearest_point(0.7, start);
    for (size_t i = 0; i < GM_COUNT(schemes); i++) {
        struct gm_run *together = open_run(&gm_problem_kepler, schemes[i], 0.05, start);
        struct gm_run *each = open_run(&gm_problem_kepler, schemes[i], 0.05, start);
        assert_int_equal(gm_run_to(together, 10, INFINITY), GM_OK);
        assert_int_equal(together->steps, 10);
        assert_int_equal(gm_run_until(together, 40), GM_OK);
        double before = 0;
        while (each->t < 40) {
            before = each->t;
            assert_int_equal(gm_run_advance(each, 1), GM_OK);
        }
        assert_true(before < 40 && together->t >= 40);
        assert_int_equal(together->steps, each->steps);
        assert_true(together->t == each->t);
        assert_memory_equal(gm_run_state(together), gm_run_state(each), 4 * sizeof(double));
        gm_run_close(together);
        gm_run_close(each);
    }
}

static struct gm_run *open_tolerant(const struct gm_problem *problem, double tolerance, double dt,
                                    const double *start)
{
    const struct gm_settings tolerant = {.tolerance = tolerance};
    struct gm_run *run = gm_run_open(problem, gm_scheme_find("dopri5"), &tolerant, 0, dt, start);
    assert_non_null(run);
    return run;
}

static void expect_near(const char *what, double value, double expected, double part)
{
    if (!(fabs(value - expected) <= part * fabs(expected))) {
        fail_msg("dopri5: %s is %.6g, expected %.6g", what, value, expected);
    }
}

/* The numbers are of another implementation in double precision. The distance of rows changes nothing. */
static void dormand_prince_on_orbits(void **unused)
{
    (void)unused;
    static const struct {
        double eccentricity, tolerance, periods, error, own_steps, evaluations;
    } lines[] = {
        {0.5, 0, 10, 1.4598e-4, 281, 2216},         {0.5, 1e-6, 100, 1.4477e-3, 2808, 22148},
        {0.5, 1e-8, 10, 3.5253e-7, 671, 4028},      {0.5, 1e-8, 100, 3.478e-6, 6695, 40172},
        {0.5, 1e-10, 100, 3.694e-8, 16895, 101372}, {0.9, 1e-8, 100, 7.128e-6, 11230, 80324},
    };
    static const int rows[] = {1, 7, 20000};
    for (size_t i = 0; i < GM_COUNT(lines); i++) {
        double start[4], ends[GM_COUNT(rows)][4];
        unsigned long evaluations = 0;
        nearest_point(lines[i].eccentricity, start);
        for (size_t k = 0; k < GM_COUNT(rows); k++) {
            struct gm_run *run = open_tolerant(&gm_problem_kepler, lines[i].tolerance,
                                               lines[i].periods * 2 * M_PI / rows[k], start);
            assert_int_equal(gm_run_advance(run, rows[k]), GM_OK);
            memcpy(ends[k], gm_run_state(run), sizeof ends[k]);
            evaluations = k == 0 ? run->evaluations : evaluations;
            assert_int_equal(run->evaluations, evaluations);
            assert_int_equal(run->evaluations, 2 + 6 * (run->own_steps + run->rejected));
            expect_near("own steps", (double)run->own_steps, lines[i].own_steps, 0.03);
            gm_run_close(run);
            assert_true(typed_apart(ends[k], ends[0], 4) < 1e-9);
        }
        expect_near("the energy error", 2 * fabs(energy_of(ends[0]) + 0.5), lines[i].error, 0.15);
        expect_near("the number of evaluations", (double)evaluations, lines[i].evaluations, 0.03);
    }
}

static void dormand_prince_between_steps(void **unused)
{
    (void)unused;
    enum { ROWS = 739 };
    struct typed typed;
    type(&typed, "coordinates: q\nH: p_q^2/2 + q^2/2\nstart: q = 1, p_q = 0\n");
    struct gm_run *run = open_tolerant(&typed.problem, 1e-8, 20. / ROWS, typed.start);
    double largest = 0;
    for (int i = 1; i < ROWS; i++) {
        assert_int_equal(gm_run_advance(run, 1), GM_OK);
        largest = fmax(largest, fabs(gm_run_state(run)[0] - cos(run->t)));
        largest = fmax(largest, fabs(gm_run_state(run)[1] + sin(run->t)));
    }
    expect_near("the largest error between steps", largest, 8e-8, 0.15);
    gm_run_close(run);
    untype(&typed);
    type(&typed, "rate: x = y\nrate: y = 5*(1 - x^2)*y - x\nstart: x = 2, y = 0\n");
    run = open_tolerant(&typed.problem, 1e-9, 0.1, typed.start);
    assert_int_equal(gm_run_advance(run, 200), GM_OK);
    assert_true(fabs(gm_run_state(run)[0] + 1.6012969) < 2e-6);
    assert_true(fabs(gm_run_state(run)[1] - 0.1983267) < 2e-6);
    gm_run_close(run);
    untype(&typed);
}

/* Another dt continues with the same own steps; another state, or the other direction, starts anew. */
static void dormand_prince_goes_on(void **unused)
{
    (void)unused;
    double start[4];
    nearest_point(0.5, start);
    struct gm_run *run = open_tolerant(&gm_problem_kepler, 1e-9, 0.125, start);
    struct gm_run *whole = open_tolerant(&gm_problem_kepler, 1e-9, 0.125, start);
    gm_run_advance(run, 80);
    gm_run_set_step(run, 0.0625);
    gm_run_advance(run, 160);
    gm_run_advance(whole, 160);
    assert_true(run->t == whole->t && run->evaluations == whole->evaluations);
    assert_memory_equal(gm_run_state(run), gm_run_state(whole), sizeof start);
    gm_run_set_step(run, -0.5);
    assert_int_equal(gm_run_advance(run, 40), GM_OK);
    assert_true(run->t == 0);
    assert_true(typed_apart(gm_run_state(run), start, 4) < 1e-5);
    gm_run_set_state(whole, start, NULL);
    const unsigned long before = whole->own_steps;
    assert_int_equal(gm_run_advance(whole, 1), GM_OK);
    struct gm_run *fresh = open_tolerant(&gm_problem_kepler, 1e-9, 0.125, start);
    assert_int_equal(gm_run_advance(fresh, 1), GM_OK);
    assert_int_equal(whole->own_steps - before, fresh->own_steps);
    assert_true(typed_apart(gm_run_state(whole), gm_run_state(fresh), 4) < 1e-12);
    gm_run_close(run);
    gm_run_close(whole);
    gm_run_close(fresh);
}

static void dormand_prince_fails(void **unused)
{
    (void)unused;
    static const struct {
        const char *text;
        double dt, least, most; /* between these times the run ends */
        enum gm_status status;
    } lines[] = {
        {"rate: x = x^2\nstart: x = 1\n", 0.01, 0.98, 1, GM_BLOW_UP},
        {"rate: x = 1/x\nstart: x = 1\n", -0.01, -0.5, -0.48, GM_STEP_TOO_SMALL},
        {"rate: x = sqrt(x) - 1\nstart: x = 0\n", 0.01, 0, 0, GM_STEP_TOO_SMALL},
    };
    for (size_t i = 0; i < GM_COUNT(lines); i++) {
        struct typed typed;
        type(&typed, lines[i].text);
        for (int rows = 1; rows <= 1000; rows *= 1000) {
            struct gm_run *run = open_tolerant(&typed.problem, 0, lines[i].dt, typed.start);
            while (run->status == GM_OK && run->steps < 1000) {
                gm_run_advance(run, rows);
            }
            if (run->status != lines[i].status || !(run->t >= lines[i].least && run->t <= lines[i].most)) {
                fail_msg("%s: %s at t = %g", lines[i].text, gm_status_name(run->status), run->t);
            }
            assert_true(isfinite(gm_run_state(run)[0]));
            gm_run_close(run);
        }
        untype(&typed);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(energy_over_a_thousand_periods),
        cmocka_unit_test(symplectic_in_the_extended_phase_space),
        cmocka_unit_test(a_typed_monitor),
        cmocka_unit_test(a_typed_attraction),
        cmocka_unit_test(where_they_end),
        cmocka_unit_test(dormand_prince_on_orbits),
        cmocka_unit_test(dormand_prince_between_steps),
        cmocka_unit_test(dormand_prince_goes_on),
        cmocka_unit_test(dormand_prince_fails),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
