/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Schemes for waves against levels computed elsewhere, and their laws against the formulas. */
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
#include "core/field/multisymplectic.h"
#include "core/field/problems/problems.h"
#include "core/run.h"
#include "core/schemes.h"
#include "tests/common/dispersive_solitons.h"
#include "tests/common/reference.h"
#include "tests/common/sine_gordon.h"

enum { REFERENCE_POINTS = 101 };

static const struct gm_settings no_settings;

/* A level of the reference. */
static const double *level(const char *name)
{
    return reference(name, REFERENCE_POINTS);
}

static void expect_level(const double *u, const double *expected, double tolerance, const char *what)
{
    double error = 0, scale = 0;
    for (size_t i = 0; i < REFERENCE_POINTS; i++) {
        error = fmax(error, fabs(u[i] - expected[i]));
        scale = fmax(scale, fabs(expected[i]));
    }
    if (!(error <= tolerance * scale)) {
        fail_msg("%s: error %.2e, tolerance %.2e", what, error / scale, tolerance);
    }
}

static struct gm_problem wave_problem(size_t points, double half_length, double jump)
{
    struct gm_problem problem = gm_problem_sine_gordon;
    problem.line = (struct gm_grid1){points, 2 * half_length / (double)points, -half_length, jump, false};
    problem.n = gm_wave_size(points);
    return problem;
}

static void expect_number(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance * fmax(1, fabs(expected)))) {
        fail_msg("%.17g is not %.17g", value, expected);
    }
}

static void levels_agree(void **unused)
{
    (void)unused;
    for (size_t c = 0; c < reference_cases(); c++) {
        const char *initial = reference_word(c, 0), *scheme = reference_word(c, 1);
        const double dt = reference_number(c, "dt"), *energy = reference_of(c, "energy", 3);
        const double *cell_energy = reference_of(c, "cell_energy", 3);
        const double jump = strcmp(initial, "kink") == 0       ? 2 * M_PI
                            : strcmp(initial, "antikink") == 0 ? -2 * M_PI
                                                               : 0;
        const struct gm_problem problem = wave_problem(REFERENCE_POINTS, 20, jump);
        double y[2 * REFERENCE_POINTS + 1];
        for (int k = 0; k < 2; k++) {
            char name[64];
            snprintf(name, sizeof name, "%s_level_%d", initial, k);
            memcpy(y + k * REFERENCE_POINTS, level(name), REFERENCE_POINTS * sizeof *y);
        }
        y[2 * REFERENCE_POINTS] = dt;
        const double tolerance =
            1e-12 + 100 * (reference_number(c, "conditioning") + reference_number(c, "agreement"));
        expect_number(gm_wave_energy(&problem, y), energy[0], 1e-13);
        expect_number(gm_wave_cell_energy(&problem, y), cell_energy[0], 1e-13);
        struct gm_run *run = gm_run_open(&problem, gm_scheme_find(scheme), &no_settings, 0, dt, y);
        assert_non_null(run);
        assert_int_equal(gm_run_advance(run, 20), GM_OK);
        expect_level(gm_run_state(run), reference_of(c, "level_20", REFERENCE_POINTS), tolerance, scheme);
        expect_number(gm_wave_energy(&problem, gm_run_state(run)), energy[1], 10 * tolerance);
        expect_number(gm_wave_cell_energy(&problem, gm_run_state(run)), cell_energy[1], 10 * tolerance);
        assert_int_equal(gm_run_advance(run, 80), GM_OK);
        expect_level(gm_run_state(run), reference_of(c, "level_100", REFERENCE_POINTS), tolerance, scheme);
        expect_number(gm_wave_energy(&problem, gm_run_state(run)), energy[2], 10 * tolerance);
        expect_number(gm_wave_cell_energy(&problem, gm_run_state(run)), cell_energy[2], 10 * tolerance);
        gm_run_close(run);
    }
}

static const struct gm_sine_gordon breather = {.initial = GM_BREATHER, .frequency = 0.5, .velocity = 0.5};

