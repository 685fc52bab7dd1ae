/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The r-adaptive schemes against an independent implementation's values of every node. */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "core/basics.h"
#include "core/linear/banded.h"
#include "core/mesh/element.h"
#include "core/mesh/families/families.h"
#include "core/run.h"
#include "core/schemes.h"
#include "core/theory/certify.h"
#include "tests/common/mesh_soliton.h"
#include "tests/common/reference.h"

static const struct gm_settings settings = {0};

static struct gm_run *open_soliton(const struct gm_soliton *soliton, struct gm_problem *problem,
                                   const char *name, double dt)
{
    gm_soliton_problem(soliton, problem);
    const struct gm_scheme *scheme = gm_scheme_find(name);
    assert_non_null(scheme);
    struct gm_mesh mesh;
    gm_moving_mesh_of(problem)->describe(problem, &mesh);
    double *state = malloc(problem->n * sizeof *state);
    assert_non_null(state);
    assert_true(gm_mesh_start(&mesh, gm_scheme_mesh(scheme), gm_soliton_profile, soliton, state));
    struct gm_run *run = gm_run_open(problem, scheme, &settings, 0, dt, state);
    free(state);
    assert_non_null(run);
    assert_int_equal(run->status, GM_OK);
    return run;
}

static const struct gm_soliton boxed = {
    .solitons = 1, .points = 15, .velocity = 0.9, .length = 25, .alpha = 2.5};

static void every_node_of_the_reference(void **unused)
{
    (void)unused;
    for (size_t i = 0; i < reference_cases(); i++) {
        const char *scheme = reference_word(i, 0);
        const double *y = reference_of(i, "y", 17), *x = reference_of(i, "x", 17),
                     t = reference_number(i, "t");
        struct gm_problem problem;
        struct gm_run *run = open_soliton(&boxed, &problem, scheme, 0.01);
        struct gm_mesh mesh;
        gm_moving_mesh_of(&problem)->describe(&problem, &mesh);
        assert_true(fabs(gm_mesh_energy(&mesh, gm_run_state(run)) - reference_number(i, "energy")) < 1e-11);
        assert_int_equal(gm_run_until(run, t), GM_OK);
        double farthest = 0;
        for (size_t k = 0; k < 15; k++) {
            farthest = fmax(farthest, fabs(gm_run_state(run)[k] - y[k + 1]));
            farthest = fmax(farthest, fabs(gm_run_state(run)[15 + k] - x[k + 1]));
        }
        if (!(farthest < fmax(1e-9, 10 * reference_number(i, "spread")))) {
            fail_msg("%s at t = %g: %.3g", scheme, t, farthest);
        }
        print_message("    %-24s t = %-4g every node within %.1e\n", scheme, t, farthest);
        gm_run_close(run);
    }
}

/* 200 steps there and 200 back, over a stretch where every scheme holds. */
static void symmetric_schemes_come_back(void **unused)
{
    (void)unused;
    static const char *const names[] = {
        "uniform-gauss2",      "uniform-gauss4",      "uniform-lobatto2",       "uniform-lobatto4",
        "control-gauss2",      "control-gauss4",      "control-lobatto2",       "control-lobatto4",
        "multiplier-lobatto2", "multiplier-lobatto4", "multiplier-trapezoidal", "multiplier-adaptive4"};
    double start[60];
    for (size_t i = 0; i < GM_COUNT(names); i++) {
        struct gm_problem problem;
        struct gm_run *run = open_soliton(&boxed, &problem, names[i], 0.01);
        memcpy(start, gm_run_state(run), sizeof start);
        assert_int_equal(gm_run_advance(run, 200), GM_OK);
        gm_run_set_step(run, -0.01);
        assert_int_equal(gm_run_advance(run, 200), GM_OK);
        double farthest = 0;
        for (size_t k = 0; k < 30; k++) {
            farthest = fmax(farthest, fabs(gm_run_state(run)[k] - start[k]));
        }
        print_message("    200 steps there and back, %-22s %.1e\n", names[i], farthest);
        if (!(farthest < 1e-11)) {
            fail_msg("%s: %.3g", names[i], farthest);
        }
        gm_run_close(run);
    }
}

