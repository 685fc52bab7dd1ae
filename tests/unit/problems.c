/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The problems' kernels against their energies, differences and each other. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "core/basics.h"
#include "core/expression/graph.h"
#include "core/functions/functions.h"
#include "core/ode/kernel/loops.h"
#include "core/ode/problems/problems.h"
#include "core/ode/trace_free.h"
#include "tests/problems/problems.h"

enum { MOST = 32 };

static const double perturbation = 0.03, omega = 7, stiffness = 40, strength = 2;
static const double abc_constants[] = {1, 0.8, 0.6};
static const double matrix[] = {0.4, 1.1, -0.3, -0.7, 0.5, 0.2, 0.9, -0.6, -0.9};

static void trace_free_flow(const struct gm_problem *problem, size_t piece, double h, double *y, size_t m)
{
    gm_trace_free_flow(problem->parameters, piece, h, y, m);
}
static const struct gm_volume trace_free = {.pieces = GM_TRACE_FREE_PIECES, .flow = trace_free_flow};

static const struct {
    const struct gm_problem *problem;
    const void *parameters;
    double y[12];
} cases[] = {
    {&gm_problem_kepler, NULL, {0.5, 0.1, 0.2, 1.7}},
    {&gm_problem_kepler_perturbed, &perturbation, {0.5, 0.1, 0.2, 1.7}},
    {&gm_problem_henon_heiles, NULL, {0.1, -0.1, 0.3, 0.2}},
    {&gm_problem_fpu, &omega, {1, 0.2, -0.3, 0.1, 0.15, -0.05, 1, 0.1, 0.2, 1, -0.4, 0.3}},
    {&gm_problem_spring_pendulum, &stiffness, {1.1, 0.2, -0.3, 0.4}},
    {&gm_problem_vortices_four, &strength, {1, -0.6, -1.1, 0.5, 0.1, 0.8, -0.2, -0.9}},
    {&gm_problem_vortices_reduced, &strength, {1, -0.6, 0.1, 0.8}},
    {&gm_problem_abc, abc_constants, {0.5, 1.1, -0.4}},
    {&gm_problem_linear, matrix, {0.5, 1.1, -0.4}},
};
enum { CASES = GM_COUNT(cases) };

static void near_at(double value, double expected, double tolerance, int line)
{
    if (!(fabs(value - expected) <= tolerance)) {
        fail_msg("line %d: %.17g is not %.17g to %g", line, value, expected, tolerance);
    }
}
#define expect_near(value, expected, tolerance) near_at(value, expected, tolerance, __LINE__)

static struct gm_problem problem_of(size_t i)
{
    struct gm_problem problem = *cases[i].problem;
    problem.parameters = cases[i].parameters;
    return problem;
}

/* Of the problems whose energy stands in a file, the same in C, in the order of its operations. */
static double energy_by_hand(size_t which, const double *y)
{
    const double q1 = y[0], q2 = y[1], p1 = y[2], p2 = y[3], d = q1 - q2, n = 1 + (q1 * q1 + q2 * q2);
    switch (which) {
    case 0:
        return (p1 * p1 + p2 * p2 + q1 * q1 + q2 * q2) / 2 + q1 * q1 * q2 - q2 * q2 * q2 / 3;
    case 1:
        return 0.5 * q2 * q2 - gm_cos(q1);
    case 2:
        return 0.5 * q2 * q2 + 0.5 * q1 * q1;
    case 3:
        return 0.5 * y[3] * y[3] - gm_cos(q1);
    case 4:
        return 0.5 * y[3] * y[3] + 0.5 * q1 * q1;
    case 5:
        return 0.5 * (1 + q1 * q1) * (1 + q2 * q2);
    case 6:
        return n * n * (p1 * p1 + p2 * p2) / 8;
    default:
        return p1 * p1 / 2 + p2 * p2 / 6 + d * d / 2 + d * d * d * d / 4 +
               strength * (q1 * q1 * q1 * q1 + q2 * q2 * q2 * q2) / 4;
    }
}

