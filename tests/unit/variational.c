/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Variational integrators and constraints: orders and claims on systems by L, methods that have to be the
   same, forces, momentum maps, manifolds, and where no root is found. */
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
#include "core/model/equations.h"
#include "core/ode/kernel/loops.h"
#include "core/ode/kernel/members.h"
#include "core/ode/user/problem.h"
#include "core/ode/variational/manifold.h"
#include "core/run.h"
#include "core/schemes.h"
#include "core/theory/certify.h"
#include "tests/common/typed.h"
#include "tests/problems/problems.h"

static const char double_pendulum[] =
    "coordinates: a b\nL: v_a^2 + v_b^2/2 + v_a*v_b*cos(a - b) + 2*cos(a) + cos(b)\n"
    "start: a = 0.5, b = 0.8, v_a = 0.3, v_b = -0.2\n";
static const char kepler_in_space[] =
    "coordinates: x y z\nH: (p_x^2 + p_y^2 + p_z^2)/2 - 1/sqrt(x^2 + y^2 + z^2)\n"
    "start: x = 0.8, y = 0.1, z = 0.2, p_x = -0.2, p_y = 1.1, p_z = 0.3\n";
static const char pendulum_in_angles[] = "coordinates: a b\nL: (v_a^2 + sin(a)^2*v_b^2)/2 + cos(a)\n"
                                         "start: a = 1, b = 0, v_a = 0.2, v_b = 0.9\n";
/* the same motion: x = sin(a) cos(b), y = sin(a) sin(b), z = -cos(a) */
static const char pendulum_in_space[] =
    "coordinates: x y z\nL: (v_x^2 + v_y^2 + v_z^2)/2 - z\nconstraint: (x^2 + y^2 + z^2 - 1)/2\n"
    "start: x = sin(1), y = 0, z = -cos(1), v_x = 0.2*cos(1), v_y = 0.9*sin(1), v_z = 0.2*sin(1)\n";
/* masses that are not 1 and hang together, given by H */
static const char two_masses[] =
    "coordinates: a b\nH: (p_a^2 - p_a*p_b + p_b^2)/3 + p_a/5 + a^2*b^2 + a^2 + b^2\n"
    "start: a = 1, b = 0.5, p_a = 0.25, p_b = -1\n";
static const char driven[] = "coordinates: q\nL: (1 + q^2)*v_q^2/2 + sin(t)*v_q - cos(2*t)*q - q^4\n"
                             "start: q = 0.5, p_q = 1\n";
static const char pushed[] = "coordinates: a b\nL: (v_a^2 + (1 + a^2)*v_b^2)/2 - b^2\n"
                             "force: a = -0.25*p_a, b = -0.5*p_b - sin(a)\n"
                             "start: a = 0.5, b = 1, p_a = 0, p_b = 1\n";
static const char shaken[] =
    "coordinates: q\nH: (p_q - sin(t))^2/2 + cos(2*t)*q + q^4\nstart: q = 0.5, p_q = 1\n";
static const char braked[] = "coordinates: a b\nparameter: c = 0.3\n"
                             "L: (v_a^2 + (1 + a^2)*v_b^2)/2 + cos(a) - b^2/2\n"
                             "force: a = -c*p_a, b = -c*p_b\nstart: a = 0.5, b = 0.6, p_a = 0.4, p_b = 0.3\n";

static const struct gm_scheme *fitting(const char *name, const struct gm_problem *problem)
{
    const struct gm_scheme *scheme = gm_scheme_find_for(name, problem);
    assert_non_null(scheme);
    if (!gm_scheme_fits(scheme, problem)) {
        fail_msg("%s does not fit: it lacks %s", name, gm_scheme_lacks(scheme, problem));
    }
    return scheme;
}

static const struct gm_settings settings = {.newmark_beta = 0.15};

static double second_momentum(const void *data, const double *y, const double *memory)
{
    (void)memory;
    (void)data;
    return y[3];
}

static double about_z(const void *data, const double *y, const double *memory)
{
    (void)memory;
    (void)data;
    return y[0] * y[4] - y[1] * y[3];
}