/* Steps in one go, one by one, and from a snapshot between, give the same bits, factors and all. */
static void resumed_runs_keep_their_bits(void **unused)
{
    (void)unused;
    static const char *const names[] = {
        "uniform-gauss4",      "control-gauss4",         "control-radau5",      "multiplier-lobatto4",
        "multiplier-lobatto2", "multiplier-trapezoidal", "multiplier-adaptive4"};
    for (size_t i = 0; i < GM_COUNT(names); i++) {
        struct gm_problem problem;
        struct gm_run *whole = open_soliton(&boxed, &problem, names[i], 0.03);
        struct gm_run *steps = open_soliton(&boxed, &problem, names[i], 0.03);
        struct gm_run *resumed = open_soliton(&boxed, &problem, names[i], 0.03);
        void *snapshot = malloc(gm_run_snapshot_size(whole));
        assert_non_null(snapshot);
        for (int k = 0; k < 90; k++) {
            gm_run_advance(steps, 1);
            if (k == 36) {
                gm_run_save(steps, snapshot);
            }
        }
        gm_run_load(resumed, snapshot);
        gm_run_advance(resumed, 53);
        gm_run_advance(whole, 90);
        const size_t size = problem.n * sizeof(double);
        assert_int_equal(whole->steps, 90);
        assert_int_equal(resumed->steps, 90);
        assert_memory_equal(gm_run_state(whole), gm_run_state(steps), size);
        assert_memory_equal(gm_run_state(whole), gm_run_state(resumed), size);
        assert_true(whole->evaluations == steps->evaluations && whole->evaluations == resumed->evaluations);
        /* and a workspace that has seen other steps forgets them */
        gm_run_load(whole, snapshot);
        gm_run_advance(whole, 53);
        assert_memory_equal(gm_run_state(whole), gm_run_state(resumed), size);
        free(snapshot);
        gm_run_close(whole);
        gm_run_close(steps);
        gm_run_close(resumed);
    }
}

/* A run that is resumed from a memory whose factors are those of a mesh without cells makes others, at once. */
static void factors_of_no_mesh_are_made_anew(void **unused)
{
    (void)unused;
    static const char *const names[] = {"control-gauss4", "control-radau5", "multiplier-lobatto4"};
    for (size_t i = 0; i < GM_COUNT(names); i++) {
        struct gm_problem problem;
        struct gm_run *whole = open_soliton(&boxed, &problem, names[i], 0.03);
        struct gm_run *resumed = open_soliton(&boxed, &problem, names[i], 0.03);
        assert_int_equal(gm_run_advance(whole, 37), GM_OK);
        const double factorisations = gm_mesh_factorisations(whole);
        const size_t count = whole->scheme->family->memory(&problem, whole->scheme);
        double *memory = malloc(count * sizeof *memory);
        assert_non_null(memory);
        memcpy(memory, gm_run_memory(whole), count * sizeof *memory);
        memset(memory + count - problem.n, 0, problem.n * sizeof *memory); /* the state of the factors */
        gm_run_set_state(resumed, gm_run_state(whole), memory);
        assert_int_equal(gm_run_advance(resumed, 1), GM_OK);
        assert_true(gm_mesh_factorisations(resumed) == factorisations + 1);
        assert_int_equal(gm_run_advance(resumed, 9), GM_OK);
        assert_int_equal(gm_run_advance(whole, 10), GM_OK);
        assert_true(gm_distance(gm_run_state(whole), gm_run_state(resumed), problem.n) < 1e-9);
        free(memory);
        gm_run_close(whole);
        gm_run_close(resumed);
    }
}

static double error_of(const struct gm_soliton *soliton, const struct gm_run *run)
{
    double largest = 0;
    const size_t points = (size_t)soliton->points;
    for (size_t k = 0; k < points; k++) {
        const double x = gm_run_state(run)[points + k];
        largest = fmax(largest, fabs(gm_run_state(run)[k] - gm_soliton_exact(soliton, x, run->t)));
    }
    return largest;
}

/* The largest difference of d ell/dt between neighbours over the largest ell: zero where the velocities keep
   the constraint. */
static double rate_defect(const struct gm_mesh *mesh, const double *state)
{
    struct gm_elements stage;
    assert_true(gm_elements_open(&stage, mesh));
    gm_elements_place(&stage, state);
    assert_true(gm_elements_measure(&stage, mesh));
    double jump = 0, size = 0;
    for (size_t e = 1; e < stage.count; e++) {
        jump = fmax(jump, fabs(stage.rate[e] - stage.rate[e - 1]));
        size = fmax(size, stage.ell[e]);
    }
    gm_elements_close(&stage);
    return jump / size;
}

