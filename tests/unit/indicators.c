/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The derivative of every scheme's steps against differences between runs, wrong derivatives that must be
   noticed, and exponents and MEGNO of orbits whose numbers are known. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "core/basics.h"
#include "core/ode/certify/measure.h"
#include "core/ode/indicators/growth.h"
#include "core/ode/indicators/stiffness.h"
#include "core/ode/indicators/tangent.h"
#include "core/ode/kernel/loops.h"
#include "core/schemes.h"
#include "tests/common/typed.h"
#include "tests/problems/problems.h"

enum { STEPS = 3, MOST = 2 * GM_SUBJECT_COMPONENTS };

static const struct gm_settings settings = {.binding = 20, .tau0 = 0.01};

/* Where a run is after the steps that begins so far beside the start. */
static bool end_of(const struct gm_problem *problem, const struct gm_scheme *scheme, double dt,
                   const double *start, const double *direction, double distance, double *end)
{
    double from[MOST];
    for (size_t c = 0; c < problem->n; c++) {
        from[c] = start[c] + distance * direction[c];
    }
    struct gm_run *run = gm_run_open(problem, scheme, &settings, 0, dt, from);
    assert_non_null(run);
    const bool good = gm_run_advance(run, STEPS) == GM_OK;
    memcpy(end, gm_run_state(run), problem->n * sizeof *end);
    gm_run_close(run);
    return good;
}

/* Central differences at four distances, extrapolated. */
static bool by_runs(const struct gm_problem *problem, const struct gm_scheme *scheme, double dt,
                    const double *start, const double *direction, double *slope)
{
    enum { LEVELS = 4 };
    double table[LEVELS][MOST], plus[MOST], minus[MOST];
    for (int level = 0; level < LEVELS; level++) {
        const double distance = ldexp(4e-3, -level);
        if (!end_of(problem, scheme, dt, start, direction, distance, plus) ||
            !end_of(problem, scheme, dt, start, direction, -distance, minus)) {
            return false;
        }
        for (size_t c = 0; c < problem->n; c++) {
            table[level][c] = (plus[c] - minus[c]) / (2 * distance);
        }
    }
    double power = 4;
    for (int done = 1; done < LEVELS; done++, power *= 4) {
        for (int level = LEVELS - 1; level >= done; level--) {
            for (size_t c = 0; c < problem->n; c++) {
                table[level][c] += (table[level][c] - table[level - 1][c]) / (power - 1);
            }
        }
    }
    memcpy(slope, table[LEVELS - 1], problem->n * sizeof *slope);
    return true;
}

/* The largest difference between the two, of their size; -1 where the scheme comes to no number. */
static double defect_of(const struct gm_problem *problem, const struct gm_scheme *scheme,
                        const struct gm_scheme *other, double dt, const double *start)
{
    double v[2 * MOST], expected[MOST];
    for (size_t c = 0; c < problem->n; c++) {
        v[c] = sin(1.3 + (double)c);
    }
    if (!by_runs(problem, other, dt, start, v, expected)) {
        return -1;
    }
    struct gm_run *run = gm_run_open(problem, scheme, &settings, 0, dt, start);
    assert_non_null(run);
    struct gm_tangent *tangent = gm_tangent_open(run);
    assert_non_null(tangent);
    assert_true(gm_tangent_size(tangent) <= 2 * MOST);
    for (size_t i = problem->n; i < gm_tangent_size(tangent); i++) {
        v[i] = 1e200; /* whatever stands there is no part of the question */
    }
    bool good = gm_tangent_begin(tangent, v);
    for (int i = 0; good && i < STEPS; i++) {
        good = gm_tangent_step(tangent, v, 1);
    }
    gm_tangent_close(tangent);
    gm_run_close(run);
    assert_true(good);
    double difference = 0, size = 1;
    for (size_t c = 0; c < problem->n; c++) {
        difference = fmax(difference, fabs(v[c] - expected[c]));
        size = fmax(size, fabs(expected[c]));
    }
    return difference / size;
}

/* What is magnified in the steps of one scheme: the length of a step depends on the energy that it keeps by
   4 / (tau f' H'' f), 200 at tau = .02. */
static double magnified(const struct gm_scheme *scheme)
{
    return strcmp(scheme->name, "symplectic-energy-momentum2") == 0 ? 200 : 1;
}

