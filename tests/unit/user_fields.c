/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Waves in a potential that somebody wrote: the built-in equation typed again gives its numbers, phi^4 those
   of steps that are written here once more, the quotient of V does not cancel, and what is refused. */
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
#include "core/field/families/laws/laws.h"
#include "core/field/families/two_step.h"
#include "core/field/multisymplectic.h"
#include "core/field/problems/problems.h"
#include "core/field/user/potential.h"
#include "core/model/equations.h"
#include "core/model/recognition.h"
#include "core/ode/user/evolution.h"
#include "core/run.h"
#include "core/schemes.h"
#include "core/theory/certify.h"
#include "tests/common/dispersive_solitons.h"
#include "tests/common/lane.h"
#include "tests/common/sine_gordon.h"

enum { POINTS = 200, SIZE = 2 * POINTS + 1 };
#define HALF 20.0

static const struct gm_settings no_settings;
static const char *const all[] = {"leapfrog",  "energy-conserving", "box",
                                  "euler-box", "midpoint-box",      "gauss-box3"};

struct typed {
    struct gm_user_system system;
    struct gm_user_wave wave;
    struct gm_problem problem;
};

static void open_typed(struct typed *typed, const char *text)
{
    struct gm_fault fault;
    if (!gm_equations_open(&typed->system, text, strlen(text), NULL, 0, &fault)) {
        fail_msg("%s: %s", text, fault.sentence);
    }
    assert_true(gm_user_wave_derive(&typed->wave, &typed->system));
    double *values = gm_equations_start(&typed->system, NULL);
    const struct gm_grid1 ring = {POINTS, 2 * HALF / POINTS, -HALF, 0, false};
    assert_true(gm_user_wave_open(&typed->problem, &typed->wave, values, &ring));
    free(values);
}

static void close_typed(struct typed *typed)
{
    gm_user_line_close(&typed->problem);
    gm_system_close(&typed->system);
}

/* The state after so many steps, and the residual of the multisymplectic law there, where that is asked
   for. */
static void advance(const struct gm_problem *problem, const char *name, double dt, long steps, double *y,
                    double *residual)
{
    const struct gm_scheme *scheme = gm_scheme_find_for(name, problem);
    struct gm_run *run = gm_run_open(problem, scheme, &no_settings, 0, dt, y);
    assert_non_null(run);
    assert_int_equal(gm_run_advance(run, steps), GM_OK);
    memcpy(y, gm_run_state(run), SIZE * sizeof *y);
    if (residual) {
        *residual = gm_form_residual(
            (struct gm_law){problem, scheme, dt, y, gm_run_memory(run), .by_differences = false});
    }
    gm_run_close(run);
}

static double distance(const double *a, const double *b)
{
    double largest = 0;
    for (size_t i = 0; i < SIZE; i++) {
        largest = fmax(largest, fabs(a[i] - b[i]));
    }
    return largest;
}

/* A kink, too, which is 2 pi higher at the other end. */
static void typed_again_it_is_the_built_in_equation(void **unused)
{
    (void)unused;
    static const char *const texts[] = {
        "field: u\nV: 1 - cos(u)\nlet: g = sqrt(1 - 1/4)\nstart: u = 0, u_t = 4*g/cosh(g*x)\n"
        "exact: u = 4*atan(g*sin(t/2)/(cosh(g*x)/2))\n",
        "field: phi\nV: 2*sin(phi/2)^2\nparameter: c = 0.9\nlet: g = 1/sqrt(1 - c^2)\n"
        "start: phi = 4*atan(exp(g*x)), phi_t = -2*c*g/cosh(g*x)\n"
        "exact: phi = 4*atan(exp(g*(x - c*t)))\n"};
    static const struct gm_sine_gordon exact[] = {{.initial = GM_BREATHER, .frequency = 0.5},
                                                  {.initial = GM_KINK, .velocity = 0.9}};
    for (size_t which = 0; which < 2; which++) {
        struct typed typed;
        open_typed(&typed, texts[which]);
        struct gm_problem built_in = gm_problem_sine_gordon;
        built_in.parameters = &exact[which];
        typed.problem.line.jump = gm_sine_gordon_jump(&exact[which]);
        built_in.line = typed.problem.line;
        built_in.n = SIZE;
        for (size_t s = 0; s < GM_COUNT(all); s++) {
            const double dt = strcmp(all[s], "midpoint-box") == 0 ? 0.05 : 0.1;
            double ours[SIZE], theirs[SIZE];
            gm_user_line_levels(typed.problem.parameters, &typed.problem.line, dt, ours);
            gm_sine_gordon_levels(&built_in, 0, dt, theirs);
            assert_true(distance(ours, theirs) < 1e-13);
            advance(&typed.problem, all[s], dt, 60, ours, NULL);
            advance(&built_in, all[s], dt, 60, theirs, NULL);
            if (!(distance(ours, theirs) <= 1e-12)) {
                fail_msg("%s, %zu: %.2e", all[s], which, distance(ours, theirs));
            }
        }
        close_typed(&typed);
    }
}

