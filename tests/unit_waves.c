/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Schemes for waves against levels computed elsewhere, and their laws against the formulas. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "core/fourier.h"
#include "core/multisymplectic.h"
#include "core/problems/dispersive.h"
#include "core/problems/problems.h"
#include "core/problems/sine_gordon.h"
#include "core/ring.h"
#include "core/run.h"
#include "core/sine.h"
#include "core/wave_laws.h"
#include "tests/reference_waves.h"

enum { CASES = sizeof reference_waves / sizeof reference_waves[0] };

static const struct gm_settings no_settings;

static void expect_level(const double *u, const double *reference, double tolerance, const char *what)
{
    double error = 0, scale = 0;
    for (size_t i = 0; i < REFERENCE_POINTS; i++) {
        error = fmax(error, fabs(u[i] - reference[i]));
        scale = fmax(scale, fabs(reference[i]));
    }
    if (!(error <= tolerance * scale)) {
        fail_msg("%s: error %.2e, tolerance %.2e", what, error / scale, tolerance);
    }
}

static struct gm_problem wave_problem(size_t points, double half_length, double jump)
{
    struct gm_problem problem = gm_problem_sine_gordon;
    problem.line = (struct gm_line){points, 2 * half_length / (double)points, -half_length, jump};
    problem.n = gm_wave_size(points);
    return problem;
}

static void expect_number(double value, double reference, double tolerance)
{
    if (!(fabs(value - reference) <= tolerance * fmax(1, fabs(reference)))) {
        fail_msg("%.17g is not %.17g", value, reference);
    }
}

