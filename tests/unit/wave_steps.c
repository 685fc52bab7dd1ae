/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How large a step the schemes for waves take: the explicit schemes of nodes up to their limits, the boxes
   beyond what their iteration contracts for. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "core/basics.h"
#include "core/field/problems/problems.h"
#include "core/run.h"
#include "core/schemes.h"
#include "core/theory/certify.h"
#include "tests/common/dispersive_solitons.h"
#include "tests/common/sine_gordon.h"

enum { POINTS = 201 };

static const struct gm_settings no_settings;

/* The schemes of nodes against M D_t s + K D_x s - grad S of the facet, with all its variables: after a step
   every equation holds at every node. */
static void nodes_solve_the_whole_system(void **unused)
{
    (void)unused;
    static const char *const names[] = {"euler-box", "midpoint-box"};
    const double dt = 0.01;
    for (size_t s = 0; s < 2; s++) {
        const bool centred = s == 1;
        struct gm_problem problem = kdv_problem(POINTS);
        double y[2 * POINTS + 1], u[3][POINTS], phi[3][POINTS + 1] = {{0}}, v[POINTS], w[POINTS];
        kdv_levels(&problem, dt, y);
        memcpy(u[0], y, sizeof u[0]);
        memcpy(u[1], y + POINTS, sizeof u[1]);
        struct gm_run *run =
            gm_run_open(&problem, gm_scheme_find_for(names[s], &problem), &no_settings, 0, dt, y);
        assert_int_equal(gm_run_advance(run, 2), GM_OK);
        memcpy(u[2], gm_run_state(run), sizeof u[2]);
        gm_run_close(run);
        const double dx = problem.line.dx, wide = centred ? 2 * dx : dx, long_step = centred ? 2 * dt : dt;
        for (size_t n = 0; n < 3; n++) {
            for (size_t k = 0, at = 0; k + 1 < POINTS; k++) {
                const size_t next = (at + (centred ? 2 : 1)) % POINTS;
                phi[n][next] = phi[n][at] + wide * u[n][centred ? (at + 1) % POINTS : next];
                at = next;
            }
        }
        double rise = 0;
        for (size_t i = 0; i < POINTS; i++) {
            const size_t l = (i + POINTS - 1) % POINTS, r = (i + 1) % POINTS;
            v[i] = gm_kdv_of(&problem)->mu * (centred ? u[1][r] - u[1][l] : u[1][i] - u[1][l]) / wide;
        }
        for (size_t i = 0; i < POINTS; i++) {
            const size_t l = (i + POINTS - 1) % POINTS, r = (i + 1) % POINTS;
            const double fall = (phi[centred ? 2 : 1][i] - phi[0][i]) / (2 * long_step);
            w[i] = fall + (centred ? v[r] - v[l] : v[r] - v[i]) / wide + u[1][i] * u[1][i] / 2;
        }
        /* the exact levels differ in mass by 1e-9, by which phi and w do not close around the ring */
        for (size_t i = 0; i + 1 < POINTS; i++) {
            const size_t l = (i + POINTS - 1) % POINTS, r = i + 1;
            const double u_t = (u[2][i] - u[centred ? 0 : 1][i]) / long_step;
            rise = fmax(rise, fabs(u_t / 2 + (centred ? w[r] - w[l] : w[r] - w[i]) / wide));
        }
        if (!(rise < 1e-10)) {
            fail_msg("%s leaves %.2e of its first equation", names[s], rise);
        }
    }
}

/* What a row does not claim it does not keep: the Euler box of Schroedinger's equation is caught. */
static void nodes_do_not_claim_too_much(void **unused)
{
    (void)unused;
    static const unsigned bits[] = {1, 4}; /* symmetric, keeps quadratic invariants */
    const struct gm_problem nls = nls_problem(101);
    for (size_t i = 0; i < GM_COUNT(bits); i++) {
        struct gm_scheme wrong = *gm_scheme_find_for("euler-box", &nls);
        assert_true(gm_certify(&wrong).holds);
        wrong.claims |= 1u << bits[i];
        const struct gm_certificate certificate = gm_certify(&wrong);
        assert_false(certificate.holds);
        assert_true(certificate.order_holds && certificate.claims[bits[i]].defect > 1e-6);
    }
}

