/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Systems given by L against the same given by H: fields, Jacobians, energies, and what schemes make of
   them. */
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
#include "core/kind.h"
#include "core/model/equations.h"
#include "core/ode/kernel/loops.h"
#include "core/ode/user/problem.h"
#include "core/run.h"
#include "core/schemes.h"
#include "tests/common/typed.h"

enum { MOST = 7 }; /* components */

/* The Hamiltonians are transformed by hand; that of the double pendulum is the one of share/systems. */
static const struct {
    const char *name, *coordinates, *lagrangian, *hamiltonian, *start;
} pairs[] = {
    {"double pendulum", "coordinates: a b\nparameter: m = 1.5\nparameter: l = 0.75\nparameter: g = 9.81\n",
     "L: (1 + m)*v_a^2/2 + m*l^2*v_b^2/2 + m*l*v_a*v_b*cos(a - b) + (1 + m)*g*cos(a) + m*g*l*cos(b)\n",
     "let: D = 1 + m*sin(a - b)^2\nH: (m*l^2*p_a^2 + (1 + m)*p_b^2 - 2*m*l*p_a*p_b*cos(a - b))/(2*m*l^2*D)"
     " - (1 + m)*g*cos(a) - m*g*l*cos(b)\n",
     "start: a = 2, b = 2.5, p_a = 0.1, p_b = -0.2\n"},
    {"polar", "coordinates: r phi\nparameter: m = 2\n", "L: m*(v_r^2 + r^2*v_phi^2)/2 + 1/r\n",
     "H: (p_r^2 + p_phi^2/r^2)/(2*m) - 1/r\n", "start: r = 1.5, phi = 0, p_r = 0.25, p_phi = 1\n"},
    {"relativistic", "coordinates: q\n", "L: -4*sqrt(1 - v_q^2/4) - q^2/2\n",
     "H: 4*sqrt(1 + p_q^2/4) + q^2/2\n", "start: q = 2, p_q = 0.5\n"},
    {"magnetic", "coordinates: x y\nparameter: B = 2\n",
     "L: (v_x^2 + v_y^2)/2 + B*(x*v_y - y*v_x)/2 - (x^2 + y^2)^2/4\n",
     "H: ((p_x + B*y/2)^2 + (p_y - B*x/2)^2)/2 + (x^2 + y^2)^2/4\n",
     "start: x = 1, y = 0, p_x = 0, p_y = 0.5\n"},
    {"separable", "coordinates: a b\n", "L: v_a^2 + v_a*v_b + v_b^2 - a^2*b^2 - a^2 - b^2\n",
     "H: (p_a^2 - p_a*p_b + p_b^2)/3 + a^2*b^2 + a^2 + b^2\n",
     "start: a = 1, b = 0.5, p_a = 0.25, p_b = -1\n"},
    {"driven", "coordinates: q\n", "L: (1 + q^2)*v_q^2/2 + sin(t)*v_q - cos(2*t)*q - q^4\n",
     "H: (p_q - sin(t))^2/(2*(1 + q^2)) + cos(2*t)*q + q^4\n", "start: q = 0.5, p_q = 1\n"},
    {"friction", "coordinates: a b\nparameter: c = 0.25\nforce: a = -c*p_a, b = -c*p_b - sin(a)\n",
     "L: (v_a^2 + (1 + a^2)*v_b^2)/2 - b^2\n", "H: (p_a^2 + p_b^2/(1 + a^2))/2 + b^2\n",
     "start: a = 0.5, b = 1, p_a = 0, p_b = 1\n"},
    {"three", "coordinates: q[1..3]\n",
     "L: sum(i = 1 .. 3, v_q[i]^2)/2 + v_q[1]*v_q[2]*cos(q[3])/2 - sum(i = 1 .. 3, q[i]^4)\n",
     "let: c = cos(q[3])/2\n"
     "H: (p_q[1]^2 - 2*c*p_q[1]*p_q[2] + p_q[2]^2)/(2*(1 - c^2)) + p_q[3]^2/2 + sum(i = 1 .. 3, q[i]^4)\n",
     "start: q[i] = sin(i), p_q[i] = cos(i)\n"},
};
enum { PAIRS = GM_COUNT(pairs) };

