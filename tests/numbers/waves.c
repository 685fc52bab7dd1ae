/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the wave scenes are to reproduce: long runs of the sine-Gordon breather, Korteweg-de Vries solitons
   and the cosine of Zabusky & Kruskal against a spectral run made here, Schroedinger solitons, the wave
   equation. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <gsl/gsl_fft_complex.h>

#include "core/basics.h"
#include "tests/numbers/field_runs.h"

static double value_at_end(const char *words, const char *observable)
{
    struct field_run run = field_run_make(words, -1);
    assert_int_equal(run.lane->run->status, GM_OK);
    const double value = field_run_value(&run, observable);
    field_run_close(&run);
    return value;
}

static void breathers_at_equal_steps(void **unused)
{
    (void)unused;
    struct field_run run = field_run_make("sine-gordon scheme=leapfrog until=40", 0);
    expect_within("leapfrog, dt = dx = .05: error above 1 at t =", field_run_until(&run, "solution_error", 1),
                  25.5, 0.04);
    expect_within("leapfrog: |u| above 10 at t =", field_run_until(&run, "amplitude", 10), 35, 0.04);
    field_run_close(&run);

    run = field_run_make("sine-gordon scheme=energy-conserving until=500", 0);
    const double kept = field_run_largest(&run, "own_energy_error");
    assert_int_equal(run.lane->run->status, GM_OK);
    print_message("energy-conserving to t = 500: own energy error at most %.2g\n", kept);
    assert_true(kept < 6e-15);
    field_run_close(&run);

    run = field_run_make("sine-gordon scheme=box until=500", 0);
    expect_within("box to t = 500: largest energy error", field_run_largest(&run, "energy_error"), 2.7e-4,
                  0.1);
    assert_int_equal(run.lane->run->status, GM_OK);
    assert_true(field_run_value(&run, "solution_error") < 0.5);
    field_run_close(&run);
}

/* The local laws of Korteweg-de Vries and Schroedinger: mass and charge to round-off, energy and momentum with
   the square of the step, the mesh as fine as the step. */
static void the_local_laws_of_the_box(void **unused)
{
    (void)unused;
    static const struct {
        const char *coarse, *fine, *kept;
    } runs[] = {
        {"kdv scheme=box points=501 dt=0.05 until=10", "kdv scheme=box points=1002 dt=0.025 until=10",
         "local_mass_residual"},
        {"nls scheme=box points=801 dt=0.005 until=3", "nls scheme=box points=1602 dt=0.0025 until=3",
         "local_charge_residual"},
    };
    for (size_t k = 0; k < GM_COUNT(runs); k++) {
        static const char *const laws[] = {"local_energy_residual", "local_momentum_residual"};
        for (size_t law = 0; law < 2; law++) {
            const double coarse = value_at_end(runs[k].coarse, laws[law]);
            const double order = log2(coarse / value_at_end(runs[k].fine, laws[law]));
            print_message("%s, %s: %.3g, order %.3f\n", runs[k].coarse, laws[law], coarse, order);
            assert_true(coarse > 1e-6 && fabs(order - 2) < 0.1);
        }
        const double kept = value_at_end(runs[k].coarse, runs[k].kept);
        print_message("%s, %s: %.2g\n", runs[k].coarse, runs[k].kept, kept);
        assert_true(kept < 2e-11);
    }
    assert_true(isnan(value_at_end("nls scheme=split-step2 until=1", "local_charge_residual")));
}