static void every_scheme(void **unused)
{
    (void)unused;
    size_t exact = 0, differences = 0;
    for (size_t i = 0; i < gm_scheme_count(); i++) {
        const struct gm_scheme *scheme = gm_scheme_at(i);
        if (scheme->family->kind != &gm_kind_ode || strcmp(gm_tangent_word(scheme), "none") == 0) {
            continue;
        }
        size_t held = 0;
        for (size_t k = 0; k < gm_subject_count(); k++) {
            struct gm_subject subject;
            if (!gm_subject_open(&subject, k, scheme)) {
                gm_subject_close(&subject);
                continue;
            }
            /* steps at which the equations of all schemes can be solved */
            const double defect = defect_of(&subject.problem, scheme, scheme, subject.dt / 4, subject.start);
            if (defect > 1e-8 * magnified(scheme)) {
                fail_msg("%s on %s: the derivative of its steps is wrong by %.1e", scheme->name,
                         subject.problem.name, defect);
            }
            held += defect >= 0;
            gm_subject_close(&subject);
        }
        if (held == 0) {
            fail_msg("%s: its derivative was held against nothing", scheme->name);
        }
        const bool is_exact = strcmp(gm_tangent_word(scheme), "exact") == 0;
        exact += is_exact;
        differences += !is_exact;
    }
    assert_true(exact >= 30);
    assert_true(differences > 10);
}

/* A Jacobian that is wrong by a part in 10^5 of one entry. */
static void wrong_jacobian(const struct gm_problem *problem, const double *y, double *jacobian)
{
    gm_ode_of(&gm_problem_henon_heiles)->loops[GM_ISA_BASELINE]->jacobian(problem, y, jacobian);
    jacobian[2 * 4 + 1] *= 1 + 1e-5;
}

static void wrong_ones(void **unused)
{
    (void)unused;
    static const char *const names[] = {"verlet", "rk4", "gauss4", "yoshida4"};
    const double start[4] = {0.1, -0.1, 0.3, 0.2};
    struct gm_ode facets = *gm_ode_of(&gm_problem_henon_heiles);
    struct gm_loops loops = *facets.loops[GM_ISA_BASELINE];
    struct gm_problem problem = gm_problem_henon_heiles;
    loops.jacobian = wrong_jacobian;
    facets.loops[GM_ISA_BASELINE] = &loops;
    problem.facets = &facets;
    for (size_t i = 0; i < GM_COUNT(names); i++) {
        const struct gm_scheme *scheme = gm_scheme_find(names[i]);
        assert_true(defect_of(&problem, scheme, scheme, 0.3, start) > 1e-8);
        assert_true(defect_of(&gm_problem_henon_heiles, scheme, gm_scheme_find("kahan2"), 0.3, start) > 1e-8);
    }
}

/* The orbit that is followed is that of a run alone, to the last bit, and however often one looks. */
static void same_orbit(void **unused)
{
    (void)unused;
    const double start[4] = {0, 0.1, sqrt(0.19), 0.1};
    for (size_t i = 0; i < gm_scheme_count(); i++) {
        const struct gm_scheme *scheme = gm_scheme_at(i);
        if (!gm_scheme_fits(scheme, &gm_problem_henon_heiles) ||
            strcmp(gm_tangent_word(scheme), "none") == 0) {
            continue;
        }
        struct gm_run *run = gm_run_open(&gm_problem_henon_heiles, scheme, &settings, 0, 0.1, start);
        struct gm_growth *growth = gm_growth_open(&gm_problem_henon_heiles, scheme, &settings, 0, 0.1, start);
        struct gm_growth *often = gm_growth_open(&gm_problem_henon_heiles, scheme, &settings, 0, 0.1, start);
        assert_true(run && growth && often);
        assert_true(isnan(gm_growth_values(growth).exponent));
        const bool good = gm_run_advance(run, 300) == GM_OK;
        assert_int_equal(gm_growth_to(growth, 300) == NULL, good);
        for (long steps = 1; steps <= 300; steps++) {
            assert_true(!gm_growth_to(often, steps) || !good);
            gm_growth_values(often);
        }
        assert_memory_equal(gm_run_state(run), gm_run_state(gm_growth_run(growth)), sizeof start);
        const struct gm_growth_values once = gm_growth_values(growth), last = gm_growth_values(often);
        assert_memory_equal(&once, &last, sizeof once);
        gm_growth_close(growth);
        gm_growth_close(often);
        gm_run_close(run);
    }
}