/* In flight from any strategy to any other: the new one starts on its own kind of mesh, near the old
   field. */
static void strategies_take_over(void **unused)
{
    (void)unused;
    static const char *const names[] = {"uniform-gauss4", "control-gauss4", "multiplier-lobatto4",
                                        "multiplier-trapezoidal"};
    struct gm_soliton soliton = boxed;
    soliton.points = 63;
    for (size_t a = 0; a < 4; a++) {
        for (size_t b = 0; b < 4; b++) {
            struct gm_problem problem;
            struct gm_run *run = open_soliton(&soliton, &problem, names[a], 0.01);
            struct gm_mesh mesh;
            gm_moving_mesh_of(&problem)->describe(&problem, &mesh);
            assert_int_equal(gm_run_advance(run, 100), GM_OK);
            const double error = error_of(&soliton, run), energy = gm_mesh_energy(&mesh, gm_run_state(run));
            struct gm_run *next = gm_run_switch(run, gm_scheme_find(names[b]));
            assert_non_null(next);
            assert_int_equal(next->status, GM_OK);
            assert_true(error_of(&soliton, next) < error + 0.1);
            assert_true(fabs(gm_mesh_energy(&mesh, gm_run_state(next)) / energy - 1) < 0.03);
            if (gm_scheme_mesh(next->scheme) == GM_MESH_MOVING) {
                assert_true(gm_mesh_measure(&mesh, gm_run_state(next), GM_MEASURE_DEFECT) < 1e-10);
                assert_true(rate_defect(&mesh, gm_run_state(next)) < 1e-10);
            } else {
                assert_true(fabs(gm_mesh_measure(&mesh, gm_run_state(next), GM_MEASURE_NARROWEST) -
                                 25. / 64) < 1e-12);
            }
            const double taken = error_of(&soliton, next),
                         kept = gm_mesh_energy(&mesh, gm_run_state(next)) / energy - 1;
            assert_int_equal(gm_run_advance(next, 100), GM_OK);
            assert_true(error_of(&soliton, next) < error + 0.4);
            print_message("    %-22s to %-22s error %.4f to %.4f, energy %+.1e\n", names[a], names[b], error,
                          taken, kept);
            gm_run_close(run);
            gm_run_close(next);
        }
    }
}

/* alpha = 0 is the uniform mesh, to round-off, whatever moves it. */
static void without_density_the_mesh_is_uniform(void **unused)
{
    (void)unused;
    struct gm_soliton soliton = boxed;
    soliton.alpha = 0;
    static const char *const pairs[][2] = {{"control-gauss4", "uniform-gauss4"},
                                           {"control-lobatto2", "uniform-lobatto2"},
                                           {"multiplier-lobatto4", "uniform-lobatto4"},
                                           {"multiplier-lobatto2", "uniform-lobatto2"},
                                           {"multiplier-trapezoidal", "uniform-lobatto2"}};
    for (size_t i = 0; i < GM_COUNT(pairs); i++) {
        struct gm_problem problem;
        struct gm_run *moving = open_soliton(&soliton, &problem, pairs[i][0], 0.01);
        struct gm_run *fixed = open_soliton(&soliton, &problem, pairs[i][1], 0.01);
        assert_int_equal(gm_run_advance(moving, 100), GM_OK);
        assert_int_equal(gm_run_advance(fixed, 100), GM_OK);
        for (size_t k = 0; k < 30; k++) {
            if (!(fabs(gm_run_state(moving)[k] - gm_run_state(fixed)[k]) < 1e-9)) {
                fail_msg("%s: component %zu differs by %.3g", pairs[i][0], k,
                         gm_run_state(moving)[k] - gm_run_state(fixed)[k]);
            }
        }
        gm_run_close(moving);
        gm_run_close(fixed);
    }
}

/* Gradients and matrices of an element against differences of the Lagrangian written down a second time, by
   Gauss quadrature of the fields, for every potential and density. */
