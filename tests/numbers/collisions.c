/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Solitons that meet: how far they are shifted, by theory and by schemes whose error falls with the square of
   the mesh, and the box against a Fourier method with the same step. */
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
#include "core/field/problems/problems.h"
#include "core/run.h"
#include "core/schemes.h"
#include "tests/common/kdv_solutions.h"
#include "tests/numbers/field_runs.h"

static const struct gm_settings no_settings;

enum { SOLITONS = 3 };
static const double rate[SOLITONS] = {1.2, 0.9, 0.6}, start[SOLITONS] = {-50, -32, -14};

/* u = 12 (ln F)_xx of three solitons, u_t + u u_x + u_xxx = 0: F is the sum over the subsets of
       product of exp(k (x - x0) - k^3 t) times product of ((ki - kj)/(ki + kj))^2 over the pairs
   (R. Hirota, Phys. Rev. Lett. 27 (1971) 1192). */
static double three_solitons(double x, double t)
{
    double powers[1 << SOLITONS], slopes[1 << SOLITONS], largest = -INFINITY;
    for (int set = 0; set < 1 << SOLITONS; set++) {
        powers[set] = slopes[set] = 0;
        for (int i = 0; i < SOLITONS; i++) {
            if (!(set >> i & 1)) {
                continue;
            }
            powers[set] += rate[i] * (x - start[i]) - rate[i] * rate[i] * rate[i] * t;
            slopes[set] += rate[i];
            for (int j = 0; j < i; j++) {
                if (set >> j & 1) {
                    powers[set] += 2 * log(fabs(rate[i] - rate[j]) / (rate[i] + rate[j]));
                }
            }
        }
        largest = fmax(largest, powers[set]);
    }
    double sum = 0, first = 0, second = 0;
    for (int set = 0; set < 1 << SOLITONS; set++) {
        const double weight = exp(powers[set] - largest);
        sum += weight;
        first += slopes[set] * weight;
        second += slopes[set] * slopes[set] * weight;
    }
    return 12 * (second / sum - first / sum * (first / sum));
}

/* Where a positive field is highest within `reach` of a place: of the parabola through three logarithms, of
   five with the fourth differences. */
static double crest(const struct gm_grid1 *line, const double *u, double place, double reach)
{
    size_t top = 0;
    double highest = -INFINITY;
    for (size_t i = 2; i + 2 < line->points; i++) {
        if (fabs(gm_grid1_node(line, i) - place) < reach && u[i] > highest) {
            highest = u[i];
            top = i;
        }
    }
    assert_true(top > 0);
    double at = 0;
    for (int round = 0; round < 20; round++) {
        double l[5], slope = 0, bend = 0;
        for (int k = 0; k < 5; k++) {
            l[k] = log(u[top + (size_t)k - 2]);
        }
        const double d1 = (l[0] - 8 * l[1] + 8 * l[3] - l[4]) / 12;
        const double d2 = (-l[0] + 16 * l[1] - 30 * l[2] + 16 * l[3] - l[4]) / 12;
        const double d3 = (-l[0] + 2 * l[1] - 2 * l[3] + l[4]) / 2;
        const double d4 = l[0] - 4 * l[1] + 6 * l[2] - 4 * l[3] + l[4];
        slope = d1 + at * (d2 + at * (d3 / 2 + at * d4 / 6));
        bend = d2 + at * (d3 + at * d4 / 2);
        at -= slope / bend;
    }
    return gm_grid1_node(line, top) + at * line->dx;
}

/* What the solitons have gained over their free paths k^2 t when all have met: each is moved forwards by
   (2/ki) ln((ki + kj)/(ki - kj)) by every slower one and backwards as far by every faster one. */
