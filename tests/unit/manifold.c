/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Motion on manifolds against what is known of it: a spherical pendulum by elliptic functions, a double pendulum in its
   angles, and what a million steps leave of the constraints. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <gsl/gsl_integration.h>
#include <gsl/gsl_sf_elljac.h>

#include "core/basics.h"
#include "core/ode/variational/manifold.h"
#include "core/run.h"
#include "core/schemes.h"
#include "core/theory/certify.h"
#include "tests/common/typed.h"

static const struct gm_settings plain = {0};

static const struct {
    const char *name;
    int order;
    bool hidden; /* it keeps dg/dt */
} schemes[] = {{"rattle2", 2, true},
               {"shake2", 2, false},
               {"constrained-lobatto4", 4, true},
               {"constrained-lobatto6", 6, true},
               {"projected-gauss4", 4, true},
               {"projected-gauss6", 6, true}};

/* Errors of the place by slope, and both constraints. */
static void expect_orders(const char *text, double dt, double until, const double *place)
{
    struct typed typed;
    type(&typed, text);
    for (size_t i = 0; i < GM_COUNT(schemes); i++) {
        double errors[2], end[8];
        for (int finer = 0; finer < 2; finer++) {
            const double step = dt / (1 + finer);
            typed_advance(&typed, &plain, schemes[i].name, step, lround(until / step), end);
            errors[finer] = typed_apart(end, place, typed.problem.n / 2);
            const struct gm_manifold_defects defects = gm_manifold_defects(&typed.problem, end);
            assert_true(defects.constraint < 1e-13 && (defects.hidden < 1e-13) == schemes[i].hidden);
        }
        const double order = log2(errors[0] / errors[1]);
        if (!(fabs(order - schemes[i].order) < 0.25)) {
            fail_msg("%s: order %.2f, errors %g %g", schemes[i].name, order, errors[0], errors[1]);
        }
    }
    untype(&typed);
}

/* ---- the spherical pendulum, of length, mass and gravity 1 ---- */

/* Its height moves as z'^2 = 2 (E - z) (1 - z^2) - L^2 = 2 (z - low) (z - high) (z - beyond), from `low` on
       z = low + (high - low) sn^2(w t, m),   w^2 = (beyond - low)/2,   m = (high - low)/(beyond - low)
   E.T. Whittaker, Analytical Dynamics (1937), section 55. */
struct swing {
    double low, high, beyond, L;
};

static double height(double t, const struct swing *swing)
{
    double sn, cn, dn;
    gsl_sf_elljac_e(sqrt((swing->beyond - swing->low) / 2) * t,
                    (swing->high - swing->low) / (swing->beyond - swing->low), &sn, &cn, &dn);
    return swing->low + (swing->high - swing->low) * sn * sn;
}

static double rate(double t, void *data)
{
    const double z = height(t, data), L = ((const struct swing *)data)->L;
    return L / (1 - z * z);
}

static void by_elliptic_functions(void **unused)
{
    (void)unused;
    const double low = -0.9, x = sqrt(1 - low * low), v = 0.8, until = 8;
    const double E = v * v / 2 + low, b = low - E, c = b * low - 1, root = sqrt(b * b - 4 * c);
    struct swing swing = {low, (-b - root) / 2, (-b + root) / 2, x * v};
    assert_true(swing.low < swing.high && swing.high < 1 && swing.beyond > 1);
    gsl_integration_workspace *workspace = gsl_integration_workspace_alloc(1000);
    gsl_function integrand = {rate, &swing};
    double angle, error;
    assert_int_equal(gsl_integration_qag(&integrand, 0, until, 1e-13, 1e-13, 1000, GSL_INTEG_GAUSS61,
                                         workspace, &angle, &error),
                     0);
    gsl_integration_workspace_free(workspace);
    const double z = height(until, &swing), across = sqrt(1 - z * z);
    const double place[3] = {across * cos(angle), across * sin(angle), z};
    expect_orders(
        "coordinates: x y z\nH: (p_x^2 + p_y^2 + p_z^2)/2 + z\nconstraint: (x^2 + y^2 + z^2 - 1)/2\n"
        "start: x = sqrt(0.19), y = 0, z = -0.9, p_x = 0, p_y = 0.8, p_z = 0\n",
        0.1, until, place);
}

/* ---- a double pendulum ---- */

static void in_angles(void **unused)
{
    (void)unused;
    struct typed angles;
    double end[4];
    type(&angles, "coordinates: a b\nL: v_a^2 + v_b^2/2 + v_a*v_b*cos(a - b) + 2*cos(a) + cos(b)\n"
                  "start: a = 0.5, b = 0.8, v_a = 0.3, v_b = -0.2\n");
    typed_advance(&angles, &plain, "gauss8", 0.01, 400, end);
    untype(&angles);
    const double a = end[0], b = end[1];
    const double place[4] = {sin(a), sin(a) + sin(b), -cos(a), -cos(a) - cos(b)};
    expect_orders("coordinates: x[1..2] y[1..2]\nlet: x[0] = 0\nlet: y[0] = 0\n"
                  "L: sum(i = 1 .. 2, v_x[i]^2 + v_y[i]^2)/2 - y[1] - y[2]\n"
                  "constraint: i = 1 .. 2; ((x[i] - x[i-1])^2 + (y[i] - y[i-1])^2 - 1)/2\n"
                  "start: x[1] = sin(0.5), y[1] = -cos(0.5), v_x[1] = 0.3*cos(0.5), v_y[1] = 0.3*sin(0.5)\n"
                  "start: x[2] = sin(0.5) + sin(0.8), y[2] = -cos(0.5) - cos(0.8)\n"
                  "start: v_x[2] = 0.3*cos(0.5) - 0.2*cos(0.8), v_y[2] = 0.3*sin(0.5) - 0.2*sin(0.8)\n",
                  0.1, 4, place);
}

