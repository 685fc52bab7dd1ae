/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The heat equation: its symmetries against their generators, the invariant schemes against the moving frame
   that they are made of, and what each scheme keeps. */
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
#include "core/field/families/frames.h"
#include "core/run.h"
#include "core/schemes.h"
#include "core/theory/certify.h"
#include "tests/common/framed.h"

static const struct gm_settings no_settings;
static const char *const schemes[] = {"heat-ftcs", "heat-boosts", "heat-projections"};

/* The flow of a generator by the classical Runge-Kutta method, (t, x, ln u) in y: of boosts (0, t, -x/2nu),
   of projections (t^2, t x, -t/2 - x^2/4nu). */
static void flow(bool projection, double nu, double amount, double y[3])
{
    enum { STEPS = 400 };
    for (int i = 0; i < STEPS; i++) {
        static const double at[4] = {0, 0.5, 0.5, 1}, weight[4] = {1, 2, 2, 1};
        double rate[3] = {0}, sum[3] = {0};
        for (int s = 0; s < 4; s++) {
            double z[3];
            for (int c = 0; c < 3; c++) {
                z[c] = y[c] + at[s] * amount / STEPS * rate[c];
            }
            rate[0] = projection ? z[0] * z[0] : 0;
            rate[1] = projection ? z[0] * z[1] : z[0];
            rate[2] = projection ? -z[0] / 2 - z[1] * z[1] / (4 * nu) : -z[1] / (2 * nu);
            for (int c = 0; c < 3; c++) {
                sum[c] += weight[s] * rate[c];
            }
        }
        for (int c = 0; c < 3; c++) {
            y[c] += amount / STEPS / 6 * sum[c];
        }
    }
}

static void symmetries_are_flows_of_their_generators(void **unused)
{
    (void)unused;
    const double nu = 0.7;
    const struct gm_point_symmetry symmetry = {.boost = 0.8, .projection = -0.6, .scale = 1.5};
    double y[3] = {0.3, -0.4, log(1.7)};
    flow(false, nu, symmetry.boost, y);
    flow(true, nu, symmetry.projection, y);
    const struct gm_event carried = gm_frames_of_heat.carry(&(struct gm_framed){.viscosity = nu}, &symmetry,
                                                            (struct gm_event){.t = 0.3, .x = -0.4, .u = 1.7});
    assert_true(fabs(carried.t - 2.25 * y[0]) < 1e-11);
    assert_true(fabs(carried.x - 1.5 * y[1]) < 1e-11);
    assert_true(fabs(carried.u - exp(y[2])) < 1e-11);
}

/* The file's exact solution of each start, at rest and boosted: against formulas, and u_t - nu u_xx by differences of the
   eighth order. */
static void exact_solutions_solve(void **unused)
{
    (void)unused;
    static const double first[] = {4. / 5, -1. / 5, 4. / 105, -1. / 280};
    static const double second[] = {8. / 5, -1. / 5, 8. / 315, -1. / 560};
    for (int start = 0; start < 3; start++) {
        for (int boosted = 0; boosted < 2; boosted++) {
            const struct heat_solution heat = {
                .start = start, .diffusivity = 0.7, .lambda = boosted ? 1.3 : 0, .age = 0.4};
            const double t = 0.3, x = 0.2, h = 0.02;
            struct framed framed;
            heat_open(&framed, &heat, (struct gm_grid1){.points = 3, .dx = 0.1, .first = -0.1});
            for (int moving = 0; moving < 2; moving++) {
                const double exact = heat_exact(&heat, !moving, x, t);
                const double found =
                    gm_frame_exact(gm_framed_of(&framed.problem), moving ? heat.lambda : 0, x, t);
                assert_true(fabs(found / exact - 1) < 1e-14);
            }
            framed_close(&framed);
            double rate = 0, bend = -205. / 72 * heat_exact(&heat, true, x, t);
            for (int k = 1; k <= 4; k++) {
                rate += first[k - 1] *
                        (heat_exact(&heat, true, x, t + k * h) - heat_exact(&heat, true, x, t - k * h));
                bend += second[k - 1] *
                        (heat_exact(&heat, true, x + k * h, t) + heat_exact(&heat, true, x - k * h, t));
            }
            assert_true(fabs(rate / h - heat.diffusivity * bend / (h * h)) < 1e-9);
        }
    }
}

