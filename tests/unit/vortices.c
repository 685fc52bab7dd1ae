/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Runge-Kutta methods on problems whose n is chosen at run time, the passive particles they carry, and sums by moments. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "core/basics.h"
#include "core/ode/kernel/loops.h"
#include "core/ode/kernel/members.h"
#include "core/ode/problems/problems.h"
#include "core/run.h"
#include "core/schemes.h"

static const double strength = 2;
static const double four[] = {1, -0.6, -1, 0.6, 0.1, 0.8, -0.1, -0.8};
static const char *const names[] = {"explicit-euler", "rk2",    "rk4",   "implicit-euler",
                                    "midpoint",       "gauss4", "rk4sym"};
enum { NAMES = GM_COUNT(names), TRACERS = 150 };

static struct gm_run *open_run(const struct gm_problem *problem, const char *scheme, int compensated,
                               double dt, const double *y)
{
    const struct gm_settings settings = {.compensated = compensated};
    assert_true(gm_scheme_fits(gm_scheme_find(scheme), problem));
    struct gm_run *run = gm_run_open(problem, gm_scheme_find(scheme), &settings, 0, dt, y);
    assert_non_null(run);
    return run;
}

static struct gm_problem with(const struct gm_problem *problem)
{
    struct gm_problem copy = *problem;
    copy.parameters = &strength;
    return copy;
}

/* The loop for any n takes the same steps as the loop over kernels. */
static void any_number_is_four(void **unused)
{
    (void)unused;
    const struct gm_problem any = with(&gm_problem_vortices), kernels = with(&gm_problem_vortices_four);
    for (size_t i = 0; i < NAMES; i++) {
        for (int compensated = 0; compensated < 2; compensated++) {
            struct gm_run *first = open_run(&any, names[i], compensated, 0.05, four);
            struct gm_run *second = open_run(&kernels, names[i], compensated, 0.05, four);
            assert_int_equal(gm_run_advance(first, 100), GM_OK);
            assert_int_equal(gm_run_advance(second, 100), GM_OK);
            for (size_t c = 0; c < 8; c++) {
                if (!(fabs(gm_run_state(first)[c] - gm_run_state(second)[c]) < 1e-12)) {
                    fail_msg("%s, component %zu: %.17g and %.17g", names[i], c, gm_run_state(first)[c],
                             gm_run_state(second)[c]);
                }
            }
            gm_run_close(first);
            gm_run_close(second);
        }
    }
}

static void place(double *y, size_t tracers)
{
    for (size_t k = 0; k < tracers; k++) {
        /* some close to a vortex, where fixed-point iteration does not contract */
        const double turn = 2.399963 * (double)k, radius = 0.02 + 1.9 * sqrt((double)k / (double)tracers);
        y[k] = 0.1 + radius * cos(turn);
        y[tracers + k] = radius * sin(turn);
    }
}

/* Tracers change no vortex, and do not depend on their neighbours or on how many steps a call makes. */
static void tracers_are_passive(void **unused)
{
    (void)unused;
    const struct gm_problem alone = with(&gm_problem_vortices);
    struct gm_problem carrying = alone, few = alone;
    carrying.passive = TRACERS;
    carrying.n += 2 * TRACERS;
    few.passive = 3;
    few.n += 6;
    double y[8 + 2 * TRACERS], z[14];
    memcpy(y, four, sizeof four);
    place(y + 8, TRACERS);
    memcpy(z, four, sizeof four);
    for (size_t k = 0; k < 3; k++) {
        z[8 + k] = y[8 + 100 + k];
        z[11 + k] = y[8 + TRACERS + 100 + k];
    }
    for (size_t i = 0; i < NAMES; i++) {
        struct gm_run *vortices = open_run(&alone, names[i], 0, 0.05, y);
        struct gm_run *many = open_run(&carrying, names[i], 0, 0.05, y);
        struct gm_run *three = open_run(&few, names[i], 0, 0.05, z);
        assert_int_equal(gm_run_advance(vortices, 40), GM_OK);
        for (int k = 0; k < 40; k++) {
            assert_int_equal(gm_run_advance(many, 1), GM_OK);
        }
        assert_int_equal(gm_run_advance(three, 40), GM_OK);
        assert_memory_equal(gm_run_state(vortices), gm_run_state(many), sizeof four);
        size_t lost = 0;
        for (size_t k = 0; k < TRACERS; k++) {
            lost += isnan(gm_run_state(many)[8 + k]);
        }
        assert_true(lost < TRACERS / 5);
        for (size_t k = 0; k < 3; k++) {
            assert_true(gm_run_state(many)[8 + 100 + k] == gm_run_state(three)[8 + k]);
            assert_true(gm_run_state(many)[8 + TRACERS + 100 + k] == gm_run_state(three)[11 + k]);
        }
        gm_run_close(vortices);
        gm_run_close(many);
        gm_run_close(three);
    }
}