/* A run of the breather; *problem is filled. */
static struct gm_run *breather_run(struct gm_problem *problem, const char *scheme, size_t points, double dt)
{
    *problem = wave_problem(points, 20, 0);
    problem->parameters = &breather;
    double *y = malloc(problem->n * sizeof *y);
    gm_sine_gordon_levels(problem, 0, dt, y);
    struct gm_run *run = gm_run_open(problem, gm_scheme_find(scheme), &no_settings, 0, dt, y);
    free(y);
    assert_non_null(run);
    return run;
}

static double breather_error(const struct gm_run *run)
{
    double largest = 0;
    for (size_t i = 0; i < run->problem->line.points; i++) {
        const double x = run->problem->line.first + (double)i * run->problem->line.dx;
        largest = fmax(largest, fabs(gm_run_state(run)[i] - gm_sine_gordon_exact(&breather, 20, x, run->t)));
    }
    return largest;
}

static void all_have_order_two(void **unused)
{
    (void)unused;
    static const char *const names[] = {"leapfrog", "energy-conserving", "box"};
    for (size_t s = 0; s < 3; s++) {
        double error[2];
        for (size_t k = 0; k < 2; k++) {
            struct gm_problem problem;
            struct gm_run *run = breather_run(&problem, names[s], 400u << k, 0.05 / (double)(1u << k));
            assert_int_equal(gm_run_advance(run, 200l << k), GM_OK);
            error[k] = breather_error(run);
            gm_run_close(run);
        }
        const double order = log2(error[0] / error[1]);
        if (!(fabs(order - 2) < 0.1)) {
            fail_msg("%s has order %.3f", names[s], order);
        }
    }
}

/* A change of dt or of its sign in flight: leapfrog goes back the way it came; a doubled step keeps the
 * order. */
static void the_step_may_change(void **unused)
{
    (void)unused;
    struct gm_problem problem;
    struct gm_run *run = breather_run(&problem, "leapfrog", 201, 0.05);
    assert_int_equal(gm_run_advance(run, 60), GM_OK);
    gm_run_set_step(run, -0.05);
    assert_int_equal(gm_run_advance(run, 59), GM_OK);
    for (size_t i = 0; i < 201; i++) {
        const double x = problem.line.first + (double)i * problem.line.dx;
        assert_true(fabs(gm_run_state(run)[i] - gm_sine_gordon_exact(&breather, 20, x, 0.05)) < 1e-12);
    }
    gm_run_close(run);
    double error[2];
    for (size_t k = 0; k < 2; k++) {
        run = breather_run(&problem, "box", 400u << k, 0.05 / (double)(1u << k));
        assert_int_equal(gm_run_advance(run, 100l << k), GM_OK);
        gm_run_set_step(run, 0.1 / (double)(1u << k));
        assert_int_equal(gm_run_advance(run, 50l << k), GM_OK);
        error[k] = breather_error(run);
        gm_run_close(run);
    }
    assert_true(fabs(log2(error[0] / error[1]) - 2) < 0.2);
}

/* Steps one by one, all at once, and continued from a snapshot in another run are the same bits. */
static void bits_do_not_depend_on_bursts(void **unused)
{
    (void)unused;
    static const char *const names[] = {"leapfrog",     "energy-conserving", "box",
                                        "euler-box",    "midpoint-box",      "gauss-box3",
                                        "lobatto-box2", "lobatto-box4",      "lobatto-nystrom4"};
    for (size_t s = 0; s < GM_COUNT(names); s++) {
        struct gm_problem problem[3];
        const size_t points = strncmp(names[s], "lobatto", 7) == 0 ? 98 : 97;
        struct gm_run *one = breather_run(&problem[0], names[s], points, 0.1);
        struct gm_run *all = breather_run(&problem[1], names[s], points, 0.1);
        struct gm_run *other = breather_run(&problem[2], names[s], points, 0.1);
        assert_int_equal(gm_run_advance(all, 30), GM_OK);
        for (int k = 0; k < 30; k++) {
            if (k == 11) {
                void *snapshot = malloc(gm_run_snapshot_size(one));
                gm_run_save(one, snapshot);
                gm_run_load(other, snapshot);
                free(snapshot);
            }
            assert_int_equal(gm_run_advance(one, 1), GM_OK);
        }
        assert_int_equal(gm_run_advance(other, 19), GM_OK);
        const size_t size = problem[0].n * sizeof(double);
        assert_memory_equal(gm_run_state(one), gm_run_state(all), size);
        assert_memory_equal(gm_run_state(other), gm_run_state(all), size);
        gm_run_close(one);
        gm_run_close(all);
        gm_run_close(other);
    }
}