static void the_law_of_the_box(void **unused)
{
    (void)unused;
    static const struct {
        const char *words;
        double bound;
    } runs[] = {
        {"sine-gordon scheme=box points=101 dt=.1 until=10", 4e-13},
        {"sine-gordon scheme=midpoint-box dt=.04 until=10", 4e-13},
        {"kdv until=10", 4e-12},
        {"kdv scheme=euler-box points=401 dt=2.5e-3 until=10", 2e-10},
        {"kdv scheme=midpoint-box points=401 dt=.01 until=10", 2e-10},
        {"nls scheme=euler-box dt=.004 until=2", 1e-10},
        {"nls points=401 until=2", 4e-12},
    };
    for (size_t i = 0; i < GM_COUNT(runs); i++) {
        const double residual = value_at_end(runs[i].words, "multisymplectic_residual");
        print_message("%-78s %.2g\n", runs[i].words, residual);
        assert_true(residual < runs[i].bound);
    }
    assert_true(value_at_end("sine-gordon scheme=energy-conserving until=10", "multisymplectic_residual") >
                1e-4);
}

static void breathers_at_twice_the_step(void **unused)
{
    (void)unused;
    static const char *const explicit_ones[] = {"sine-gordon scheme=leapfrog dt=.1 until=500",
                                                "sine-gordon scheme=energy-conserving dt=.1 until=500"};
    for (size_t i = 0; i < 2; i++) {
        struct field_run run = field_run_make(explicit_ones[i], -1);
        assert_int_equal(run.lane->run->status, GM_BLOW_UP);
        assert_true(run.lane->run->t < 2.1);
        field_run_close(&run);
    }
    struct field_run run = field_run_make("sine-gordon scheme=box dt=.1 until=500", 0);
    expect_within("box, dt = .1, to t = 500: largest energy error", field_run_largest(&run, "energy_error"),
                  8e-4, 0.4);
    assert_int_equal(run.lane->run->status, GM_OK);
    field_run_close(&run);
    run = field_run_make("sine-gordon scheme=energy-conserving points=801 until=40", -1);
    assert_int_equal(run.lane->run->status, GM_BLOW_UP);
    expect_within("energy-conserving at dt/dx = 1.00125 blows up at t =", run.lane->run->t, 19, 0.06);
    field_run_close(&run);
}

static void korteweg_de_vries_solitons(void **unused)
{
    (void)unused;
    expect_within("kdv, one soliton, 200 points",
                  value_at_end("kdv initial=soliton points=200 dt=.05 until=10", "solution_error"), 3.43e-2,
                  0.01);
    expect_within("kdv, one soliton, 400 points",
                  value_at_end("kdv initial=soliton points=400 dt=.025 until=10", "solution_error"), 8.57e-3,
                  0.01);
    expect_within("kdv, one soliton, 800 points",
                  value_at_end("kdv initial=soliton points=800 dt=.0125 until=10", "solution_error"), 2.15e-3,
                  0.01);
    assert_true(value_at_end("kdv initial=soliton points=400 dt=.025 until=10", "mass_error") < 1e-12);
    expect_within("kdv, two solitons, 1001 points",
                  value_at_end("kdv points=1001 dt=.05 until=40", "solution_error"), 0.143, 0.01);
    expect_within("kdv, two solitons, 2001 points",
                  value_at_end("kdv points=2001 dt=.025 until=40", "solution_error"), 0.0359, 0.01);
    expect_within("kdv, two solitons, the first one across the ring's end",
                  value_at_end("kdv points=2001 dt=.025 until=60", "solution_error"), 0.0551, 0.01);
}

/* Zabusky's and Kruskal's problem by Fourier modes: the linear part exactly, the rest by Runge and Kutta's
 * method. */
enum { MODES = 512 };

struct spectral {
    gsl_fft_complex_wavetable *table;
    gsl_fft_complex_workspace *space;
    double scratch[2 * MODES];
};

static double wave_number(size_t k)
{
    return M_PI * (k <= MODES / 2 ? (double)k : (double)k - MODES);
}

/* f = -i k/2 of the transform of u^2 */
static void convection(struct spectral *spectral, const double *modes, double *f)
{
    memcpy(spectral->scratch, modes, sizeof spectral->scratch);
    gsl_fft_complex_inverse(spectral->scratch, 1, MODES, spectral->table, spectral->space);
    for (size_t i = 0; i < MODES; i++) {
        f[2 * i] = spectral->scratch[2 * i] * spectral->scratch[2 * i];
        f[2 * i + 1] = 0;
    }
    gsl_fft_complex_forward(f, 1, MODES, spectral->table, spectral->space);
    for (size_t k = 0; k < MODES; k++) {
        const double half = k == MODES / 2 ? 0 : wave_number(k) / 2, re = f[2 * k];
        f[2 * k] = half * f[2 * k + 1];
        f[2 * k + 1] = -half * re;
    }
}

