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

/* ---- linear in the velocities ---- */

#define HUNTERS "coordinates: x y\nL: log(y)/x*v_x - (x - log(x) + y - 2*log(y))\nstart: x = 2, y = 1.5\n"
#define GUIDING                                                                                              \
    "parameter: quartic = 0\ncoordinates: x y z u\nlet: s = sin(x)/5\n"                                      \
    "L: -y*(1 + x/4)*v_x + (x/2 + x*z/10 + u*s)*v_y + u*sqrt(1 - s^2)*v_z - u^2/2"                           \
    " - 0.3*(1 + x^2/4 + y^2/3 + z^2/4) - quartic*(x^4/10 + z^4/20)\n"                                       \
    "start: x = 0.5, y = 0.4, z = 0.2, u = 0.6\n"

/* Six coordinates, all of which the form holds, and the time. */
#define DENSE                                                                                                \
    "coordinates: q[1..6]\n"                                                                                 \
    "L: sum(i = 1 .. 6, (sin(i*q[mod(i, 6) + 1] + q[mod(i + 2, 6) + 1]) + i*q[mod(i + 1, 6) + 1]^2 + "       \
    "t*i*q[i])*v_q[i]) - sum(i = 1 .. 6, q[i]^4/i)\nstart: q[i] = cos(i)\n"

static void forms_have_rates(void **unused)
{
    (void)unused;
    struct typed typed;
    double f[4];
    type(&typed, HUNTERS);
    assert_int_equal(typed.problem.n, 2);
    gm_field(&typed.problem, typed.start, f, 1);
    expect_near("rates", "hunters", f, (const double[]){-1, -1.5}, 2, 1e-15);
    /* p dq - H: the equations of Hamilton, and the time in theta alone is a force */
    untype(&typed);
    type(&typed, "coordinates: q p\nL: (p + t^2)*v_q - p^2/2 - cos(q)\nstart: q = 0.5, p = 0.25\n");
    gm_field(&typed.problem, (const double[]){0.5, 0.25, 3}, f, 1);
    expect_near("rates", "timed", f, (const double[]){0.25, sin(0.5) - 6, 1}, 3, 1e-15);
    untype(&typed);
}

/* Omega f = dH/dq + d theta/dt, with Omega by differences of theta. */
static void forms_are_inverted(void **unused)
{
    (void)unused;
    enum { N = 6 };
    struct typed typed;
    type(&typed, DENSE);
    struct gm_user_system *system = &typed.system;
    const double h = 1e-5;
    double *values[2] = {malloc(system->graph.count * sizeof(double)),
                         malloc(system->graph.count * sizeof(double))};
    double omega[N][N] = {{0}}, force[N], f[N + 1];
    assert_true(system->n == N && system->timed && values[0] && values[1]);
    for (size_t i = 0; i <= N; i++) {
        for (int side = 0; side < 2; side++) {
            typed.start[i] += side == 0 ? h : -2 * h;
            gm_formula_evaluate(&system->graph, system->graph.count, typed.start, values[side]);
        }
        typed.start[i] += h;
        for (size_t j = 0; j < N; j++) {
            const double slope = (values[0][system->theta[j]] - values[1][system->theta[j]]) / (2 * h);
            if (i < N) {
                omega[i][j] += slope;
                omega[j][i] -= slope;
            } else {
                force[j] += slope;
            }
        }
        if (i < N) {
            force[i] = (values[0][system->energy] - values[1][system->energy]) / (2 * h);
        }
    }
    gm_field(&typed.problem, typed.start, f, 1);
    for (size_t i = 0; i < N; i++) {
        double sum = 0;
        for (size_t j = 0; j < N; j++) {
            sum += omega[i][j] * f[j];
        }
        assert_true(fabs(sum - force[i]) < 1e-8);
    }
    free(values[0]);
    free(values[1]);
    untype(&typed);
}

