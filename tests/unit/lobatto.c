/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lobatto IIIA-IIIB in space and time, against its tableaux: every element of every level, and steps. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "core/basics.h"
#include "core/field/families/laws/laws.h"
#include "core/field/families/waves/lobatto.h"
#include "core/field/multisymplectic.h"
#include "core/field/problems/problems.h"
#include "core/run.h"
#include "core/schemes.h"

enum { POINTS = 24 };
static const double DX = 0.25;

static const struct gm_settings no_settings;

/* E. Hairer, C. Lubich & G. Wanner, Geometric Numerical Integration (2006), table II.1.1 */
static const double a[3][3] = {{0, 0, 0}, {5. / 24, 8. / 24, -1. / 24}, {1. / 6, 4. / 6, 1. / 6}};
static const double b[3][3] = {{1. / 6, -1. / 6, 0}, {1. / 6, 2. / 6, 0}, {1. / 6, 5. / 6, 0}};
static const double weight[3] = {1. / 6, 4. / 6, 1. / 6};

static struct gm_run *open_run(struct gm_problem *problem, const char *scheme, size_t points, double dt)
{
    static double y[2 * 1000 + 1];
    *problem = gm_problem_sine_gordon;
    problem->line = (struct gm_grid1){.points = points, .dx = DX, .first = 0};
    problem->n = gm_wave_size(points);
    for (size_t i = 0; i < points; i++) {
        const double x = 2 * M_PI * (double)i / (double)points;
        y[i] = 0.5 * sin(x) + 0.3 * cos(2 * x + 0.4);
        y[points + i] = y[i] + dt * (0.2 * cos(x) - 0.1 * sin(3 * x));
    }
    y[2 * points] = dt;
    struct gm_run *run = gm_run_open(problem, gm_scheme_find(scheme), &no_settings, 0, dt, y);
    assert_non_null(run);
    return run;
}

/* w_x at the nodes of a level by the tableaux: the slopes at both sides of every element follow from u at its
   stages, and each is that of the next element; solved for by elimination around the ring. */
static void slopes_by_tableaux(const double *u, double *force)
{
    const double length = 2 * DX;
    double left[3] = {0}, right[3] = {0};
    /* U_m - u_0 = D (sum_n a_mn) w_0 + D^2 sum_n (ab)_mn F_n; the first is F_1, the others w on both sides */
    double ab[3][3] = {{0}};
    for (int m = 0; m < 3; m++) {
        for (int n = 0; n < 3; n++) {
            for (int k = 0; k < 3; k++) {
                ab[m][n] += a[m][k] * b[k][n];
            }
        }
    }
    /* nothing depends on F_2 at u's stages, and F_0 drops out of U_1 - U_2/2 */
    assert_true(fabs(ab[1][2]) < 1e-16 && fabs(ab[2][2]) < 1e-16 && fabs(ab[1][0] - ab[2][0] / 2) < 1e-16);
    for (size_t i = 0; i < POINTS; i += 2) {
        const double ends = u[(i + 2) % POINTS] - u[i], middle = u[i + 1] - u[i];
        force[i + 1] = (middle - ends / 2) / (length * length * (ab[1][1] - ab[2][1] / 2));
    }
    for (size_t i = 0; i < POINTS; i += 2) {
        /* the slope at node i from the element on its right and from that on its left, each linear in F_i */
        const size_t before = (i + POINTS - 2) % POINTS;
        right[0] = (u[(i + 2) % POINTS] - u[i]) / length - length * ab[2][1] * force[i + 1];
        right[1] = -length * ab[2][0];
        left[0] = (u[i] - u[before]) / length - length * ab[2][1] * force[before + 1] +
                  length * weight[1] * force[before + 1];
        left[1] = length * weight[2];
        left[2] = length * (weight[0] - ab[2][0]); /* of F at the other end */
        /* left0 + left1 F_i + left2 F_before = right0 + right1 F_i; left2 is 0 */
        assert_true(fabs(left[2]) < 1e-16);
        force[i] = (right[0] - left[0]) / (left[1] - right[1]);
    }
}

static void find_force(const double *u, double *force)
{
    slopes_by_tableaux(u, force);
    for (size_t i = 0; i < POINTS; i++) {
        force[i] -= sin(u[i]);
    }
}

static void verlet(double *u, double *v, double dt)
{
    double force[POINTS];
    find_force(u, force);
    for (size_t i = 0; i < POINTS; i++) {
        v[i] += dt / 2 * force[i];
        u[i] += dt * v[i];
    }
    find_force(u, force);
    for (size_t i = 0; i < POINTS; i++) {
        v[i] += dt / 2 * force[i];
    }
}

/* Three stages by the tableaux as they stand, u by IIIA and v by IIIB, iterated. */
static void three_stages(double *u, double *v, double dt)
{
    static double q[3][POINTS], p[3][POINTS], force[3][POINTS];
    for (int m = 0; m < 3; m++) {
        memcpy(q[m], u, sizeof q[m]);
        memcpy(p[m], v, sizeof p[m]);
    }
    for (int round = 0; round < 200; round++) {
        for (int m = 0; m < 3; m++) {
            find_force(q[m], force[m]);
        }
        for (size_t i = 0; i < POINTS; i++) {
            for (int m = 0; m < 3; m++) {
                p[m][i] = v[i] + dt * (b[m][0] * force[0][i] + b[m][1] * force[1][i] + b[m][2] * force[2][i]);
            }
            for (int m = 0; m < 3; m++) {
                q[m][i] = u[i] + dt * (a[m][0] * p[0][i] + a[m][1] * p[1][i] + a[m][2] * p[2][i]);
            }
        }
    }
    for (size_t i = 0; i < POINTS; i++) {
        u[i] = q[2][i];
        v[i] += dt * (weight[0] * force[0][i] + weight[1] * force[1][i] + weight[2] * force[2][i]);
    }
}