static double lagrangian(const struct gm_mesh *mesh, const double z[4], const double rate[4])
{
    static const double at[] = {0.9061798459386640, 0.5384693101056831, 0, -0.5384693101056831,
                                -0.9061798459386640};
    static const double weight[] = {0.2369268850561891, 0.4786286704993665, 0.5688888888888889,
                                    0.4786286704993665, 0.2369268850561891};
    enum { PIECES = 8 };
    const double d = z[3] - z[1], slope = (z[2] - z[0]) / d;
    double sum = 0;
    for (int piece = 0; piece < PIECES; piece++) {
        for (int i = 0; i < 5; i++) {
            const double s = (piece + (1 + at[i]) / 2) / PIECES;
            const double phi = (1 - s) * z[0] + s * z[2];
            const double phi_t = (1 - s) * (rate[0] - slope * rate[1]) + s * (rate[2] - slope * rate[3]);
            const double w =
                mesh->potential == &gm_potential_phi4 ? (phi * phi - 1) * (phi * phi - 1) / 4 : 1 - cos(phi);
            sum += weight[i] / 2 / PIECES * d * (phi_t * phi_t / 2 - slope * slope / 2 - w);
        }
    }
    return sum;
}

/* ell of the density itself */
static double ell_of(const struct gm_mesh *mesh, const double z[4])
{
    const double d = z[3] - z[1], s = (z[2] - z[0]) / d, at[] = {s, s, z[0], z[2], z[1], z[3]};
    double values[2 * GM_DENSITY_VALUES];
    if (mesh->density->local) {
        mesh->density->values(mesh->density, at, values, 2);
        return d * d * (values[0] + values[1]) / 2;
    }
    mesh->density->values(mesh->density, at, values, 1);
    return d * d * values[0];
}

static void expect_near(const char *what, double got, double wanted)
{
    if (!(fabs(got - wanted) < 2e-7 * (1 + fabs(wanted)))) {
        fail_msg("%s: %.12g instead of %.12g", what, got, wanted);
    }
}

static void derivatives_of_an_element(void **unused)
{
    (void)unused;
    static const double places[][4] = {
        {0.3, 1, 1.1, 1.7}, {1, 2, 1 + 1e-9, 2.5}, {-1, 0.5, 3.5, 1.2}, {6, 1, 6.2, 9}};
    static const double rate[4] = {0.4, -0.3, 0.7, 0.9};
    const struct gm_potential *const potentials[] = {&gm_potential_sine_gordon, &gm_potential_phi4};
    for (size_t which = 0; which < 48; which++) {
        const struct gm_density_numbers numbers = {(enum gm_closed_density)(which / 4 % 6),
                                                   which < 24 ? GM_SINE_GORDON : GM_PHI4, 1.3, 2.5, 0.4};
        const struct gm_mesh mesh = {.points = 1,
                                     .level = 1,
                                     .length = 12,
                                     .density = gm_closed_density(&numbers),
                                     .potential = potentials[which / 24]};
        const double *z0 = places[which % 4];
        struct gm_elements stage;
        assert_true(gm_elements_open(&stage, &mesh));
        for (int a = 0; a < 4; a++) {
            for (int b = 0; b < 4; b++) {
                /* element 0 holds z, element 1 some other shape */
                double z[2][4], v[2][4];
                const double h = 1e-4;
                for (int side = 0; side < 2; side++) {
                    memcpy(z[side], z0, sizeof z[side]);
                    memcpy(v[side], rate, sizeof v[side]);
                }
                z[1][b] += h;
                z[0][b] -= h;
                double gradient[2][4], momentum[2][4], ell[2][4];
                struct gm_element_matrices matrices;
                for (int side = 0; side < 3; side++) {
                    const double *at = side < 2 ? z[side] : z0;
                    stage.y[0] = at[0], stage.x[0] = at[1], stage.y[1] = at[2], stage.x[1] = at[3];
                    stage.u[0] = rate[0], stage.v[0] = rate[1], stage.u[1] = rate[2], stage.v[1] = rate[3];
                    stage.y[2] = 0, stage.x[2] = at[3] + 1;
                    assert_true(gm_elements_evaluate(&stage, &mesh));
                    gm_elements_constrain(&stage, &mesh);
                    if (side == 2) {
                        gm_elements_matrices(&stage, &mesh, 0, true, &matrices);
                        break;
                    }
                    const double g = stage.slope[0];
                    const double list[3][4] = {
                        {stage.force_y0[0], -stage.force_d[0], stage.force_y1[0], stage.force_d[0]},
                        {stage.momentum_u0[0], -g * stage.momentum_u0[0], stage.momentum_u1[0],
                         -g * stage.momentum_u1[0]},
                        {stage.gradient[0][0], stage.gradient[1][0], stage.gradient[2][0],
                         stage.gradient[3][0]}};
                    memcpy(gradient[side], list[0], sizeof list[0]);
                    memcpy(momentum[side], list[1], sizeof list[1]);
                    memcpy(ell[side], list[2], sizeof list[2]);
                }
                expect_near("stiffness", matrices.stiff[a][b], (gradient[1][a] - gradient[0][a]) / (2 * h));
                expect_near("mixed", matrices.mixed[a][b], (momentum[1][a] - momentum[0][a]) / (2 * h));
                expect_near("density's Hessian", matrices.hessian[a][b], (ell[1][a] - ell[0][a]) / (2 * h));
                if (b == 0) { /* what a step takes is the same */
                    double along = 0;
                    for (int c = 0; c < 4; c++) {
                        along += matrices.hessian[a][c] * rate[c];
                    }
                    expect_near("Hessian times velocity", matrices.bend[a], along);
                }
                if (a == b) {
                    const double force[4] = {stage.force_y0[0], -stage.force_d[0], stage.force_y1[0],
                                             stage.force_d[0]};
                    expect_near("force", force[b],
                                (lagrangian(&mesh, z[1], rate) - lagrangian(&mesh, z[0], rate)) / (2 * h));
                    expect_near("density's gradient", matrices.gradient[b],
                                (ell_of(&mesh, z[1]) - ell_of(&mesh, z[0])) / (2 * h));
                    v[1][b] += h;
                    v[0][b] -= h;
                    const double g = stage.slope[0];
                    const double p[4] = {stage.momentum_u0[0], -g * stage.momentum_u0[0],
                                         stage.momentum_u1[0], -g * stage.momentum_u1[0]};
                    expect_near("momentum", p[b],
                                (lagrangian(&mesh, z0, v[1]) - lagrangian(&mesh, z0, v[0])) / (2 * h));
                }
            }
        }
        gm_elements_close(&stage);
    }
}

