/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Nanoseconds a point and step of the schemes for fields, beside a bare loop over libm's sin: no test, ratios
   to read. Every figure is the median of several runs.
       bench_fields [SECTION...]: all of it, or what is named of waves, large, typed, boxes, burgers, fourier. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/basics.h"
#include "core/field/problems/problems.h"
#include "core/field/user/form.h"
#include "core/model/equations.h"
#include "core/ode/problems/problems.h"
#include "core/run.h"
#include "core/schemes.h"
#include "tests/bench/timing.h"
#include "tests/common/dispersive_solitons.h"
#include "tests/common/framed.h"
#include "tests/common/sine_gordon.h"

enum { REPEATS = 7 };

static double bare_sine(size_t points, long steps)
{
    double *x = malloc(points * sizeof *x), *y = malloc(points * sizeof *y), taken[REPEATS], sum = 0;
    for (size_t i = 0; i < points; i++) {
        x[i] = 4 * sin(0.01 * (double)i);
    }
    for (int r = 0; r < REPEATS; r++) {
        const double start = seconds();
        for (long n = 0; n < steps; n++) {
            for (size_t i = 0; i < points; i++) {
                y[i] = sin(x[i]);
            }
            sum += y[(size_t)n % points];
            x[(size_t)n % points] += 1e-9;
        }
        taken[r] = (seconds() - start) * 1e9 / (double)steps / (double)points;
    }
    free(x);
    free(y);
    return sum < INFINITY ? median(taken, REPEATS) : 0;
}

static double time_of(const struct gm_problem *problem, const char *scheme, double dt, long steps,
                      const double *y)
{
    static const struct gm_settings no_settings;
    double taken[REPEATS];
    for (int r = 0; r < REPEATS; r++) {
        struct gm_run *run =
            gm_run_open(problem, gm_scheme_find_for(scheme, problem), &no_settings, 0, dt, y);
        gm_run_advance(run, 10);
        const double start = seconds();
        gm_run_advance(run, steps);
        taken[r] = (seconds() - start) * 1e9 / (double)steps / (double)problem->line.points;
        if (run->status != GM_OK) {
            printf("%s: %s\n", scheme, gm_status_name(run->status));
        }
        gm_run_close(run);
    }
    return median(taken, REPEATS);
}

static void tell(const char *what, double time, double line, double sine)
{
    printf("%-34s %7.2f ns a point and step   %5.2f of a bare sin", what, time, time / sine);
    if (line > 0) {
        printf("   %4.0f %% of the line at %g ns", 100 * time / line, line);
    }
    printf("\n");
}

static void waves(size_t points, double half_length, double dt, long steps, double sine)
{
    static const struct gm_sine_gordon breather = {.initial = GM_BREATHER, .frequency = 0.5};
    struct gm_problem problem = gm_problem_sine_gordon;
    problem.parameters = &breather;
    problem.line = (struct gm_grid1){points, 2 * half_length / (double)points, -half_length, 0, false};
    problem.n = gm_wave_size(points);
    double *y = malloc(problem.n * sizeof *y);
    gm_sine_gordon_levels(&problem, 0, dt, y);
    printf("sine-Gordon, %zu points\n", points);
    tell("  leapfrog", time_of(&problem, "leapfrog", 0.9 * problem.line.dx, steps, y), 8, sine);
    tell("  energy-conserving",
         time_of(&problem, "energy-conserving", 0.9 * problem.line.dx, steps / 8 + 1, y), 0, sine);
    tell("  box", time_of(&problem, "box", dt, steps / 4 + 1, y), 150, sine);
    free(y);
}

/* The implicit schemes at steps from small to large: the iteration, and Newton's method where it is slow. */
static void larger_steps(struct gm_problem *problem, const double *ratios, size_t count, double unit,
                         long steps, void (*levels)(const struct gm_problem *, double, double *))
{
    double *y = malloc(problem->n * sizeof *y);
    printf("%s, box, %zu points\n", problem->name, problem->line.points);
    for (size_t i = 0; i < count; i++) {
        static const struct gm_settings no_settings;
        const double dt = ratios[i] * unit;
        levels(problem, dt, y);
        struct gm_run *run = gm_run_open(problem, gm_scheme_find_for("box", problem), &no_settings, 0, dt, y);
        gm_run_advance(run, steps);
        const double iterations = (double)run->iterations / (double)(run->steps > 0 ? run->steps : 1);
        gm_run_close(run);
        printf("  dt %-8.3g dt/dx %-7.3g %9.2f ns a point and step   %5.1f iterations\n", dt,
               dt / problem->line.dx, time_of(problem, "box", dt, steps, y), iterations);
    }
    free(y);
}