/* Bit for bit, of one member and of three; and a potential with its derivatives. */
static void energies_are_those_by_hand(void **unused)
{
    (void)unused;
    static const struct gm_problem *const problems[] = {
        &gm_problem_henon_heiles,     &gm_problem_pendulum,           &gm_problem_oscillator,
        &gm_problem_pendulum_tangent, &gm_problem_oscillator_tangent, &gm_problem_product,
        &gm_problem_fish_eye,         &gm_problem_particles,
    };
    uint64_t seed = 1;
    for (size_t which = 0; which < GM_COUNT(problems); which++) {
        struct gm_problem problem = *problems[which];
        problem.parameters = &strength;
        for (int trial = 0; trial < 10000; trial++) {
            double state[3][6] = {{0}}, y[18], energy[3], alone;
            for (size_t i = 0; i < 3; i++) {
                for (size_t c = 0; c < problem.n; c++) {
                    seed = seed * 6364136223846793005u + 1442695040888963407u;
                    state[i][c] = y[3 * c + i] = ((double)(seed >> 11) * 0x1p-53 - 0.5) * 8;
                }
            }
            gm_ode_of(&problem)->hamiltonian->energy(&problem, y, energy, 3);
            for (size_t i = 0; i < 3; i++) {
                const double expected = energy_by_hand(which, state[i]);
                gm_ode_of(&problem)->hamiltonian->energy(&problem, state[i], &alone, 1);
                assert_memory_equal(&energy[i], &expected, sizeof expected);
                assert_memory_equal(&alone, &expected, sizeof expected);
            }
        }
    }
    for (double q = -4; q < 4; q += 0.01) {
        const double pendulum[3] = {-gm_cos(q), gm_sin(q), gm_cos(q)}, oscillator[3] = {q * q / 2, q, 1};
        double values[3];
        gm_ode_of(&gm_problem_pendulum)->lagrangian->potential(&gm_problem_pendulum, q, values);
        assert_memory_equal(values, pendulum, sizeof values);
        gm_ode_of(&gm_problem_oscillator)->lagrangian->potential(&gm_problem_oscillator, q, values);
        assert_memory_equal(values, oscillator, sizeof values);
    }
}

static void jacobians_are_derivatives(void **unused)
{
    (void)unused;
    for (size_t i = 0; i < CASES; i++) {
        const struct gm_problem problem = problem_of(i);
        const size_t n = problem.n;
        double jacobian[MOST * MOST], y[MOST], plus[MOST], minus[MOST];
        gm_ode_of(&problem)->loops[GM_ISA_BASELINE]->jacobian(&problem, cases[i].y, jacobian);
        for (size_t c = 0; c < n; c++) {
            const double h = 1e-5;
            memcpy(y, cases[i].y, n * sizeof *y);
            y[c] += h;
            gm_field(&problem, y, plus, 1);
            y[c] -= 2 * h;
            gm_field(&problem, y, minus, 1);
            for (size_t r = 0; r < n; r++) {
                const double difference = (plus[r] - minus[r]) / (2 * h);
                if (!(fabs(jacobian[r * n + c] - difference) <= 1e-7 * fmax(1, fabs(difference)))) {
                    fail_msg("%s: J[%zu][%zu] is %g, differences give %g", problem.name, r, c,
                             jacobian[r * n + c], difference);
                }
            }
        }
    }
}