/* The box in all its variables, through the matrices of the facet: from the levels of a run
   the mean velocity V = A_x v of every cell and the mean slope W = A_t w of every node follow up to a
   constant, and with them every equation of the box; so does the local law of energy, whose residual is known
   in closed form. */
static void the_box_solves_the_whole_system(void **unused)
{
    (void)unused;
    enum { POINTS = 201, STEPS = 40 };
    const double dt = 0.1;
    struct gm_problem problem;
    struct gm_run *run = breather_run(&problem, "box", POINTS, dt);
    const double dx = problem.line.dx;
    double before[POINTS], now[POINTS], v[POINTS], v_next[POINTS], w[POINTS], worst = 0, worst_law = 0;
    memcpy(now, gm_run_state(run), sizeof now);
    for (long n = 0; n < STEPS; n++) {
        memcpy(before, now, sizeof now);
        assert_int_equal(gm_run_advance(run, 1), GM_OK);
        memcpy(now, gm_run_state(run), sizeof now);
        /* A_t D_x u = A_x W: around a ring of odd length W_0 = sum (-1)^i D_x A_t u_i */
        double sum = 0;
        for (size_t i = 0; i < POINTS; i++) {
            const size_t r = (i + 1) % POINTS;
            const double slope = (before[r] + now[r] - before[i] - now[i]) / (2 * dx);
            sum += i % 2 ? -slope : slope;
        }
        w[0] = sum;
        for (size_t i = 0; i + 1 < POINTS; i++) {
            const double slope = (before[i + 1] + now[i + 1] - before[i] - now[i]) / (2 * dx);
            w[i + 1] = 2 * slope - w[i];
        }
        double largest = 0, law_largest = 0;
        for (size_t i = 0; i < POINTS; i++) {
            const size_t r = (i + 1) % POINTS;
            const double a = (before[i] + before[r]) / 2, b = (now[i] + now[r]) / 2, rate = (b - a) / dt;
            const double slope = (before[r] + now[r] - before[i] - now[i]) / (2 * dx);
            const double turn = (w[r] - w[i]) / dx;
            if (n == 0) {
                /* the first equation gives V at the start; the second is its definition */
                const double change = turn - sin((a + b) / 2);
                v[i] = rate - dt / 2 * change;
            }
            v_next[i] = 2 * rate - v[i];
            /* M s_t + K s_x - grad S(mean) */
            const double s_t[3] = {rate, (v_next[i] - v[i]) / dt, 0}, s_x[3] = {slope, 0, turn};
            const double mean[3] = {(a + b) / 2, (v[i] + v_next[i]) / 2, (w[i] + w[r]) / 2};
            const double gradient[3] = {sin(mean[0]), mean[1], -mean[2]};
            for (size_t row = 0; row < 3; row++) {
                double residual = -gradient[row];
                for (size_t k = 0; k < 3; k++) {
                    residual += gm_field_of(&problem)->form->m[3 * row + k] * s_t[k] +
                                gm_field_of(&problem)->form->k[3 * row + k] * s_x[k];
                }
                largest = fmax(largest, fabs(residual));
            }
            /* D_t [V^2/2 + (D_x u)^2/2 + V(U)] - D_x [D_t u W] */
            const double past_slope = (before[r] - before[i]) / dx, now_slope = (now[r] - now[i]) / dx;
            const double energy_change =
                (v_next[i] * v_next[i] - v[i] * v[i] + now_slope * now_slope - past_slope * past_slope) / 2 -
                cos(b) + cos(a);
            const double flux = ((now[r] - before[r]) * w[r] - (now[i] - before[i]) * w[i]) / dt;
            const double law = energy_change / dt - flux / dx;
            const double closed = (cos(a) - cos(b)) / dt - rate * sin((a + b) / 2);
            worst_law = fmax(worst_law, fabs(law - closed));
            law_largest = fmax(law_largest, fabs(closed));
        }
        worst = fmax(worst, largest);
        double told[POINTS], told_largest = 0;
        assert_true(gm_local_laws(&problem, run->scheme, dt, gm_run_state(run), GM_LAW_OF_ENERGY, told));
        for (size_t i = 0; i < POINTS; i++) {
            told_largest = fmax(told_largest, fabs(told[i]));
        }
        assert_true(fabs(told_largest - law_largest) < 1e-12);
        memcpy(v, v_next, sizeof v);
    }
    if (!(worst < 1e-9 && worst_law < 1e-9)) {
        fail_msg("the box leaves %.2e, its energy law %.2e", worst, worst_law);
    }
    gm_run_close(run);
}