/* Steps that are made at once carry a vector as steps one by one do, to the last bit: where the stages are
   the scheme's operations, where they are not (compensated sums), and where the orbit leaves on the way. */
static void steps_at_once(void **unused)
{
    enum { N = 4, ALL = 200 };
    (void)unused;
    size_t whole = 0;
    static const double starts[2][N] = {{0, 0.1, 0.435889894354067, 0.1}, {0, 1.2, 0.3, 0.2}};
    for (size_t i = 0; i < 4 * gm_scheme_count(); i++) {
        const struct gm_scheme *scheme = gm_scheme_at(i / 4);
        if (!gm_scheme_fits(scheme, &gm_problem_henon_heiles) || gm_scheme_has_memory(scheme) ||
            strcmp(gm_tangent_word(scheme), "exact") != 0) {
            continue;
        }
        struct gm_settings own = settings;
        own.compensated = i % 2 == 1;
        const double *start = starts[i / 2 % 2];
        double v[2][N] = {{0.6, -0.48, 0.64, 0}, {0.6, -0.48, 0.64, 0}};
        struct gm_stretch made[ALL];
        struct gm_run *runs[2];
        struct gm_tangent *tangents[2];
        for (int k = 0; k < 2; k++) {
            runs[k] = gm_run_open(&gm_problem_henon_heiles, scheme, &own, 0, 0.1, start);
            tangents[k] = runs[k] ? gm_tangent_open(runs[k]) : NULL;
            assert_non_null(tangents[k]);
        }
        const size_t first = gm_tangent_advance(tangents[0], v[0], 77, made);
        const size_t count =
            first + (first < 77 ? 0 : gm_tangent_advance(tangents[0], v[0], ALL - 77, made + 77));
        whole += count == ALL;
        for (size_t step = 0; step < count; step++) {
            double square = 0;
            assert_true(gm_tangent_step(tangents[1], v[1], 1));
            for (size_t c = 0; c < N; c++) {
                square += v[1][c] * v[1][c];
            }
            for (size_t c = 0; c < N; c++) {
                v[1][c] *= 1 / sqrt(square);
            }
            assert_true(made[step].length == sqrt(square) && made[step].t == runs[1]->t);
        }
        assert_true(count == ALL || !gm_tangent_step(tangents[1], v[1], 1));
        assert_true(count < ALL || memcmp(v[0], v[1], sizeof v[0]) == 0);
        assert_int_equal(runs[0]->status, runs[1]->status);
        assert_int_equal(runs[0]->steps, runs[1]->steps);
        assert_memory_equal(gm_run_state(runs[0]), gm_run_state(runs[1]), N * sizeof(double));
        for (int k = 0; k < 2; k++) {
            gm_tangent_close(tangents[k]);
            gm_run_close(runs[k]);
        }
    }
    assert_true(whole > 40);
}

/* An orbit of Henon and Heiles through (q2, p2) of the section q1 = 0. */
static struct gm_growth_values henon_heiles(const char *scheme, double energy, double q2, double p2,
                                            double dt, double until)
{
    const double potential = q2 * q2 / 2 - q2 * q2 * q2 / 3;
    const double start[4] = {0, q2, sqrt(2 * (energy - potential) - p2 * p2), p2};
    struct gm_growth *growth =
        gm_growth_open(&gm_problem_henon_heiles, gm_scheme_find(scheme), &settings, 0, dt, start);
    assert_non_null(growth);
    assert_null(gm_growth_to(growth, lround(until / dt)));
    const struct gm_growth_values values = gm_growth_values(growth);
    gm_growth_close(growth);
    return values;
}

/* On top of the pendulum a step of Verlet is a linear map of trace 2 + h^2: errors grow by its larger
   eigenvalue, exp(l h) with cosh(l h) = 1 + h^2 / 2, once the other one is forgotten. */
static void known_exponent(void **unused)
{
    (void)unused;
    const double start[2] = {M_PI, 0}, dt = 0.1;
    struct gm_growth *growth =
        gm_growth_open(&gm_problem_pendulum, gm_scheme_find("verlet"), &settings, 0, dt, start);
    assert_non_null(growth);
    assert_null(gm_growth_to(growth, 100));
    const double first = gm_growth_values(growth).exponent * 100 * dt;
    assert_null(gm_growth_to(growth, 200));
    const struct gm_growth_values values = gm_growth_values(growth);
    const double second = values.exponent * 200 * dt;
    assert_true(fabs((second - first) / (100 * dt) - acosh(1 + dt * dt / 2) / dt) < 1e-7);
    assert_true(fabs(values.exponent_change - (second / 20 - first / 10)) <
                0.02); /* as far as it was recorded */
    gm_growth_close(growth);
}