static void fields_are_hamiltonian(void **unused)
{
    (void)unused;
    size_t found = 0;
    for (size_t i = 0; i < CASES; i++) {
        const struct gm_problem problem = problem_of(i);
        if (!gm_ode_of(&problem)->hamiltonian) {
            continue;
        }
        found++;
        const size_t n = problem.n;
        const double weight =
            gm_ode_of(&problem)->hamiltonian->weight ? gm_ode_of(&problem)->hamiltonian->weight(&problem) : 1;
        double y[MOST], f[MOST], plus, minus;
        gm_field(&problem, cases[i].y, f, 1);
        for (size_t c = 0; c < n; c++) {
            const double h = 1e-5;
            memcpy(y, cases[i].y, n * sizeof *y);
            y[c] += h;
            gm_ode_of(&problem)->hamiltonian->energy(&problem, y, &plus, 1);
            y[c] -= 2 * h;
            gm_ode_of(&problem)->hamiltonian->energy(&problem, y, &minus, 1);
            const double slope = weight * (plus - minus) / (2 * h);
            const double expected = c < n / 2 ? -f[n / 2 + c] : f[c - n / 2];
            if (!(fabs(slope - expected) <= 1e-7 * fmax(1, fabs(expected)))) {
                fail_msg("%s: component %zu, w dH is %g, the field gives %g", problem.name, c, slope,
                         expected);
            }
        }
    }
    assert_int_equal(found, 7);
}

/* What the facets take apart makes the field again. */
static void parts_make_the_whole(void **unused)
{
    (void)unused;
    double f[MOST], part[MOST];
    struct gm_problem problem = problem_of(3);
    gm_field(&problem, cases[3].y, f, 1);
    gm_ode_of(&problem)->fast_linear->slow_force(&problem, cases[3].y, part, 1);
    for (size_t c = 0; c < 6; c++) {
        const double frequency = gm_ode_of(&problem)->fast_linear->frequency(&problem, c);
        expect_near(part[c] - frequency * frequency * cases[3].y[c], f[6 + c], 1e-13);
    }
    problem = problem_of(1);
    gm_field(&problem, cases[1].y, f, 1);
    gm_ode_of(&problem)->kepler_split->perturbing_force(&problem, cases[1].y, part, 1);
    const double r = hypot(cases[1].y[0], cases[1].y[1]);
    expect_near(part[0] - cases[1].y[0] / (r * r * r), f[2], 1e-13);
    expect_near(part[1] - cases[1].y[1] / (r * r * r), f[3], 1e-13);
    for (size_t i = 7; i < 9; i++) {
        problem = problem_of(i);
        gm_field(&problem, cases[i].y, f, 1);
        double sum[3] = {0};
        const struct gm_volume *volume = i == 8 ? &trace_free : gm_ode_of(&problem)->volume;
        for (size_t piece = 0; piece < volume->pieces; piece++) {
            double ahead[3], back[3];
            memcpy(ahead, cases[i].y, sizeof ahead);
            memcpy(back, cases[i].y, sizeof back);
            volume->flow(&problem, piece, 1e-5, ahead, 1);
            volume->flow(&problem, piece, -1e-5, back, 1);
            for (size_t c = 0; c < 3; c++) {
                sum[c] += (ahead[c] - back[c]) / 2e-5;
            }
            /* an exact flow: two halves are a whole */
            double twice[3], once[3];
            memcpy(twice, cases[i].y, sizeof twice);
            memcpy(once, cases[i].y, sizeof once);
            volume->flow(&problem, piece, 0.7, once, 1);
            volume->flow(&problem, piece, 0.35, twice, 1);
            volume->flow(&problem, piece, 0.35, twice, 1);
            for (size_t c = 0; c < 3; c++) {
                expect_near(once[c], twice[c], 1e-14);
            }
        }
        for (size_t c = 0; c < 3; c++) {
            expect_near(sum[c], f[c], 1e-9);
        }
    }
}