static void three_korteweg_de_vries_solitons(void **unused)
{
    (void)unused;
    const double until = 100;
    double error[2][SOLITONS] = {{0}};
    for (int k = 0; k < 2; k++) {
        const struct kdv_solution kdv = {.initial = KDV_TWO, .kdv.eta = 1, .kdv.mu = 1};
        struct gm_problem problem = gm_problem_kdv;
        const size_t points = 1000u << k;
        const double dt = ldexp(0.1, -k);
        problem.parameters = &kdv;
        problem.line = (struct gm_grid1){.points = points, .dx = 240 / (double)points, .first = -120};
        problem.n = gm_wave_size(points);
        double *y = malloc(problem.n * sizeof *y);
        for (size_t i = 0; i < points; i++) {
            y[i] = three_solitons(gm_grid1_node(&problem.line, i), 0);
            y[points + i] = three_solitons(gm_grid1_node(&problem.line, i), dt);
        }
        y[2 * points] = dt;
        double before[SOLITONS];
        for (int i = 0; i < SOLITONS; i++) {
            before[i] = crest(&problem.line, y, start[i], 8);
        }
        struct gm_run *run = gm_run_open(&problem, gm_scheme_find("box"), &no_settings, 0, dt, y);
        assert_int_equal(gm_run_until(run, until), GM_OK);
        for (int i = 0; i < SOLITONS; i++) {
            double shift = 0;
            for (int j = 0; j < SOLITONS; j++) {
                shift += i == j ? 0
                                : (rate[i] > rate[j] ? 2 : -2) / rate[i] *
                                      log((rate[i] + rate[j]) / fabs(rate[i] - rate[j]));
            }
            const double arrival = before[i] + rate[i] * rate[i] * until + shift;
            const double found = crest(&problem.line, gm_run_state(run), arrival, 6);
            error[k][i] = found - arrival;
            print_message("%zu points, k = %g: shift %.4f, of theory %.4f\n", points, rate[i],
                          found - arrival + shift, shift);
        }
        gm_run_close(run);
        free(y);
    }
    for (int i = 0; i < SOLITONS; i++) {
        const double order = log2(error[0][i] / error[1][i]);
        print_message("k = %g: order %.3f\n", rate[i], order);
        assert_true(fabs(order - 2) < 0.15);
        assert_true(fabs((4 * error[1][i] - error[0][i]) / 3) < 0.02);
    }
}

/* Two solitons sqrt(2) a sech(a x) with the velocities c and -c pass through each other and are each moved
   forwards by (1/a) ln(1 + 4 a^2/c^2): of V.E. Zakharov and A.B. Shabat (Sov. Phys. JETP 34 (1972) 62),
   (1/eta) ln |(l1 - l2*)/(l1 - l2)| with l = -+c/4 + i eta, eta = a/2. */
static void two_schroedinger_solitons(void **unused)
{
    (void)unused;
    static const char *const words[] = {
        "nls scheme=%s initial=collision position=-10 half_length=40 points=800 dt=0.02 until=20",
        "nls scheme=%s initial=collision position=-10 half_length=40 points=1600 dt=0.01 until=20",
    };
    const double shift = log(5);
    double error[2] = {0};
    for (int k = 0; k < 2; k++) {
        char text[200];
        snprintf(text, sizeof text, words[k], "box");
        struct field_run run = field_run_make(text, -1);
        assert_int_equal(run.lane->run->status, GM_OK);
        const struct gm_grid1 *line = &run.lane->problem.line;
        const double *psi = gm_run_state(run.lane->run);
        double *modulus = malloc(line->points * sizeof *modulus);
        for (size_t i = 0; i < line->points; i++) {
            modulus[i] = hypot(psi[i], psi[line->points + i]);
        }
        const double arrival = -10 + 20 + shift, found = crest(line, modulus, arrival, 4);
        const double mirrored = crest(line, modulus, -arrival, 4);
        error[k] = found - arrival;
        print_message("%s: shift %.4f, of theory %.4f\n", text, found - 10, shift);
        assert_true(fabs(found + mirrored) < 1e-6);
        free(modulus);
        field_run_close(&run);
    }
    print_message("order %.3f\n", log2(error[0] / error[1]));
    assert_true(fabs(log2(error[0] / error[1]) - 2) < 0.15);
    assert_true(fabs((4 * error[1] - error[0]) / 3) < 0.005);
}

static double error_of(const char *words, enum gm_status status)
{
    struct field_run run = field_run_make(words, -1);
    assert_int_equal(run.lane->run->status, status);
    const double error = field_run_value(&run, "solution_error");
    print_message("%s: error %.4g at t = %g\n", words, error, run.lane->run->t);
    field_run_close(&run);
    return error;
}

/* Two Korteweg-de Vries solitons with the same step: where the Fourier method is stable its error is less than
   a hundredth of that of the box, which at twice this step goes on where the Fourier method blows up. */
static void the_box_against_fourier_modes(void **unused)
{
    (void)unused;
    const double box = error_of("kdv scheme=box points=501 dt=0.025 until=40", GM_OK);
    const double fourier = error_of("kdv scheme=fourier-rk4 points=501 dt=0.025 until=40", GM_OK);
    assert_true(fourier < box / 100);
    assert_true(error_of("kdv scheme=box points=501 dt=0.05 until=40", GM_OK) < 0.5);
    error_of("kdv scheme=fourier-rk4 points=501 dt=0.05 until=40", GM_BLOW_UP);
    /* its order */
    const double finer = error_of("kdv scheme=fourier-rk4 points=501 dt=0.0125 until=40", GM_OK);
    assert_true(log2(fourier / finer) > 3.8);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(three_korteweg_de_vries_solitons),
        cmocka_unit_test(two_schroedinger_solitons),
        cmocka_unit_test(the_box_against_fourier_modes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