/* The built-in file is the solutions that are written by hand: its start, its error, and when none is known. */
static void the_scene_has_the_known_solutions(void **unused)
{
    (void)unused;
    static const struct {
        const char *words;
        struct gm_sine_gordon solution;
    } cases[] = {
        {"frequency=0.3", {.initial = GM_BREATHER, .frequency = 0.3}},
        {"frequency=0.9 half_length=15", {.initial = GM_BREATHER, .frequency = 0.9}},
        {"initial=kink velocity=-0.7", {.initial = GM_KINK, .velocity = -0.7, .position = -5}},
        {"initial=antikink position=3", {.initial = GM_ANTIKINK, .velocity = 0.5, .position = 3}},
        {"initial=kink half_length=4", {.initial = GM_KINK, .velocity = 0.5, .position = -5}},
        {"initial=kink-antikink velocity=0.8", {.initial = GM_KINK_ANTIKINK, .velocity = 0.8}},
        {"initial=kink-antikink velocity=0", {.initial = GM_KINK_ANTIKINK}},
        {"initial=kink-antikink velocity=0.3 half_length=8", {.initial = GM_KINK_ANTIKINK, .velocity = 0.3}},
        {"initial=antikink-kink", {.initial = GM_KINK_COLLISION, .velocity = 0.5, .position = -5}},
        {"initial=antikink-kink position=12",
         {.initial = GM_KINK_COLLISION, .velocity = 0.5, .position = 12}},
    };
    static const double times[] = {0, 1, 30, 90};
    for (size_t i = 0; i < GM_COUNT(cases); i++) {
        char words[200];
        double levels[SIZE];
        snprintf(words, sizeof words, "sine-gordon scheme=box points=%d dt=0.1 %s", POINTS, cases[i].words);
        struct gm_lane *lane = test_lane(words);
        struct gm_problem problem = lane->problem;
        const double half_length = problem.line.dx * POINTS / 2;
        problem.parameters = &cases[i].solution;
        gm_sine_gordon_levels(&problem, 0, 0.1, levels);
        if (!(distance(gm_lane_view(lane).state, levels) < 1e-13)) {
            fail_msg("%s starts %.3g away", words, distance(gm_lane_view(lane).state, levels));
        }
        for (size_t k = 0; k < GM_COUNT(times); k++) {
            assert_int_equal(gm_run_until(lane->run, times[k]), GM_OK);
            const double t = lane->run->t, *u = gm_lane_view(lane).state;
            double largest = 0;
            gm_sine_gordon_levels(&problem, t, 0.1, levels);
            for (size_t j = 0; j < POINTS; j++) {
                largest = fmax(largest, fabs(u[j] - levels[j]));
            }
            const double error = test_observed(lane, "solution_error");
            const bool known = gm_sine_gordon_is_known(&cases[i].solution, half_length, t);
            if (known != !isnan(error) || (known && !(fabs(error - largest) < 1e-12))) {
                fail_msg("%s at t = %g: %.3g, not %.3g", words, t, error, known ? largest : NAN);
            }
        }
        gm_lane_close(lane);
    }
}

/* The built-in file of Korteweg and de Vries' equation, too, from a moving frame and with the cosine's Euler step. */
static void the_korteweg_scene_has_the_known_solutions(void **unused)
{
    (void)unused;
    static const struct {
        const char *words;
        struct kdv_solution solution;
    } cases[] = {
        {"initial=soliton", {{.eta = 1, .mu = 1}, KDV_SOLITON, 1, -5}},
        {"initial=soliton eta=1.5 mu=0.7 velocity=0.8 position=2 lambda=1.2 frame=fixed",
         {{.eta = 1.5, .mu = 0.7, .framed.lambda = 1.2}, KDV_SOLITON, 0.8, 2}},
        {"initial=soliton half_length=3", {{.eta = 1, .mu = 1}, KDV_SOLITON, 1, -5}},
        {"dt=0.05", {{.eta = 1, .mu = 1}, KDV_TWO, 1, -5}},
        {"eta=2 mu=0.5 half_length=40 lambda=-0.5",
         {{.eta = 2, .mu = 0.5, .framed.lambda = -0.5}, KDV_TWO, 1, -5}},
        {"initial=cosine", {{.eta = 1, .mu = 0.022 * 0.022}, KDV_COSINE, 1, -5}},
        {"initial=cosine lambda=0.3 mu=1e-3",
         {{.eta = 1, .mu = 1e-3, .framed.lambda = 0.3}, KDV_COSINE, 1, -5}},
    };
    for (size_t i = 0; i < GM_COUNT(cases); i++) {
        char words[200];
        double levels[SIZE];
        const struct kdv_solution *solution = &cases[i].solution;
        snprintf(words, sizeof words, "kdv scheme=box points=%d %s", POINTS, cases[i].words);
        struct gm_lane *lane = test_lane(words);
        struct gm_problem problem = lane->problem;
        problem.parameters = solution;
        kdv_levels(&problem, lane->run->dt, levels);
        if (!(distance(gm_lane_view(lane).state, levels) < 1e-12)) {
            fail_msg("%s starts %.3g away", words, distance(gm_lane_view(lane).state, levels));
        }
        assert_int_equal(gm_run_advance(lane->run, 20), GM_OK);
        const double t = lane->run->t, *u = gm_lane_view(lane).state;
        double largest = 0;
        for (size_t j = 0; j < POINTS; j++) {
            const double x = gm_grid1_node(&problem.line, j);
            largest = fmax(largest, fabs(u[j] - kdv_exact(solution, &problem.line, x, t)));
        }
        const double error = test_observed(lane, "solution_error");
        const bool known = kdv_is_known(solution, &problem.line, t);
        if (known != !isnan(error) || (known && !(fabs(error - largest) < 1e-11))) {
            fail_msg("%s at t = %g: %.3g, not %.3g", words, t, error, known ? largest : NAN);
        }
        gm_lane_close(lane);
    }
}

/* The built-in file of Schroedinger's equation, too: its start, its errors, and when no solution is known. */
static void the_schroedinger_scene_has_the_known_solitons(void **unused)
{
    (void)unused;
    static const struct {
        const char *words;
        struct bright solution;
        bool known; /* after the start */
    } cases[] = {
        {"initial=soliton", {1, 1, -5, false}, true},
        {"initial=soliton amplitude=0.7 velocity=-2 position=3", {0.7, -2, 3, false}, true},
        {"initial=soliton half_length=6", {1, 1, -5, false}, false},
        {"initial=collision velocity=0.5", {1, 0.5, -5, true}, false},
    };
    for (size_t i = 0; i < GM_COUNT(cases); i++) {
        char words[200];
        double exact[2 * POINTS];
        snprintf(words, sizeof words, "nls scheme=box points=%d dt=0.02 %s", POINTS, cases[i].words);
        struct gm_lane *lane = test_lane(words);
        for (int k = 0; k < 2; k++) {
            assert_int_equal(gm_run_until(lane->run, 2.0 * k), GM_OK);
            const double *y = gm_lane_view(lane).state;
            double largest = 0, of_modulus = 0;
            bright_state(&cases[i].solution, &lane->problem.line, lane->run->t, exact);
            for (size_t j = 0; j < POINTS; j++) {
                const double re = exact[j], im = exact[POINTS + j];
                largest = fmax(largest, hypot(y[j] - re, y[POINTS + j] - im));
                of_modulus = fmax(of_modulus, fabs(hypot(y[j], y[POINTS + j]) - hypot(re, im)));
            }
            const double errors[] = {test_observed(lane, "solution_error"),
                                     test_observed(lane, "modulus_error")};
            assert_true(k > 0 || largest < 1e-13);
            assert_true(cases[i].known || k == 0 || (isnan(errors[0]) && isnan(errors[1])));
            if ((cases[i].known || k == 0) &&
                !(fabs(errors[0] - largest) < 1e-12 && fabs(errors[1] - of_modulus) < 1e-12)) {
                fail_msg("%s: %.3g, %.3g, not %.3g, %.3g", words, errors[0], errors[1], largest, of_modulus);
            }
        }
        gm_lane_close(lane);
    }
}