/* The sum over pairs, for any number of vortices, against the plain double sum. */
static void pair_sums(void **unused)
{
    (void)unused;
    enum { COUNT = 37 };
    double y[2 * COUNT + 2], f[2 * COUNT];
    for (size_t i = 0; i < COUNT; i++) {
        y[i] = cos(0.4 * (double)(i * i)) * (1 + 0.1 * (double)i);
        y[COUNT + i] = sin(0.4 * (double)(i * i)) * (1 + 0.1 * (double)i);
    }
    struct gm_problem problem = gm_problem_vortices;
    problem.parameters = &strength;
    for (size_t count = 2; count <= COUNT; count++) {
        double packed[2 * COUNT];
        memcpy(packed, y, count * sizeof *y);
        memcpy(packed + count, y + COUNT, count * sizeof *y);
        problem.n = 2 * count;
        gm_field(&problem, packed, f, 1);
        for (size_t i = 0; i < count; i++) {
            double u = 0, v = 0;
            for (size_t j = 0; j < count; j++) {
                const double dx = y[i] - y[j], dy = y[COUNT + i] - y[COUNT + j];
                if (j != i) {
                    u -= strength / (2 * M_PI) * dy / (dx * dx + dy * dy);
                    v += strength / (2 * M_PI) * dx / (dx * dx + dy * dy);
                }
            }
            expect_near(f[i], u, 1e-11 * fmax(1, fabs(u)));
            expect_near(f[count + i], v, 1e-11 * fmax(1, fabs(v)));
        }
    }
}

static void four_ways_to_four_vortices(void **unused)
{
    (void)unused;
    const double two[] = {1, -0.6, 0.1, 0.8}, four[] = {1, -0.6, -1, 0.6, 0.1, 0.8, -0.1, -0.8};
    double reduced[4], carrying[4], kernels[8], any[8];
    struct gm_problem problem = gm_problem_vortices_reduced;
    problem.parameters = &strength;
    gm_field(&problem, two, reduced, 1);
    problem = gm_problem_vortices_reduced_carrying;
    problem.parameters = &strength;
    gm_field(&problem, two, carrying, 1);
    problem = gm_problem_vortices_four;
    problem.parameters = &strength;
    gm_field(&problem, four, kernels, 1);
    problem = gm_problem_vortices;
    problem.parameters = &strength;
    gm_field(&problem, four, any, 1);
    for (size_t i = 0; i < 8; i++) {
        expect_near(kernels[i], any[i], 1e-15);
    }
    for (size_t i = 0; i < 2; i++) {
        expect_near(reduced[i], kernels[i], 1e-15);
        expect_near(reduced[2 + i], kernels[4 + i], 1e-15);
        assert_true(reduced[i] == carrying[i] && reduced[2 + i] == carrying[2 + i]);
    }
    /* of all six pairs, the reduced ones too */
    double of_two, of_four;
    gm_ode_of(&gm_problem_vortices_reduced)->hamiltonian->energy(&problem, two, &of_two, 1);
    gm_ode_of(&gm_problem_vortices)->hamiltonian->energy(&problem, four, &of_four, 1);
    expect_near(of_two, of_four, 1e-14);
}

/* The energies of vortices as formulas are those that are computed. */
static void formulas_are_energies(void **unused)
{
    (void)unused;
    for (size_t i = 5; i < 7; i++) {
        const struct gm_problem problem = problem_of(i);
        const struct gm_hamiltonian *hamiltonian = gm_ode_of(&problem)->hamiltonian;
        struct gm_formula graph;
        gm_node_id node;
        gm_formula_open(&graph);
        assert_true(hamiltonian->formula(&problem, &graph, &node));
        double *values = malloc((graph.count + (size_t)1) * sizeof *values), energy;
        assert_non_null(values);
        gm_formula_evaluate(&graph, graph.count, cases[i].y, values);
        hamiltonian->energy(&problem, cases[i].y, &energy, 1);
        expect_near(values[node], energy, 1e-14);
        free(values);
        gm_formula_close(&graph);
    }
}