static const char *const variational[] = {
    "variational-midpoint2", "variational-trapezoidal2", "variational-simpson4", "variational-galerkin2",
    "variational-galerkin4", "variational-galerkin6",    "variational-newmark2"};
enum { VARIATIONAL = GM_COUNT(variational) };

/* Orders are measured against GSL's stepper on the field of the system, claims on its own steps. */
static struct gm_certificate certified(const char *text, const char *name, double dt,
                                       const struct gm_kept *kept)
{
    struct typed typed;
    type(&typed, text);
    struct gm_scheme scheme = *fitting(name, &typed.problem);
    const struct gm_certified_system system = {
        .problem = &typed.problem, .start = typed.start, .dt = dt, .kept = kept, .kept_count = kept != NULL};
    struct gm_certificate certificate = gm_certify_on(&scheme, &system);
    untype(&typed);
    if (!certificate.holds || !certificate.ladder.settled || fabs(certificate.order - scheme.order) > 0.3) {
        fail_msg("%s on %s: order %.2f, symplecticity %.1e", name, text, certificate.order,
                 certificate.claims[0].defect);
    }
    return certificate;
}

static void orders_and_claims(void **unused)
{
    (void)unused;
    const struct gm_kept vertical = {"p_b", second_momentum, NULL}, turning = {"L_z", about_z, NULL};
    for (int i = 0; i < VARIATIONAL; i++) {
        struct gm_certificate on = certified(double_pendulum, variational[i], 0.1, NULL);
        assert_true(on.claims[0].holds && on.claims[1].holds && on.claims[2].holds);
        on = certified(kepler_in_space, variational[i], 0.1, &turning);
        assert_true(on.claims[0].holds && on.claims[1].holds && on.claims[2].holds && on.claims[13].holds);
        on = certified(pendulum_in_angles, variational[i], 0.1, &vertical);
        assert_true(on.claims[0].holds && on.claims[1].holds && on.claims[2].holds && on.claims[13].holds);
    }
}

/* The time in L and H, forces that are no friction, and one that is. */
static void forces_and_time(void **unused)
{
    (void)unused;
    for (int i = 0; i < VARIATIONAL; i++) {
        certified(driven, variational[i], 0.04, NULL);
        certified(pushed, variational[i], 0.1, NULL);
        certified(shaken, variational[i], 0.04, NULL);
    }
    static const char *const conformal[] = {"conformal-midpoint2", "conformal-trapezoidal2"};
    for (int i = 0; i < 2; i++) {
        const struct gm_certificate on = certified(braked, conformal[i], 0.1, NULL);
        assert_true(on.claims[14].measured && on.claims[14].holds && on.claims[1].holds);
    }
}

/* Discrete Lagrangians of which other families of the program have the Hamiltonian form: where the mass
   matrix is constant, and the midpoint rule everywhere. */
static void the_same_methods(void **unused)
{
    (void)unused;
    static const struct {
        const char *text, *variational, *other;
    } same[] = {
        {kepler_in_space, "variational-trapezoidal2", "verlet"},
        {kepler_in_space, "variational-midpoint2", "midpoint"},
        {kepler_in_space, "variational-simpson4", "lobatto4"},
        {two_masses, "variational-trapezoidal2", "verlet"},
        {two_masses, "variational-midpoint2", "midpoint"},
        {two_masses, "variational-simpson4", "lobatto4"},
        {double_pendulum, "variational-midpoint2", "midpoint"},
        {pendulum_in_angles, "variational-midpoint2", "midpoint"},
    };
    for (size_t i = 0; i < GM_COUNT(same); i++) {
        struct typed typed;
        double here[12], there[12];
        type(&typed, same[i].text);
        typed_advance(&typed, &settings, same[i].variational, 0.05, 100, here);
        typed_advance(&typed, &settings, same[i].other, 0.05, 100, there);
        if (!(typed_apart(here, there, typed.problem.n) < 1e-12)) {
            fail_msg("%s and %s: %g apart", same[i].variational, same[i].other,
                     typed_apart(here, there, typed.problem.n));
        }
        untype(&typed);
    }
}