#define PHI4 "field: u\nV: (u^2 - 1)^2/4\nstart: u = 1 + exp(-x^2)/2, u_t = x*exp(-x^2)\n"

/* u + d u at the start and behind one step, of phi^4: Taylor's formula with derivatives by hand. */
static double phi4_start(double x, double t)
{
    const double e = exp(-x * x), u = 1 + e / 2, v = x * e;
    const double bend = (2 * x * x - 1) * e, bend_v = (4 * x * x * x - 6 * x) * e;
    const double u2 = bend - (u * u * u - u), u3 = bend_v - (3 * u * u - 1) * v;
    return u + t * (v + t / 2 * (u2 + t / 3 * u3));
}

/* Leapfrog and the energy-conserving scheme once more: the quotient of V is (a + b) (a^2 + b^2 - 2) / 4. */
static void phi4_moves_as_written_by_hand(void **unused)
{
    (void)unused;
    struct typed typed;
    open_typed(&typed, PHI4);
    const double dt = 0.05, dx = 2 * HALF / POINTS;
    for (int conserving = 0; conserving < 2; conserving++) {
        double y[SIZE], past[POINTS], now[POINTS], next[POINTS];
        gm_user_line_levels(typed.problem.parameters, &typed.problem.line, dt, y);
        for (size_t i = 0; i < POINTS; i++) {
            const double x = -HALF + (double)i * dx;
            past[i] = phi4_start(x, 0);
            now[i] = y[POINTS + i];
            assert_true(fabs(y[i] - past[i]) < 1e-14 && fabs(now[i] - phi4_start(x, dt)) < 2e-5);
        }
        for (int step = 1; step < 100; step++) {
            for (size_t i = 0; i < POINTS; i++) {
                const double bend =
                    (now[(i + 1) % POINTS] - 2 * now[i] + now[(i + POINTS - 1) % POINTS]) / (dx * dx);
                const double b = past[i], force = now[i] * now[i] * now[i] - now[i];
                double a = 2 * now[i] - b + dt * dt * (bend - force);
                for (int k = 0; conserving && k < 60; k++) {
                    a = 2 * now[i] - b + dt * dt * (bend - (a + b) * (a * a + b * b - 2) / 4);
                }
                next[i] = a;
            }
            memcpy(past, now, sizeof now);
            memcpy(now, next, sizeof now);
        }
        advance(&typed.problem, conserving ? "energy-conserving" : "leapfrog", dt, 100, y, NULL);
        double error = 0;
        for (size_t i = 0; i < POINTS; i++) {
            error = fmax(error, fabs(y[i] - now[i]));
        }
        if (!(error < 1e-12)) {
            fail_msg("%s: %.2e", conserving ? "energy-conserving" : "leapfrog", error);
        }
    }
    close_typed(&typed);
}

#define DOUBLE "field: u\nV: 1 - cos(u) + 0.7*(1 - cos(u/2))\nstart: u = 3*exp(-x^2), u_t = x*exp(-x^2)\n"

/* sin x / x */
static double sinc(double x)
{
    return fabs(x) < 1e-4 ? 1 - x * x / 6 : sin(x) / x;
}

static double double_force(double u)
{
    return sin(u) + 0.35 * sin(u / 2);
}

/* [V(a) - V(b)] / (a - b), by the formula for differences of cosines */
static double double_quotient(double a, double b)
{
    return sin((a + b) / 2) * sinc((a - b) / 2) + 0.35 * sin((a + b) / 4) * sinc((a - b) / 4);
}

/* The force of the box at a node: that of the four cells around it. */
static double force_of_cells(const double *now, const double *other, size_t i)
{
    const size_t r = (i + 1) % POINTS, l = (i + POINTS - 1) % POINTS;
    return double_force((now[i] + now[r] + other[i] + other[r]) / 4) +
           double_force((now[i] + now[l] + other[i] + other[l]) / 4);
}

/* The next level by each scheme, as it is written, and iterated; the box by Jacobi's method. */
static void double_step(const char *name, double dt, const double *past, const double *now, double *next)
{
    const double dx = 2 * HALF / POINTS, in_time = 1 / (4 * dt * dt), in_space = 1 / (4 * dx * dx);
    const bool box = strcmp(name, "box") == 0, conserving = strcmp(name, "energy-conserving") == 0;
    double made[POINTS];
    for (size_t i = 0; i < POINTS; i++) {
        next[i] = 2 * now[i] - past[i];
    }
    for (int k = 0; k < (box ? 400 : 60); k++) {
        for (size_t i = 0; i < POINTS; i++) {
            const size_t r = (i + 1) % POINTS, l = (i + POINTS - 1) % POINTS;
            const double bend = (now[r] - 2 * now[i] + now[l]) / (dx * dx);
            if (!box) {
                const double force = conserving ? double_quotient(next[i], past[i]) : double_force(now[i]);
                made[i] = 2 * now[i] - past[i] + dt * dt * (bend - force);
                continue;
            }
            const double of_now = 2 * in_time * (now[r] + 2 * now[i] + now[l]) +
                                  2 * in_space * (now[r] - 2 * now[i] + now[l]),
                         of_past = in_space * (past[r] - 2 * past[i] + past[l]) -
                                   in_time * (past[r] + 2 * past[i] + past[l]),
                         force = (force_of_cells(now, next, i) + force_of_cells(now, past, i)) / 4;
            made[i] = (of_now + of_past - force - (in_time - in_space) * (next[r] + next[l])) /
                      (2 * (in_time + in_space));
        }
        memcpy(next, made, sizeof made);
    }
}

static void double_sine_gordon_moves_as_written_by_hand(void **unused)
{
    (void)unused;
    static const char *const names[] = {"leapfrog", "energy-conserving", "box"};
    struct typed typed;
    open_typed(&typed, DOUBLE);
    for (size_t s = 0; s < GM_COUNT(names); s++) {
        double y[SIZE], past[POINTS], now[POINTS], next[POINTS], error = 0;
        gm_user_line_levels(typed.problem.parameters, &typed.problem.line, 0.05, y);
        memcpy(past, y, sizeof past);
        memcpy(now, y + POINTS, sizeof now);
        for (int step = 1; step < 60; step++) {
            double_step(names[s], 0.05, past, now, next);
            memcpy(past, now, sizeof now);
            memcpy(now, next, sizeof now);
        }
        advance(&typed.problem, names[s], 0.05, 60, y, NULL);
        for (size_t i = 0; i < POINTS; i++) {
            error = fmax(error, fabs(y[i] - now[i]));
        }
        if (!(error < 1e-12)) {
            fail_msg("%s: %.2e", names[s], error);
        }
    }
    close_typed(&typed);
}

