/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Burgers' equation: every scheme, form and frame against values computed elsewhere; its symmetries. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "core/field/families/frames.h"
#include "core/run.h"
#include "core/schemes.h"
#include "tests/common/framed.h"
#include "tests/common/reference.h"

enum { MOST = 102, STEPS = 10 };

static const struct gm_settings no_settings;

static void values_agree(void **unused)
{
    (void)unused;
    for (size_t c = 0; c < reference_cases(); c++) {
        const char *test = reference_word(c, 0), *scheme = reference_word(c, 1);
        const char *form = reference_word(c, 2), *frame = reference_word(c, 3);
        const size_t points = (size_t)reference_number(c, "points");
        const double lambda = reference_number(c, "lambda");
        const double *start = reference(reference_word(c, 4), points), *end = reference_of(c, "u", points);
        const bool fixed = strcmp(frame, "fixed") == 0, shock = strcmp(test, "shock") == 0;
        const struct burgers_solution burgers = {
            .test = shock ? BURGERS_SHOCK : BURGERS_FRONT,
            .frame = fixed ? GM_FRAME_FIXED : GM_FRAME_MOVING,
            .printed = strcmp(form, "printed") == 0,
            .viscosity = 0.05,
            .lambda = lambda,
        };
        struct framed framed;
        burgers_open(&framed, &burgers,
                     (struct gm_grid1){.points = points, .dx = 0.04, .first = shock ? -1 : -2});
        const struct gm_problem *problem = &framed.problem;
        double y[2 * MOST + 1];
        memcpy(y, start, points * sizeof *y);
        for (size_t j = 0; j < points; j++) {
            y[points + j] = start[j] - lambda;
        }
        y[2 * points] = 1;
        const double t0 = burgers_begin(&burgers);
        struct gm_run *run =
            gm_run_open(problem, gm_scheme_find_for(scheme, problem), &no_settings, t0, 0.008, y);
        assert_non_null(run);
        assert_int_equal(gm_run_advance(run, STEPS), GM_OK);
        const double *u = gm_run_state(run);
        double largest = 0, error = 0, sup = 0, sum = 0;
        for (size_t j = 0; j < points; j++) {
            largest = fmax(largest, fabs(end[j]));
            error = fmax(error, fabs(u[j] - end[j]));
            const double exact = burgers_exact(&burgers, fixed, gm_grid1_node(&problem->line, j), run->t);
            sup = fmax(sup, fabs(u[j] - exact));
            sum += 0.04 * fabs(u[j] - exact);
        }
        const double tolerance =
            1e-12 + 100 * (reference_number(c, "conditioning") + reference_number(c, "agreement"));
        if (!(error <= tolerance * largest)) {
            fail_msg("%s, %s, %s, %s, lambda %g: error %.2e", test, scheme, form, frame, lambda, error);
        }
        assert_true(fabs(sup - reference_number(c, "sup_error")) < 1e-9);
        assert_true(fabs(sum - reference_number(c, "l1_error")) < 1e-9);
        gm_run_close(run);
        framed_close(&framed);
    }
}

/* Three nodes, dx = dt = 0.01: values 0.4, 0.3, 0.15 around x = 0.3, projected with a4 = 0.5. */
static void projections_commute_or_not(void **unused)
{
    (void)unused;
    static const struct {
        const char *name;
        bool commutes;
    } schemes[] = {
        {"ftcs", false}, {"lax-wendroff", false}, {"ftcs-invariant", true}, {"lax-wendroff-invariant", true}};
    for (size_t s = 0; s < 4; s++) {
        const struct gm_point_symmetry projection = {.projection = 0.5, .scale = 1}, scaling = {.scale = 1.3};
        const struct gm_burgers burgers = {.framed.viscosity = 0.005};
        const struct gm_problem problem = {.parameters = &burgers, .line.dx = 0.01};
        const struct gm_scheme *scheme = gm_scheme_find(schemes[s].name);
        const double defect = gm_frames_of_burgers.defect(&problem, scheme, 0.01, &projection, NULL);
        assert_true(gm_frames_of_burgers.defect(&problem, scheme, 0.01, &scaling, NULL) < 1e-15);
        if (schemes[s].commutes ? !(defect < 1e-15) : !(defect > 1e-6)) {
            fail_msg("%s: defect %.2e", schemes[s].name, defect);
        }
    }
}

