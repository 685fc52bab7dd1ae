/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every scheme against states computed elsewhere. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "core/basics.h"
#include "core/ode/problems/problems.h"
#include "core/run.h"
#include "core/schemes.h"
#include "tests/common/reference.h"
#include "tests/problems/problems.h"

static struct gm_problem problem_of(const char *name)
{
    static const double omega = 50, stiffness = 1e4, strength = 2, abc[3] = {1, 1, 1}, perturbation = 1e-3;
    const struct {
        const char *name;
        const struct gm_problem *problem;
        const void *parameters;
    } list[] = {
        {"oscillator", &gm_problem_oscillator, NULL},
        {"pendulum", &gm_problem_pendulum, NULL},
        {"kepler-0.5", &gm_problem_kepler, NULL},
        {"kepler-0.9", &gm_problem_kepler, NULL},
        {"kepler-0.99", &gm_problem_kepler, NULL},
        {"kepler-perturbed", &gm_problem_kepler_perturbed, &perturbation},
        {"henon-heiles", &gm_problem_henon_heiles, NULL},
        {"fpu", &gm_problem_fpu, &omega},
        {"spring-pendulum", &gm_problem_spring_pendulum, &stiffness},
        {"vortices-two-turned", &gm_problem_vortices_four, &strength},
        {"vortices-reduced", &gm_problem_vortices_reduced, &strength},
        {"abc", &gm_problem_abc, abc},
        {"rigid-body", &gm_problem_rigid_body, NULL},
    };
    for (size_t i = 0; i < GM_COUNT(list); i++) {
        if (strcmp(list[i].name, name) == 0) {
            struct gm_problem problem = *list[i].problem;
            problem.parameters = list[i].parameters;
            return problem;
        }
    }
    fail_msg("no problem %s", name);
    return gm_problem_pendulum;
}

/* relative to the reference's maximum norm */
static double distance(const double *y, const double *reference, int n)
{
    double scale = 0, error = 0;
    for (int c = 0; c < n; c++) {
        scale = fmax(scale, fabs(reference[c]));
        error = fmax(error, fabs(y[c] - reference[c]));
    }
    return error / scale;
}

static struct gm_run *open_run(const struct gm_problem *problem, const char *scheme,
                               const struct gm_settings *settings, double dt, const double *start)
{
    const struct gm_scheme *found = gm_scheme_find_for(scheme, problem);
    if (!found || !gm_scheme_fits(found, problem)) {
        fail_msg("no scheme %s for %s", scheme, problem->name);
    }
    struct gm_run *run = gm_run_open(problem, found, settings, 0, dt, start);
    assert_non_null(run);
    return run;
}

/* Whether a case is of this kind: a state of a scheme, or a control, or of the schemes that choose their
   step. */
static bool is_kind(size_t index, const char *kind)
{
    return strcmp(reference_word(index, 0), kind) == 0;
}

static const char *problem_name(size_t index)
{
    return reference_word(index, 1);
}

static const char *scheme_name(size_t index)
{
    return reference_word(index, 2);
}

static bool is_same(const char *(*name)(size_t index), size_t i, size_t k)
{
    return strcmp(name(i), name(k)) == 0;
}

/* Whether a control's end is a different state at all: schemes of order 8 may come too close to each
   other. */
static bool is_telling(size_t control)
{
    const size_t n = problem_of(problem_name(control)).n;
    for (size_t i = 0; i < reference_cases(); i++) {
        if (is_kind(i, "ode") && is_same(scheme_name, i, control) && is_same(problem_name, i, control)) {
            return distance(reference_of(i, "end", n), reference_of(control, "end", n), (int)n) >
                   4 * reference_number(control, "tolerance");
        }
    }
    return false;
}

/* The states after one step and at the end agree; those of a control do not. */
static void states_agree(void **unused)
{
    (void)unused;
    for (size_t i = 0; i < reference_cases(); i++) {
        const bool control = is_kind(i, "control");
        if (control ? !is_telling(i) : !is_kind(i, "ode")) {
            continue;
        }
        const struct gm_problem problem = problem_of(problem_name(i));
        const double *start = reference_of(i, "start", problem.n), *end = reference_of(i, "end", problem.n);
        const double *after_one_step = reference_of(i, "after_one_step", problem.n);
        const double dt = reference_number(i, "dt"), tolerance = reference_number(i, "tolerance");
        const long steps = (long)reference_number(i, "steps");
        const int n = (int)problem.n;
        for (int compensated = 0; compensated < 2; compensated++) {
            const struct gm_settings settings = {.compensated = compensated, .binding = 20};
            struct gm_run *run = open_run(&problem, scheme_name(i), &settings, dt, start);
            assert_int_equal(gm_run_advance(run, 1), GM_OK);
            const double at_once = distance(gm_run_state(run), after_one_step, n);
            assert_int_equal(gm_run_advance(run, steps - 1), GM_OK);
            const double at_end = distance(gm_run_state(run), end, n);
            const bool same = at_once <= fmin(1e-13, tolerance) && at_end <= tolerance;
            const bool far = at_end > 2 * tolerance;
            if (control ? !far : !same) {
                fail_msg("%s%s on %s: error %.2e after one step, %.2e at the end, tolerance %.2e",
                         control ? "the control of " : "", scheme_name(i), problem_name(i), at_once, at_end,
                         tolerance);
            }
            gm_run_close(run);
        }
    }
}