/* modes *= exp(i mu k^3 h) */
static void disperse(double *modes, double h)
{
    for (size_t k = 0; k < MODES; k++) {
        const double number = k == MODES / 2 ? 0 : wave_number(k);
        const double angle = 0.022 * 0.022 * number * number * number * h, re = modes[2 * k];
        modes[2 * k] = cos(angle) * re - sin(angle) * modes[2 * k + 1];
        modes[2 * k + 1] = cos(angle) * modes[2 * k + 1] + sin(angle) * re;
    }
}

static void combine(double *out, const double *base, double h, const double *f)
{
    for (size_t i = 0; i < 2 * MODES; i++) {
        out[i] = base[i] + h * f[i];
    }
}

static void spectral_run(double *modes, double until, long steps)
{
    static struct spectral spectral;
    spectral.table = gsl_fft_complex_wavetable_alloc(MODES);
    spectral.space = gsl_fft_complex_workspace_alloc(MODES);
    for (size_t i = 0; i < MODES; i++) {
        modes[2 * i] = cos(2 * M_PI * (double)i / MODES);
        modes[2 * i + 1] = 0;
    }
    gsl_fft_complex_forward(modes, 1, MODES, spectral.table, spectral.space);
    static double a[2 * MODES], b[2 * MODES], c[2 * MODES], d[2 * MODES], stage[2 * MODES];
    const double h = until / (double)steps;
    for (long n = 0; n < steps; n++) {
        convection(&spectral, modes, a);
        combine(stage, modes, h / 2, a);
        disperse(stage, h / 2);
        convection(&spectral, stage, b);
        disperse(modes, h / 2);
        combine(stage, modes, h / 2, b);
        convection(&spectral, stage, c);
        combine(stage, modes, h, c);
        disperse(stage, h / 2);
        convection(&spectral, stage, d);
        disperse(a, h / 2);
        for (size_t i = 0; i < 2 * MODES; i++) {
            modes[i] += h / 6 * (a[i] + 2 * b[i] + 2 * c[i]);
        }
        disperse(modes, h / 2);
        combine(modes, modes, h / 6, d);
    }
    gsl_fft_complex_wavetable_free(spectral.table);
    gsl_fft_complex_workspace_free(spectral.space);
}

static double spectral_value(const double *modes, double x)
{
    double sum = modes[0];
    for (size_t k = 1; k < MODES / 2; k++) {
        const double angle = M_PI * (double)k * x;
        sum += 2 * (modes[2 * k] * cos(angle) - modes[2 * k + 1] * sin(angle));
    }
    return sum / MODES;
}