static void nystrom(double *u, double *v, double dt)
{
    const double outer = 1 / (4 - cbrt(4));
    for (int i = 0; i < 5; i++) {
        verlet(u, v, dt * (i == 2 ? 1 - 4 * outer : outer));
    }
}

static void steps_are_those_of_the_tableaux(void **unused)
{
    (void)unused;
    static const struct {
        const char *name;
        void (*step)(double *u, double *v, double dt);
    } rows[] = {{"lobatto-box2", verlet}, {"lobatto-box4", three_stages}, {"lobatto-nystrom4", nystrom}};
    for (size_t s = 0; s < GM_COUNT(rows); s++) {
        struct gm_problem problem;
        struct gm_run *run = open_run(&problem, rows[s].name, POINTS, 0.1);
        double u[POINTS], v[POINTS], other[POINTS];
        memcpy(u, gm_run_memory(run), sizeof u);
        memcpy(v, gm_run_memory(run) + POINTS, sizeof v);
        memcpy(other, gm_run_state(run) + POINTS, sizeof other);
        double largest = 0;
        for (int n = 0; n < 5; n++) {
            rows[s].step(u, v, 0.1);
            assert_int_equal(gm_run_advance(run, 1), GM_OK);
            for (size_t i = 0; i < POINTS; i++) {
                largest = fmax(largest, fabs(u[i] - gm_run_state(run)[i]));
                largest = fmax(largest, fabs(v[i] - gm_run_memory(run)[POINTS + i]));
                /* the first step leads to the level that the state came with */
                largest = fmax(largest, n == 0 ? fabs(u[i] - other[i]) : 0);
            }
        }
        print_message("%s: %.1e from the tableaux\n", rows[s].name, largest);
        assert_true(largest < 1e-12);
        gm_run_close(run);
    }
}

/* The multisymplectic law at round-off, by tangents of the scheme and by differences of its steps. */
static void the_law_holds(void **unused)
{
    (void)unused;
    static const char *const names[] = {"lobatto-box2", "lobatto-box4", "lobatto-nystrom4"};
    for (size_t s = 0; s < GM_COUNT(names); s++) {
        struct gm_problem problem;
        struct gm_run *run = open_run(&problem, names[s], 100, 0.1);
        assert_int_equal(gm_run_advance(run, 20), GM_OK);
        const struct gm_scheme *scheme = gm_scheme_find(names[s]);
        const double law = gm_form_residual((struct gm_law){&problem, scheme, 0.1, gm_run_state(run),
                                                            gm_run_memory(run), .by_differences = false});
        const double defect = gm_form_residual((struct gm_law){&problem, scheme, 0.1, gm_run_state(run),
                                                               gm_run_memory(run), .by_differences = true});
        print_message("%s: %.1e, by differences %.1e\n", names[s], law, defect);
        assert_true(law < 1e-11 && defect < 1e-8);
        /* other weights in time are caught */
        if (s == 1) {
            struct gm_lobatto_row row = *(const struct gm_lobatto_row *)scheme->coefficients;
            row.kick[0] = row.kick[2] = 0.17;
            row.kick[1] = 0.66;
            struct gm_scheme wrong = *scheme;
            wrong.coefficients = &row;
            assert_true(gm_form_residual((struct gm_law){&problem, &wrong, 0.1, gm_run_state(run),
                                                         gm_run_memory(run), .by_differences = false}) >
                        1e-6);
        }
        gm_run_close(run);
    }
}

/* A hundredth below the limit of linear theory a noisy field stays, a hundredth above it blows up. */
static void steps_are_bound_as_told(void **unused)
{
    (void)unused;
    static const char *const names[] = {"lobatto-box2", "lobatto-box4", "lobatto-nystrom4"};
    for (size_t s = 0; s < GM_COUNT(names); s++) {
        const struct gm_scheme *scheme = gm_scheme_find(names[s]);
        for (int above = 0; above < 2; above++) {
            struct gm_problem problem = gm_problem_wave;
            problem.line = (struct gm_grid1){.points = POINTS, .dx = DX};
            problem.n = gm_wave_size(POINTS);
            double y[2 * POINTS + 1];
            unsigned noise = 7;
            for (size_t i = 0; i < 2 * POINTS; i++) {
                noise = noise * 1664525u + 1013904223u;
                y[i] = i < POINTS ? noise / 4294967296. : y[i - POINTS];
            }
            const double dt = gm_wave_longest_step(&problem, scheme, y) * (above ? 1.01 : 0.99);
            y[2 * POINTS] = dt;
            struct gm_run *run = gm_run_open(&problem, scheme, &no_settings, 0, dt, y);
            assert_int_equal(gm_run_advance(run, 2000), above ? GM_BLOW_UP : GM_OK);
            gm_run_close(run);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(steps_are_those_of_the_tableaux),
        cmocka_unit_test(the_law_holds),
        cmocka_unit_test(steps_are_bound_as_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