/* A banded solve against the matrix it was made of. */
static void banded_systems_are_solved(void **unused)
{
    (void)unused;
    for (size_t n = 1; n <= 40; n += 3) {
        for (size_t band = 1; band <= 17; band += 4) {
            struct gm_banded matrix;
            assert_true(gm_banded_open(&matrix, n, band));
            double dense[40][40] = {{0}}, x[40], wanted[40];
            for (size_t i = 0; i < n; i++) {
                wanted[i] = cos((double)i);
                for (size_t j = i > band ? i - band : 0; j < n && j <= i + band; j++) {
                    dense[i][j] = sin((double)(7 * i + 3 * j * j)) + (i == j ? 0.01 : 0);
                    gm_banded_add(&matrix, i, j, dense[i][j]);
                }
            }
            for (size_t i = 0; i < n; i++) {
                x[i] = 0;
                for (size_t j = 0; j < n; j++) {
                    x[i] += dense[i][j] * wanted[j];
                }
            }
            assert_true(gm_banded_factor(&matrix));
            gm_banded_solve(&matrix, x);
            for (size_t i = 0; i < n; i++) {
                assert_true(fabs(x[i] - wanted[i]) < 1e-9);
            }
            gm_banded_close(&matrix);
        }
    }
}

/* Where a banded matrix of the test holds zeros. */
enum zeros { NOWHERE, IN_CORNERS, ANYWHERE, ZEROS };

enum { ORDER = 40 };

static double drawn(unsigned long long *seed)
{
    *seed = *seed * 6364136223846793005u + 1442695040888963407u;
    return (double)(*seed >> 11) / (1ull << 52) - 1;
}

/* Rows of a random banded matrix. In corners: three unknowns a node, and nodes that know their neighbours alone, so
   that a row ends where its neighbour's last unknown does. Small diagonals make pivots move. */
static void draw_banded(double dense[ORDER][ORDER], size_t n, size_t band, enum zeros zeros,
                        unsigned long long *seed)
{
    memset(dense, 0, ORDER * sizeof *dense);
    for (size_t i = 0; i < n; i++) {
        for (size_t j = i > band ? i - band : 0; j < n && j <= i + band; j++) {
            const size_t nodes = i / 3 > j / 3 ? i / 3 - j / 3 : j / 3 - i / 3;
            const bool passed = (zeros == IN_CORNERS && nodes > band / 3) ||
                                (zeros == ANYWHERE && i != j && drawn(seed) < 0.2);
            const double value = drawn(seed) * (i == j ? 0.1 : 1);
            dense[i][j] = passed ? 0 : value;
        }
    }
}