/* A scheme with a little friction, which no law survives. */
static const struct gm_family *rubbed;

static struct gm_progress rub(const struct gm_task *task)
{
    const struct gm_progress progress = rubbed->loop(task);
    for (size_t i = 0; progress.status == GM_OK && i < task->problem->line.points; i++) {
        task->out[i] -= 1e-4 * (task->out[i] - task->y[i]);
    }
    /* what is remembered begins with the field or its velocity */
    for (size_t i = 0; progress.status == GM_OK && task->memory && i < task->problem->line.points; i++) {
        task->memory_out[i] -= 1e-4 * (task->memory_out[i] - task->memory[i]);
    }
    return progress;
}

/* The residual of the law after 20 steps, by the linearised scheme and by differences of the scheme itself;
   and the latter for the scheme with friction. */
static void expect_law(const struct gm_problem *problem, const char *name, double dt, const double *y,
                       bool kept)
{
    const struct gm_scheme *scheme = gm_scheme_find_for(name, problem);
    struct gm_run *run = gm_run_open(problem, scheme, &no_settings, 0, dt, y);
    assert_non_null(run);
    assert_int_equal(gm_run_advance(run, 20), GM_OK);
    const double *state = gm_run_state(run), *memory = gm_run_memory(run);
    const double residual =
        gm_form_residual((struct gm_law){problem, scheme, dt, state, memory, .by_differences = false});
    const double defect =
        gm_form_residual((struct gm_law){problem, scheme, dt, state, memory, .by_differences = true});
    struct gm_family family = *scheme->family;
    struct gm_scheme wrong = *scheme;
    rubbed = scheme->family;
    family.loop = rub;
    wrong.family = &family;
    const double friction =
        gm_form_residual((struct gm_law){problem, &wrong, dt, state, memory, .by_differences = true});
    if (kept ? !(residual < 1e-11 && defect < 1e-8 && friction > 1e-6)
             : !(residual > 1e-4 && defect > 1e-4)) {
        fail_msg("%s, %s: residual %.2e, by differences %.2e, with friction %.2e", problem->name, name,
                 residual, defect, friction);
    }
    gm_run_close(run);
}

static void the_form_is_kept_or_not(void **unused)
{
    (void)unused;
    static const struct {
        const char *name;
        bool kept;
    } of_waves[] = {{"leapfrog", true},     {"euler-box", true},  {"box", true},
                    {"midpoint-box", true}, {"gauss-box3", true}, {"energy-conserving", false}};
    enum { POINTS = 101 };
    static double y[2 * POINTS + 1];
    for (size_t s = 0; s < GM_COUNT(of_waves); s++) {
        struct gm_problem problem = wave_problem(POINTS, 20, 0);
        problem.parameters = &breather;
        gm_sine_gordon_levels(&problem, 0, 0.1, y);
        expect_law(&problem, of_waves[s].name, 0.1, y, of_waves[s].kept);
    }
    /* on an even number of points the alternating parts of slopes follow from the forces */
    struct gm_problem even = wave_problem(POINTS - 1, 20, 0);
    even.parameters = &breather;
    gm_sine_gordon_levels(&even, 0, 0.1, y);
    expect_law(&even, "box", 0.1, y, true);
    even = kdv_problem(60);
    kdv_levels(&even, 0.05, y);
    expect_law(&even, "box", 0.05, y, true);
    even = nls_problem(60);
    bright_state(&bright, &even.line, 0, y);
    expect_law(&even, "box", 0.02, y, true);
    const struct gm_problem kdv = kdv_problem(POINTS), nls = nls_problem(POINTS);
    kdv_levels(&kdv, 0.05, y);
    expect_law(&kdv, "box", 0.05, y, true);
    kdv_levels(&kdv, 0.01, y);
    expect_law(&kdv, "euler-box", 0.01, y, true);
    expect_law(&kdv, "midpoint-box", 0.01, y, true);
    kdv_levels(&kdv, -0.01, y);
    expect_law(&kdv, "euler-box", -0.01, y, true);
    expect_law(&kdv, "midpoint-box", -0.01, y, true);
    bright_state(&bright, &nls.line, 0, y);
    expect_law(&nls, "box", 0.02, y, true);
    expect_law(&nls, "euler-box", 0.02, y, true);
    expect_law(&nls, "euler-box", -0.02, y, true);
    struct gm_run *run = gm_run_open(&nls, gm_scheme_find("split-step2"), &no_settings, 0, 0.02, y);
    assert_true(
        isnan(gm_form_residual((struct gm_law){&nls, run->scheme, 0.02, y, NULL, .by_differences = false})));
    gm_run_close(run);
}

