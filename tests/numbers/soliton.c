/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The numbers of the r-adaptive schemes that are published or agreed on: orders, the error table of one
   soliton, the energy of two. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "core/basics.h"
#include "core/run.h"
#include "core/schemes.h"
#include "tests/common/mesh_soliton.h"

static const struct gm_settings settings = {0};

struct trial {
    struct gm_soliton soliton;
    struct gm_problem problem;
    struct gm_mesh mesh;
    struct gm_run *run;
};

static void trial_open(struct trial *trial, const char *name, double dt)
{
    const struct gm_scheme *scheme = gm_scheme_find(name);
    assert_non_null(scheme);
    gm_soliton_problem(&trial->soliton, &trial->problem);
    gm_moving_mesh_of(&trial->problem)->describe(&trial->problem, &trial->mesh);
    double *state = malloc(trial->problem.n * sizeof *state);
    assert_non_null(state);
    assert_true(
        gm_mesh_start(&trial->mesh, gm_scheme_mesh(scheme), gm_soliton_profile, &trial->soliton, state));
    trial->run = gm_run_open(&trial->problem, scheme, &settings, 0, dt, state);
    free(state);
    assert_non_null(trial->run);
}

static void within(const char *what, double got, double wanted, double tolerance)
{
    print_message("    %-46s %.6g  (%.6g)\n", what, got, wanted);
    if (!(fabs(got - wanted) <= tolerance)) {
        fail_msg("%s: %.9g is not within %.3g of %.9g", what, got, tolerance, wanted);
    }
}

/* Section 8a: field after t = 2 on 15 nodes, the exponent of the last two differences. */
static void orders(void **unused)
{
    (void)unused;
    static const struct {
        const char *scheme;
        double order;
    } rows[] = {{"multiplier-lobatto2", 2}, {"multiplier-lobatto4", 4}, {"multiplier-trapezoidal", 2},
                {"control-gauss2", 2},      {"control-gauss4", 4},      {"control-lobatto2", 2},
                {"control-lobatto4", 4},    {"control-radau3", 3},      {"control-radau5", 5},
                {"uniform-gauss2", 2},      {"uniform-gauss4", 4},      {"uniform-lobatto2", 2},
                {"uniform-lobatto4", 4}};
    for (size_t i = 0; i < GM_COUNT(rows); i++) {
        double before[30] = {0}, change[8] = {0}, order = NAN;
        for (int k = 0; k < 6; k++) {
            struct trial trial = {
                .soliton = {.solitons = 1, .points = 15, .velocity = 0.9, .length = 25, .alpha = 2.5}};
            const long steps = 20L << k;
            trial_open(&trial, rows[i].scheme, 2. / (double)steps);
            assert_int_equal(gm_run_advance(trial.run, steps), GM_OK);
            for (size_t c = 0; c < 30; c++) {
                change[k] = fmax(change[k], fabs(gm_run_state(trial.run)[c] - before[c]));
            }
            memcpy(before, gm_run_state(trial.run), sizeof before);
            gm_run_close(trial.run);
            if (k > 1 && change[k] > 1e-9) {
                order = log2(change[k - 1] / change[k]);
            }
        }
        within(rows[i].scheme, order, rows[i].order, 0.05);
    }
}

/* Largest error at any node and step up to t = 50 (section 8b). */
static double largest_error(const char *name, int density, long points, double *ended)
{
    struct trial trial = {.soliton = {.solitons = 1,
                                      .density = density,
                                      .points = points,
                                      .velocity = 0.9,
                                      .length = 25,
                                      .alpha = 2.5}};
    trial_open(&trial, name, 0.01);
    double largest = 0;
    while (trial.run->steps < 5000 && gm_run_advance(trial.run, 1) == GM_OK) {
        const double *state = gm_run_state(trial.run);
        for (long k = 0; k < points; k++) {
            const double exact = gm_soliton_exact(&trial.soliton, state[points + k], trial.run->t);
            largest = fmax(largest, fabs(state[k] - exact));
        }
    }
    *ended = trial.run->t;
    gm_run_close(trial.run);
    return largest;
}

static void error_table(void **unused)
{
    (void)unused;
    static const struct {
        const char *scheme;
        double error[4];
    } rows[] = {{"multiplier-lobatto4", {0.5832, 0.0996, 0.0380, 0.0111}},
                {"control-gauss4", {NAN, 0.8875, 0.2419, 0.0621}},
                {"uniform-gauss4", {4.8028, 4.8809, 2.8541, 1.0838}}};
    for (size_t i = 0; i < GM_COUNT(rows); i++) {
        for (int k = 0; k < 4; k++) {
            double ended = 0;
            const double error = largest_error(rows[i].scheme, GM_ARCLENGTH, (16L << k) - 1, &ended);
            if (isnan(rows[i].error[k])) {
                within("control at 15 points ends at", ended, 35, 5);
            } else {
                assert_true(ended == 50);
                within(rows[i].scheme, error, rows[i].error[k], 0.01 * rows[i].error[k]);
            }
        }
    }
}

/* Beyond the document: the density that is tempered is more accurate than arclength, on every mesh of the
 * table. */
static void tempered_density(void **unused)
{
    (void)unused;
    static const double arclength[] = {0.5832, 0.0996, 0.0380, 0.0111};
    for (int k = 0; k < 4; k++) {
        double ended = 0;
        const double error = largest_error("multiplier-lobatto4", GM_TEMPERED, (16L << k) - 1, &ended);
        print_message("    %-46s %.6g  (below %.6g)\n", "tempered", error, arclength[k]);
        assert_true(ended == 50);
        assert_true(error < arclength[k]);
    }
}