/* Every scheme that claims the law keeps it; the one that does not is the control. */
static void the_multisymplectic_law_holds(void **unused)
{
    (void)unused;
    struct typed typed;
    open_typed(&typed, PHI4);
    for (size_t s = 0; s < GM_COUNT(all); s++) {
        const struct gm_scheme *scheme = gm_scheme_find_for(all[s], &typed.problem);
        double y[SIZE];
        gm_user_line_levels(typed.problem.parameters, &typed.problem.line, 0.05, y);
        double residual;
        advance(&typed.problem, all[s], 0.05, 20, y, &residual);
        const bool claims = scheme->claims & GM_MULTISYMPLECTIC;
        if (!(claims ? residual < 1e-8 : residual > 1e-6)) {
            fail_msg("%s: %.2e", all[s], residual);
        }
    }
    close_typed(&typed);
}

struct quotient {
    double value, slope;
};

static struct quotient quotient_of(const struct gm_problem *problem, double a, double b)
{
    struct quotient of;
    gm_field_of(problem)->wave->quotients(problem, &a, &b, &of.value, &of.slope, 1);
    return of;
}

/* exp: the quotient is exp(b) expm1(a - b) / (a - b), however near the two are, or far; its derivative
   too. */
static void the_quotient_does_not_cancel(void **unused)
{
    (void)unused;
    struct typed typed;
    open_typed(&typed, "field: u\nV: exp(u)\nstart: u = 0, u_t = 0\n");
    static const double gaps[] = {1e-14, 1e-9, 1e-5, 1e-2, 0.3, 2, 9, 40};
    for (size_t i = 0; i < GM_COUNT(gaps); i++) {
        const double b = 0.25, a = b + gaps[i], h = a - b, exact = exp(b) * expm1(h) / h;
        const double found = quotient_of(&typed.problem, a, b).value;
        if (!(fabs(found - exact) <= 2e-14 * exact) || found != quotient_of(&typed.problem, b, a).value) {
            fail_msg("gap %g: %.17g, not %.17g", h, found, exact);
        }
        /* [exp(a) - q] / h; where that cancels q is exp(b) (1 + h/2 + ..) */
        const double slope = h > 1e-2 ? (exp(a) - exact) / h : exp(b) * (0.5 + h / 3 + h * h / 8);
        if (h <= 2 && !(fabs(quotient_of(&typed.problem, a, b).slope - slope) <= 1e-6 * slope)) {
            fail_msg("gap %g: slope %.17g, not %.17g", h, quotient_of(&typed.problem, a, b).slope, slope);
        }
    }
    close_typed(&typed);
}

/* Sums of powers: a^n - b^n over a - b is the sum of a^k b^(n-1-k). V' of degree 11 is the last that six points are
   exact for; beyond it, and where V is no polynomial, pieces are halved. */
static void the_quotient_of_powers_is_exact(void **unused)
{
    (void)unused;
    static const struct {
        const char *text;
        int power;
    } rows[] = {
        {"V: u^3", 3},   {"V: (u^2)^2*u/1", 5}, {"V: u^12", 12},         {"V: u^6*u^7", 13},
        {"V: u^16", 16}, {"V: u^5/u^2", 3},     {"V: exp(4*log(u))", 4}, {"V: u^12 + cos(u) - cos(u)", 12}};
    static const double pairs[][2] = {{0.2, 1.9}, {1.1, 1.1000001}, {0.5, 3}};
    for (size_t i = 0; i < GM_COUNT(rows); i++) {
        struct typed typed;
        char text[128];
        snprintf(text, sizeof text, "field: u\n%s\nstart: u = 1, u_t = 0\n", rows[i].text);
        open_typed(&typed, text);
        for (size_t k = 0; k < GM_COUNT(pairs); k++) {
            const double a = pairs[k][0], b = pairs[k][1];
            double exact = 0;
            for (int j = 0; j < rows[i].power; j++) {
                exact += pow(a, j) * pow(b, rows[i].power - 1 - j);
            }
            const double found = quotient_of(&typed.problem, a, b).value;
            if (!(fabs(found - exact) <= 2e-14 * exact)) {
                fail_msg("%s, %g to %g: %.17g, not %.17g", rows[i].text, a, b, found, exact);
            }
        }
        close_typed(&typed);
    }
}

/* The energy is that of V as it is written: phi^4's of a field at rest in its vacuum is none. */
static void the_energy_is_of_the_potential_as_written(void **unused)
{
    (void)unused;
    static const struct {
        const char *text;
        double density;
    } rows[] = {{"field: u\nV: (u^2 - 1)^2/4\nstart: u = -1, u_t = 0\n", 0},
                {"field: u\nV: (u^2 - 1)^2/4 + 3\nstart: u = -1, u_t = 0\n", 3},
                {"field: u\nV: 1 - cos(u)\nstart: u = 0, u_t = 0\n", 0},
                {"field: u\nV: 2 - cos(u)\nstart: u = 0, u_t = 0\n", 1}};
    for (size_t i = 0; i < GM_COUNT(rows); i++) {
        struct typed typed;
        double y[SIZE];
        open_typed(&typed, rows[i].text);
        gm_user_line_levels(typed.problem.parameters, &typed.problem.line, 0.05, y);
        const double energy = rows[i].density * 2 * HALF;
        assert_true(fabs(gm_wave_energy(&typed.problem, y) - energy) < 1e-12);
        assert_true(fabs(gm_wave_cell_energy(&typed.problem, y) - energy) < 1e-12);
        close_typed(&typed);
    }
}

/* Near a vacuum V' is rounding, and the quotient of V(a) - V(b) would be noise over nothing: with x = a - 1,
   y = b - 1 it is (2 + x + y) (2 x + 2 y + x^2 + y^2) / 4 for phi^4. */