/* Newmark's method as books have it, for q'' = -q/|q|^3 in space; Q are its places. */
static void newmark(double beta, double dt, long steps, double *Q, double *v)
{
    double a[3], r = sqrt(Q[0] * Q[0] + Q[1] * Q[1] + Q[2] * Q[2]);
    for (int c = 0; c < 3; c++) {
        a[c] = -Q[c] / (r * r * r);
    }
    for (long n = 0; n < steps; n++) {
        double next[3], there[3];
        memcpy(there, a, sizeof there);
        for (int iteration = 0; iteration < 60; iteration++) {
            for (int c = 0; c < 3; c++) {
                next[c] = Q[c] + dt * v[c] + dt * dt * ((0.5 - beta) * a[c] + beta * there[c]);
            }
            r = sqrt(next[0] * next[0] + next[1] * next[1] + next[2] * next[2]);
            for (int c = 0; c < 3; c++) {
                there[c] = -next[c] / (r * r * r);
            }
        }
        for (int c = 0; c < 3; c++) {
            v[c] += dt / 2 * (a[c] + there[c]);
            Q[c] = next[c];
            a[c] = there[c];
        }
    }
}

/* What the variational one has of Q are x = Q - beta h^2 a(Q); for beta = 0 it is Verlet's scheme. */
static void newmarks_method(void **unused)
{
    (void)unused;
    const double beta = settings.newmark_beta, dt = 0.05;
    struct typed typed;
    type(&typed, kepler_in_space);
    double Q[3], v[3], end[6], start[6];
    memcpy(Q, typed.start, sizeof Q);
    memcpy(v, typed.start + 3, sizeof v);
    for (int late = 0; late < 2; late++) {
        const double r = sqrt(Q[0] * Q[0] + Q[1] * Q[1] + Q[2] * Q[2]),
                     factor = 1 + beta * dt * dt / (r * r * r);
        for (int c = 0; c < 3; c++) {
            (late ? end : start)[c] = Q[c] * factor;
            (late ? end : start)[3 + c] = v[c];
        }
        if (!late) {
            newmark(beta, dt, 200, Q, v);
        }
    }
    memcpy(typed.start, start, sizeof start);
    double found[6];
    typed_advance(&typed, &settings, "variational-newmark2", dt, 200, found);
    assert_true(typed_apart(found, end, 6) < 1e-12);
    static const struct gm_settings none = {0};
    struct gm_run *run =
        gm_run_open(&typed.problem, fitting("variational-newmark2", &typed.problem), &none, 0, dt, start);
    assert_non_null(run);
    assert_int_equal(gm_run_advance(run, 200), GM_OK);
    typed_advance(&typed, &settings, "verlet", dt, 200, end);
    assert_true(typed_apart(gm_run_state(run), end, 6) < 1e-12);
    gm_run_close(run);
    untype(&typed);
}

/* Of one degree of freedom the variation of time is that of the scheme that there was. */
static void times_of_one_degree(void **unused)
{
    (void)unused;
    static const char *const names[] = {"symplectic-energy-momentum2", "variational-midpoint"};
    static const struct gm_settings first = {.tau0 = 0.02};
    const double start[2] = {0.3, 1.2};
    struct gm_run *runs[2];
    for (int k = 0; k < 2; k++) {
        runs[k] = gm_run_open(&gm_problem_pendulum, gm_scheme_find(names[k]), &first, 0, 1, start);
        assert_non_null(runs[k]);
        assert_int_equal(gm_run_advance(runs[k], 100), GM_OK);
    }
    assert_true(typed_apart(gm_run_state(runs[0]), gm_run_state(runs[1]), 2) < 1e-10);
    assert_true(fabs(runs[0]->t - runs[1]->t) < 1e-10);
    gm_run_close(runs[0]);
    gm_run_close(runs[1]);
}