/* What the law needs at the sides of cells is found without the round-off of short waves, which the way there would
   multiply by the cube of their number. */
static void many_cells(void **unused)
{
    (void)unused;
    static const char *const names[] = {"box", "gauss-box3"};
    for (size_t s = 0; s < GM_COUNT(names); s++) {
        for (size_t points = 2000; points < 2002; points++) {
            struct gm_problem problem;
            struct gm_run *run = breather_run(&problem, names[s], points, 0.1);
            assert_int_equal(gm_run_advance(run, 20), GM_OK);
            const double residual = gm_form_residual((struct gm_law){
                &problem, run->scheme, 0.1, gm_run_state(run), gm_run_memory(run), .by_differences = false});
            if (!(residual < 1e-12)) {
                fail_msg("%s, %zu cells: %.2e", names[s], points, residual);
            }
            gm_run_close(run);
        }
    }
}

/* Collocation at two points comes closer by its order. */
static void collocation_at_two_points_has_its_order(void **unused)
{
    (void)unused;
    double error[2];
    for (size_t k = 0; k < 2; k++) {
        struct gm_problem problem;
        struct gm_run *run = breather_run(&problem, "gauss-box3", 200u << k, 0.1 / (double)(1u << k));
        assert_int_equal(gm_run_advance(run, 50l << k), GM_OK);
        error[k] = breather_error(run);
        gm_run_close(run);
    }
    if (!(error[0] < 1.25e-3 && error[0] / error[1] > 8)) {
        fail_msg("errors %.3g, %.3g", error[0], error[1]);
    }
}

/* The caller frees it. */
static double *profile_of(const struct gm_problem *problem, const struct gm_scheme *scheme, const double *u)
{
    double *values = malloc(2 * problem->line.points * sizeof *values);
    assert_true(gm_field_profile(problem, scheme, u, values));
    return values;
}

static double box_square(const struct gm_problem *problem, const double *y)
{
    double *profile = profile_of(problem, gm_scheme_find("box"), y);
    assert_non_null(profile);
    const double square = kdv_square(problem, profile);
    free(profile);
    return square;
}

static double box_energy(const struct gm_problem *problem, const double *y)
{
    double *re = profile_of(problem, gm_scheme_find("box"), y);
    double *im = profile_of(problem, gm_scheme_find("box"), y + problem->line.points);
    assert_true(re && im);
    const size_t points = problem->line.points;
    double energy = 0;
    for (size_t i = 0; i < points; i++) {
        const double square = re[i] * re[i] + im[i] * im[i];
        energy += problem->line.dx *
                  (re[points + i] * re[points + i] + im[points + i] * im[points + i] - square * square / 2);
    }
    free(re);
    free(im);
    return energy;
}