static void breather_levels(const struct gm_problem *problem, double dt, double *y)
{
    gm_sine_gordon_levels(problem, 0, dt, y);
}

static void nls_levels(const struct gm_problem *problem, double dt, double *y)
{
    (void)dt;
    bright_state(&(const struct bright){.amplitude = 1, .velocity = 1}, &problem->line, 0, y);
}

static void boxes(size_t points, double half_length, long steps)
{
    static const struct gm_sine_gordon breather = {.initial = GM_BREATHER, .frequency = 0.5};
    static const struct kdv_solution one_soliton = {
        .initial = KDV_SOLITON, .kdv.eta = 1, .kdv.mu = 1, .velocity = 1};
    static const double ratios[] = {0.5, 2, 10, 20, 40};
    enum { COUNT = GM_COUNT(ratios) };
    const struct gm_grid1 line = {points, 2 * half_length / (double)points, -half_length, 0, false};
    struct gm_problem problem = gm_problem_sine_gordon;
    problem.parameters = &breather;
    problem.line = line;
    problem.n = gm_wave_size(points);
    larger_steps(&problem, ratios, COUNT, 0.05, steps, breather_levels);
    problem = gm_problem_kdv;
    problem.parameters = &one_soliton;
    problem.line = line;
    problem.n = gm_wave_size(points);
    larger_steps(&problem, ratios, COUNT, 0.05, steps, kdv_levels);
    problem = gm_problem_nls;
    problem.line = line;
    problem.n = 2 * points;
    larger_steps(&problem, ratios, COUNT, 0.01, steps, nls_levels);
}

static void burgers(size_t points, long steps, double sine)
{
    static const char *const names[] = {
        "ftcs",           "lax-wendroff",           "crank-nicolson",
        "ftcs-invariant", "lax-wendroff-invariant", "crank-nicolson-invariant"};
    const double dx = 4.0 / (double)(points - 1);
    const struct burgers_solution front = {.viscosity = dx / 2};
    struct framed framed;
    burgers_open(&framed, &front, (struct gm_grid1){.points = points, .dx = dx, .first = -2});
    double *y = malloc(framed.problem.n * sizeof *y);
    for (size_t j = 0; j < points; j++) {
        y[j] = burgers_exact(&front, true, gm_grid1_node(&framed.problem.line, j), 0);
    }
    printf("Burgers, %zu points\n", points);
    for (size_t s = 0; s < 6; s++) {
        char what[48];
        snprintf(what, sizeof what, "  %s", names[s]);
        const bool implicit = s % 3 == 2;
        tell(what, time_of(&framed.problem, names[s], dx / 4, implicit ? steps / 8 + 1 : steps, y),
             implicit ? 0 : 4, sine);
    }
    framed_close(&framed);
    free(y);
}