/* The midpoint rule in x and P = log(y)/x, by a fixed point here: H(x, P) = x - log(x) + exp(P x) - 2 P x. */
static void hunters_by_midpoint(double h, int steps, double y[2])
{
    double x = y[0], p = log(y[1]) / y[0];
    for (int step = 0; step < steps; step++) {
        double to_x = x, to_p = p;
        for (int sweep = 0; sweep < 200; sweep++) {
            const double a = (x + to_x) / 2, b = (p + to_p) / 2;
            to_x = x + h * (a * exp(a * b) - 2 * a);
            to_p = p - h * (1 - 1 / a + b * exp(a * b) - 2 * b);
        }
        x = to_x;
        p = to_p;
    }
    y[0] = x;
    y[1] = exp(p * x);
}

static void half_a_form_is_canonical(void **unused)
{
    (void)unused;
    struct typed typed;
    double end[2], wanted[2];
    type(&typed, HUNTERS);
    memcpy(wanted, typed.start, sizeof wanted);
    hunters_by_midpoint(0.1, 300, wanted);
    typed_advance(&typed, &settings, "degenerate-midpoint2", 0.1, 300, end);
    expect_near("300 steps", "hunters", end, wanted, 2, 1e-12);
    untype(&typed);
}

/* 40 steps of 0.1, by an independent computation with 40 digits and differences of theta. */
static void centres_are_guided(void **unused)
{
    (void)unused;
    static const double wanted[2][4] = {
        {0.2790768474162552, 0.5364516496503313, 1.554478290994164, -0.06164673338617337},
        {0.2933116925922715, 0.6044419070411135, 0.6184383368127211, -0.5373649927709805}};
    for (int quartic = 0; quartic < 2; quartic++) {
        struct typed typed;
        double end[4], back[4];
        type(&typed, GUIDING);
        typed.start[typed.system.parameters] = quartic;
        gm_user_problem_close(&typed.problem);
        assert_true(gm_user_problem_open(&typed.problem, &typed.model, typed.start));
        typed_advance(&typed, &settings, "degenerate-midpoint2", 0.1, 40, end);
        expect_near("40 steps", "guiding centre", end, wanted[quartic], 4, 1e-13);
        memcpy(back, typed.start, sizeof back);
        memcpy(typed.start, end, sizeof end);
        typed_advance(&typed, &settings, "degenerate-midpoint2", -0.1, 40, end);
        expect_near("40 steps back", "guiding centre", end, back, 4, 1e-13);
        untype(&typed);
    }
}

/* Two vortices at a distance d turn by (G_1 + G_2) t / (2 pi d^2) about their centre. Omega is constant: the step is
   that of the midpoint rule. */
static void vortices_turn(void **unused)
{
    (void)unused;
    struct typed typed;
    double end[4], other[4];
    type(&typed, "coordinates: a b x y\n"
                 "L: (a*v_b - b*v_a)/2 + 3*(x*v_y - y*v_x)/2 - 3*log((a - x)^2 + (b - y)^2)/(4*pi)\n"
                 "start: a = 1.5, b = 0, x = -0.5, y = 0\n");
    const double angle = 4 * 10. / (2 * M_PI * 4), c = cos(angle), s = sin(angle);
    typed_advance(&typed, &settings, "gauss8", 0.1, 100, end);
    expect_near("gauss8", "vortices", end, (const double[]){1.5 * c, 1.5 * s, -0.5 * c, -0.5 * s}, 4, 1e-13);
    typed_advance(&typed, &settings, "degenerate-midpoint2", 0.5, 20, end);
    typed_advance(&typed, &settings, "midpoint", 0.5, 20, other);
    expect_near("the midpoint rule", "vortices", end, other, 4, 1e-14);
    untype(&typed);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(states_agree),
        cmocka_unit_test(runs_agree),
        cmocka_unit_test(members_are_alone),
        cmocka_unit_test(a_singular_transform_stops),
        cmocka_unit_test(forms_have_rates),
        cmocka_unit_test(forms_are_inverted),
        cmocka_unit_test(half_a_form_is_canonical),
        cmocka_unit_test(centres_are_guided),
        cmocka_unit_test(vortices_turn),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