static void the_quotient_holds_at_rest(void **unused)
{
    (void)unused;
    struct typed typed;
    open_typed(&typed, PHI4);
    for (int k = 1; k < 400; k++) {
        const double a = 1 + 1e-10 * k * k, b = a + 3e-15 * k, x = a - 1, y = b - 1;
        const double exact = (2 + x + y) * (2 * x + 2 * y + x * x + y * y) / 4,
                     found = quotient_of(&typed.problem, a, b).value;
        if (!(fabs(found - exact) <= 1e-15)) {
            fail_msg("%g and %g from 1: %.17g, not %.17g", x, y, found, exact);
        }
    }
    close_typed(&typed);
}

/* A wave exp(i (k x - w t)) of a linear equation turns as its formula says: with waves through the nodes w is that
   of the equation, with differences that of the grid; the mass divides it. Exponential steps make no error. */
static void a_linear_wave_turns_as_by_hand(void **unused)
{
    (void)unused;
    static const char text[] = "field: u\nrate: u = -2*u_x - u_xxx\nmass: u - u_xx\nstart: u = cos(3*x)\n";
    enum { NODES = 32 };
    const struct gm_grid1 line = {.points = NODES, .dx = 2 * M_PI / NODES, .first = -M_PI};
    const double k = 3, dx = line.dx, first = sin(k * dx) / dx, second = 2 * (1 - cos(k * dx)) / (dx * dx);
    const double frequencies[] = {(2 * first - first * second) / (1 + second),
                                  (2 * k - k * k * k) / (1 + k * k)};
    for (int space = 0; space < 2; space++) {
        struct gm_user_system system;
        struct gm_user_evolution evolution;
        struct gm_problem problem;
        struct gm_fault fault;
        assert_true(gm_equations_open(&system, text, strlen(text), NULL, 0, &fault));
        assert_true(gm_user_evolution_derive(&evolution, &system));
        double *values = gm_equations_start(&system, NULL), y[NODES];
        assert_true(gm_user_evolution_open(&problem, &evolution, values, &line, (enum gm_derivatives)space));
        assert_true(gm_user_evolution_closes(&problem, &fault));
        gm_user_evolution_start(&problem, y);
        struct gm_run *run =
            gm_run_open(&problem, gm_scheme_find_for("etdrk4", &problem), &no_settings, 0, 0.5, y);
        assert_int_equal(gm_run_advance(run, 20), GM_OK);
        for (size_t i = 0; i < NODES; i++) {
            const double exact = cos(k * gm_grid1_node(&line, i) - frequencies[space] * 10);
            assert_true(fabs(gm_run_state(run)[i] - exact) < 1e-12);
        }
        gm_run_close(run);
        free(values);
        gm_user_line_close(&problem);
        gm_system_close(&system);
    }
}

/* Where the highest wave is after a time: of the parabola through the highest node and its neighbours. */
static double crest_of(const struct gm_grid1 *line, const double *u)
{
    const size_t n = line->points;
    size_t top = 0;
    for (size_t i = 1; i < n; i++) {
        top = u[i] > u[top] ? i : top;
    }
    const double left = u[(top + n - 1) % n], right = u[(top + 1) % n];
    return gm_grid1_node(line, top) + line->dx * (left - right) / (2 * (left - 2 * u[top] + right));
}

/* A peakon of height c moves with c: the error of its velocity falls nearly by half with every halved distance of
   nodes, since it has a corner. */
static void a_peakon_moves_as_fast_as_it_is_high(void **unused)
{
    (void)unused;
    static const char text[] = "field: u\nmass: u - u_xx\nrate: u = -3*u*u_x + 2*u_x*u_xx + u*u_xxx\n"
                               "start: u = cosh(10 - mod(x + 5, 20))/cosh(10)\n";
    double error[2];
    for (size_t k = 0; k < GM_COUNT(error); k++) {
        const size_t points = 500u << k;
        const struct gm_grid1 line = {.points = points, .dx = 20 / (double)points, .first = -10};
        struct gm_user_system system;
        struct gm_user_evolution evolution;
        struct gm_problem problem;
        struct gm_fault fault;
        assert_true(gm_equations_open(&system, text, strlen(text), NULL, 0, &fault));
        assert_true(gm_user_evolution_derive(&evolution, &system));
        double *values = gm_equations_start(&system, NULL), *y = malloc(points * sizeof *y);
        assert_true(gm_user_evolution_open(&problem, &evolution, values, &line, GM_SPACE_DIFFERENCES));
        gm_user_evolution_start(&problem, y);
        struct gm_run *run =
            gm_run_open(&problem, gm_scheme_find_for("rk4", &problem), &no_settings, 0, 0.01, y);
        assert_int_equal(gm_run_until(run, 4), GM_OK);
        error[k] = fabs((crest_of(&line, gm_run_state(run)) + 5) / 4 - 1);
        gm_run_close(run);
        free(y);
        free(values);
        gm_user_line_close(&problem);
        gm_system_close(&system);
    }
    if (!(error[1] < 0.02 && error[0] > 1.7 * error[1] && error[0] < 2.3 * error[1])) {
        fail_msg("the velocity errs by %.4f, and by %.4f on the finer grid", error[0], error[1]);
    }
}