/* A tracer moves as a fifth vortex of no strength would: it is put where a vortex of the reduced system is
 * missing. */
static void a_tracer_is_a_vortex_without_strength(void **unused)
{
    (void)unused;
    /* two vortices carry a third particle; by Kirchhoff's equations it moves in their field alone */
    struct gm_problem problem = with(&gm_problem_vortices);
    problem.n = 6;
    problem.passive = 1;
    const double y[] = {1, -1, 0, 0, 0.3, 0.9};
    double ends[2][2];
    for (int k = 0; k < 2; k++) {
        struct gm_run *run = open_run(&problem, k == 0 ? "gauss4" : "rk4", 0, 0.002, y);
        assert_int_equal(gm_run_advance(run, 1000), GM_OK);
        ends[k][0] = gm_run_state(run)[4];
        ends[k][1] = gm_run_state(run)[5];
        /* the pair turns with g / (4 pi R^2) */
        const double turn = strength / (4 * M_PI) * 2;
        assert_true(fabs(gm_run_state(run)[0] - cos(turn)) < 1e-10);
        assert_true(fabs(gm_run_state(run)[2] - sin(turn)) < 1e-10);
        gm_run_close(run);
    }
    assert_true(hypot(ends[0][0] - ends[1][0], ends[0][1] - ends[1][1]) < 1e-10);
    assert_true(hypot(ends[0][0] - 0.3, ends[0][1] - 0.9) > 0.1);
}

/* Midpoint steps keep the area of a small triangle of tracers, to the square of its size. */
static void tracers_keep_area(void **unused)
{
    (void)unused;
    struct gm_problem problem = with(&gm_problem_vortices);
    problem.passive = 3;
    problem.n = 14;
    const double size = 1e-7;
    const double triangle[] = {0.4, 0.4 + size, 0.4, 0.2, 0.2, 0.2 + size};
    double y[14], areas[2];
    memcpy(y, four, sizeof four);
    memcpy(y + 8, triangle, sizeof triangle);
    for (int k = 0; k < 2; k++) {
        struct gm_run *run = open_run(&problem, k == 0 ? "midpoint" : "explicit-euler", 0, 0.05, y);
        assert_int_equal(gm_run_advance(run, 60), GM_OK);
        const double *x = gm_run_state(run) + 8, *z = x + 3;
        areas[k] = ((x[1] - x[0]) * (z[2] - z[0]) - (x[2] - x[0]) * (z[1] - z[0])) / (size * size);
        gm_run_close(run);
    }
    assert_true(fabs(areas[0] - 1) < 1e-3);
    assert_true(fabs(areas[1] - 1) > 1e-2);
}

/* Places of many kinds: a disc, a circle, a line, two clusters far apart, one whose density has no bound, and many in
   one row of places that lie a rounding apart. */
enum { DISC, CIRCLE, LINE, CLUSTERS, POINTED, ROUNDED, PLACES, MANY = 3000 };

static void scatter(int kind, double *y)
{
    for (size_t i = 0; i < MANY; i++) {
        const double part = ((double)i + 0.5) / MANY, turn = 2.3999632297286533 * (double)i;
        double radius = sqrt(part);
        if (kind == CIRCLE) {
            radius = 1;
        } else if (kind == CLUSTERS) {
            radius *= i % 2 == 0 ? 1e-9 : 1;
        } else if (kind == POINTED) {
            radius = pow(10, -12 * part);
        }
        y[i] = radius * cos(turn) + (kind == CLUSTERS && i % 2 == 0 ? 40 : 0);
        y[MANY + i] = kind == LINE ? 0.5 : radius * sin(turn);
        if (kind == ROUNDED) {
            y[i] = 1 + (double)i * 0x1p-52;
            y[MANY + i] = 1;
        }
    }
}