/* Of the modes of Fourier: the energy of sin x is that of a wave whose slope is exact, on few nodes. */
static void slopes_are_those_of_the_scheme(void **unused)
{
    (void)unused;
    enum { POINTS = 7 };
    static const struct {
        const char *scheme;
        double value, slope; /* at x = 0, where the sine's are 0 and 1 */
    } rows[] = {{"fourier-rk4", 0, 1}, {"zabusky-kruskal", 0, 0.87103}, {"box", 0.390916, 0.87103}};
    struct gm_problem problem = gm_problem_kdv;
    problem.line = (struct gm_grid1){POINTS, 2 * M_PI / POINTS, 0, 0, false};
    double u[POINTS];
    for (size_t i = 0; i < POINTS; i++) {
        u[i] = sin(2 * M_PI * (double)i / POINTS);
    }
    for (size_t i = 0; i < GM_COUNT(rows); i++) {
        double *profile = profile_of(&problem, gm_scheme_find(rows[i].scheme), u);
        assert_non_null(profile);
        assert_true(fabs(profile[0] - rows[i].value) < 1e-6);
        assert_true(fabs(profile[POINTS] - rows[i].slope) < 1e-5);
        free(profile);
    }
}

/* The box for Korteweg-de Vries and nonlinear Schroedinger, and leapfrog for the former. */
static void dispersive_levels_agree(void **unused)
{
    (void)unused;
    const size_t bytes = REFERENCE_POINTS * sizeof(double);
    const double *kdv_box_invariants = reference("kdv_box_invariants", 4);
    const double *nls_box_invariants = reference("nls_box_invariants", 4);
    struct gm_problem problem = kdv_problem(REFERENCE_POINTS);
    double y[2 * REFERENCE_POINTS + 1] = {0};
    memcpy(y, level("kdv_one_soliton_level_0"), bytes);
    y[2 * REFERENCE_POINTS] = 0.05;
    expect_number(kdv_mass(&problem, y), kdv_box_invariants[0], 1e-13);
    expect_number(box_square(&problem, y), kdv_box_invariants[1], 1e-13);
    struct gm_run *run = gm_run_open(&problem, gm_scheme_find("box"), &no_settings, 0, 0.05, y);
    assert_int_equal(gm_run_advance(run, 20), GM_OK);
    expect_level(gm_run_state(run), level("kdv_box_level_20"), 1e-12 + 100 * 4.6e-15, "kdv box");
    expect_number(kdv_mass(&problem, gm_run_state(run)), kdv_box_invariants[2], 1e-12);
    expect_number(box_square(&problem, gm_run_state(run)), kdv_box_invariants[3], 1e-11);
    gm_run_close(run);

    const struct kdv_solution cosine = {.initial = KDV_COSINE, .kdv.eta = 1, .kdv.mu = 0.022 * 0.022};
    problem.parameters = &cosine;
    problem.line = (struct gm_grid1){REFERENCE_POINTS, 2.0 / REFERENCE_POINTS, 0, 0, false};
    kdv_levels(&problem, 1e-3, y);
    expect_level(y + REFERENCE_POINTS, level("kdv_cosine_level_1"), 1e-15, "second level of the cosine");
    memcpy(y, level("kdv_cosine_level_0"), bytes);
    memcpy(y + REFERENCE_POINTS, level("kdv_cosine_level_1"), bytes);
    run = gm_run_open(&problem, gm_scheme_find("zabusky-kruskal"), &no_settings, 0, 1e-3, y);
    assert_int_equal(gm_run_advance(run, 20), GM_OK);
    expect_level(gm_run_state(run), level("kdv_zabusky_kruskal_level_20"), 1e-12 + 100 * 2.5e-15,
                 "zabusky-kruskal");
    assert_true(fabs(kdv_mass(&problem, gm_run_state(run))) < 1e-13);
    gm_run_close(run);

    problem = nls_problem(REFERENCE_POINTS);
    memcpy(y, level("nls_one_soliton_level_0_re"), bytes);
    memcpy(y + REFERENCE_POINTS, level("nls_one_soliton_level_0_im"), bytes);
    expect_number(nls_charge(&problem, y), nls_box_invariants[0], 1e-13);
    expect_number(box_energy(&problem, y), nls_box_invariants[1], 1e-13);
    run = gm_run_open(&problem, gm_scheme_find("box"), &no_settings, 0, 0.05, y);
    assert_int_equal(gm_run_advance(run, 20), GM_OK);
    expect_level(gm_run_state(run), level("nls_box_level_20_re"), 1e-12 + 100 * 1.1e-14, "nls box");
    expect_level(gm_run_state(run) + REFERENCE_POINTS, level("nls_box_level_20_im"), 1e-12 + 100 * 1.1e-14,
                 "nls box");
    expect_number(nls_charge(&problem, gm_run_state(run)), nls_box_invariants[2], 1e-12);
    expect_number(box_energy(&problem, gm_run_state(run)), nls_box_invariants[3], 1e-11);
    gm_run_close(run);
}
/* The matrices of every equation are skew. */
static void matrices_are_skew(void **unused)
{
    (void)unused;
    const struct gm_problem *const problems[] = {&gm_problem_sine_gordon, &gm_problem_wave, &gm_problem_kdv,
                                                 &gm_problem_nls};
    for (size_t p = 0; p < 4; p++) {
        const struct gm_form *field = gm_field_of(problems[p])->form;
        for (size_t i = 0; i < field->dimension; i++) {
            for (size_t k = 0; k < field->dimension; k++) {
                assert_true(field->m[i * field->dimension + k] == -field->m[k * field->dimension + i]);
                assert_true(field->k[i * field->dimension + k] == -field->k[k * field->dimension + i]);
            }
        }
    }
}