static void every_control_tells_somewhere(void **unused)
{
    (void)unused;
    for (size_t i = 0; i < reference_cases(); i++) {
        bool told = !is_kind(i, "control");
        for (size_t j = 0; j < reference_cases() && !told; j++) {
            told = is_kind(j, "control") && is_same(scheme_name, i, j) && is_telling(j);
        }
        if (!told) {
            fail_msg("no control of %s tells it apart", scheme_name(i));
        }
    }
}

static void schemes_that_choose_their_step_agree(void **unused)
{
    (void)unused;
    size_t found = 0;
    for (size_t i = 0; i < reference_cases(); i++) {
        if (!is_kind(i, "own-time")) {
            continue;
        }
        const struct gm_problem problem = problem_of(problem_name(i));
        const struct gm_settings settings = {0};
        const double *once = reference_of(i, "after_one_step", 5), *end = reference_of(i, "end", 5);
        const double tolerance = reference_number(i, "tolerance");
        struct gm_run *run = open_run(&problem, scheme_name(i), &settings, reference_number(i, "dt"),
                                      reference_of(i, "start", 4));
        assert_int_equal(gm_run_advance(run, 1), GM_OK);
        assert_true(fabs(run->t - once[0]) < 1e-15);
        assert_true(distance(gm_run_state(run), once + 1, 4) < 1e-13);
        assert_int_equal(gm_run_advance(run, (long)reference_number(i, "steps") - 1), GM_OK);
        assert_true(fabs(run->t - end[0]) <= tolerance * fabs(end[0]));
        assert_true(distance(gm_run_state(run), end + 1, 4) <= tolerance);
        gm_run_close(run);
        found++;
    }
    assert_int_equal(found, 17);
}

/* Unperturbed, half a step turns the eccentric anomaly by 4 atan(ds sqrt(B/8)/2), B = 1/(2a); the time that
   passes is the area under r between both ends, by the rule that takes |u|^2 at the mean of both u =
   sqrt(q). */
static void levi_civita_agrees(void **unused)
{
    (void)unused;
    static const double eccentricities[] = {0, 0.5, 0.99};
    for (size_t k = 0; k < GM_COUNT(eccentricities); k++) {
        const double e = eccentricities[k], ds = 2 * M_PI / 47, narrow = sqrt(1 - e * e);
        const double start[] = {1 - e, 0, 0, sqrt((1 + e) / (1 - e))};
        const struct gm_settings settings = {0};
        const struct gm_problem problem = gm_problem_kepler;
        struct gm_run *run = open_run(&problem, "levi-civita", &settings, ds, start);
        double E = 0, t = 0;
        for (int n = 1; n <= 300; n++) {
            assert_int_equal(gm_run_advance(run, 1), GM_OK);
            for (int half = 0; half < 2; half++) {
                const double next = E + 4 * atan(ds / 8);
                /* u = (sqrt(1 - e) cos(E/2), sqrt(1 + e) sin(E/2)) */
                const double x = sqrt(1 - e) * (cos(E / 2) + cos(next / 2)) / 2;
                const double y = sqrt(1 + e) * (sin(E / 2) + sin(next / 2)) / 2;
                t += ds / 2 * (x * x + y * y);
                E = next;
            }
            const double r = 1 - e * cos(E);
            const double exact[] = {cos(E) - e, narrow * sin(E), -sin(E) / r, narrow * cos(E) / r};
            assert_true(fabs(run->t - t) < 1e-13 * t);
            /* the velocity at the pericentre magnifies the rounding of the anomaly */
            assert_true(distance(gm_run_state(run), exact, 4) < 3e-13 / (1 - e));
        }
        gm_run_close(run);
    }
}