/* Elimination by the book on the whole matrix, the right side carried along, no zero passed over. Multipliers are
   products with a pivot's inverse, as in banded solves, and every entry takes its terms in the order of columns, so
   that the same is rounded. False: singular. How many rows were exchanged is added to `exchanges`. */
static bool eliminate(double a[ORDER][ORDER], size_t n, double *x, size_t *exchanges)
{
    for (size_t j = 0; j < n; j++) {
        size_t pivot = j;
        for (size_t i = j + 1; i < n; i++) {
            pivot = fabs(a[i][j]) > fabs(a[pivot][j]) ? i : pivot;
        }
        if (a[pivot][j] == 0) {
            return false;
        }
        *exchanges += pivot != j;
        for (size_t k = 0; k < n; k++) {
            const double held = a[j][k];
            a[j][k] = a[pivot][k];
            a[pivot][k] = held;
        }
        const double held = x[j], inverse = 1 / a[j][j];
        x[j] = x[pivot];
        x[pivot] = held;
        for (size_t i = j + 1; i < n; i++) {
            const double factor = a[i][j] * inverse;
            for (size_t k = j + 1; k < n; k++) {
                a[i][k] -= a[j][k] * factor;
            }
            x[i] -= x[j] * factor;
        }
    }
    for (size_t i = n; i-- > 0;) {
        for (size_t j = n; --j > i;) {
            x[i] -= x[j] * a[i][j];
        }
        x[i] /= a[i][i];
    }
    return true;
}

/* Bit for bit what elimination on the whole matrix gives, wherever zeros are; one set of factors serves two right
   sides; and x solves a system that is
   the given one but for round-off. */
static void zeros_of_a_band_change_nothing(void **unused)
{
    (void)unused;
    unsigned long long seed = 20;
    size_t exchanges[ZEROS] = {0};
    double worst = 0;
    for (int trial = 0; trial < 3000; trial++) {
        const enum zeros zeros = (enum zeros)(trial % ZEROS);
        const size_t n = 1 + (size_t)trial % ORDER, band = 1 + (size_t)trial / ORDER % 17;
        static double dense[ORDER][ORDER], eliminated[ORDER][ORDER];
        draw_banded(dense, n, band, zeros, &seed);
        struct gm_banded matrix;
        assert_true(gm_banded_open(&matrix, n, band));
        for (size_t i = 0; i < n; i++) {
            for (size_t j = i > band ? i - band : 0; j < n && j <= i + band; j++) {
                gm_banded_add(&matrix, i, j, dense[i][j]);
            }
        }
        const bool factored = gm_banded_factor(&matrix);
        for (int side = 0; side < 2; side++) {
            double right[ORDER], x[ORDER], wanted[ORDER];
            for (size_t i = 0; i < n; i++) {
                right[i] = wanted[i] = x[i] = side == 1 && i % 3 != 0 ? 0 : drawn(&seed);
            }
            memcpy(eliminated, dense, sizeof eliminated);
            assert_int_equal(factored, eliminate(eliminated, n, wanted, &exchanges[zeros]));
            if (!factored) {
                break;
            }
            gm_banded_solve(&matrix, x);
            for (size_t i = 0; i < n; i++) {
                if (x[i] != wanted[i]) {
                    fail_msg("n = %zu, band %zu, zeros %d: x[%zu] = %.17g, %.17g on the whole matrix", n,
                             band, (int)zeros, i, x[i], wanted[i]);
                }
            }
            double defect = 0, size = 0, length = 0;
            for (size_t i = 0; i < n; i++) {
                double left = right[i], row = 0;
                for (size_t j = 0; j < n; j++) {
                    left -= dense[i][j] * x[j];
                    row += fabs(dense[i][j]);
                }
                defect = fmax(defect, fabs(left));
                size = fmax(size, row);
                length = fmax(length, fabs(x[i]));
            }
            worst = fmax(worst, defect / (size * length));
        }
        gm_banded_close(&matrix);
    }
    print_message("    rows exchanged: %zu, %zu, %zu; largest defect %.1e\n", exchanges[NOWHERE],
                  exchanges[IN_CORNERS], exchanges[ANYWHERE], worst);
    assert_true(worst < 100 * DBL_EPSILON); /* 40 columns, and pivots that let entries grow a little */
    for (int zeros = 0; zeros < ZEROS; zeros++) {
        assert_true(exchanges[zeros] > 10000);
    }
}