/* The energy in the middle of every step is that of the first to round-off, while there is a root. */
static void energies_of_times(void **unused)
{
    (void)unused;
    static const char *const texts[] = {double_pendulum, kepler_in_space, pendulum_in_angles, two_masses};
    static const struct gm_settings first = {.tau0 = 0.02};
    for (size_t i = 0; i < GM_COUNT(texts); i++) {
        struct typed typed;
        type(&typed, texts[i]);
        const struct gm_scheme *scheme = fitting("symplectic-energy-momentum2", &typed.problem);
        double middle[6], kept = 0, largest = 0;
        struct gm_run *run = gm_run_open(&typed.problem, scheme, &first, 0, 1, typed.start);
        assert_non_null(run);
        for (long steps = 0; steps < 100; steps++) {
            memcpy(middle, gm_run_state(run), typed.problem.n * sizeof *middle);
            assert_int_equal(gm_run_advance(run, 1), GM_OK);
            for (size_t c = 0; c < typed.problem.n; c++) {
                middle[c] = (middle[c] + gm_run_state(run)[c]) / 2;
            }
            const double energy = gm_energy(&typed.problem, middle);
            kept = steps == 0 ? energy : kept;
            largest = fmax(largest, fabs(energy - kept));
        }
        if (!(largest < 2e-14 * (1 + fabs(kept)))) {
            fail_msg("%s: the energy is off by %g", texts[i], largest);
        }
        gm_run_close(run);
        untype(&typed);
    }
}

/* An orbit of eccentricity .9 comes to where f' H'' f is 0, and no step leads on. */
static void times_without_a_root(void **unused)
{
    (void)unused;
    static const struct gm_settings first = {.tau0 = 0.005};
    struct typed typed;
    type(&typed, "coordinates: x y\nH: (p_x^2 + p_y^2)/2 - 1/sqrt(x^2 + y^2)\n"
                 "start: x = 0.1, y = 0, p_x = 0, p_y = sqrt(19)\n");
    const struct gm_scheme *scheme = fitting("symplectic-energy-momentum2", &typed.problem);
    struct gm_run *run = gm_run_open(&typed.problem, scheme, &first, 0, 1, typed.start);
    assert_non_null(run);
    assert_int_equal(gm_run_advance(run, 10000), GM_STEP_COLLAPSE);
    assert_true(run->t > 0 && run->t < M_PI && isfinite(gm_run_state(run)[0]));
    gm_run_close(run);
    untype(&typed);
}

/* Of the runs that round-off is watched in; 1e5 with the argument `all`. */
enum { FEW_STEPS = 5000 };
static long many_steps = FEW_STEPS;

/* The largest change of a momentum map over many steps. */
static double lost(const char *text, const char *name,
                   double (*map)(const void *data, const double *y, const double *memory),
                   const struct gm_settings *with, long steps)
{
    struct typed typed;
    type(&typed, text);
    struct gm_run *run =
        gm_run_open(&typed.problem, fitting(name, &typed.problem), with, 0, 0.05, typed.start);
    assert_non_null(run);
    const double before = map(NULL, typed.start, NULL);
    double largest = 0;
    for (int i = 0; i < 100; i++) {
        assert_int_equal(gm_run_advance(run, steps / 100), GM_OK);
        largest = fmax(largest, fabs(map(NULL, gm_run_state(run), NULL) - before) / fabs(before));
    }
    gm_run_close(run);
    untype(&typed);
    return largest;
}

static void momentum_maps(void **unused)
{
    (void)unused;
    for (int i = 0; i < VARIATIONAL; i++) {
        const double turned = lost(kepler_in_space, variational[i], about_z, &settings, many_steps),
                     swung = lost(pendulum_in_angles, variational[i], second_momentum, &settings, many_steps);
        if (!(turned < 1e-13) || !(swung < 1e-13)) {
            fail_msg("%s: %g, %g", variational[i], turned, swung);
        }
    }
    assert_true(lost(kepler_in_space, "rk4", about_z, &settings, many_steps) > 1e-7);
    /* plain sums round to one side, by 1e-18 of the momentum a step: 2e-13 in 1e5 */
    struct gm_settings compensated = settings;
    compensated.compensated = 1;
    static const char *const constrained[] = {"rattle2", "constrained-lobatto6"};
    for (size_t i = 0; i < GM_COUNT(constrained); i++) {
        assert_true(lost(pendulum_in_space, constrained[i], about_z, &settings, FEW_STEPS) < 1e-13);
        assert_true(lost(pendulum_in_space, constrained[i], about_z, &compensated, many_steps) < 1e-13);
    }
}