/* The family of frames: each choice of a and d commutes with a boost, a projection and a scaling; numbers
   that miss one of eqs. 119 do not, which a step made here shows. */
static double family_step(const double u[3], double h, double k, double nu, const double f[6], double sigma)
{
    const double a4 = (f[0] * u[2] + f[1] * u[1] + f[2] * u[0]) / h;
    const double a5 = f[3] * u[2] + f[4] * u[1] + f[5] * u[0], m = 1 - a4 * k;
    const double right = u[2] + a4 * h + a5, left = u[0] - a4 * h + a5, here = u[1] + a5;
    const double slope = (right - left) / (2 * h), bend = (right - 2 * here + left) / (h * h);
    const double arrived = here + k / m * (nu * bend - here * slope);
    return (arrived - a5 - sigma * a4) / m;
}

static void every_frame_of_the_family_commutes(void **unused)
{
    (void)unused;
    static const double u[3] = {0.4, 0.3, 0.15};
    const double h = 0.01, k = 0.01, x = 0.3, a4 = 0.5, a5 = 0.4, m = 1 - a4 * k;
    const struct gm_point_symmetry symmetry = {.boost = a5, .projection = a4, .scale = 1.3};
    static const struct {
        double a, d, broken;
    } choices[] = {{-0.5, 0, 0}, {-0.5, 0.3, 0}, {0, 0, 0}, {-1, 0.3, 0}, {-0.3, -0.7, 0}, {-0.3, 0.2, 0.1}};
    double carried[3];
    for (int j = 0; j < 3; j++) {
        carried[j] = u[j] + a4 * (x + (j - 1) * h) + a5;
    }
    for (size_t c = 0; c < sizeof choices / sizeof *choices; c++) {
        const double a = choices[c].a, d = choices[c].d, broken = choices[c].broken;
        const struct gm_burgers burgers = {.framed.viscosity = 0.005, .a = a, .d = d};
        const struct gm_problem problem = {.parameters = &burgers, .line.dx = h};
        const double numbers[6] = {a, -1 - 2 * a, 1 + a + broken, d, -1 - 2 * d, d};
        const double plain = family_step(u, h, k, 0.005, numbers, 0);
        const double boosted = family_step(carried, h, k / m, 0.005, numbers, (x + a5 * k) / m - x);
        const double defect = fabs(boosted - (m * plain + a4 * x + a5));
        if (broken != 0) {
            assert_true(defect > 1e-4);
            continue;
        }
        assert_true(defect < 1e-14);
        assert_true(gm_frames_of_burgers.defect(&problem, gm_scheme_find("ftcs-family"), k, &symmetry, NULL) <
                    1e-14);
        /* and its run makes that step */
        const struct burgers_solution moving = {
            .frame = GM_FRAME_MOVING, .viscosity = 0.005, .lambda = 0.7, .a = a, .d = d};
        struct framed framed;
        burgers_open(&framed, &moving, (struct gm_grid1){.points = 3, .dx = h, .first = -h});
        const double y[7] = {u[0], u[1], u[2]};
        struct gm_run *run =
            gm_run_open(&framed.problem, gm_scheme_find("ftcs-family"), &no_settings, 0, k, y);
        assert_int_equal(gm_run_advance(run, 1), GM_OK);
        assert_true(fabs(gm_run_state(run)[1] - family_step(u, h, k, 0.005, numbers, 0.7 * k)) < 1e-15);
        gm_run_close(run);
        framed_close(&framed);
    }
}

/* The largest error on a resolved front. */
static double front_error(const char *scheme, double a, double d, size_t pieces)
{
    const struct burgers_solution burgers = {.viscosity = 0.1, .a = a, .d = d};
    struct framed framed;
    burgers_open(&framed, &burgers,
                 (struct gm_grid1){.points = pieces + 1, .dx = 4.0 / (double)pieces, .first = -2});
    const struct gm_problem *problem = &framed.problem;
    double y[321], largest = 0;
    for (size_t j = 0; j <= pieces; j++) {
        y[j] = burgers_exact(&burgers, true, gm_grid1_node(&problem->line, j), 0);
    }
    struct gm_run *run =
        gm_run_open(problem, gm_scheme_find(scheme), &no_settings, 0, 1.28 / (double)(pieces * pieces), y);
    assert_int_equal(gm_run_until(run, 0.5), GM_OK);
    for (size_t j = 0; j <= pieces; j++) {
        const double exact = burgers_exact(&burgers, true, gm_grid1_node(&problem->line, j), 0.5);
        largest = fmax(largest, fabs(gm_run_state(run)[j] - exact));
    }
    gm_run_close(run);
    framed_close(&framed);
    return largest;
}