/* A column of zeros and a number that is none end in no factors. */
static void singular_bands_are_refused(void **unused)
{
    (void)unused;
    for (size_t column = 0; column < 9; column++) {
        for (int fault = 0; fault < 2; fault++) {
            struct gm_banded matrix;
            assert_true(gm_banded_open(&matrix, 9, 2));
            for (size_t i = 0; i < 9; i++) {
                for (size_t j = i > 2 ? i - 2 : 0; j < 9 && j <= i + 2; j++) {
                    const double value = 1 + (double)((i + 2 * j) % 5);
                    gm_banded_add(&matrix, i, j, j != column ? value : fault == 0 ? 0 : i == j ? NAN : value);
                }
            }
            assert_false(gm_banded_factor(&matrix));
            gm_banded_close(&matrix);
        }
    }
}

/* What ends a run is a status, never a tangled mesh; one node and very many are as good as any. */
static void extremes_end_well(void **unused)
{
    (void)unused;
    static const struct {
        long points;
        double velocity, alpha, dt;
        long steps;
    } cases[] = {{1, 0.9, 2.5, 0.01, 200},      {2, 0.9, 2.5, 0.01, 200}, {31, 0.9, 2.5, 1, 50},
                 {31, 0.999999, 2.5, 0.01, 20}, {31, 0.9, 100, 0.01, 50}, {20000, 0.9, 2.5, 1e-6, 1},
                 {31, 0.01, 2.5, 0.1, 50},      {127, 0.9, 2.5, 1, 50},   {31, 0.9, 1000, 0.01, 50}};
    static const char *const names[] = {"uniform-gauss4", "control-gauss4", "control-radau5",
                                        "multiplier-lobatto4", "multiplier-trapezoidal"};
    for (size_t c = 0; c < GM_COUNT(cases); c++) {
        const struct gm_soliton soliton = {.solitons = 1,
                                           .points = cases[c].points,
                                           .velocity = cases[c].velocity,
                                           .length = 25,
                                           .alpha = cases[c].alpha};
        for (size_t i = 0; i < GM_COUNT(names); i++) {
            struct gm_problem problem;
            gm_soliton_problem(&soliton, &problem);
            struct gm_mesh mesh;
            gm_moving_mesh_of(&problem)->describe(&problem, &mesh);
            const struct gm_scheme *scheme = gm_scheme_find(names[i]);
            double *state = malloc(problem.n * sizeof *state);
            assert_non_null(state);
            if (gm_mesh_start(&mesh, gm_scheme_mesh(scheme), gm_soliton_profile, &soliton, state)) {
                struct gm_run *run = gm_run_open(&problem, scheme, &settings, 0, cases[c].dt, state);
                assert_non_null(run);
                gm_run_advance(run, cases[c].steps);
                assert_true(gm_mesh_measure(&mesh, gm_run_state(run), GM_MEASURE_NARROWEST) > 0);
                assert_true(isfinite(gm_mesh_energy(&mesh, gm_run_state(run))));
                gm_run_close(run);
            } else {
                fail_msg("no mesh of %ld nodes for alpha = %g", cases[c].points, cases[c].alpha);
            }
            free(state);
        }
    }
}

/* Two sine-Gordon solitons and phi^4 kinks: the mesh follows, the energy is kept. */
static void other_fields_and_densities(void **unused)
{
    (void)unused;
    for (int field = 0; field < 2; field++) {
        for (int which = 0; which < 5; which++) {
            const struct gm_soliton soliton = {.field = field,
                                               .density = which,
                                               .solitons = 1,
                                               .points = 31,
                                               .velocity = 0.5,
                                               .length = 25,
                                               .alpha = NAN};
            struct gm_problem problem;
            struct gm_run *run = open_soliton(&soliton, &problem, "multiplier-lobatto4", 0.01);
            struct gm_mesh mesh;
            gm_moving_mesh_of(&problem)->describe(&problem, &mesh);
            const double energy = gm_mesh_energy(&mesh, gm_run_state(run));
            assert_true(fabs(energy / gm_soliton_energy(&soliton) - 1) < 0.02);
            assert_int_equal(gm_run_advance(run, 500), GM_OK);
            assert_true(error_of(&soliton, run) < 0.05);
            assert_true(fabs(gm_mesh_energy(&mesh, gm_run_state(run)) / energy - 1) < 1e-6);
            assert_true(gm_mesh_measure(&mesh, gm_run_state(run), GM_MEASURE_DEFECT) < 1e-10);
            gm_run_close(run);
        }
    }
}