/* Both constraints at round-off, but of SHAKE one; the motion is that in angles. */
static void constraints_are_kept(void **unused)
{
    (void)unused;
    static const struct {
        const char *name;
        int order;
        bool hidden;
    } schemes[] = {{"rattle2", 2, true},
                   {"shake2", 2, false},
                   {"constrained-lobatto4", 4, true},
                   {"constrained-lobatto6", 6, true},
                   {"projected-gauss4", 4, true},
                   {"projected-gauss6", 6, true},
                   {"projected-rk4", 4, true}};
    struct typed space, angles;
    double end[6], of_angles[4];
    type(&space, pendulum_in_space);
    type(&angles, pendulum_in_angles);
    typed_advance(&angles, &settings, "gauss8", 0.01, 500, of_angles);
    const double a = of_angles[0], b = of_angles[1];
    const double place[3] = {sin(a) * cos(b), sin(a) * sin(b), -cos(a)};
    for (size_t i = 0; i < GM_COUNT(schemes); i++) {
        double errors[2];
        for (int finer = 0; finer < 2; finer++) {
            typed_advance(&space, &settings, schemes[i].name, 0.1 / (1 + finer), 50 * (1 + finer), end);
            errors[finer] = typed_apart(end, place, 3);
            const struct gm_manifold_defects defects = gm_manifold_defects(&space.problem, end);
            assert_true(defects.constraint < 1e-13);
            assert_true(schemes[i].hidden ? defects.hidden < 1e-13 : defects.hidden > 1e-6);
        }
        const double order = log2(errors[0] / errors[1]);
        if (fabs(order - schemes[i].order) > 0.2) {
            fail_msg("%s: order %.2f, errors %g %g", schemes[i].name, order, errors[0], errors[1]);
        }
    }
    typed_advance(&space, &settings, "rk4", 0.1, 500, end);
    assert_true(gm_manifold_defects(&space.problem, end).constraint > 1e-8);
    untype(&space);
    untype(&angles);
    const struct gm_kept vertical = {"L_z", about_z, NULL};
    static const char *const kept[] = {"rattle2", "constrained-lobatto4", "constrained-lobatto6"};
    for (int i = 0; i < 3; i++) {
        const struct gm_certificate on = certified(pendulum_in_space, kept[i], 0.1, &vertical);
        assert_true(on.claims[0].holds && on.claims[13].holds && on.claims[15].holds && on.claims[16].holds);
    }
}

/* A chain of rods is as many constraints, with a multiplier each. */
static void a_chain(void **unused)
{
    (void)unused;
    static const char text[] = "coordinates: x[1..3] y[1..3]\n"
                               "H: sum(i = 1 .. 3, p_x[i]^2/i + p_y[i]^2/i)/2 + sum(i = 1 .. 3, i*y[i])\n"
                               "constraint: x[1]^2 + y[1]^2 - 1\n"
                               "constraint: (x[2] - x[1])^2 + (y[2] - y[1])^2 - 1\n"
                               "constraint: (x[3] - x[2])^2 + (y[3] - y[2])^2 - 1\n"
                               "start: x[i] = i, y[i] = 0, p_x[i] = 0, p_y[i] = 0\n";
    struct typed typed;
    double end[12], other[12];
    type(&typed, text);
    typed_advance(&typed, &settings, "constrained-lobatto4", 0.02, 100, end);
    typed_advance(&typed, &settings, "constrained-lobatto6", 0.02, 100, other);
    const struct gm_manifold_defects defects = gm_manifold_defects(&typed.problem, end);
    assert_true(defects.constraint < 1e-13 && defects.hidden < 1e-13);
    assert_true(typed_apart(end, other, 12) < 1e-5);
    typed_advance(&typed, &settings, "gauss8", 0.02, 100, end);
    assert_true(typed_apart(end, other, 12) < 1e-8);
    /* all gradients are horizontal at first, and nearly so for a while */
    typed_advance(&typed, &settings, "rattle2", 0.01, 400, end);
    assert_true(gm_manifold_defects(&typed.problem, end).hidden < 1e-13);
    untype(&typed);
}