/* ---- many steps ---- */

static long many_steps = 20000;

/* Compensated, the momentum about the vertical stays as well: plain sums round the positions to one side more often
   than to the other, by 1e-18 a step. */
static void constraints_and_momentum_stay(void **unused)
{
    (void)unused;
    static const struct gm_settings settings = {.compensated = 1};
    struct typed typed;
    type(&typed, "coordinates: x y z\nH: (p_x^2 + p_y^2 + p_z^2)/2 + z\nconstraint: (x^2 + y^2 + z^2 - 1)/2\n"
                 "start: x = 0.6, y = 0, z = -0.8, p_x = 0.4, p_y = 0.7, p_z = 0.3\n");
    struct gm_run *run = gm_run_open(&typed.problem, gm_scheme_find_for("rattle2", &typed.problem), &settings,
                                     0, 0.05, typed.start);
    assert_non_null(run);
    for (int i = 0; i < 1000; i++) {
        assert_int_equal(gm_run_advance(run, many_steps / 1000), GM_OK);
        const struct gm_manifold_defects defects = gm_manifold_defects(&typed.problem, gm_run_state(run));
        assert_true(defects.constraint < 1e-13 && defects.hidden < 1e-13);
        const double *y = gm_run_state(run);
        assert_float_equal(y[0] * y[4] - y[1] * y[3], 0.6 * 0.7, 1e-13 * 0.6 * 0.7);
    }
    gm_run_close(run);
    untype(&typed);
}

/* A problem without an action has no such field: none of its rates is a number. */
static void no_action_has_no_field(void **unused)
{
    (void)unused;
    struct typed typed;
    type(&typed, "rate: x = y\nrate: y = -x - y^3\nstart: x = 1, y = 0\n");
    double rates[] = {1, 2, 3, 4, 5, 6};
    gm_manifold_field(&typed.problem, (const double[]){1, 2, 3, 4, 5, 6}, rates, 3);
    for (size_t i = 0; i < GM_COUNT(rates); i++) {
        assert_true(isnan(rates[i]));
    }
    untype(&typed);
}

/* A symplectic scheme has to be one where the motion is Hamiltonian: with constraints, if it conserves them. */
static void symplectic_where_constraints_hold(void **unused)
{
    (void)unused;
    static const struct {
        const char *text, *scheme;
        bool claimed;
    } rows[] = {
        {"coordinates: q\nH: p_q^2/2 - cos(q)\nstart: q = 0.5, p_q = 0.2\n", "midpoint", true},
        {"coordinates: x y\nH: (p_x^2 + p_y^2)/2 + y\nconstraint: (x^2 + y^2 - 1)/2\n"
         "start: x = 0.6, y = -0.8, p_x = 0.4, p_y = 0.3\n",
         "midpoint", false},
        {"coordinates: x y\nH: (p_x^2 + p_y^2)/2 + y\nconstraint: (x^2 + y^2 - 1)/2\n"
         "start: x = 0.6, y = -0.8, p_x = 0.4, p_y = 0.3\n",
         "rattle2", true},
    };
    for (size_t i = 0; i < GM_COUNT(rows); i++) {
        struct typed typed;
        type(&typed, rows[i].text);
        const struct gm_certified_system system = {
            .problem = &typed.problem, .start = typed.start, .dt = 0.1};
        struct gm_certificate certificate =
            gm_certify_on(gm_scheme_find_for(rows[i].scheme, &typed.problem), &system);
        const struct gm_verdict *verdict = gm_certificate_claim(&certificate, GM_SYMPLECTIC);
        assert_int_equal(verdict->claimed, rows[i].claimed);
        assert_true(verdict->holds || !rows[i].claimed);
        untype(&typed);
    }
}

int main(int count, char **words)
{
    const bool all = count > 1 && strcmp(words[1], "all") == 0;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(by_elliptic_functions),         cmocka_unit_test(in_angles),
        cmocka_unit_test(no_action_has_no_field),        cmocka_unit_test(symplectic_where_constraints_hold),
        cmocka_unit_test(constraints_and_momentum_stay),
    };
    const struct CMUnitTest long_ones[] = {cmocka_unit_test(constraints_and_momentum_stay)};
    many_steps = all ? 1000000 : many_steps;
    return all ? cmocka_run_group_tests(long_ones, NULL, NULL) : cmocka_run_group_tests(tests, NULL, NULL);
}