/* Velocities by moments keep to the tolerance, on every instruction set with the same bits, and so does the energy. */
static void moments_keep_to_the_tolerance(void **unused)
{
    (void)unused;
    static double y[2 * MANY], f[2 * MANY], again[2 * MANY], exact[2 * MANY], single[MANY];
    static const double tolerances[] = {1e-2, 1e-3, 1e-6, 1e-9, 1e-12};
    for (int kind = 0; kind < PLACES; kind++) {
        scatter(kind, y);
        long double logarithms = 0;
        for (size_t i = 0; i < MANY; i++) {
            long double u = 0, v = 0, sum = 0;
            for (size_t j = 0; j < MANY; j++) {
                const long double dx = (long double)y[i] - y[j], dy = (long double)y[MANY + i] - y[MANY + j];
                const long double square = dx * dx + dy * dy;
                if (j != i) {
                    u -= dy / square;
                    v += dx / square;
                    sum += 1 / sqrtl(square);
                    logarithms += j < i ? logl(square) : 0;
                }
            }
            exact[i] = (double)u * strength / (2 * M_PI);
            exact[MANY + i] = (double)v * strength / (2 * M_PI);
            single[i] = (double)sum * strength / (2 * M_PI);
        }
        for (size_t k = 0; k < GM_COUNT(tolerances); k++) {
            const double parameters[] = {strength, tolerances[k]};
            struct gm_problem problem = gm_problem_vortices_multipole;
            problem.n = 2 * (size_t)MANY;
            problem.parameters = parameters;
            gm_field(&problem, y, f, 1);
            double worst = 0;
            for (size_t i = 0; i < MANY; i++) {
                const double error = hypot(f[i] - exact[i], f[MANY + i] - exact[MANY + i]) / single[i];
                worst = fmax(worst, isnan(error) ? INFINITY : error);
            }
            if (!(worst <= tolerances[k])) {
                fail_msg("places %d err by %g of %g", kind, worst, tolerances[k]);
            }
            if (tolerances[k] == 1e-2) {
                assert_true(worst > 1e-13); /* moments are taken */
            }
            for (int isa = 0; isa <= (int)gm_isa_best(); isa++) {
                gm_ode_of(&problem)->loops[isa]->field(&problem, y, again, 1);
                assert_memory_equal(again, f, sizeof f);
            }
            double energies[] = {0, 7};
            gm_ode_of(&problem)->hamiltonian->energy(&problem, y, energies, 1);
            const double energy = energies[0];
            assert_true(energies[1] == 7); /* of one member there is one */
            const double wanted = -strength * strength / (4 * M_PI) * (double)logarithms;
            const double pairs = strength * strength / (4 * M_PI) * MANY * (MANY - 1) / 2;
            if (!(fabs(energy - wanted) <= tolerances[k] * pairs + 1e-12 * fabs(wanted))) {
                fail_msg("places %d: energy %.17g and not %.17g with %g", kind, energy, wanted,
                         tolerances[k]);
            }
        }
    }
}

/* Two cells act on each other by equal and opposite amounts, so that the centre stays to round-off whatever the
   tolerance; the energy stays as the tolerance lets it. */
static void moments_keep_the_centre(void **unused)
{
    (void)unused;
    static double y[2 * MANY];
    double moved[2] = {0};
    for (int k = 0; k < 2; k++) {
        const double parameters[] = {1e-3, k == 0 ? 1e-2 : 1e-12};
        struct gm_problem problem = gm_problem_vortices_multipole;
        problem.n = 2 * (size_t)MANY;
        problem.parameters = parameters;
        scatter(DISC, y);
        struct gm_run *run = open_run(&problem, "rk4", 0, 0.01, y);
        assert_int_equal(gm_run_advance(run, 10), GM_OK);
        double start, end, x = 0;
        gm_ode_of(&problem)->hamiltonian->energy(&problem, y, &start, 1);
        gm_ode_of(&problem)->hamiltonian->energy(&problem, gm_run_state(run), &end, 1);
        for (size_t i = 0; i < MANY; i++) {
            x += gm_run_state(run)[i] - y[i];
            moved[k] = fmax(moved[k], fabs(gm_run_state(run)[i] - y[i]));
        }
        assert_true(fabs(x) < 1e-13 * MANY);
        assert_true(fabs(end / start - 1) < (k == 0 ? 1e-2 : 1e-11));
        gm_run_close(run);
    }
    assert_true(moved[1] > 1e-4 && fabs(moved[0] - moved[1]) < 1e-2 * moved[1]);
}