/* Where a step finds no root the run ends there, and says after how many iterations. */
static void no_root(void **unused)
{
    (void)unused;
    struct typed typed;
    type(&typed, "coordinates: q\nL: v_q^2/2 + q^4\nstart: q = 1, v_q = 1\n");
    struct gm_run *run = gm_run_open(&typed.problem, fitting("variational-midpoint2", &typed.problem),
                                     &settings, 0, 0.4, typed.start);
    assert_non_null(run);
    assert_int_equal(gm_run_advance(run, 100), GM_NO_CONVERGENCE);
    assert_true(run->steps < 10 && run->t == 0.4 * (double)run->steps);
    assert_true(isfinite(gm_run_state(run)[0]) && isfinite(gm_run_state(run)[1]));
    gm_run_close(run);
    untype(&typed);
}

/* Compensated, the time that a state holds is that of the run, as its coordinates and momenta are. */
static void time_of_the_state(void **unused)
{
    (void)unused;
    static const struct gm_settings compensated = {.compensated = 1};
    struct typed typed;
    type(&typed, "coordinates: q\nL: v_q^2/2 - q^2/2 + q*cos(t)\nstart: q = 1, v_q = 0\n");
    assert_int_equal(typed.problem.n, 3);
    struct gm_run *run = gm_run_open(&typed.problem, fitting("variational-midpoint2", &typed.problem),
                                     &compensated, 0, 0.1, typed.start);
    assert_non_null(run);
    assert_int_equal(gm_run_advance(run, 10000), GM_OK);
    assert_float_equal(gm_run_state(run)[2], run->t,
                       0x1p-42); /* 1000, to a few roundings; plain sums: 1e-10 */
    gm_run_close(run);
    untype(&typed);
}

/* What the schemes need, and what they are refused for. */
static void what_does_not_fit(void **unused)
{
    (void)unused;
    struct typed typed;
    type(&typed, "coordinates: q\nH: (1 + q^2)*p_q^2/2\nstart: q = 1, p_q = 1\n");
    const struct gm_scheme *scheme = gm_scheme_find("variational-galerkin4");
    assert_false(gm_scheme_fits(scheme, &typed.problem));
    assert_non_null(strstr(gm_scheme_lacks(scheme, &typed.problem), "a Lagrangian"));
    untype(&typed);
    type(&typed, pendulum_in_space);
    assert_false(gm_scheme_fits(scheme, &typed.problem));
    assert_false(gm_scheme_fits(gm_scheme_find("verlet"), &typed.problem));
    assert_false(gm_scheme_fits(gm_scheme_find("avf2"), &typed.problem));
    untype(&typed);
    type(&typed, double_pendulum);
    assert_string_equal(gm_scheme_lacks(gm_scheme_find("rattle2"), &typed.problem), "constraints");
    assert_non_null(
        strstr(gm_scheme_lacks(gm_scheme_find("conformal-midpoint2"), &typed.problem), "friction"));
    untype(&typed);
}

int main(int count, char **words)
{
    many_steps = count > 1 && strcmp(words[1], "all") == 0 ? 100000 : many_steps;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(orders_and_claims),
        cmocka_unit_test(forces_and_time),
        cmocka_unit_test(the_same_methods),
        cmocka_unit_test(newmarks_method),
        cmocka_unit_test(times_of_one_degree),
        cmocka_unit_test(energies_of_times),
        cmocka_unit_test(times_without_a_root),
        cmocka_unit_test(momentum_maps),
        cmocka_unit_test(constraints_are_kept),
        cmocka_unit_test(a_chain),
        cmocka_unit_test(no_root),
        cmocka_unit_test(time_of_the_state),
        cmocka_unit_test(what_does_not_fit),
    };
    const struct CMUnitTest long_ones[] = {cmocka_unit_test(momentum_maps)};
    return many_steps > 5000 ? cmocka_run_group_tests(long_ones, NULL, NULL)
                             : cmocka_run_group_tests(tests, NULL, NULL);
}