static void the_cosine_of_zabusky_and_kruskal(void **unused)
{
    (void)unused;
    static double modes[2 * MODES], coarse[2 * MODES];
    const double until = 3.6 / M_PI;
    spectral_run(modes, until, 20000);
    spectral_run(coarse, until, 10000);
    double largest = 0, difference = 0;
    for (int i = 0; i < MODES; i++) {
        const double x = 2.0 * i / MODES, u = spectral_value(modes, x);
        largest = fmax(largest, u);
        difference = fmax(difference, fabs(u - spectral_value(coarse, x)));
    }
    print_message("the spectral run is good to %.1g\n", difference);
    assert_true(difference < 1e-6);
    expect_within("its greatest value at the nodes", largest, 2.26227, 1e-5);
    static const struct {
        const char *words;
        double error, part;
    } cases[] = {
        {"kdv initial=cosine points=200 dt=3.6/pi/1146 until=3.6/pi", 0.380, 0.02},
        {"kdv initial=cosine points=400 dt=3.6/pi/1146 until=3.6/pi", 0.0985, 0.02},
        {"kdv initial=cosine points=800 dt=3.6/pi/2292 until=3.6/pi", 0.0248, 0.02},
        {"kdv scheme=zabusky-kruskal initial=cosine points=200 dt=3.6/pi/4000 until=3.6/pi", 0.252, 0.02},
        {"kdv scheme=zabusky-kruskal initial=cosine points=400 dt=3.6/pi/30000 until=3.6/pi", 0.0623, 0.02},
    };
    for (size_t c = 0; c < GM_COUNT(cases); c++) {
        struct field_run run = field_run_make(cases[c].words, -1);
        assert_int_equal(run.lane->run->status, GM_OK);
        double error = 0;
        for (size_t i = 0; i < run.lane->problem.line.points; i++) {
            const double x = gm_grid1_node(&run.lane->problem.line, i);
            error = fmax(error, fabs(gm_run_state(run.lane->run)[i] - spectral_value(modes, x)));
        }
        expect_within(cases[c].words, error, cases[c].error, cases[c].part);
        field_run_close(&run);
    }
    /* the same method, by another transform */
    struct field_run run =
        field_run_make("kdv scheme=fourier-rk4 initial=cosine points=512 dt=3.6/pi/10000 until=3.6/pi", -1);
    double apart = 0;
    for (size_t i = 0; i < MODES; i++) {
        const double x = gm_grid1_node(&run.lane->problem.line, i);
        apart = fmax(apart, fabs(gm_run_state(run.lane->run)[i] - spectral_value(coarse, x)));
    }
    print_message("fourier-rk4 with the step of the coarser spectral run: %.1g from it\n", apart);
    assert_true(apart < 1e-9);
    field_run_close(&run);
    run = field_run_make("kdv scheme=zabusky-kruskal initial=cosine points=400 dt=1e-4 until=3.6/pi", -1);
    assert_int_equal(run.lane->run->status, GM_BLOW_UP);
    field_run_close(&run);
}

static void schroedinger_solitons(void **unused)
{
    (void)unused;
    static const char *const words[] = {"nls initial=soliton points=200 dt=.02",
                                        "nls initial=soliton points=400 dt=.01",
                                        "nls initial=soliton points=800 dt=.005"};
    static const double complex_errors[] = {0.513, 0.134, 0.0337},
                        modulus_errors[] = {7.1e-2, 1.9e-2, 4.8e-3};
    for (size_t i = 0; i < 3; i++) {
        expect_within(words[i], value_at_end(words[i], "solution_error"), complex_errors[i], 0.01);
        expect_within("  of the modulus", value_at_end(words[i], "modulus_error"), modulus_errors[i], 0.02);
    }
    struct field_run run = field_run_make("nls", 0);
    const double charge = field_run_largest(&run, "charge_error");
    print_message("nls collision: charge error at most %.2g\n", charge);
    assert_true(charge < 4e-13);
    field_run_close(&run);

    /* by another program: the same splitting, and the energy of the derivative by Fourier modes */
    static const double steps[] = {0.005, 0.00125}, energy_errors[] = {7.737e-4, 4.850e-5};
    for (size_t i = 0; i < GM_COUNT(steps); i++) {
        char split[80];
        snprintf(split, sizeof split, "nls scheme=split-step2 until=5 dt=%g", steps[i]);
        run = field_run_make(split, 0);
        expect_within(split, field_run_largest(&run, "energy_error"), energy_errors[i], 1e-3);
        field_run_close(&run);
    }
}

/* Measured where a scheme has its field, what it loses of the energy falls with its order in time, whatever the grid: at
   nodes the grid errs as much with every step. The linear wave loses what rounding takes. */