static void variational_steps_agree(void **unused)
{
    (void)unused;
    size_t count = 0;
    for (size_t i = 0; i < reference_cases(); i++) {
        if (!is_kind(i, "variational")) {
            continue;
        }
        const struct gm_problem problem = problem_of(problem_name(i));
        const struct gm_settings settings = {.tau0 = reference_number(i, "tau0")};
        const double *entry = reference_of(i, "entry", 4), tolerance = reference_number(i, "tolerance");
        const long steps = (long)reference_number(i, "steps");
        struct gm_run *run = open_run(&problem, scheme_name(i), &settings, 1, reference_of(i, "start", 2));
        assert_int_equal(gm_run_advance(run, steps), GM_OK);
        const double *y = gm_run_state(run);
        const double found[4] = {run->t, y[0], y[1], gm_run_memory(run)[0]};
        for (int c = 0; c < 4; c++) {
            if (!(fabs(found[c] - entry[c]) <= tolerance)) {
                fail_msg("%s, tau0 = %g, entry %ld, column %d: %.17g, expected %.17g, tolerance %.2e",
                         scheme_name(i), settings.tau0, steps, c, found[c], entry[c], tolerance);
            }
        }
        gm_run_close(run);
        count++;
    }
    assert_int_equal(count, 17);
}

/* As printed, it ends before the first turning point: from tau0 = .1 the 13th step, at t = 1.01, has no
   root. */
static void the_printed_rectangle_rule_loses_its_root(void **unused)
{
    (void)unused;
    const struct gm_problem problem = gm_problem_oscillator;
    const double start[2] = {sin(0.3), cos(0.3)}, tau0[] = {0.1, 0.02, 1e-3, 1e-4};
    for (size_t i = 0; i < GM_COUNT(tau0); i++) {
        const struct gm_settings settings = {.tau0 = tau0[i]};
        struct gm_run *run = open_run(&problem, "variational-rectangle", &settings, 1, start);
        assert_int_equal(gm_run_advance(run, 1000000), GM_STEP_COLLAPSE);
        const double q = gm_run_state(run)[0], v = gm_run_state(run)[1];
        assert_true(q > 0.97 && q < 1 && run->t < M_PI / 2 - 0.3 + 0.1);
        assert_true(fabs(q * q + v * v - 1) < 1e-14);
        if (i == 0) {
            assert_int_equal(run->steps, 12);
            assert_true(fabs(run->t - 1.01) < 5e-3);
        }
        gm_run_close(run);
    }
}

/* Held to their claims by tests/unit/claims.c, to a second solver by that, by lagrangian.c or by
   tests/shell/systems.sh, or to other schemes by variational.c. */
static bool is_without_reference(const char *name)
{
    const char *const list[] = {"radau3",
                                "radau5",
                                "boris2",
                                "degenerate-midpoint2",
                                "saba2",
                                "saba3",
                                "saba4",
                                "sabac2",
                                "sabac3",
                                "sabac4",
                                "aba104",
                                "aba864",
                                "aba1064",
                                "magnetic-splitting2",
                                "sdirk2",
                                "lobatto2",
                                "avf4",
                                "discrete-gradient2",
                                "tao2",
                                "tao4",
                                "gsl-rk4",
                                "gsl-rk8pd",
                                "gsl-msadams",
                                "gsl-msbdf",
                                "variational-rectangle",
                                "levi-civita",
                                "variational-rectangle-restart",
                                "variational-midpoint",
                                "symplectic-energy-momentum2",
                                "variational-midpoint2",
                                "variational-trapezoidal2",
                                "variational-simpson4",
                                "variational-galerkin2",
                                "variational-galerkin4",
                                "variational-galerkin6",
                                "conformal-midpoint2",
                                "conformal-trapezoidal2",
                                "rattle2",
                                "shake2",
                                "constrained-lobatto4",
                                "constrained-lobatto6",
                                "variational-newmark2",
                                "projected-gauss4",
                                "projected-gauss6",
                                "projected-rk4",
                                "exponential-euler1",
                                "lawson4",
                                "dopri5",
                                "etdrk4"};
    for (size_t i = 0; i < GM_COUNT(list); i++) {
        if (strcmp(list[i], name) == 0) {
            return true;
        }
    }
    return false;
}

static void every_scheme_has_a_reference(void **unused)
{
    (void)unused;
    for (size_t s = 0; s < gm_scheme_count(); s++) {
        if (gm_scheme_at(s)->family->kind != &gm_kind_ode) {
            continue; /* they have references of their own */
        }
        const char *name = gm_scheme_at(s)->name;
        size_t found = is_without_reference(name);
        for (size_t i = 0; i < reference_cases(); i++) {
            found += strcmp(scheme_name(i), name) == 0 && (is_kind(i, "ode") || is_kind(i, "own-time"));
        }
        if (found == 0) {
            fail_msg("%s has no reference", name);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(states_agree),
        cmocka_unit_test(every_control_tells_somewhere),
        cmocka_unit_test(schemes_that_choose_their_step_agree),
        cmocka_unit_test(levi_civita_agrees),
        cmocka_unit_test(variational_steps_agree),
        cmocka_unit_test(the_printed_rectangle_rule_loses_its_root),
        cmocka_unit_test(every_scheme_has_a_reference),
    };
    reference_open("ode.txt");
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    reference_close();
    return failed;
}