/* The box of all components, typed by its matrices, beside the box in which all but the field is eliminated. */
static void typed(size_t points)
{
    static const struct {
        const char *text;
        double dt;
    } rows[] = {
        {"components: u v w\nK-matrix: 0, -1, 0 | 1, 0, 0 | 0, 0, 0\nL-matrix: 0, 0, 1 | 0, 0, 0 | -1, 0, 0\n"
         "S: 1 - cos(u) + v^2/2 - w^2/2\nstart: u = 0, v = 3.4/cosh(0.86*x), w = 0\n",
         0.05},
        {"components: u phi v w\nK-matrix: 0, -1/2, 0, 0 | 1/2, 0, 0, 0 | 0, 0, 0, 0 | 0, 0, 0, 0\n"
         "L-matrix: 0, 0, -1, 0 | 0, 0, 0, 1 | 1, 0, 0, 0 | 0, -1, 0, 0\nS: v^2/2 - u*w + u^3/6\n"
         "start: u = 3/cosh(x/2)^2, phi = 0, v = 0, w = 0\n",
         0.05},
        {"components: p q v w\nK-matrix: 0, 1, 0, 0 | -1, 0, 0, 0 | 0, 0, 0, 0 | 0, 0, 0, 0\n"
         "L-matrix: 0, 0, -1, 0 | 0, 0, 0, -1 | 1, 0, 0, 0 | 0, 1, 0, 0\nS: (p^2 + q^2)^2/4 + (v^2 + w^2)/2\n"
         "start: p = sqrt(2)/cosh(x)*cos(x/2), q = sqrt(2)/cosh(x)*sin(x/2), v = 0, w = 0\n",
         0.02},
    };
    static const struct kdv_solution one_soliton = {.kdv.eta = 1, .kdv.mu = 1, .velocity = 1};
    struct gm_problem built_in[] = {gm_problem_sine_gordon, gm_problem_kdv, gm_problem_nls};
    built_in[1].parameters = &one_soliton;
    for (size_t i = 0; i < GM_COUNT(rows); i++) {
        struct gm_user_system system;
        struct gm_user_form form;
        struct gm_problem problem;
        struct gm_fault fault;
        const struct gm_grid1 line = {points, 40 / (double)points, -20, 0, false};
        if (!gm_equations_open(&system, rows[i].text, strlen(rows[i].text), NULL, 0, &fault) ||
            !gm_user_form_derive(&form, &system)) {
            printf("%s\n", fault.sentence);
            continue;
        }
        double *values = gm_equations_start(&system, NULL);
        gm_user_form_open(&problem, &form, values, &line);
        double *y = calloc(problem.n + 2 * points + 1, sizeof *y);
        gm_user_form_start(&problem, y);
        const double general = time_of(&problem, "box", rows[i].dt, 200, y);
        built_in[i].line = line;
        built_in[i].n = i == 2 ? 2 * points : gm_wave_size(points);
        if (i < 2) { /* a wave from rest in two levels */
            for (size_t k = 0; k < points; k++) {
                y[points + k] = y[k] + (i == 0 ? rows[i].dt * y[points + k] : 0);
            }
            y[2 * points] = rows[i].dt;
        }
        const double special = time_of(&built_in[i], "box", rows[i].dt, 200, y);
        printf("%s by its matrices, %zu points: %.0f ns a point and step, %.2f times the box of its own\n",
               built_in[i].name, points, general, general / special);
        free(y);
        free(values);
        gm_user_line_close(&problem);
        gm_system_close(&system);
    }
}

/* The pseudo-spectral scheme at lengths of small factors and at primes, beside the first. */
static void fourier(void)
{
    static const struct kdv_solution one_soliton = {
        .initial = KDV_SOLITON, .kdv.eta = 1, .kdv.mu = 1, .velocity = 1};
    static const size_t points[] = {1024, 1001, 1000, 10000, 10007, 100000, 100003};
    double first = 0;
    for (size_t i = 0; i < GM_COUNT(points); i++) {
        struct gm_problem problem = gm_problem_kdv;
        problem.parameters = &one_soliton;
        problem.line = (struct gm_grid1){points[i], 100 / (double)points[i], -50, 0, false};
        problem.n = gm_wave_size(points[i]);
        double *y = calloc(problem.n, sizeof *y);
        kdv_levels(&problem, 1e-6, y);
        const double time = time_of(&problem, "fourier-rk4", 1e-6, (long)(1000000 / points[i]), y);
        first = i == 0 ? time : first;
        printf("kdv fourier-rk4, %6zu points: %.1f ns a point and step, %.2f times that of 1024\n", points[i],
               time, time / first);
        free(y);
    }
}

static bool is_asked(const char *section, int argc, char **argv)
{
    bool asked = argc < 2;
    for (int i = 1; i < argc; i++) {
        asked |= strcmp(argv[i], section) == 0;
    }
    return asked;
}

int main(int argc, char **argv)
{
    setvbuf(stdout, NULL, _IOLBF, 0); /* it takes minutes */
    const double sine = bare_sine(801, 4000);
    printf("a bare loop over libm's sin          %.2f ns\n", sine);
    if (is_asked("waves", argc, argv)) {
        waves(801, 20, 0.05, 4000, sine);
    }
    if (is_asked("large", argc, argv)) {
        waves(1000000, 20000, 0.04, 8, sine);
    }
    if (is_asked("typed", argc, argv)) {
        typed(401);
    }
    if (is_asked("boxes", argc, argv)) {
        boxes(801, 20, 100);
        boxes(10001, 250, 4);
    }
    if (is_asked("burgers", argc, argv)) {
        burgers(801, 8000, sine);
        burgers(1000000, 8, sine);
    }
    if (is_asked("fourier", argc, argv)) {
        fourier();
    }
    return 0;
}