/* A step on three nodes by eq. 91: the frame is found by what it has to do, the ordinary step made there, and
   the result carried back by the flows; nodes that rest and nodes that move. */
static void steps_are_made_in_the_moving_frame(void **unused)
{
    (void)unused;
    const double nu = 0.7, h = 0.1, k = 0.004, u[3] = {0.5, 0.8, 0.9};
    for (size_t s = 1; s < GM_COUNT(schemes); s++) {
        for (int moving = 0; moving < 2; moving++) {
            const double boost = nu / h * (log(u[2]) - log(u[0]));
            double middle[3], carried[3], projection = 0;
            for (int round = 0; round < 2; round++) {
                for (int j = 0; j < 3; j++) {
                    double y[3] = {0, (j - 1) * h, log(u[j])};
                    flow(false, nu, boost, y);
                    flow(true, nu, projection, y);
                    carried[j] = exp(y[2]);
                }
                /* at t = 0 the rate of ln u along a projection is -x^2/4nu */
                projection += s == 2 ? log(carried[0] / carried[1]) / (h * h / (4 * nu)) : 0;
            }
            const double r = nu * k / (h * h) / (1 - projection * k);
            double arrival[3] = {k, moving * 0.02, 0};
            flow(false, nu, boost, arrival);
            flow(true, nu, projection, arrival);
            middle[0] = arrival[0];
            middle[1] = arrival[1];
            middle[2] = log(carried[1] + r * (carried[0] - 2 * carried[1] + carried[2]));
            flow(true, nu, -projection, middle);
            flow(false, nu, -boost, middle);

            const struct heat_solution heat = {
                .frame = GM_FRAME_MOVING, .diffusivity = nu, .lambda = moving * 0.02 / k, .age = 1};
            struct framed framed;
            heat_open(&framed, &heat, (struct gm_grid1){.points = 3, .dx = h, .first = -h});
            struct gm_run *run =
                gm_run_open(&framed.problem, gm_scheme_find(schemes[s]), &no_settings, 0, k, u);
            assert_int_equal(gm_run_advance(run, 1), GM_OK);
            const double error = fabs(gm_run_state(run)[1] / exp(middle[2]) - 1);
            if (!(error < 1e-12)) {
                fail_msg("%s: error %.2e", schemes[s], error);
            }
            gm_run_close(run);
            framed_close(&framed);
        }
    }
}

enum { MOST = 481 };

/* The field at `until` as the original frame sees it, and its largest error. */
static double run_to(const char *scheme, const struct heat_solution *heat, double half, size_t points,
                     double dt, double until, double *u)
{
    struct framed framed;
    heat_open(&framed, heat,
              (struct gm_grid1){.points = points, .dx = 2 * half / (double)(points - 1), .first = -half});
    const struct gm_problem *problem = &framed.problem;
    double y[MOST], largest = 0;
    for (size_t j = 0; j < points; j++) {
        y[j] = heat_exact(heat, true, gm_grid1_node(&problem->line, j), 0);
    }
    const struct gm_scheme *found = gm_scheme_find(scheme);
    struct gm_run *run = gm_run_open(problem, found, &no_settings, 0, dt, y);
    assert_non_null(run);
    assert_int_equal(gm_run_until(run, until), GM_OK);
    const bool fixed = gm_frame_rests(gm_framed_of(problem), found);
    for (size_t j = 0; j < points; j++) {
        const double x = gm_grid1_node(&problem->line, j),
                     factor = gm_heat_factor(gm_framed_of(problem), fixed, x, until);
        u[j] = gm_run_state(run)[j] / factor;
        largest = fmax(largest, fabs(u[j] - heat_exact(heat, fixed, x, until) / factor));
    }
    gm_run_close(run);
    framed_close(&framed);
    return largest;
}

/* A frame of the velocity 6: to 1e-12 the invariant schemes give the profile at rest, and FTCS, whose nodes
   rest in the frame, an error that is 80 times as large. */