static void levels_agree(void **unused)
{
    (void)unused;
    for (size_t c = 0; c < CASES; c++) {
        const struct reference_wave *reference = &reference_waves[c];
        const double jump = strcmp(reference->initial, "kink") == 0       ? 2 * M_PI
                            : strcmp(reference->initial, "antikink") == 0 ? -2 * M_PI
                                                                          : 0;
        const struct gm_problem problem = wave_problem(REFERENCE_POINTS, 20, jump);
        double y[2 * REFERENCE_POINTS + 1];
        memcpy(y, reference->start[0], REFERENCE_POINTS * sizeof *y);
        memcpy(y + REFERENCE_POINTS, reference->start[1], REFERENCE_POINTS * sizeof *y);
        y[2 * REFERENCE_POINTS] = reference->dt;
        const double tolerance = 1e-12 + 100 * (reference->conditioning + reference->agreement);
        expect_number(gm_wave_energy(&problem, y), reference->energy[0], 1e-13);
        expect_number(gm_wave_cell_energy(&problem, y), reference->cell_energy[0], 1e-13);
        struct gm_run *run =
            gm_run_open(&problem, gm_scheme_find(reference->scheme), &no_settings, 0, reference->dt, y);
        assert_non_null(run);
        assert_int_equal(gm_run_advance(run, 20), GM_OK);
        expect_level(gm_run_state(run), reference->level_20, tolerance, reference->scheme);
        expect_number(gm_wave_energy(&problem, gm_run_state(run)), reference->energy[1], 10 * tolerance);
        expect_number(gm_wave_cell_energy(&problem, gm_run_state(run)), reference->cell_energy[1],
                      10 * tolerance);
        assert_int_equal(gm_run_advance(run, 80), GM_OK);
        expect_level(gm_run_state(run), reference->level_100, tolerance, reference->scheme);
        expect_number(gm_wave_energy(&problem, gm_run_state(run)), reference->energy[2], 10 * tolerance);
        expect_number(gm_wave_cell_energy(&problem, gm_run_state(run)), reference->cell_energy[2],
                      10 * tolerance);
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
    static const char *const names[] = {"leapfrog",     "energy-conserving", "box",       "euler-box",
                                        "midpoint-box", "gauss-box2",        "gauss-box3"};
    for (size_t s = 0; s < sizeof names / sizeof names[0]; s++) {
        struct gm_problem problem[3];
        struct gm_run *one = breather_run(&problem[0], names[s], 97, 0.1);
        struct gm_run *all = breather_run(&problem[1], names[s], 97, 0.1);
        struct gm_run *other = breather_run(&problem[2], names[s], 97, 0.1);
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

/* The box in all its variables, through the matrices and the gradient of the facet: from the levels of a run
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
            double gradient[3];
            problem.field->gradient(problem.parameters, mean, gradient);
            for (size_t row = 0; row < 3; row++) {
                double residual = -gradient[row];
                for (size_t k = 0; k < 3; k++) {
                    residual +=
                        problem.field->m[3 * row + k] * s_t[k] + problem.field->k[3 * row + k] * s_x[k];
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
        const double told = gm_wave_energy_residual(&problem, run->scheme, dt, gm_run_state(run));
        assert_true(fabs(told - law_largest) < 1e-12);
        memcpy(v, v_next, sizeof v);
    }
    if (!(worst < 1e-9 && worst_law < 1e-9)) {
        fail_msg("the box leaves %.2e, its energy law %.2e", worst, worst_law);
    }
    gm_run_close(run);
}

static const struct gm_kdv soliton = {
    .initial = GM_KDV_SOLITON, .eta = 1, .mu = 1, .velocity = 1, .position = -5};
static const struct gm_nls bright = {
    .initial = GM_NLS_SOLITON, .amplitude = 1, .velocity = 1, .position = -5};

static struct gm_problem kdv_problem(size_t points)
{
    struct gm_problem problem = gm_problem_kdv;
    problem.kdv = &soliton;
    problem.line = (struct gm_line){points, 40.0 / (double)points, -20, 0};
    problem.n = gm_wave_size(points);
    return problem;
}

static struct gm_problem nls_problem(size_t points)
{
    struct gm_problem problem = gm_problem_nls;
    problem.nls = &bright;
    problem.line = (struct gm_line){points, 40.0 / (double)points, -20, 0};
    problem.n = 2 * points;
    return problem;
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
    const double residual = gm_form_residual(problem, scheme, dt, state, memory);
    const double defect = gm_form_defect(problem, scheme, dt, state, memory);
    struct gm_family family = *scheme->family;
    struct gm_scheme wrong = *scheme;
    rubbed = scheme->family;
    family.loop = rub;
    wrong.family = &family;
    const double friction = gm_form_defect(problem, &wrong, dt, state, memory);
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
    } of_waves[] = {{"leapfrog", true},          {"euler-box", true},  {"box", true},
                    {"midpoint-box", true},      {"gauss-box2", true}, {"gauss-box3", true},
                    {"energy-conserving", false}};
    enum { POINTS = 101 };
    static double y[2 * POINTS + 1];
    for (size_t s = 0; s < sizeof of_waves / sizeof of_waves[0]; s++) {
        struct gm_problem problem = wave_problem(POINTS, 20, 0);
        problem.parameters = &breather;
        gm_sine_gordon_levels(&problem, 0, 0.1, y);
        expect_law(&problem, of_waves[s].name, 0.1, y, of_waves[s].kept);
    }
    /* an odd number of points, or v, the mean of which over a side is the slope of u, need not exist */
    const struct gm_problem kdv = kdv_problem(POINTS), nls = nls_problem(POINTS);
    gm_kdv_levels(&kdv, 0.05, y);
    expect_law(&kdv, "box", 0.05, y, true);
    gm_kdv_levels(&kdv, 0.01, y);
    expect_law(&kdv, "euler-box", 0.01, y, true);
    expect_law(&kdv, "midpoint-box", 0.01, y, true);
    gm_kdv_levels(&kdv, -0.01, y);
    expect_law(&kdv, "euler-box", -0.01, y, true);
    expect_law(&kdv, "midpoint-box", -0.01, y, true);
    for (size_t i = 0; i < POINTS; i++) {
        gm_nls_exact(&bright, &nls.line, gm_line_node(&nls.line, i), 0, &y[i], &y[POINTS + i]);
    }
    expect_law(&nls, "box", 0.02, y, true);
    expect_law(&nls, "euler-box", 0.02, y, true);
    expect_law(&nls, "euler-box", -0.02, y, true);
    struct gm_run *run = gm_run_open(&nls, gm_scheme_find("split-step2"), &no_settings, 0, 0.02, y);
    assert_true(isnan(gm_form_residual(&nls, run->scheme, 0.02, y, NULL)));
    gm_run_close(run);
}

/* Collocation at one point is the box, whatever solves it; with an even number of points as well. At two
   points it comes closer, by its order. */
static void collocation_at_one_point_is_the_box(void **unused)
{
    (void)unused;
    for (size_t points = 200; points <= 201; points++) {
        struct gm_problem problem[2];
        struct gm_run *box = breather_run(&problem[0], "box", points, 0.1);
        struct gm_run *gauss = breather_run(&problem[1], "gauss-box2", points, 0.1);
        assert_int_equal(gm_run_advance(box, 100), GM_OK);
        assert_int_equal(gm_run_advance(gauss, 100), GM_OK);
        for (size_t i = 0; i < points; i++) {
            assert_true(fabs(gm_run_state(box)[i] - gm_run_state(gauss)[i]) < 1e-8);
        }
        gm_run_close(box);
        gm_run_close(gauss);
    }
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

/* The box for Korteweg-de Vries and nonlinear Schroedinger, and leapfrog for the former. */
static void dispersive_levels_agree(void **unused)
{
    (void)unused;
    struct gm_problem problem = kdv_problem(REFERENCE_POINTS);
    double y[2 * REFERENCE_POINTS + 1] = {0};
    memcpy(y, kdv_one_soliton_level_0, sizeof kdv_one_soliton_level_0);
    y[2 * REFERENCE_POINTS] = 0.05;
    expect_number(gm_kdv_mass(&problem, y), kdv_box_invariants[0], 1e-13);
    expect_number(gm_kdv_square(&problem, y), kdv_box_invariants[1], 1e-13);
    struct gm_run *run = gm_run_open(&problem, gm_scheme_find("box"), &no_settings, 0, 0.05, y);
    assert_int_equal(gm_run_advance(run, 20), GM_OK);
    expect_level(gm_run_state(run), kdv_box_level_20, 1e-12 + 100 * 4.6e-15, "kdv box");
    expect_number(gm_kdv_mass(&problem, gm_run_state(run)), kdv_box_invariants[2], 1e-12);
    expect_number(gm_kdv_square(&problem, gm_run_state(run)), kdv_box_invariants[3], 1e-11);
    gm_run_close(run);

    const struct gm_kdv cosine = {.initial = GM_KDV_COSINE, .eta = 1, .mu = 0.022 * 0.022};
    problem.kdv = &cosine;
    problem.line = (struct gm_line){REFERENCE_POINTS, 2.0 / REFERENCE_POINTS, 0, 0};
    gm_kdv_levels(&problem, 1e-3, y);
    expect_level(y + REFERENCE_POINTS, kdv_cosine_level_1, 1e-15, "second level of the cosine");
    memcpy(y, kdv_cosine_level_0, sizeof kdv_cosine_level_0);
    memcpy(y + REFERENCE_POINTS, kdv_cosine_level_1, sizeof kdv_cosine_level_1);
    run = gm_run_open(&problem, gm_scheme_find("zabusky-kruskal"), &no_settings, 0, 1e-3, y);
    assert_int_equal(gm_run_advance(run, 20), GM_OK);
    expect_level(gm_run_state(run), kdv_zabusky_kruskal_level_20, 1e-12 + 100 * 2.5e-15, "zabusky-kruskal");
    assert_true(fabs(gm_kdv_mass(&problem, gm_run_state(run))) < 1e-13);
    gm_run_close(run);

    problem = nls_problem(REFERENCE_POINTS);
    memcpy(y, nls_one_soliton_level_0_re, sizeof nls_one_soliton_level_0_re);
    memcpy(y + REFERENCE_POINTS, nls_one_soliton_level_0_im, sizeof nls_one_soliton_level_0_im);
    expect_number(gm_nls_charge(&problem, y), nls_box_invariants[0], 1e-13);
    expect_number(gm_nls_energy(&problem, y), nls_box_invariants[1], 1e-13);
    run = gm_run_open(&problem, gm_scheme_find("box"), &no_settings, 0, 0.05, y);
    assert_int_equal(gm_run_advance(run, 20), GM_OK);
    expect_level(gm_run_state(run), nls_box_level_20_re, 1e-12 + 100 * 1.1e-14, "nls box");
    expect_level(gm_run_state(run) + REFERENCE_POINTS, nls_box_level_20_im, 1e-12 + 100 * 1.1e-14, "nls box");
    expect_number(gm_nls_charge(&problem, gm_run_state(run)), nls_box_invariants[2], 1e-12);
    expect_number(gm_nls_energy(&problem, gm_run_state(run)), nls_box_invariants[3], 1e-11);
    gm_run_close(run);
}

/* The schemes of nodes against M D_t s + K D_x s - grad S of the facet, with all its variables: after a step
   every equation holds at every node. */
static void nodes_solve_the_whole_system(void **unused)
{
    (void)unused;
    enum { POINTS = 101, PHI = 0, U, V, W, DIMENSION };
    static const char *const names[] = {"euler-box", "midpoint-box"};
    const double dt = 0.01;
    for (size_t s = 0; s < 2; s++) {
        const bool centred = s == 1;
        struct gm_problem problem = kdv_problem(POINTS);
        problem.parameters = problem.kdv;
        double y[2 * POINTS + 1], u[3][POINTS], phi[3][POINTS + 1] = {{0}}, v[POINTS], w[POINTS];
        gm_kdv_levels(&problem, dt, y);
        memcpy(u[0], y, sizeof u[0]);
        memcpy(u[1], y + POINTS, sizeof u[1]);
        struct gm_run *run =
            gm_run_open(&problem, gm_scheme_find_for(names[s], &problem), &no_settings, 0, dt, y);
        assert_int_equal(gm_run_advance(run, 2), GM_OK);
        memcpy(u[2], gm_run_state(run), sizeof u[2]);
        gm_run_close(run);
        const double dx = problem.line.dx, wide = centred ? 2 * dx : dx, long_step = centred ? 2 * dt : dt;
        for (size_t n = 0; n < 3; n++) {
            for (size_t k = 0, at = 0; k + 1 < POINTS; k++) {
                const size_t next = (at + (centred ? 2 : 1)) % POINTS;
                phi[n][next] = phi[n][at] + wide * u[n][centred ? (at + 1) % POINTS : next];
                at = next;
            }
        }
        double rise = 0;
        for (size_t i = 0; i < POINTS; i++) {
            const size_t l = (i + POINTS - 1) % POINTS, r = (i + 1) % POINTS;
            v[i] = problem.kdv->mu * (centred ? u[1][r] - u[1][l] : u[1][i] - u[1][l]) / wide;
        }
        for (size_t i = 0; i < POINTS; i++) {
            const size_t l = (i + POINTS - 1) % POINTS, r = (i + 1) % POINTS;
            const double fall = (phi[centred ? 2 : 1][i] - phi[0][i]) / (2 * long_step);
            w[i] = fall + (centred ? v[r] - v[l] : v[r] - v[i]) / wide + u[1][i] * u[1][i] / 2;
        }
        /* the exact levels differ in mass by 1e-9, by which phi and w do not close around the ring */
        for (size_t i = 0; i + 1 < POINTS; i++) {
            const size_t l = (i + POINTS - 1) % POINTS, r = i + 1;
            const double u_t = (u[2][i] - u[centred ? 0 : 1][i]) / long_step;
            rise = fmax(rise, fabs(u_t / 2 + (centred ? w[r] - w[l] : w[r] - w[i]) / wide));
        }
        if (!(rise < 1e-10)) {
            fail_msg("%s leaves %.2e of its first equation", names[s], rise);
        }
    }
}

/* The linear limits of the schemes of nodes: just below them a run stays bounded, just above it does not. */
static void nodes_are_stable_below_their_limits(void **unused)
{
    (void)unused;
    enum { POINTS = 200 };
    const struct gm_problem kdv = kdv_problem(POINTS), nls = nls_problem(POINTS);
    const double dx = kdv.line.dx;
    const struct {
        const struct gm_problem *problem;
        const char *name;
        double limit;
    } cases[] = {
        {&kdv, "euler-box", dx * dx * dx / 4},
        {&kdv, "midpoint-box", dx * dx * dx},
        {&nls, "euler-box", dx * dx / 2},
    };
    static double y[2 * POINTS + 1];
    for (size_t c = 0; c < sizeof cases / sizeof cases[0]; c++) {
        for (int k = 0; k < 4; k++) {
            /* backwards as well */
            const double dt = (k % 2 ? 1.06 : 0.94) * cases[c].limit * (k < 2 ? 1 : -1);
            if (cases[c].problem == &kdv) {
                gm_kdv_levels(&kdv, dt, y);
            } else {
                for (size_t i = 0; i < POINTS; i++) {
                    gm_nls_exact(&bright, &nls.line, gm_line_node(&nls.line, i), 0, &y[i], &y[POINTS + i]);
                }
            }
            struct gm_run *run =
                gm_run_open(cases[c].problem, gm_scheme_find_for(cases[c].name, cases[c].problem),
                            &no_settings, 0, dt, y);
            const bool stays = gm_run_advance(run, lround(10 / fabs(dt))) == GM_OK;
            if (stays != (k % 2 == 0)) {
                fail_msg("%s, %s: dt = %g is %s", cases[c].problem->name, cases[c].name, dt,
                         gm_status_name(run->status));
            }
            gm_run_close(run);
        }
    }
}

/* Where the iteration of the boxes no longer contracts Newton's method goes on; what it finds solves the
   equations, and small steps give the same by either. */
static void large_steps_are_solved(void **unused)
{
    (void)unused;
    static const double steps[] = {0.5, 1.25, 1.9, 2};
    for (size_t s = 0; s < sizeof steps / sizeof steps[0]; s++) {
        enum { POINTS = 201 };
        const double dt = steps[s];
        struct gm_problem problem;
        struct gm_run *run = breather_run(&problem, "box", POINTS, dt);
        double u[3][POINTS];
        for (size_t n = 0; n < 3; n++) {
            assert_int_equal(gm_run_advance(run, n ? 1 : 7), GM_OK);
            memcpy(u[n], gm_run_state(run), sizeof u[n]);
        }
        const double dx = problem.line.dx;
        double worst = 0;
        for (size_t i = 0; i < POINTS; i++) {
            const size_t l = (i + POINTS - 1) % POINTS, r = (i + 1) % POINTS;
            double means[3], bends[3], force = 0;
            for (size_t n = 0; n < 3; n++) {
                means[n] = (u[n][r] + 2 * u[n][i] + u[n][l]) / 4;
                bends[n] = u[n][r] - 2 * u[n][i] + u[n][l];
            }
            for (size_t n = 0; n < 2; n++) {
                force += sin((u[n][i] + u[n][r] + u[n + 1][i] + u[n + 1][r]) / 4) / 4;
                force += sin((u[n][i] + u[n][l] + u[n + 1][i] + u[n + 1][l]) / 4) / 4;
            }
            worst = fmax(worst, fabs((means[2] - 2 * means[1] + means[0]) / (dt * dt) -
                                     (bends[2] + 2 * bends[1] + bends[0]) / (4 * dx * dx) + force));
        }
        if (!(worst < 1e-11)) {
            fail_msg("dt = %g leaves %.2e", dt, worst);
        }
        gm_run_close(run);
    }
    enum { POINTS = 201 };
    double y[2 * POINTS + 1];
    const struct gm_problem kdv = kdv_problem(POINTS), nls = nls_problem(POINTS);
    for (int k = 0; k < 3; k++) {
        gm_kdv_levels(&kdv, ldexp(1, k), y);
        struct gm_run *run =
            gm_run_open(&kdv, gm_scheme_find_for("box", &kdv), &no_settings, 0, ldexp(1, k), y);
        const double mass = gm_kdv_mass(&kdv, y);
        assert_int_equal(gm_run_advance(run, 20), GM_OK);
        expect_number(gm_kdv_mass(&kdv, gm_run_state(run)), mass, 1e-11);
        gm_run_close(run);
        for (size_t i = 0; i < POINTS; i++) {
            gm_nls_exact(&bright, &nls.line, gm_line_node(&nls.line, i), 0, &y[i], &y[POINTS + i]);
        }
        run = gm_run_open(&nls, gm_scheme_find_for("box", &nls), &no_settings, 0, ldexp(1, k), y);
        const double charge = gm_nls_charge(&nls, y);
        assert_int_equal(gm_run_advance(run, 20), GM_OK);
        expect_number(gm_nls_charge(&nls, gm_run_state(run)), charge, 1e-12);
        gm_run_close(run);
    }
}

/* The matrices of every equation are skew. */
static void matrices_are_skew(void **unused)
{
    (void)unused;
    const struct gm_problem *const problems[] = {&gm_problem_sine_gordon, &gm_problem_wave, &gm_problem_kdv,
                                                 &gm_problem_nls};
    for (size_t p = 0; p < 4; p++) {
        const struct gm_field *field = problems[p]->field;
        for (size_t i = 0; i < field->dimension; i++) {
            for (size_t k = 0; k < field->dimension; k++) {
                assert_true(field->m[i * field->dimension + k] == -field->m[k * field->dimension + i]);
                assert_true(field->k[i * field->dimension + k] == -field->k[k * field->dimension + i]);
            }
        }
    }
}

static void sines_are_sines(void **unused)
{
    (void)unused;
    for (int k = -40000; k <= 40000; k++) {
        const double x = 0.0123456789 * k * (k % 5 ? 1 : 200);
        double sine = 0;
        gm_sines(&x, &sine, 1);
        assert_true(fabs(sine - sin(x)) <= 2.3e-16);
    }
    const double none = NAN, infinite = INFINITY;
    double sine = 0;
    gm_sines(&none, &sine, 1);
    assert_true(isnan(sine));
    gm_sines(&infinite, &sine, 1);
    assert_true(isnan(sine));
}

/* Both ring solvers against the matrix. */
static void rings_are_solved(void **unused)
{
    (void)unused;
    static const size_t sizes[] = {2, 3, 8, 101};
    for (size_t s = 0; s < 4; s++) {
        const size_t n = sizes[s];
        double b[101], x[101];
        for (size_t i = 0; i < n; i++) {
            b[i] = sin(1 + 3.7 * (double)i);
        }
        double f[101], alternating = 0;
        for (size_t i = 0; i < n; i++) {
            alternating += (i % 2 ? -b[i] : b[i]) / (double)n;
        }
        for (size_t i = 0; i < n; i++) {
            f[i] = b[i] - (n % 2 ? 0 : i % 2 ? -alternating : alternating);
            x[i] = b[i] = f[i];
        }
        gm_ring_unaverage(f, n);
        for (size_t i = 0; i < n; i++) {
            assert_true(fabs((f[i] + f[(i + 1) % n]) / 2 - b[i]) < 1e-13);
        }
        const struct gm_ring ring = gm_ring_make(n, 2.5, -1.1);
        gm_ring_solve(&ring, x);
        for (size_t i = 0; i < n; i++) {
            assert_true(fabs(2.5 * x[i] - 1.1 * (x[(i + 1) % n] + x[(i + n - 1) % n]) - b[i]) < 1e-13);
        }
        for (size_t reach = 1; reach <= 2 && 2 * reach < n; reach++) {
            struct gm_ring_band band;
            double two[202], matrix[2][2][5][101], given[202];
            assert_true(gm_ring_band_open(&band, n, 2, reach));
            gm_ring_band_clear(&band);
            for (size_t i = 0; i < 2 * n; i++) {
                two[i] = given[i] = sin(0.3 + (double)i);
            }
            for (size_t i = 0; i < n; i++) {
                for (size_t part = 0; part < 4; part++) {
                    for (long by = -(long)reach; by <= (long)reach; by++) {
                        double *entry = &matrix[part / 2][part % 2][by + 2][i];
                        *entry = cos(7.1 * (double)i + 3.3 * (double)part + 1.7 * (double)by);
                        gm_ring_band_add(&band, i, part / 2, by, part % 2, *entry);
                    }
                }
            }
            assert_true(gm_ring_band_solve(&band, two));
            for (size_t i = 0; i < 2 * n; i++) {
                double left = -given[i];
                for (size_t k = 0; k < 2 * (2 * reach + 1); k++) {
                    const size_t column = k % 2, by = k / 2 + 2 - reach;
                    left += matrix[i / n][column][by][i % n] * two[column * n + (i % n + n + by - 2) % n];
                }
                assert_true(fabs(left) < 1e-11);
            }
            gm_ring_band_close(&band);
        }
        for (int power = 1; power <= 3; power++) {
            const double complex mean = power == 2 ? 3 * I : 3, difference = 0.2;
            const double h = 0.3;
            struct gm_ring_roots roots;
            assert_true(gm_ring_roots_make(&roots, n, power, mean, difference, h));
            double complex f[101];
            double re[101], im[101], scratch[202];
            for (size_t i = 0; i < n; i++) {
                re[i] = b[i];
                im[i] = cos((double)i);
                f[i] = 0;
            }
            gm_ring_roots_solve(&roots, re, im, scratch);
            static const int binomial[4][4] = {{1}, {1, 1}, {1, 2, 1}, {1, 3, 3, 1}};
            for (size_t i = 0; i < n; i++) {
                for (int k = 0; k <= power; k++) {
                    const double sign = (power - k) % 2 ? -1 : 1;
                    const double complex entry =
                        binomial[power][k] * (mean / pow(2, power) + sign * difference / pow(h, power));
                    f[i] += entry * (re[(i + (size_t)k) % n] + I * im[(i + (size_t)k) % n]);
                }
                assert_true(cabs(f[i] - (b[i] + I * cos((double)i))) < 1e-11);
            }
        }
    }
}

/* Transforms against their sums; lengths with small factors alone, and primes. */
static void transforms_of_any_length(void **unused)
{
    (void)unused;
    static const size_t sizes[] = {1, 2, 3, 64, 101, 300, 809};
    for (size_t s = 0; s < sizeof sizes / sizeof sizes[0]; s++) {
        const size_t n = sizes[s];
        double complex x[809], y[809];
        for (size_t j = 0; j < n; j++) {
            x[j] = y[j] = sin(1 + 3.7 * (double)j) + I * cos(0.3 * (double)(j * j));
        }
        struct gm_fourier *fourier = gm_fourier_open(n);
        gm_fourier_forward(fourier, y);
        for (size_t k = 0; k < n; k += 1 + n / 20) {
            double complex sum = 0;
            for (size_t j = 0; j < n; j++) {
                sum += x[j] * cexp(-2 * M_PI * I * (double)(j * k % n) / (double)n);
            }
            assert_true(cabs(y[k] - sum) < 1e-12 * (double)n);
        }
        gm_fourier_inverse(fourier, y);
        for (size_t j = 0; j < n; j++) {
            assert_true(cabs(y[j] - x[j]) < 1e-12);
        }
        gm_fourier_close(fourier);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(levels_agree),
        cmocka_unit_test(all_have_order_two),
        cmocka_unit_test(the_step_may_change),
        cmocka_unit_test(bits_do_not_depend_on_bursts),
        cmocka_unit_test(the_box_solves_the_whole_system),
        cmocka_unit_test(the_form_is_kept_or_not),
        cmocka_unit_test(collocation_at_one_point_is_the_box),
        cmocka_unit_test(dispersive_levels_agree),
        cmocka_unit_test(nodes_solve_the_whole_system),
        cmocka_unit_test(nodes_are_stable_below_their_limits),
        cmocka_unit_test(large_steps_are_solved),
        cmocka_unit_test(matrices_are_skew),
        cmocka_unit_test(sines_are_sines),
        cmocka_unit_test(rings_are_solved),
        cmocka_unit_test(transforms_of_any_length),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