#define FIELD "field: u\nstart: u = cos(pi*x/20), u_t = 0\n"
static const struct {
    const char *text, *sentence;
} refused[] = {
    {"field: u\nstart: u = 0, u_t = 0\n", "a field needs V"},
    {"field: u v\nrate: u = v\nstart: u = 0, v = 0\n", "there is no rate of v"},
    {"field: u\nrate: u = t*u\nstart: u = 0\n", "the rate of a field does not hold t"},
    {"field: u\nrate: u = u_x\nmass: u^2\nstart: u = 0\n", "a mass is linear in u"},
    {"field: u v\nrate: u = v, v = u\nmass: u - v_xx\nstart: u = 0, v = 0\n", "a mass is of one of"},
    {"field: u\nrate: u = u_x\nmass: u\nmass: u - u_xx\nstart: u = 0\n", "the mass of u is given twice"},
    {"field: u\nrate: u = u_x\nspace: spline\nstart: u = 0\n", "space is differences or fourier"},
    {"field: u\nrate: u = u_x\njump: 1\nstart: u = 0\n", "has no line \"jump\""},
    {"V: u^2\n", "which a line \"field\" names"},
    {"field: u v\nV: u^2\n", "a field has one name"},
    {FIELD "V: abs(u)\n", "V has to be smooth, and abs is not"},
    {FIELD "V: max(u, 0)^2\n", "V has to be smooth, and max is not"},
    {FIELD "V: mod(u, 2)\n", "V has to be smooth, and mod is not"},
    {FIELD "V: u^2*x\n", "V does not hold x"},
    {FIELD "V: u*t\n", "V does not hold t"},
    {FIELD "V: u_x^2\n", "V does not hold u_x"},
    {FIELD "V: u^2\nH: u\n", "a system with a field has no line \"H\""},
    {FIELD "V: u^2\nmembers: 3\n", "a system with a field has no line \"members\""},
    {FIELD "V: u^2\npoints: 2\n", "points is 2, and has to be a whole number from 3 to 1e7"},
    {FIELD "V: u^2\npoints: 12.5\n", "has to be a whole number"},
    {FIELD "V: u^2\nhalf_length: -1\n", "half_length is -1, and has to be"},
    {FIELD "V: u^2\nexact: u = u\n", "does not hold u"},
    {FIELD "V: u^2\nexact-while: 1\n", "a sentence was expected: exact-while: F"},
    {FIELD "V: u^2\ncolours: 1\n", "colours: are two values, as in colours: -1, 1"},
    {FIELD "V: u^2\nends: 1, 2, 3\n", "ends: are two values, as in ends: -1, 1"},
    {FIELD "V: u^2\nends: 0, x\n", "ends: does not hold x"},
    {FIELD "V: u^2\nalpha: u\n", "alpha: does not hold u"},
    {FIELD "V: u^2\nalpha: 1; steepest 2; bend t\n", "alpha: does not hold t"},
    {FIELD "V: u^2\nalpha: 1; steep 2\n", "alpha: has no option \"steep\"; did you mean steepest"},
    {FIELD "V: u^2\nalpha: 1; bend\n", "the option bend needs a value"},
    {"field: u\nrate: u = -u_x\nstart: u = 1\nends: 0, 1\n", "has no line \"ends\""},
    {FIELD "V: u^2\nexact: u_t = x\n", "exact: is of u alone"},
    {FIELD "V: u^2\ninvariant: m = t\n", "a density does not hold t"},
    {FIELD "V: u^2\nparameter: points = 3\n", "the name points is reserved"},
    {FIELD "V: u^2\nparameter: x = 3\n", "x is the place"},
    {"field: x\nV: x^2\nstart: x = 0, x_t = 1\n", "x is the place"},
    {"field: u x\nrate: u = x_x\nrate: x = u_x\nstart: u = 0, x = 0\n", "x is the place"},
    {"field: u\nV: u^2\nstart: u = t, u_t = 0\n", "the start of a field does not hold t"},
    {"field: u\nV: u^2\nstart: u = x\n", "u_t has no value at the start"},
};

static void what_is_wrong_is_said(void **unused)
{
    (void)unused;
    for (size_t i = 0; i < GM_COUNT(refused); i++) {
        struct gm_user_system system;
        struct gm_fault fault;
        if (gm_equations_open(&system, refused[i].text, strlen(refused[i].text), NULL, 0, &fault)) {
            fail_msg("accepted: %s", refused[i].text);
        }
        if (!strstr(fault.sentence, refused[i].sentence)) {
            fail_msg("%s: %s", refused[i].text, fault.sentence);
        }
        gm_system_close(&system);
    }
}

static void a_field_closes_on_its_ring(void **unused)
{
    (void)unused;
    static const struct {
        const char *text;
        double jump;
        const char *sentence; /* NULL: it closes */
    } rings[] = {
        {"field: u\nV: 1 - cos(u)\nstart: u = 4*atan(exp(x)), u_t = 0\n", 2 * M_PI, NULL},
        {"field: u\nV: 1 - cos(u)\nstart: u = 4*atan(exp(x)), u_t = 0\n", 0, "does not close on the ring"},
        {"field: u\nV: (u^2 - 1)^2/4\nstart: u = tanh(x/sqrt(2)), u_t = 0\n", 2, "V' does not repeat"},
        {"field: u\nV: u^2\nstart: u = 1/x, u_t = 0\n", 0, "is not finite where x = 0"},
        {"field: u\nV: u^2\nstart: u = 1, u_t = 1/x\n", 0, "u_t at the start is not finite where x = 0"},
        {"field: u\nV: u^2\nstart: u = exp(-x^2), u_t = 0\n", 0, NULL},
        {"field: u\nV: u^2\nstart: u = 3, u_t = 0\n", 0, NULL},
    };
    for (size_t i = 0; i < GM_COUNT(rings); i++) {
        struct typed typed;
        struct gm_fault fault;
        open_typed(&typed, rings[i].text);
        typed.problem.line.jump = rings[i].jump;
        const bool closes = gm_user_wave_closes(&typed.problem, &fault);
        if (closes != !rings[i].sentence || (!closes && !strstr(fault.sentence, rings[i].sentence))) {
            fail_msg("%s: %s", rings[i].text, fault.sentence);
        }
        close_typed(&typed);
    }
}

/* ---- certificates ---- */

/* A typed field on grids each twice as fine as the one before, with half its step. */
enum { GRIDS = 4 };
struct grids {
    struct gm_problem problem[GRIDS];
    struct gm_certified_system system[GRIDS];
};

static double distance_from_exact(const void *data, double t, const double *y)
{
    const struct gm_problem *problem = data;
    double largest = 0;
    for (size_t i = 0; i < problem->line.points; i++) {
        largest = fmax(largest, fabs(y[i] - gm_user_line_exact(problem->parameters, 0,
                                                               gm_grid1_node(&problem->line, i), t)));
    }
    return largest;
}

static void open_grids(struct grids *grids, const struct typed *typed, double dt, bool solved)
{
    for (size_t k = 0; k < GRIDS; k++) {
        struct gm_problem *problem = &grids->problem[k];
        const size_t points = (size_t)POINTS << k;
        *problem = typed->problem;
        problem->name = "typed";
        problem->line.points = points;
        problem->line.dx = 2 * HALF / (double)points;
        problem->n = gm_wave_size(points);
        double *start = malloc(problem->n * sizeof *start);
        gm_user_line_levels(problem->parameters, &problem->line, ldexp(dt, -(int)k), start);
        grids->system[k] = (struct gm_certified_system){.problem = problem,
                                                        .start = start,
                                                        .dt = ldexp(dt, -(int)k),
                                                        .finer = k + 1 < GRIDS ? &grids->system[k + 1] : NULL,
                                                        .error = solved ? distance_from_exact : NULL,
                                                        .error_data = problem};
    }
}

static void close_grids(struct grids *grids)
{
    for (size_t k = 0; k < GRIDS; k++) {
        free((double *)grids->system[k].start);
    }
}