static void type_pair(struct typed *typed, int pair, bool lagrangian)
{
    char text[1000];
    snprintf(text, sizeof text, "%s%s%s", pairs[pair].coordinates,
             lagrangian ? pairs[pair].lagrangian : pairs[pair].hamiltonian, pairs[pair].start);
    type(typed, text);
}

static void expect_near(const char *what, const char *name, const double *a, const double *b, size_t count,
                        double most)
{
    double size = 0, distance = 0;
    for (size_t i = 0; i < count; i++) {
        size = fmax(size, fabs(b[i]));
        distance = fmax(distance, isfinite(a[i]) ? fabs(a[i] - b[i]) : INFINITY);
    }
    if (!(distance <= most * size)) {
        fail_msg("%s, %s: %g apart, of %g", name, what, distance, size);
    }
}

static void states_agree(void **unused)
{
    (void)unused;
    srand(5);
    for (int k = 0; k < PAIRS; k++) {
        struct typed l, h;
        type_pair(&l, k, true);
        type_pair(&h, k, false);
        const size_t n = l.problem.n;
        assert_true(n == h.problem.n && n <= MOST);
        const struct gm_loops *by_l = gm_ode_of(&l.problem)->loops[0],
                              *by_h = gm_ode_of(&h.problem)->loops[0];
        for (int trial = 0; trial < 50; trial++) {
            double y[MOST], f[MOST], g[MOST], matrix[MOST * MOST], other[MOST * MOST];
            for (size_t i = 0; i < n; i++) {
                y[i] = l.start[i] + .5 * rand() / RAND_MAX;
            }
            gm_field(&l.problem, y, f, 1);
            gm_field(&h.problem, y, g, 1);
            expect_near("field", pairs[k].name, f, g, n, 1e-14);
            by_l->jacobian(&l.problem, y, matrix);
            by_h->jacobian(&h.problem, y, other);
            expect_near("Jacobian", pairs[k].name, matrix, other, n * n, 2e-14);
            if (gm_ode_of(&h.problem)->hamiltonian) {
                double energy, wanted;
                gm_ode_of(&l.problem)->hamiltonian->energy(&l.problem, y, &energy, 1);
                gm_ode_of(&h.problem)->hamiltonian->energy(&h.problem, y, &wanted, 1);
                assert_true(fabs(energy - wanted) <= 1e-13 * (1 + fabs(wanted)));
            }
        }
        /* what is asked of H is the same */
        const unsigned of_rates = GM_NEEDS_VOLUME | GM_NEEDS_QUADRATIC | GM_NEEDS_MAGNETIC | GM_NEEDS_PARTS,
                       of_action = GM_NEEDS_ACTION | GM_NEEDS_FRICTION;
        assert_int_equal(gm_kind_ode.facets(&l.problem) & ~of_action,
                         gm_kind_ode.facets(&h.problem) & ~of_rates & ~of_action);
        untype(&l);
        untype(&h);
    }
}

static const struct gm_settings settings = {.binding = 1};