/* With k / h^2 fixed the order in h is 2 for a = -1/2, whatever d, and 1 for others. */
static void one_frame_has_the_second_order(void **unused)
{
    (void)unused;
    static const struct {
        double a, d;
        int order;
    } choices[] = {{-0.5, 0, 2}, {-0.5, 5, 2}, {-0.4, 0, 1}, {-0.4, 0.5, 1}, {-0.6, 0, 1}};
    for (size_t c = 0; c < sizeof choices / sizeof *choices; c++) {
        const double coarse = front_error("ftcs-family", choices[c].a, choices[c].d, 160);
        const double fine = front_error("ftcs-family", choices[c].a, choices[c].d, 320);
        print_message("a = %g, d = %g: errors %.3g, %.3g, order %.3f\n", choices[c].a, choices[c].d, coarse,
                      fine, log2(coarse / fine));
        assert_true(fabs(log2(coarse / fine) - choices[c].order) < 0.15);
    }
    const double known = front_error("ftcs-invariant", 0, 0, 160);
    assert_true(fabs(front_error("ftcs-family", -0.5, 3, 160) - known) < 1e-12);
}

/* Steps made one by one and all at once are the same bits; so are those after a copy of the state. */
static void bits_do_not_depend_on_bursts(void **unused)
{
    (void)unused;
    const struct burgers_solution burgers = {.frame = GM_FRAME_FIXED, .viscosity = 0.005, .lambda = 0.7};
    struct framed framed;
    burgers_open(&framed, &burgers, (struct gm_grid1){.points = 161, .dx = 0.025, .first = -2});
    const struct gm_problem *problem = &framed.problem;
    double *y = malloc(problem->n * sizeof *y);
    for (size_t j = 0; j < 161; j++) {
        y[j] = burgers_exact(&burgers, true, gm_grid1_node(&problem->line, j), 0);
        y[161 + j] = y[j] - 0.7;
    }
    y[322] = 1;
    struct gm_run *one =
        gm_run_open(problem, gm_scheme_find_for("crank-nicolson", problem), &no_settings, 0, 0.01, y);
    struct gm_run *all =
        gm_run_open(problem, gm_scheme_find_for("crank-nicolson", problem), &no_settings, 0, 0.01, y);
    assert_int_equal(gm_run_advance(all, 30), GM_OK);
    for (int k = 0; k < 30; k++) {
        assert_int_equal(gm_run_advance(one, 1), GM_OK);
    }
    assert_memory_equal(gm_run_state(one), gm_run_state(all), problem->n * sizeof *y);
    gm_run_close(one);
    gm_run_close(all);
    framed_close(&framed);
    free(y);
}

/* The file's formulas against others, also for no viscosity. */
static void exact_solutions_survive_extremes(void **unused)
{
    (void)unused;
    static const double viscosities[] = {0, 1e-300, 1e-6, 1, 10}, lambdas[] = {0, 1e3};
    for (size_t i = 0; i < 5 * 2; i++) {
        for (int test = 0; test < 2; test++) {
            const struct burgers_solution burgers = {
                .test = test, .viscosity = viscosities[i / 2], .lambda = lambdas[i % 2]};
            struct framed framed;
            burgers_open(&framed, &burgers, (struct gm_grid1){.points = 3, .dx = 0.1, .first = -0.1});
            for (int k = -10; k <= 10; k++) {
                const double x = k / 10.0 + burgers.lambda, t = burgers_begin(&burgers) + 1;
                const double found = gm_frame_exact(gm_framed_of(&framed.problem), 0, x, t);
                assert_true(fabs(found - burgers.lambda) <= 1);
                assert_true(fabs(found - burgers_exact(&burgers, true, x, t)) < 1e-15);
            }
            framed_close(&framed);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(values_agree),
        cmocka_unit_test(projections_commute_or_not),
        cmocka_unit_test(every_frame_of_the_family_commutes),
        cmocka_unit_test(one_frame_has_the_second_order),
        cmocka_unit_test(bits_do_not_depend_on_bursts),
        cmocka_unit_test(exact_solutions_survive_extremes),
    };
    reference_open("burgers.txt");
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    reference_close();
    return failed;
}