static const struct gm_verdict *verdict(struct gm_certificate *certificate, enum gm_claim claim)
{
    return gm_certificate_claim(certificate, claim);
}

#define BREATHER(factor)                                                                                     \
    "field: u\nV: " factor "*(1 - cos(u))\nlet: g = sqrt(1 - 1/4)\nstart: u = 0, u_t = 4*g/cosh(g*x)\n"      \
    "exact: u = 4*atan(g*sin(t/2)/(cosh(g*x)/2))\n"

/* One whose force bends over a fortieth of what it is differentiated along. */
#define STEEP "field: u\nV: cosh(20*u)/400\nstart: u = exp(-x^2)/2, u_t = 0\n"

/* What rows claim holds of somebody's V, with an exact solution and without. */
static void schemes_are_certified_on_somebodys_potential(void **unused)
{
    (void)unused;
    static const char *const names[] = {"leapfrog", "energy-conserving", "euler-box",
                                        "box",      "gauss-box3",        "lobatto-box4"};
    static const char *const texts[] = {PHI4, BREATHER("1")};
    for (size_t which = 0; which < GM_COUNT(texts); which++) {
        struct typed typed;
        struct grids grids;
        open_typed(&typed, texts[which]);
        open_grids(&grids, &typed, 0.08, which == 1);
        for (size_t i = 0; i < GM_COUNT(names); i++) {
            const struct gm_scheme *scheme = gm_scheme_find_for(names[i], &typed.problem);
            struct gm_certificate certificate = gm_certify_on(scheme, grids.system);
            const struct gm_verdict *law = verdict(&certificate, GM_MULTISYMPLECTIC),
                                    *energy = verdict(&certificate, GM_KEEPS_ENERGY);
            if (!certificate.holds || !(fabs(certificate.order - scheme->order) < 0.15) ||
                !verdict(&certificate, GM_SYMMETRIC)->holds || !law->measured || !energy->measured ||
                law->holds != law->claimed || energy->holds != energy->claimed ||
                certificate.ladder.count < 2) {
                fail_msg("%s on %s: order %.3f, M %.1e, H %.1e", names[i], texts[which], certificate.order,
                         law->defect, energy->defect);
            }
        }
        close_grids(&grids);
        close_typed(&typed);
    }
}

/* Tangents of such steps are differences over less. */
static void a_steep_force_is_blamed_on_nobody(void **unused)
{
    (void)unused;
    static const char *const names[] = {"leapfrog", "box"};
    struct typed typed;
    struct grids grids;
    open_typed(&typed, STEEP);
    open_grids(&grids, &typed, 0.01, false);
    for (size_t i = 0; i < GM_COUNT(names); i++) {
        struct gm_certificate certificate =
            gm_certify_on(gm_scheme_find_for(names[i], &typed.problem), grids.system);
        const struct gm_verdict *law = verdict(&certificate, GM_MULTISYMPLECTIC);
        if (!law->holds) {
            fail_msg("%s: %.1e", names[i], law->defect);
        }
    }
    close_grids(&grids);
    close_typed(&typed);
}

/* Round-off of large numbers and fine grids, and starts with corners, on their ring or elsewhere, refute no claim; a
   false one on a smooth start still is. */
static void what_cannot_be_told_is_blamed_on_nobody(void **unused)
{
    (void)unused;
    static const char *const names[] = {"leapfrog", "energy-conserving", "box", "gauss-box3"};
    static const struct {
        const char *text;
        bool large;
    } rows[] = {
        {"field: u\nV: 0\nstart: u = 1000000 + exp(-x^2), u_t = 0\n", true},
        {"field: u\nV: 0\nstart: u = 1000000*exp(-x^2), u_t = 0\n", true},
        {"field: u\nV: u^2/2\nstart: u = exp(-abs(x)), u_t = 0\n", false},
        {"field: u\nV: u^2/2\nstart: u = 0, u_t = exp(-abs(x))\n", false},
        {"field: u\nV: u^2/2\nstart: u = max(0, 1 - x^2)^3, u_t = 0\n", false},
        {"field: u\nV: u^2/2\nstart: u = exp(-x^2/50), u_t = 0\n", false},
    };
    for (size_t which = 0; which < GM_COUNT(rows); which++) {
        struct typed typed;
        struct grids grids;
        open_typed(&typed, rows[which].text);
        open_grids(&grids, &typed, 0.08, false);
        for (size_t i = 0; i < GM_COUNT(names); i++) {
            const struct gm_scheme *scheme = gm_scheme_find_for(names[i], &typed.problem);
            struct gm_certificate certificate = gm_certify_on(scheme, grids.system);
            const struct gm_verdict *law = verdict(&certificate, GM_MULTISYMPLECTIC);
            if (!certificate.holds ||
                (law->claimed && rows[which].large && (law->measured || !law->reason))) {
                fail_msg("%s on %s: order %.3f, M %.1e, H %.1e", names[i], rows[which].text,
                         certificate.order, law->defect, verdict(&certificate, GM_KEEPS_ENERGY)->defect);
            }
        }
        close_grids(&grids);
        close_typed(&typed);
    }
}

/* Leapfrog with some friction, and with the square of the speed of sound so much less. */
static double friction, slowness;

static enum gm_status spoilt(struct gm_two_step_work *work, const struct gm_problem *problem, double dt,
                             struct gm_progress *progress)
{
    const double *past = work->level[0], *now = work->level[1];
    double *next = work->level[2];
    const size_t last = work->points - 1;
    const double square = dt * dt / (problem->line.dx * problem->line.dx);
    const struct gm_two_step_row *row = gm_scheme_find("leapfrog")->coefficients;
    const enum gm_status status = row->step(work, problem, dt, progress);
    for (size_t i = 0; i <= last; i++) {
        const double sides = now[i > 0 ? i - 1 : last] + now[i < last ? i + 1 : 0];
        next[i] -= friction * (now[i] - past[i]) + slowness * square * (sides - 2 * now[i]);
    }
    return status;
}