/* 1000 steps; what a solve rounds is magnified by as much as orbits part meanwhile. */
static void runs_agree(void **unused)
{
    (void)unused;
    static const char *const schemes[] = {"midpoint",     "rk4",      "gauss4", "gauss8", "verlet",
                                          "blanes-moan4", "lobatto4", "avf4",   "tao2",   "symplectic-euler"};
    int compared = 0;
    for (int k = 0; k < PAIRS; k++) {
        struct typed l, h;
        type_pair(&l, k, true);
        type_pair(&h, k, false);
        for (size_t s = 0; s < GM_COUNT(schemes); s++) {
            const struct gm_scheme *scheme = gm_scheme_find(schemes[s]);
            assert_non_null(scheme);
            if (!gm_scheme_fits(scheme, &h.problem)) {
                continue;
            }
            assert_true(gm_scheme_fits(scheme, &l.problem));
            struct gm_run *a = gm_run_open(&l.problem, scheme, &settings, 0, 0.002, l.start);
            struct gm_run *b = gm_run_open(&h.problem, scheme, &settings, 0, 0.002, h.start);
            assert_true(a && b);
            assert_int_equal(gm_run_advance(a, 1000), GM_OK);
            assert_int_equal(gm_run_advance(b, 1000), GM_OK);
            expect_near(schemes[s], pairs[k].name, gm_run_state(a), gm_run_state(b), l.problem.n, 2e-12);
            gm_run_close(a);
            gm_run_close(b);
            compared++;
        }
        untype(&l);
        untype(&h);
    }
    assert_true(compared >= 4 * PAIRS);
}

static void members_are_alone(void **unused)
{
    (void)unused;
    enum { MEMBERS = 37 };
    for (int k = 0; k < PAIRS; k++) {
        struct typed typed;
        type_pair(&typed, k, true);
        const size_t n = typed.problem.n;
        double y[MOST * MEMBERS], f[MOST * MEMBERS];
        for (size_t i = 0; i < n * MEMBERS; i++) {
            y[i] = typed.start[i / MEMBERS] + .001 * (double)(i % MEMBERS);
        }
        gm_field(&typed.problem, y, f, MEMBERS);
        for (size_t l = 0; l < MEMBERS; l++) {
            double one[MOST], g[MOST];
            for (size_t i = 0; i < n; i++) {
                one[i] = y[i * MEMBERS + l];
            }
            gm_field(&typed.problem, one, g, 1);
            for (size_t i = 0; i < n; i++) {
                assert_true(g[i] == f[i * MEMBERS + l]);
            }
        }
        untype(&typed);
    }
}

/* Where dL/dv = p has no solution there is no motion. */
static void a_singular_transform_stops(void **unused)
{
    (void)unused;
    struct typed typed;
    type(&typed, "coordinates: a b\nL: (v_a^2 + sin(a)^2*v_b^2)/2\nstart: a = 1, b = 0, v_a = -1, v_b = 0\n");
    double f[4], matrix[16], energy;
    const double pole[] = {0, 0, -1, 0}, beside[] = {1e-3, 0, -1, 0};
    gm_field(&typed.problem, pole, f, 1);
    assert_true(isnan(f[0]) && isnan(f[2]));
    gm_ode_of(&typed.problem)->loops[0]->jacobian(&typed.problem, pole, matrix);
    assert_true(isnan(matrix[0]) && isnan(matrix[15]));
    gm_ode_of(&typed.problem)->hamiltonian->energy(&typed.problem, pole, &energy, 1);
    assert_true(isnan(energy));
    gm_field(&typed.problem, beside, f, 1);
    assert_true(f[0] == -1 && f[1] == 0);
    struct gm_run *run = gm_run_open(&typed.problem, gm_scheme_find("rk4"), &settings, 0, 0.5, typed.start);
    assert_non_null(run);
    assert_int_equal(gm_run_advance(run, 10), GM_BLOW_UP); /* a = 1 - 2 * 0.5 is the pole, to the bit */
    assert_true(run->steps < 2);
    gm_run_close(run);
    untype(&typed);
    /* p = v / sqrt(1 + v^2) is below 1 */
    type(&typed, "coordinates: q\nL: sqrt(1 + v_q^2)\nstart: q = 0, p_q = 0.5\n");
    gm_field(&typed.problem, (const double[]){0, .5}, f, 1);
    assert_true(fabs(f[0] - .5 / sqrt(.75)) <= 4e-16);
    gm_field(&typed.problem, (const double[]){0, 1.5}, f, 1);
    assert_true(isnan(f[0]));
    untype(&typed);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(states_agree),
        cmocka_unit_test(runs_agree),
        cmocka_unit_test(members_are_alone),
        cmocka_unit_test(a_singular_transform_stops),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