/* The second derivatives of a form are the slopes of its gradient, and all of them are written. */
static void hessians_are_slopes_of_gradients(void **unused)
{
    (void)unused;
    const struct gm_kdv kdv = {.eta = 1.3, .mu = 0.7};
    const struct gm_form *form = gm_field_of(&gm_problem_kdv)->form;
    const size_t d = form->dimension;
    const double h = 1e-4;
    double hessian[GM_LARGEST_FORM * GM_LARGEST_FORM], s[GM_LARGEST_FORM];
    for (size_t i = 0; i < d * d; i++) {
        hessian[i] = 7; /* what was there before */
        s[i % d] = 0.3 + 0.2 * (double)(i % d);
    }
    form->hessians(&kdv, s, hessian, 1);
    for (size_t column = 0; column < d; column++) {
        double left[GM_LARGEST_FORM], right[GM_LARGEST_FORM];
        const double at = s[column];
        s[column] = at - h;
        form->gradients(&kdv, s, left, 1);
        s[column] = at + h;
        form->gradients(&kdv, s, right, 1);
        s[column] = at;
        for (size_t i = 0; i < d; i++) {
            assert_true(fabs(hessian[i * d + column] - (right[i] - left[i]) / (2 * h)) < 1e-8);
        }
    }
}

/* Central differences of order 8. */
static double slope(double (*f)(double at, const void *with), double at, const void *with, double h)
{
    static const double weights[] = {4. / 5, -1. / 5, 4. / 105, -1. / 280};
    double sum = 0;
    for (int k = 1; k <= 4; k++) {
        sum += weights[k - 1] * (f(at + k * h, with) - f(at - k * h, with));
    }
    return sum / h;
}

enum { DEEPEST = 3 };

/* A wave at a place, differentiated along x or t so many times. */
struct wave_of {
    double (*u)(double x, double t);
    double x, t;
    int along_x, along_t;
};

static double differentiated(double at, const void *with)
{
    const struct wave_of *wave = with;
    struct wave_of there = *wave;
    if (wave->along_x > 0) {
        there.x = at;
        there.along_x--;
    } else {
        there.t = at;
        there.along_t--;
    }
    if (there.along_x > 0) {
        return slope(differentiated, there.x, &there, 0.1);
    }
    return there.along_t > 0 ? slope(differentiated, there.t, &there, 0.05) : there.u(there.x, there.t);
}

static double derivative(double (*u)(double x, double t), double x, double t, int along_x, int along_t)
{
    const struct wave_of wave = {u, x, t, along_x, along_t};
    return slope(differentiated, along_x > 0 ? x : t, &wave, along_x > 0 ? 0.1 : 0.05);
}

static double two_kdv_solitons(double x, double t)
{
    static const struct kdv_solution two = {.initial = KDV_TWO, .kdv.eta = 1, .kdv.mu = 1};
    static const struct gm_grid1 ring = {1000, 0.1, -50, 0, false};
    return kdv_exact(&two, &ring, x, t);
}