/* A wrong step, a wrong order and false claims are found out; steps that are too long refute nothing. */
static void wrong_schemes_are_found_out(void **unused)
{
    (void)unused;
    struct typed typed, stiffer;
    struct grids grids, other;
    struct gm_two_step_row row;
    open_typed(&typed, BREATHER("1"));
    open_grids(&grids, &typed, 0.08, true);
    struct gm_scheme wrong = *gm_scheme_find("leapfrog");
    row = *(const struct gm_two_step_row *)wrong.coefficients;
    row.step = spoilt;
    wrong.coefficients = &row;
    friction = 1e-4;
    slowness = 0;
    struct gm_certificate certificate = gm_certify_on(&wrong, grids.system);
    assert_false(certificate.holds);
    assert_false(verdict(&certificate, GM_SYMMETRIC)->holds);
    assert_true(verdict(&certificate, GM_MULTISYMPLECTIC)->defect > 1e-6);
    /* runs agree with each other the better the finer they are, but not with the equation */
    friction = 0;
    slowness = 0.1;
    certificate = gm_certify_on(&wrong, grids.system);
    assert_false(certificate.order_holds);
    assert_non_null(strstr(certificate.order_reason, "but not with the solution"));
    wrong = *gm_scheme_find("leapfrog");
    wrong.order = 3;
    assert_false(gm_certify_on(&wrong, grids.system).order_holds);
    wrong.order = 2;
    assert_true(gm_certify_on(&wrong, grids.system).holds);
    wrong.claims |= GM_KEEPS_ENERGY;
    assert_false(gm_certify_on(&wrong, grids.system).holds);
    wrong = *gm_scheme_find("energy-conserving");
    wrong.claims |= GM_MULTISYMPLECTIC;
    certificate = gm_certify_on(&wrong, grids.system);
    assert_true(!certificate.holds && verdict(&certificate, GM_MULTISYMPLECTIC)->defect > 1e-6);
    /* the solution of another equation */
    open_typed(&stiffer, BREATHER("1.1"));
    open_grids(&other, &stiffer, 0.08, true);
    assert_false(gm_certify_on(gm_scheme_find("leapfrog"), other.system).order_holds);
    grids.system[0].dt = 0.3;
    certificate = gm_certify_on(gm_scheme_find("leapfrog"), grids.system);
    assert_true(certificate.holds && isnan(certificate.order) &&
                strstr(certificate.order_reason, "linear theory"));
    assert_true(!verdict(&certificate, GM_SYMMETRIC)->measured &&
                verdict(&certificate, GM_SYMMETRIC)->reason);
    close_grids(&other);
    close_grids(&grids);
    close_typed(&stiffer);
    close_typed(&typed);
}

/* Well-known equations are found whatever the order of their terms; not where a coefficient depends on x or u, nor with a
   term more. */
static void equations_are_recognised(void **unused)
{
    (void)unused;
    static const struct {
        const char *rates, *name;
        double constants[2]; /* with a = 2 */
    } cases[] = {
        {"u = -6*u*u_x - u_xxx", "Korteweg-de Vries", {6, 1}},
        {"u = -u_xxx/a - 2*u_x*(a + 1)*u", "Korteweg-de Vries", {6, 0.5}},
        {"u = -((u + u_x)^2 - u^2 - u_x^2)/2 - 3*u_xxx", "Korteweg-de Vries", {1, 3}},
        {"u = 0.1*u_xx", "heat", {0.1}},
        {"u = a*u_xx - u_x*u", "Burgers", {2}},
        {"u = -2*u*u_x + u_xx", NULL, {0}},
        {"u = -x*u*u_x - u_xxx", NULL, {0}},
        {"u = -u^2*u_x - u_xxx", NULL, {0}},
        {"u = -u*u_x - (1 + u^2)*u_xxx", NULL, {0}},
        {"u = -u*u_x - u_xxx + u_xx", NULL, {0}},
        {"u = -u_xxx", NULL, {0}},
        {"p = -3*q*(q*q + p^2) - q_xx, q = p_xx + 3*(p^2 + q^2)*p", "nonlinear Schrödinger", {3}},
        {"p = -q_xx - (p^2 + q^2)*q, q = p_xx + 2*(p^2 + q^2)*p", NULL, {0}},
    };
    for (size_t i = 0; i < GM_COUNT(cases); i++) {
        char text[400];
        struct gm_user_system system;
        struct gm_recognised found;
        struct gm_fault fault;
        const bool two = cases[i].rates[0] == 'p';
        snprintf(text, sizeof text, "field: %s\nparameter: a = 2\nrate: %s\nstart: %s\n", two ? "p q" : "u",
                 cases[i].rates, two ? "p = cos(x), q = 0" : "u = cos(x)");
        if (!gm_equations_open(&system, text, strlen(text), NULL, 0, &fault)) {
            fail_msg("%s: %s", text, fault.sentence);
        }
        assert_true(gm_equation_recognise(&system, &found));
        if (!found.name != !cases[i].name || (found.name && strcmp(found.name, cases[i].name) != 0)) {
            fail_msg("%s: %s", cases[i].rates, found.name ? found.name : "none");
        }
        double *start = gm_equations_start(&system, NULL);
        double *values = malloc((system.graph.count + (size_t)1) * sizeof *values);
        gm_formula_evaluate(&system.graph, system.graph.count, start, values);
        for (size_t k = 0; found.name && k < GM_EQUATION_CONSTANTS && found.constants[k]; k++) {
            assert_true(fabs(values[found.values[k]] - cases[i].constants[k]) < 1e-14);
        }
        free(values);
        free(start);
        gm_system_close(&system);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(equations_are_recognised),
        cmocka_unit_test(the_korteweg_scene_has_the_known_solutions),
        cmocka_unit_test(the_schroedinger_scene_has_the_known_solitons),
        cmocka_unit_test(typed_again_it_is_the_built_in_equation),
        cmocka_unit_test(the_scene_has_the_known_solutions),
        cmocka_unit_test(phi4_moves_as_written_by_hand),
        cmocka_unit_test(double_sine_gordon_moves_as_written_by_hand),
        cmocka_unit_test(the_multisymplectic_law_holds),
        cmocka_unit_test(the_quotient_does_not_cancel),
        cmocka_unit_test(the_quotient_of_powers_is_exact),
        cmocka_unit_test(the_quotient_holds_at_rest),
        cmocka_unit_test(the_energy_is_of_the_potential_as_written),
        cmocka_unit_test(a_linear_wave_turns_as_by_hand),
        cmocka_unit_test(a_peakon_moves_as_fast_as_it_is_high),
        cmocka_unit_test(what_is_wrong_is_said),
        cmocka_unit_test(a_field_closes_on_its_ring),
        cmocka_unit_test(schemes_are_certified_on_somebodys_potential),
        cmocka_unit_test(a_steep_force_is_blamed_on_nobody),
        cmocka_unit_test(what_cannot_be_told_is_blamed_on_nobody),
        cmocka_unit_test(wrong_schemes_are_found_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