/* Logarithms are summed as products, which go beyond the numbers' ends where vortices lie very near, very far, or both. */
static void energies_of_any_size(void **unused)
{
    (void)unused;
    static double y[2 * MANY];
    static const double scales[][2] = {
        {1, 1}, {1e-120, 1e-120}, {1e120, 1e120}, {1e-30, 1e30}, {1e-70, 1e70}};
    for (size_t k = 0; k < GM_COUNT(scales); k++) {
        scatter(DISC, y);
        long double wanted = 0;
        for (size_t i = 0; i < MANY; i++) {
            y[i] *= scales[k][i % 64 < 32];
            y[MANY + i] *= scales[k][i % 64 < 32];
            for (size_t j = 0; j < i; j++) {
                const long double dx = (long double)y[i] - y[j], dy = (long double)y[MANY + i] - y[MANY + j];
                wanted -= logl(dx * dx + dy * dy) * strength * strength / (4 * M_PI);
            }
        }
        struct gm_problem problem = gm_problem_vortices;
        problem.n = 2 * (size_t)MANY;
        problem.parameters = &(const double){strength};
        for (int isa = 0; isa <= (int)gm_isa_best(); isa++) {
            const double energy = gm_ode_of(&problem)->loops[isa]->energy(&problem, y);
            if (!(fabsl(energy - wanted) <= 1e-12L * fabsl(wanted))) {
                fail_msg("sizes %g and %g: energy %.17g and not %.17Lg", scales[k][0], scales[k][1], energy,
                         wanted);
            }
            assert_true(energy == gm_energy(&problem, y));
        }
    }
}

/* A place that is no number leaves no velocity that looks like one. */
static void moments_of_what_is_no_place(void **unused)
{
    (void)unused;
    static double y[2 * MANY], f[2 * MANY];
    const double parameters[] = {strength, 1e-6};
    struct gm_problem problem = gm_problem_vortices_multipole;
    problem.n = 2 * (size_t)MANY;
    problem.parameters = parameters;
    static const double wrong[] = {NAN, INFINITY, -INFINITY, 1e300};
    for (size_t k = 0; k < GM_COUNT(wrong); k++) {
        scatter(DISC, y);
        y[MANY + 7] = wrong[k];
        gm_field(&problem, y, f, 1);
        for (size_t i = 0; i < 2 * (size_t)MANY; i++) {
            assert_true(isnan(f[i]));
        }
    }
}

/* What has no split and no kernels is refused by the families that need them. */
static void what_does_not_fit(void **unused)
{
    (void)unused;
    struct gm_problem problem = with(&gm_problem_vortices);
    assert_false(gm_scheme_fits(gm_scheme_find("verlet"), &problem));
    problem.passive = 10;
    problem.n += 20;
    for (size_t i = 0; i < gm_scheme_count(); i++) {
        const struct gm_scheme *scheme = gm_scheme_at(i);
        assert_true(!gm_scheme_fits(scheme, &problem) || scheme->family->carries_passive);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(any_number_is_four),
        cmocka_unit_test(tracers_are_passive),
        cmocka_unit_test(a_tracer_is_a_vortex_without_strength),
        cmocka_unit_test(tracers_keep_area),
        cmocka_unit_test(moments_keep_to_the_tolerance),
        cmocka_unit_test(moments_keep_the_centre),
        cmocka_unit_test(energies_of_any_size),
        cmocka_unit_test(moments_of_what_is_no_place),
        cmocka_unit_test(what_does_not_fit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