/* A passive particle's velocity is that of a vortex that the others do not feel. */
static void passive_particles(void **unused)
{
    (void)unused;
    enum { COUNT = 11 };
    double x[COUNT], y[COUNT], u[COUNT], v[COUNT], strain[2 * COUNT], two_u[COUNT], two_v[COUNT];
    for (size_t i = 0; i < COUNT; i++) {
        x[i] = 1.7 * cos((double)i);
        y[i] = 1.3 * sin(2.0 * (double)i + 1);
    }
    const double four[] = {1, -0.6, -1, 0.6, 0.1, 0.8, -0.1, -0.8}, two[] = {1, -0.6, 0.1, 0.8};
    struct gm_problem problem = gm_problem_vortices;
    problem.parameters = &strength;
    problem.passive = COUNT;
    problem.n = 8 + 2 * COUNT;
    const struct gm_loops *loops = gm_ode_of(&problem)->loops[gm_isa_best()];
    loops->passive(&problem, four, x, y, u, v, strain, COUNT);
    struct gm_problem half = gm_problem_vortices_reduced_carrying;
    half.parameters = &strength;
    gm_ode_of(&half)->loops[gm_isa_best()]->passive(&half, two, x, y, two_u, two_v, NULL, COUNT);
    for (size_t i = 0; i < COUNT; i++) {
        double expected_u = 0, expected_v = 0, a = 0, b = 0;
        for (size_t j = 0; j < 4; j++) {
            const double dx = x[i] - four[j], dy = y[i] - four[4 + j], square = dx * dx + dy * dy;
            expected_u -= strength / (2 * M_PI) * dy / square;
            expected_v += strength / (2 * M_PI) * dx / square;
            a += strength / (2 * M_PI) * 2 * dx * dy / (square * square);
            b += strength / (2 * M_PI) * (dy * dy - dx * dx) / (square * square);
        }
        expect_near(u[i], expected_u, 1e-13);
        expect_near(v[i], expected_v, 1e-13);
        expect_near(two_u[i], u[i], 1e-13);
        expect_near(two_v[i], v[i], 1e-13);
        expect_near(strain[i], a, 1e-12);
        expect_near(strain[COUNT + i], b, 1e-12);
    }
}

/* The exact Kepler motion: a closed orbit, Kepler's second law through a quarter of it, and the reverse. */
static void kepler_motion(void **unused)
{
    (void)unused;
    for (int k = 0; k < 4; k++) {
        const double e = (const double[]){0, 0.5, 0.9, 0.99}[k];
        const double start[] = {1 - e, 0, 0, sqrt((1 + e) / (1 - e))};
        /* 1/a = 2/r - v^2 cancels by this much at the pericentre */
        const double tolerance = 1e-14 / (1 - e);
        double y[4], back[4];
        gm_problem_kepler.exact->solution(&gm_problem_kepler, M_PI, start, y, 1);
        expect_near(y[0], -(1 + e), tolerance);
        expect_near(y[1], 0, 10 * tolerance);
        expect_near(y[3], -sqrt((1 - e) / (1 + e)), tolerance);
        /* E = pi/2 at the time pi/2 - e */
        gm_problem_kepler.exact->solution(&gm_problem_kepler, M_PI / 2 - e, start, y, 1);
        expect_near(y[0], -e, tolerance);
        expect_near(y[1], sqrt(1 - e * e), tolerance);
        gm_problem_kepler.exact->solution(&gm_problem_kepler, -(M_PI / 2 - e) - 200 * M_PI, y, back, 1);
        for (size_t c = 0; c < 4; c++) {
            expect_near(back[c], start[c], 1e3 * tolerance / ((1 - e) * (1 - e)));
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(energies_are_those_by_hand),
        cmocka_unit_test(jacobians_are_derivatives),
        cmocka_unit_test(fields_are_hamiltonian),
        cmocka_unit_test(parts_make_the_whole),
        cmocka_unit_test(pair_sums),
        cmocka_unit_test(four_ways_to_four_vortices),
        cmocka_unit_test(formulas_are_energies),
        cmocka_unit_test(passive_particles),
        cmocka_unit_test(kepler_motion),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