static void known_numbers(void **unused)
{
    (void)unused;
    /* chaotic at the energy 1/8: the exponent is .044 (among others G. Benettin et al., Phys. Rev. A 14
       (1976) 2338) */
    const struct gm_growth_values chaotic = henon_heiles("verlet", 1. / 8, -0.25, 0, 0.1, 1e5);
    if (!(fabs(chaotic.exponent - 0.044) < 0.003)) {
        fail_msg("the exponent is %.5f", chaotic.exponent);
    }
    /* regular ones: near the periodic orbits in the middles of the islands, and in one of the islands
       themselves */
    static const struct {
        double energy, q2, p2;
    } regular[] = {{1. / 12, 0.1, 0.1}, {1. / 12, 0.3, 0}, {1. / 8, 0.3, 0}, {1. / 8, 0.2, 0.1}};
    for (size_t i = 0; i < GM_COUNT(regular); i++) {
        const struct gm_growth_values values =
            henon_heiles("verlet", regular[i].energy, regular[i].q2, regular[i].p2, 0.1, 1e5);
        if (!(fabs(values.megno - 2) < 0.05 && values.exponent < 2e-4)) {
            fail_msg("energy %.3f, q2 = %.2f, p2 = %.2f: MEGNO %.4f, exponent %.5f", regular[i].energy,
                     regular[i].q2, regular[i].p2, values.megno, values.exponent);
        }
    }
}

/* ln of the volume of a friction that depends on the place: the orbit's third component has the same rate. */
static void volumes_follow_the_divergence(void **unused)
{
    (void)unused;
    struct typed typed;
    type(&typed, "rate: x = y\nrate: y = -sin(x) - 0.2*(1 + x^2)*y\nrate: w = -0.2*(1 + x^2)\n"
                 "start: x = 1.5, y = 0, w = 0\n");
    struct gm_run *run = gm_run_open(&typed.problem, gm_scheme_find("rk4"), &settings, 0, 0.02, typed.start);
    assert_non_null(run);
    struct gm_tangent *tangent = gm_tangent_open(run);
    assert_non_null(tangent);
    double square[9], v[3] = {1, 0, 0};
    gm_tangent_follow_volume(tangent, square);
    for (int i = 0; i < 100; i++) {
        assert_true(gm_tangent_step(tangent, v, 1));
    }
    const double sum = gm_run_state(run)[2];
    assert_true(sum < -0.5 && fabs(gm_tangent_volume(tangent) - sum) < 1e-7);
    gm_tangent_close(tangent);
    gm_run_close(run);
    untype(&typed);
}

/* A component that decays a thousand times faster than the others move is stiff, unless they move as fast. */
static void what_is_slow_beside_a_decay_is_stiff(void **unused)
{
    (void)unused;
    static const struct {
        const char *text;
        double fast, slow; /* about that many per unit of time */
        bool stiff;
    } rows[] = {
        {"rate: x = -1e4*(x - y)\nrate: y = z\nrate: z = -y\nstart: x = 1, y = 1, z = 0.5\n", 1e4, 0.5, true},
        {"rate: x = -1e4*(x - y)\nrate: y = 1e3*z\nrate: z = -1e3*y\nstart: x = 1, y = 1, z = 0.5\n", 1e4,
         500, false},
    };
    for (size_t i = 0; i < GM_COUNT(rows); i++) {
        struct typed typed;
        type(&typed, rows[i].text);
        const struct gm_stiffness found = gm_stiffness_of(&typed.problem, typed.start, 100);
        assert_true(fabs(found.fast - rows[i].fast) < 1e-6 * rows[i].fast);
        assert_true(found.slow > rows[i].slow / 3 && found.slow < 3 * rows[i].slow);
        assert_int_equal(found.stiff, rows[i].stiff);
        untype(&typed);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_scheme),
        cmocka_unit_test(wrong_ones),
        cmocka_unit_test(same_orbit),
        cmocka_unit_test(steps_at_once),
        cmocka_unit_test(known_exponent),
        cmocka_unit_test(known_numbers),
        cmocka_unit_test(volumes_follow_the_divergence),
        cmocka_unit_test(what_is_slow_beside_a_decay_is_stiff),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