/* The sum over the images of the two solitons on the line, which holds while none meets another's image. */
static double images_of_two(double x, double t)
{
    double sum = 0;
    for (int n = -2; n <= 2; n++) {
        const double k = 1.2, l = 0.8, part = (k - l) / (k + l);
        const double e = exp(k * (x + 100 * n + 30) - k * k * k * t);
        const double f = exp(l * (x + 100 * n + 15) - l * l * l * t), both = part * part * e * f;
        const double whole = 1 + e + f + both, once = k * e + l * f + (k + l) * both,
                     twice = k * k * e + l * l * f + (k + l) * (k + l) * both;
        sum += 12 * (twice / whole - once / whole * (once / whole));
    }
    return sum;
}

static const struct gm_sine_gordon parting = {.initial = GM_KINK_ANTIKINK, .velocity = 0.5};

static double kink_and_antikink(double x, double t)
{
    return gm_sine_gordon_exact(&parting, 20, x, t);
}

/* What a run is compared with goes on to solve the equation on the ring when waves cross its end and meet
   again, from one meeting to the next. */
static void waves_meet_again_on_the_ring(void **unused)
{
    (void)unused;
    double highest = 0;
    for (double x = -50; x < 50; x += 0.7) {
        for (double t = 0; t <= 60; t += 12) {
            expect_number(two_kdv_solitons(x, t), images_of_two(x, t), 1e-10);
        }
        /* the first meeting is at 19.6, the second at 136, what counts changes in between and after */
        for (double t = 72.3; t < 210; t += 4.7) {
            const double u = two_kdv_solitons(x, t), u_x = derivative(two_kdv_solitons, x, t, 1, 0);
            expect_number(two_kdv_solitons(x + 100, t), u, 1e-10);
            expect_number(derivative(two_kdv_solitons, x, t, 0, 1) + u * u_x +
                              derivative(two_kdv_solitons, x, t, DEEPEST, 0),
                          0, 1e-4);
            highest = fmax(highest, u);
        }
    }
    expect_number(highest, 3 * 1.2 * 1.2, 0.02);
    for (double t = 0.3; t < 130; t += 1.3) {
        for (double x = -20; x < 20; x += 0.7) {
            const double u = kink_and_antikink(x, t);
            expect_number(kink_and_antikink(x + 40, t), u, 1e-8);
            expect_number(derivative(kink_and_antikink, x, t, 0, 2) -
                              derivative(kink_and_antikink, x, t, 2, 0) + sin(u),
                          0, 1e-4);
        }
    }
}

/* On a ring too short for them no solution is known, and none is invented. */
static void short_rings_have_no_exact_waves(void **unused)
{
    (void)unused;
    const struct gm_grid1 wide = {100, 0.4, -20, 0, false}, narrow = {100, 0.1, -5, 0, false};
    const struct kdv_solution one = {.initial = KDV_SOLITON, .kdv.eta = 1, .kdv.mu = 1, .velocity = 1};
    assert_true(kdv_is_known(&one, &wide, 1) && !kdv_is_known(&one, &narrow, 1));
    assert_true(gm_sine_gordon_is_known(&parting, 20, 1000) && !gm_sine_gordon_is_known(&parting, 5, 1000));
    /* two that hardly move part for a while, until their images pull as hard */
    const struct gm_sine_gordon slow = {.initial = GM_KINK_ANTIKINK, .velocity = 1e-6};
    assert_true(gm_sine_gordon_is_known(&slow, 20, 50) && !gm_sine_gordon_is_known(&slow, 20, 1e4));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(waves_meet_again_on_the_ring),
        cmocka_unit_test(short_rings_have_no_exact_waves),
        cmocka_unit_test(levels_agree),
        cmocka_unit_test(all_have_order_two),
        cmocka_unit_test(the_step_may_change),
        cmocka_unit_test(bits_do_not_depend_on_bursts),
        cmocka_unit_test(the_box_solves_the_whole_system),
        cmocka_unit_test(the_form_is_kept_or_not),
        cmocka_unit_test(many_cells),
        cmocka_unit_test(collocation_at_two_points_has_its_order),
        cmocka_unit_test(slopes_are_those_of_the_scheme),
        cmocka_unit_test(dispersive_levels_agree),
        cmocka_unit_test(matrices_are_skew),
        cmocka_unit_test(hessians_are_slopes_of_gradients),
    };
    reference_open("waves.txt");
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    reference_close();
    return failed;
}