static void energies_fall_with_the_order_of_the_step(void **unused)
{
    (void)unused;
    static const struct {
        const char *scheme;
        double error; /* with dt = .04; an order below it .01 shows */
        int order;
        bool keeps_waves;
    } schemes[] = {{"box", 3.2e-4, 2, true},           {"gauss-box3", 1.1e-8, 4, true},
                   {"midpoint-box", 6.4e-4, 2, true},  {"lobatto-box2", 3.9e-4, 2, false},
                   {"lobatto-box4", 3.1e-8, 4, false}, {"lobatto-nystrom4", 5.1e-8, 4, false}};
    for (size_t i = 0; i < GM_COUNT(schemes); i++) {
        double errors[2];
        for (size_t k = 0; k < 2; k++) {
            char words[80];
            snprintf(words, sizeof words, "sine-gordon scheme=%s dt=%s until=20", schemes[i].scheme,
                     k ? "0.01" : "0.04");
            struct field_run run = field_run_make(words, 0);
            errors[k] = field_run_largest(&run, "own_energy_error");
            field_run_close(&run);
        }
        expect_within(schemes[i].scheme, errors[0], schemes[i].error, 0.05);
        expect_within("  its order", log2(errors[0] / errors[1]) / 2, schemes[i].order, 0.03);
        char words[80];
        snprintf(words, sizeof words, "wave scheme=%s dt=0.04 until=20", schemes[i].scheme);
        struct field_run run = field_run_make(words, 0);
        assert_true(!schemes[i].keeps_waves || field_run_largest(&run, "energy_error") < 1e-12);
        field_run_close(&run);
    }
}

/* The box loses of the integral of u^2 what its cells do, with every step the same, and less of finer ones. */
static void squares_fall_with_the_cells(void **unused)
{
    (void)unused;
    static const char *const words[] = {"kdv scheme=box initial=soliton until=4 points=401 dt=0.04",
                                        "kdv scheme=box initial=soliton until=4 points=401 dt=0.01",
                                        "kdv scheme=box initial=soliton until=4 points=801 dt=0.01"};
    double errors[GM_COUNT(words)];
    for (size_t i = 0; i < GM_COUNT(words); i++) {
        struct field_run run = field_run_make(words[i], 0);
        errors[i] = field_run_largest(&run, "square_error");
        field_run_close(&run);
    }
    expect_within("box, square: with a quarter of the step", errors[1], errors[0], 1e-3);
    expect_within("  with half the cell", errors[2], errors[1] / 16, 0.02);
}

static void waves_on_a_ring(void **unused)
{
    (void)unused;
    assert_true(value_at_end("wave points=64 courant=1", "solution_error") < 1e-14);
    expect_within("wave, Courant number .9", value_at_end("wave points=64", "solution_error"), 0.088, 0.01);
    expect_within("wave, Courant number .5", value_at_end("wave points=64 courant=.5", "solution_error"),
                  0.277, 0.01);
    expect_within("rank", value_at_end("wave points=64", "rank"), 65, 0);
    expect_within("unknowns", value_at_end("wave points=64", "unknowns"), 129, 0);
    struct field_run run = field_run_make("wave points=64 courant=1.02", -1);
    assert_int_equal(run.lane->run->status, GM_BLOW_UP);
    field_run_close(&run);
    assert_true(value_at_end("wave points=64 courant=1", "energy_sum_residual") < 1e-15);
    const double pointwise = value_at_end("wave points=64", "energy_law_residual");
    assert_true(pointwise > 0.05 && pointwise < 0.6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(breathers_at_equal_steps),
        cmocka_unit_test(breathers_at_twice_the_step),
        cmocka_unit_test(the_local_laws_of_the_box),
        cmocka_unit_test(the_law_of_the_box),
        cmocka_unit_test(korteweg_de_vries_solitons),
        cmocka_unit_test(the_cosine_of_zabusky_and_kruskal),
        cmocka_unit_test(schroedinger_solitons),
        cmocka_unit_test(waves_on_a_ring),
        cmocka_unit_test(energies_fall_with_the_order_of_the_step),
        cmocka_unit_test(squares_fall_with_the_cells),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