/* certify refuses rows that are wrong or claim what they do not have. */
static void wrong_rows_are_caught(void **unused)
{
    (void)unused;
    struct gm_scheme wrong = *gm_scheme_find("control-gauss4");
    assert_true(gm_certify(&wrong).holds);
    wrong.claims |= GM_SYMPLECTIC;
    assert_false(gm_certify(&wrong).holds);
    wrong = *gm_scheme_find("control-radau3");
    wrong.claims |= GM_SYMMETRIC;
    assert_false(gm_certify(&wrong).holds);
    wrong = *gm_scheme_find("multiplier-lobatto2");
    wrong.order = 3;
    assert_false(gm_certify(&wrong).order_holds);
    /* a wrong digit among the coefficients */
    struct gm_mesh_tableau tableau = gm_tableau_lobatto4;
    tableau.abar[2][1] += 1e-4;
    struct gm_mesh_row digit =
        *(const struct gm_mesh_row *)gm_scheme_find("multiplier-lobatto4")->coefficients;
    digit.tableau = &tableau;
    wrong = *gm_scheme_find("multiplier-lobatto4");
    wrong.coefficients = &digit;
    assert_false(gm_certify(&wrong).holds);
}

/* The local law of the trapezoidal discrete Lagrangian holds for its own rule, and for no other. */
static void one_rule_is_multisymplectic(void **unused)
{
    (void)unused;
    const unsigned bit = 7;
    assert_int_equal(1u << bit, GM_MULTISYMPLECTIC);
    const struct gm_certificate right = gm_certify(gm_scheme_find("multiplier-trapezoidal"));
    assert_true(right.claims[bit].claimed && right.claims[bit].holds);
    assert_true(right.claims[bit].defect < 1e-10);
    static const char *const others[] = {"multiplier-lobatto2", "multiplier-lobatto4", "control-lobatto2",
                                         "control-gauss4", "control-radau3"};
    for (size_t i = 0; i < GM_COUNT(others); i++) {
        struct gm_scheme wrong = *gm_scheme_find(others[i]);
        wrong.claims |= GM_MULTISYMPLECTIC;
        const struct gm_certificate certificate = gm_certify(&wrong);
        assert_false(certificate.holds);
        if (!(certificate.claims[bit].defect > 1e-4)) {
            fail_msg("%s: defect %.3g", others[i], certificate.claims[bit].defect);
        }
    }
    /* on a mesh that stands still one stage is, and two are not */
    assert_true(gm_certify(gm_scheme_find("uniform-gauss2")).claims[bit].holds);
    struct gm_scheme uniform = *gm_scheme_find("uniform-gauss4");
    uniform.claims |= GM_MULTISYMPLECTIC;
    const struct gm_certificate certificate = gm_certify(&uniform);
    assert_true(certificate.claims[bit].measured && !certificate.holds);
    if (!(certificate.claims[bit].defect > 1e-6)) {
        fail_msg("uniform-gauss4: defect %.3g", certificate.claims[bit].defect);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_node_of_the_reference),
        cmocka_unit_test(symmetric_schemes_come_back),
        cmocka_unit_test(resumed_runs_keep_their_bits),
        cmocka_unit_test(factors_of_no_mesh_are_made_anew),
        cmocka_unit_test(strategies_take_over),
        cmocka_unit_test(without_density_the_mesh_is_uniform),
        cmocka_unit_test(derivatives_of_an_element),
        cmocka_unit_test(banded_systems_are_solved),
        cmocka_unit_test(zeros_of_a_band_change_nothing),
        cmocka_unit_test(singular_bands_are_refused),
        cmocka_unit_test(extremes_end_well),
        cmocka_unit_test(other_fields_and_densities),
        cmocka_unit_test(wrong_rows_are_caught),
        cmocka_unit_test(one_rule_is_multisymplectic),
    };
    reference_open("soliton.txt");
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    reference_close();
    return failed;
}