static void profiles_do_not_depend_on_the_frame(void **unused)
{
    (void)unused;
    for (size_t s = 0; s < GM_COUNT(schemes); s++) {
        struct heat_solution heat = {.start = HEAT_TWO, .diffusivity = 1, .age = 0.25};
        double at_rest[MOST], boosted[MOST];
        const double error = run_to(schemes[s], &heat, 6, 121, 0.0025, 0.5, at_rest);
        heat.lambda = 6;
        const double boosted_error = run_to(schemes[s], &heat, 6, 121, 0.0025, 0.5, boosted);
        print_message("%s: error %.4g at rest, %.4g from the frame\n", schemes[s], error, boosted_error);
        if (s == 0) {
            assert_true(boosted_error > 50 * error);
        } else {
            assert_true(gm_distance(at_rest, boosted, 121) < 1e-12);
        }
    }
}

/* With k / h^2 fixed each halving of h divides the error by 4. */
static void order(void **unused)
{
    (void)unused;
    for (size_t s = 0; s < GM_COUNT(schemes); s++) {
        const struct heat_solution heat = {.start = HEAT_TWO, .diffusivity = 1, .age = 0.25};
        double u[MOST], error[3];
        for (int k = 0; k < 3; k++) {
            error[k] = run_to(schemes[s], &heat, 6, (60u << k) + 1, ldexp(0.01, -2 * k), 0.5, u);
        }
        for (int k = 0; k < 2; k++) {
            const double slope = log2(error[k] / error[k + 1]);
            if (!(fabs(slope - 2) < 0.05)) {
                fail_msg("%s: order %.3f", schemes[s], slope);
            }
        }
    }
}

/* A kernel is a projected constant. */
static void projections_solve_a_kernel_exactly(void **unused)
{
    (void)unused;
    const struct heat_solution heat = {.start = HEAT_KERNEL, .diffusivity = 1, .age = 0.25};
    double u[MOST];
    assert_true(run_to("heat-projections", &heat, 6, 121, 0.0025, 0.5, u) < 1e-14);
    assert_true(run_to("heat-boosts", &heat, 6, 121, 0.0025, 0.5, u) > 1e-4);
    assert_true(run_to("heat-ftcs", &heat, 6, 121, 0.0025, 0.5, u) > 1e-4);
}

/* The defects of a step under each group, kept or not, as the rows say. */
static void groups_are_kept_or_not(void **unused)
{
    (void)unused;
    static const struct gm_point_symmetry symmetries[] = {
        {.scale = 1.3}, {.boost = 0.5, .scale = 1}, {.projection = 0.5, .scale = 1}};
    const struct heat_solution heat = {.start = HEAT_TWO, .diffusivity = 1, .age = 0.25};
    struct framed framed;
    heat_open(&framed, &heat, (struct gm_grid1){.points = 81, .dx = 0.1, .first = -4});
    double u[81];
    for (size_t j = 0; j < 81; j++) {
        u[j] = heat_exact(&heat, true, gm_grid1_node(&framed.problem.line, j), 0.1);
    }
    for (size_t s = 0; s < GM_COUNT(schemes); s++) {
        const struct gm_scheme *scheme = gm_scheme_find(schemes[s]);
        for (size_t g = 0; g < GM_COUNT(symmetries); g++) {
            const double defect =
                gm_frames_of_heat.defect(&framed.problem, scheme, 0.0025, &symmetries[g], u);
            const bool kept = s >= g; /* scalings, boosts, projections */
            if (kept ? !(defect < 1e-13) : !(defect > 1e-6)) {
                fail_msg("%s, group %zu: defect %.2e", schemes[s], g, defect);
            }
        }
    }
    framed_close(&framed);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(symmetries_are_flows_of_their_generators),
        cmocka_unit_test(exact_solutions_solve),
        cmocka_unit_test(steps_are_made_in_the_moving_frame),
        cmocka_unit_test(profiles_do_not_depend_on_the_frame),
        cmocka_unit_test(order),
        cmocka_unit_test(projections_solve_a_kernel_exactly),
        cmocka_unit_test(groups_are_kept_or_not),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