/* The linear limits of the schemes of nodes: just below them a run stays bounded, just above it does not. */
static void nodes_are_stable_below_their_limits(void **unused)
{
    (void)unused;
    const struct gm_problem kdv = kdv_problem(POINTS), nls = nls_problem(POINTS);
    const double dx = kdv.line.dx;
    const struct {
        const struct gm_problem *problem;
        const char *name;
        double limit;
    } cases[] = {
        {&kdv, "euler-box", dx * dx * dx / 4},
        {&kdv, "midpoint-box", dx * dx * dx},
        {&nls, "euler-box", dx * dx / 2},
    };
    static double y[2 * POINTS + 1];
    for (size_t c = 0; c < GM_COUNT(cases); c++) {
        for (int k = 0; k < 4; k++) {
            /* backwards as well */
            const double dt = (k % 2 ? 1.06 : 0.94) * cases[c].limit * (k < 2 ? 1 : -1);
            if (cases[c].problem == &kdv) {
                kdv_levels(&kdv, dt, y);
            } else {
                bright_state(&bright, &nls.line, 0, y);
            }
            struct gm_run *run =
                gm_run_open(cases[c].problem, gm_scheme_find_for(cases[c].name, cases[c].problem),
                            &no_settings, 0, dt, y);
            const bool stays = gm_run_until(run, copysign(10, dt)) == GM_OK;
            if (stays != (k % 2 == 0)) {
                fail_msg("%s, %s: dt = %g is %s", cases[c].problem->name, cases[c].name, dt,
                         gm_status_name(run->status));
            }
            gm_run_close(run);
        }
    }
}

/* The residual of the nine-point scheme between three levels. */
static double nine_points(const double *const u[3], double dx, double dt)
{
    double worst = 0;
    for (size_t i = 0; i < POINTS; i++) {
        const size_t l = (i + POINTS - 1) % POINTS, r = (i + 1) % POINTS;
        double means[3], bends[3], force = 0;
        for (size_t n = 0; n < 3; n++) {
            means[n] = (u[n][r] + 2 * u[n][i] + u[n][l]) / 4;
            bends[n] = u[n][r] - 2 * u[n][i] + u[n][l];
        }
        for (size_t n = 0; n < 2; n++) {
            force += sin((u[n][i] + u[n][r] + u[n + 1][i] + u[n + 1][r]) / 4) / 4;
            force += sin((u[n][i] + u[n][l] + u[n + 1][i] + u[n + 1][l]) / 4) / 4;
        }
        worst = fmax(worst, fabs((means[2] - 2 * means[1] + means[0]) / (dt * dt) -
                                 (bends[2] + 2 * bends[1] + bends[0]) / (4 * dx * dx) + force));
    }
    return worst;
}

/* Where the iteration no longer contracts, by dt^2/4, Newton's method goes on, and what it finds solves the
   equations. */
static void the_box_takes_large_steps(void **unused)
{
    (void)unused;
    static const struct gm_sine_gordon breather = {.initial = GM_BREATHER, .frequency = 0.5};
    static const double steps[] = {0.5, 1.25, 1.9, 2};
    for (size_t s = 0; s < GM_COUNT(steps); s++) {
        const double dt = steps[s];
        struct gm_problem problem = gm_problem_sine_gordon;
        problem.parameters = &breather;
        problem.line = (struct gm_grid1){POINTS, 40.0 / POINTS, -20, 0, false};
        problem.n = gm_wave_size(POINTS);
        double y[2 * POINTS + 1], levels[3][POINTS];
        gm_sine_gordon_levels(&problem, 0, dt, y);
        struct gm_run *run = gm_run_open(&problem, gm_scheme_find("box"), &no_settings, 0, dt, y);
        for (size_t n = 0; n < 3; n++) {
            assert_int_equal(gm_run_advance(run, n ? 1 : 7), GM_OK);
            memcpy(levels[n], gm_run_state(run), sizeof levels[n]);
        }
        gm_run_close(run);
        const double *const u[3] = {levels[0], levels[1], levels[2]};
        const double left = nine_points(u, problem.line.dx, dt);
        if (!(left < 1e-11)) {
            fail_msg("dt = %g leaves %.2e", dt, left);
        }
    }
}

/* Steps a hundred times those of the scenes: solved so well that mass and charge do not move. */
static void boxes_of_first_order_take_large_steps(void **unused)
{
    (void)unused;
    double y[2 * POINTS + 1];
    const struct gm_problem kdv = kdv_problem(POINTS), nls = nls_problem(POINTS);
    for (double dt = 1; dt <= 4; dt *= 2) {
        kdv_levels(&kdv, dt, y);
        const double mass = kdv_mass(&kdv, y);
        struct gm_run *run = gm_run_open(&kdv, gm_scheme_find_for("box", &kdv), &no_settings, 0, dt, y);
        assert_int_equal(gm_run_advance(run, 20), GM_OK);
        assert_true(fabs(kdv_mass(&kdv, gm_run_state(run)) - mass) < 1e-11 * mass);
        gm_run_close(run);
        bright_state(&bright, &nls.line, 0, y);
        const double charge = nls_charge(&nls, y);
        run = gm_run_open(&nls, gm_scheme_find_for("box", &nls), &no_settings, 0, dt, y);
        assert_int_equal(gm_run_advance(run, 20), GM_OK);
        assert_true(fabs(nls_charge(&nls, gm_run_state(run)) - charge) < 1e-12 * charge);
        gm_run_close(run);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nodes_solve_the_whole_system),
        cmocka_unit_test(nodes_do_not_claim_too_much),
        cmocka_unit_test(nodes_are_stable_below_their_limits),
        cmocka_unit_test(the_box_takes_large_steps),
        cmocka_unit_test(boxes_of_first_order_take_large_steps),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
