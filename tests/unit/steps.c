/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Steps that follow the motion: what they keep over long times beside an ordinary control of the error, in what
   phase space they are symplectic, a monitor that was typed, and where they end. */
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(energy_over_a_thousand_periods),
        cmocka_unit_test(symplectic_in_the_extended_phase_space),
        cmocka_unit_test(a_typed_monitor),
        cmocka_unit_test(a_typed_attraction),
        cmocka_unit_test(where_they_end),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