/* Two solitons on 25 nodes, dt = 0.05 (section 8c): how far the energy goes from its start, and over which
 * range. */
static void energy_of_two(void **unused)
{
    (void)unused;
    static const struct {
        const char *scheme;
        double until, low, high; /* NaN: the largest change is held instead */
        double change, tolerance;
    } rows[] = {
        {"multiplier-lobatto4", 300, NAN, NAN, 1.2e-4, 0.1e-4},
        {"multiplier-lobatto2", 300, NAN, NAN, 2.9e-2, 0.1e-2},
        {"multiplier-trapezoidal", 300, NAN, NAN, 4.1e-2, 0.1e-2},
        {"control-gauss4", 50, 35.41, 36.75, NAN, 0.01},
        {"control-radau5", 50, 35.41, 36.75, NAN, 0.01},
    };
    for (size_t i = 0; i < GM_COUNT(rows); i++) {
        struct trial trial = {
            .soliton = {.solitons = 2, .points = 25, .velocity = 0.9, .length = 25, .alpha = 1.5}};
        trial_open(&trial, rows[i].scheme, 0.05);
        const double initial = gm_mesh_energy(&trial.mesh, gm_run_state(trial.run));
        double low = initial, high = initial;
        within("initial energy", initial, 35.5835, 1e-4);
        while (trial.run->t < rows[i].until - 0.01) {
            assert_int_equal(gm_run_advance(trial.run, 1), GM_OK);
            const double energy = gm_mesh_energy(&trial.mesh, gm_run_state(trial.run));
            low = fmin(low, energy);
            high = fmax(high, energy);
        }
        gm_run_close(trial.run);
        if (isnan(rows[i].low)) {
            within(rows[i].scheme, fmax(high - initial, initial - low), rows[i].change, rows[i].tolerance);
        } else {
            within(rows[i].scheme, low, rows[i].low, rows[i].tolerance);
            within(rows[i].scheme, high, rows[i].high, rows[i].tolerance);
        }
    }
}

/* The largest relative change of the energy of two solitons on 25 nodes up to t = 2000; infinite if it ended
 * before. */
static double energy_error_for_long(const char *scheme, int density, double dt)
{
    struct trial trial = {
        .soliton = {
            .solitons = 2, .density = density, .points = 25, .velocity = 0.9, .length = 25, .alpha = 1.5}};
    trial_open(&trial, scheme, dt);
    const double initial = gm_mesh_energy(&trial.mesh, gm_run_state(trial.run));
    double farthest = 0;
    while (trial.run->t < 2000 && gm_run_advance(trial.run, 1) == GM_OK) {
        farthest = fmax(farthest, fabs(gm_mesh_energy(&trial.mesh, gm_run_state(trial.run)) / initial - 1));
    }
    farthest = trial.run->status == GM_OK ? farthest : INFINITY;
    gm_run_close(trial.run);
    return farthest;
}

/* Beyond the document: a density with a limit keeps the energy within 0.5 % to t = 2000, with constant and
   with time-symmetric steps, where arclength loses it. */
static void energy_for_long(void **unused)
{
    (void)unused;
    /* from 0.04 on some steps make nodes cross before t = 2000, and rounding decides which ones */
    static const double steps[] = {0.035, 0.03, 0.025};
    for (size_t i = 0; i < 3; i++) {
        within("tempered, to t = 2000", energy_error_for_long("multiplier-lobatto4", GM_TEMPERED, steps[i]),
               0, 0.005);
        within("with a limit, to t = 2000",
               energy_error_for_long("multiplier-lobatto4", GM_LIMITED, steps[i]), 0, 0.005);
        within("and a time-symmetric step",
               energy_error_for_long("multiplier-adaptive4", GM_LIMITED, steps[i]), 0, 0.005);
    }
    const double lost = energy_error_for_long("multiplier-lobatto4", GM_ARCLENGTH, 0.05);
    print_message("    %-46s %.6g\n", "arclength, to t = 2000", lost);
    assert_true(lost > 0.005);
}

/* The nearly exact solution: passages and energies that the document prints. */
static void solitons(void **unused)
{
    (void)unused;
    const struct gm_soliton one = {.solitons = 1, .points = 31, .velocity = 0.9, .length = 25, .alpha = 2.5};
    const struct gm_soliton two = {.solitons = 2, .points = 25, .velocity = 0.9, .length = 25, .alpha = 1.5};
    within("continuum energy of two", gm_soliton_energy(&two), 36.71, 0.005);
    within("in the middle after two bounces", gm_soliton_exact(&one, 12.5, 4 * 13.837860), M_PI, 1e-4);
    within("back at the middle", gm_soliton_exact(&one, 12.5, 2 * 13.837860), M_PI, 1e-4);
    double value, slope, rate, farthest = 0;
    for (int i = 0; i <= 100; i++) {
        const double x = 0.25 * i;
        gm_soliton_profile(&one, &x, 1, &value, &slope, &rate);
        farthest = fmax(farthest, fabs(value - gm_soliton_exact(&one, 0.25 * i, 0)));
        gm_soliton_profile(&two, &x, 1, &value, &slope, &rate);
        farthest = fmax(farthest, fabs(value - gm_soliton_exact(&two, 0.25 * i, 0)));
    }
    within("start against the exact solution", farthest, 0, 1e-10);
    /* one period of two solitons */
    within("a period later", gm_soliton_exact(&two, 15, 1 + 27.5737) - gm_soliton_exact(&two, 15, 1), 0,
           1e-3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(orders),           cmocka_unit_test(error_table),
        cmocka_unit_test(tempered_density), cmocka_unit_test(energy_of_two),
        cmocka_unit_test(energy_for_long),  cmocka_unit_test(solitons),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
