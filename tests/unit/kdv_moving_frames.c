/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The Korteweg-de Vries equation from moving frames: its symmetries against the equation, the invariant schemes
   against the moving frames that they are made of, and runs from several frames. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "core/basics.h"
#include "core/field/families/frames.h"
#include "core/run.h"
#include "core/schemes.h"
#include "tests/common/kdv_solutions.h"

static const struct gm_settings no_settings;
static const char *const schemes[] = {"zabusky-kruskal-invariant", "evolution-projection"};

enum { POINTS = 160 };
static const double half_length = 16;

static struct gm_problem ring(const struct kdv_solution *kdv, double scale)
{
    struct gm_problem problem = gm_problem_kdv;
    problem.parameters = kdv;
    problem.line = (struct gm_grid1){
        .points = POINTS, .dx = scale * 2 * half_length / POINTS, .first = -scale * half_length};
    problem.n = gm_wave_size(POINTS);
    return problem;
}

/* The field after a time, less what the frame adds to it; the status of the run. */
static enum gm_status after(const struct gm_problem *problem, const char *scheme, double dt, double until,
                            double *u)
{
    const struct gm_kdv *kdv = gm_kdv_of(problem);
    double y[2 * POINTS + 1];
    kdv_levels(problem, dt, y);
    struct gm_run *run = gm_run_open(problem, gm_scheme_find(scheme), &no_settings, 0, dt, y);
    assert_non_null(run);
    const enum gm_status status = gm_run_until(run, until);
    for (size_t j = 0; j < POINTS; j++) {
        u[j] = gm_run_state(run)[j] - kdv->framed.lambda / kdv->eta;
    }
    gm_run_close(run);
    return status;
}

/* Boosts of the frames of all nodes. */
static void find_boosts(const struct gm_problem *problem, const struct gm_scheme *scheme, double dt,
                        const double *y, double *boosts)
{
    struct gm_point_symmetry frame;
    for (size_t j = 0; j < POINTS; j++) {
        assert_true(gm_frames_of_kdv.find(problem, scheme, dt, y, j, &frame));
        boosts[j] = frame.boost;
    }
}

/* Exact solutions are solutions in every frame, and carried ones are. */
static void symmetries_are_those_of_the_equation(void **unused)
{
    (void)unused;
    const struct kdv_solution kdv = {.initial = KDV_SOLITON,
                                     .kdv.eta = 1.5,
                                     .kdv.mu = 0.7,
                                     .velocity = 0.8,
                                     .position = -1,
                                     .kdv.framed.lambda = 0.6};
    const struct gm_problem problem = ring(&kdv, 1);
    const double h = 0.02, x = 1.3, t = 0.9;
    double value[7], rate = 0;
    for (int k = -3; k <= 3; k++) {
        value[k + 3] = kdv_exact(&kdv, &problem.line, x + k * h, t);
        rate += (k == 1 || k == -1   ? 3. / 4
                 : k == 2 || k == -2 ? -3. / 20
                                     : 1. / 60) *
                (k > 0   ? 1
                 : k < 0 ? -1
                         : 0) *
                kdv_exact(&kdv, &problem.line, x, t + k * h);
    }
    const double slope = (45 * (value[4] - value[2]) - 9 * (value[5] - value[1]) + value[6] - value[0]) / 60;
    const double third =
        (-13 * (value[4] - value[2]) + 8 * (value[5] - value[1]) - (value[6] - value[0])) / 8;
    assert_true(fabs(rate / h + kdv.kdv.eta * value[3] * slope / h + kdv.kdv.mu * third / (h * h * h)) <
                2e-5);
    /* a soliton of velocity c is carried to one of c + b, or of c/s^2 */
    const struct gm_point_symmetry symmetry = {.boost = 0.4, .scale = 1.3};
    const struct gm_event event = {.t = t, .x = x, .u = value[3]};
    const struct gm_event carried = gm_frames_of_kdv.carry(&kdv.kdv.framed, &symmetry, event);
    const double s = symmetry.scale;
    struct kdv_solution other = kdv;
    other.velocity = kdv.velocity / (s * s);
    other.position = s * kdv.position;
    other.kdv.framed.lambda = (kdv.kdv.framed.lambda + symmetry.boost) / (s * s);
    const struct gm_problem wide = ring(&other, s);
    assert_true(fabs(carried.u - kdv_exact(&other, &wide.line, carried.x, carried.t)) < 1e-13);
}

/* Each node's step in its own frame: the levels are carried there, the scheme of the equation without
   convection is made along the node's way, and the result is carried back. */
static void leapfrog_is_made_in_its_frames(void **unused)
{
    (void)unused;
    const struct kdv_solution kdv = {.initial = KDV_TWO,
                                     .kdv.eta = 1.3,
                                     .kdv.mu = 0.6,
                                     .kdv.framed.lambda = 0.7,
                                     .kdv.framed.frame = GM_FRAME_MOVING};
    const struct gm_problem problem = ring(&kdv, 1);
    const double dt = 0.002, h = problem.line.dx;
    double y[2 * POINTS + 1];
    for (size_t j = 0; j < POINTS; j++) {
        y[j] = 0.5 + sin(M_PI * gm_grid1_node(&problem.line, j) / half_length) + 0.3 * cos(5. * (double)j);
        y[POINTS + j] = y[j];
    }
    y[2 * POINTS] = dt / 3; /* of no use: the first step is its own */
    struct gm_run *run =
        gm_run_open(&problem, gm_scheme_find("zabusky-kruskal-invariant"), &no_settings, 0, dt, y);
    assert_int_equal(gm_run_advance(run, 3), GM_OK);
    memcpy(y, gm_run_state(run), sizeof y);
    double boosts[POINTS];
    find_boosts(&problem, run->scheme, dt, y, boosts);
    assert_int_equal(gm_run_advance(run, 1), GM_OK);
    for (size_t j = 0; j < POINTS; j++) {
        double u[5];
        const struct gm_point_symmetry frame = {.boost = boosts[j], .scale = 1},
                                       back = {.boost = -boosts[j], .scale = 1};
        for (size_t i = 0; i < 5; i++) {
            const struct gm_event event = {.x = ((double)i - 2) * h, .u = y[(j + i + POINTS - 2) % POINTS]};
            u[i] = gm_frames_of_kdv.carry(&kdv.kdv.framed, &frame, event).u;
        }
        assert_true(fabs(u[1] + u[2] + u[3]) < 1e-14); /* the cross-section */
        const struct gm_event past = gm_frames_of_kdv.carry(
            &kdv.kdv.framed, &frame,
            (struct gm_event){.t = -dt, .x = -kdv.kdv.framed.lambda * dt, .u = y[POINTS + j]});
        /* du/dt along the way from -x to x is u_t + (x/dt) u_x */
        const double along = -past.x / dt * (u[3] - u[1]) / (2 * h);
        const double dispersion = kdv.kdv.mu * (u[4] - 2 * u[3] + 2 * u[1] - u[0]) / (2 * h * h * h);
        const struct gm_event next = {.t = dt, .x = -past.x, .u = past.u + 2 * dt * (along - dispersion)};
        const struct gm_event arrived = gm_frames_of_kdv.carry(&kdv.kdv.framed, &back, next);
        assert_true(fabs(arrived.x - kdv.kdv.framed.lambda * dt) < 1e-15);
        assert_true(fabs(arrived.u - gm_run_state(run)[j]) < 1e-13);
    }
    gm_run_close(run);
}

/* The polynomial through six values at 0 .. 5, by Neville's scheme. */
static double neville(const double values[6], double at)
{
    double table[6];
    memcpy(table, values, sizeof table);
    for (int width = 1; width < 6; width++) {
        for (int i = 0; i + width < 6; i++) {
            table[i] = ((at - i - width) * table[i] - (at - i) * table[i + 1]) / -width;
        }
    }
    return table[0];
}

/* The equations of evolution and projection, by other formulas, hold after a step. */
static void projections_solve_their_equations(void **unused)
{
    (void)unused;
    const struct kdv_solution kdv = {.initial = KDV_SOLITON,
                                     .kdv.eta = 1.3,
                                     .kdv.mu = 0.6,
                                     .kdv.framed.lambda = -0.9,
                                     .kdv.framed.frame = GM_FRAME_MOVING};
    const struct gm_problem problem = ring(&kdv, 1);
    const double dt = 0.3, h = problem.line.dx, half = kdv.kdv.mu * dt / 2;
    double y[2 * POINTS + 1], boosts[POINTS], rest[POINTS];
    for (size_t j = 0; j < POINTS; j++) {
        y[j] = 0.5 + sin(M_PI * gm_grid1_node(&problem.line, j) / half_length);
        y[POINTS + j] = y[j];
    }
    y[2 * POINTS] = dt;
    struct gm_run *run =
        gm_run_open(&problem, gm_scheme_find("evolution-projection"), &no_settings, 0, dt, y);
    find_boosts(&problem, run->scheme, dt, y, boosts);
    assert_int_equal(gm_run_advance(run, 1), GM_OK);
    const double *v = gm_run_state(run);
    for (size_t pass = 0; pass < 2; pass++) {
        for (size_t j = 0; j < POINTS; j++) {
            const double *f = pass == 0 ? y : v;
            const double third = (f[(j + 2) % POINTS] - 2 * f[(j + 1) % POINTS] +
                                  2 * f[(j + POINTS - 1) % POINTS] - f[(j + POINTS - 2) % POINTS]) /
                                 (2 * h * h * h);
            if (pass == 0) {
                rest[j] = f[j] - half * third;
                continue;
            }
            /* the frame's boost is -eta w, and where the node arrives in it, it left */
            const double left = (double)j + (kdv.kdv.framed.lambda + boosts[j]) * dt / h;
            const double below = floor(left) - 2;
            double there[6], value[6];
            for (int i = 0; i < 6; i++) {
                const size_t at = (size_t)((long)below + i + 2 * POINTS) % POINTS;
                there[i] = rest[at];
                value[i] = y[at];
            }
            assert_true(fabs(v[j] + half * third - neville(there, left - below)) < 1e-12);
            assert_true(fabs(-boosts[j] / kdv.kdv.eta - (neville(value, left - below) + v[j]) / 2) < 1e-12);
        }
    }
    gm_run_close(run);
}

/* From whichever frame a run is seen it is the same, and larger by whatever factor; that of the ordinary scheme
   is not. */
static void runs_do_not_depend_on_the_frame(void **unused)
{
    (void)unused;
    for (size_t s = 0; s < GM_COUNT(schemes); s++) {
        const double dt = s == 0 ? 0.002 : 0.05;
        struct kdv_solution kdv = {
            .initial = KDV_SOLITON, .kdv.eta = 1.5, .kdv.mu = 0.7, .velocity = 0.8, .position = -2};
        struct gm_problem problem = ring(&kdv, 1);
        double rest[POINTS], moving[POINTS];
        assert_int_equal(after(&problem, schemes[s], dt, 4, rest), GM_OK);
        double error = 0;
        for (size_t j = 0; j < POINTS; j++) {
            error = fmax(error,
                         fabs(rest[j] - kdv_exact(&kdv, &problem.line, gm_grid1_node(&problem.line, j), 4)));
        }
        assert_true(error < 0.05);
        static const double velocities[] = {-3, 0.7, 5};
        for (size_t i = 0; i < GM_COUNT(velocities); i++) {
            kdv.kdv.framed.lambda = velocities[i];
            assert_int_equal(after(&problem, schemes[s], dt, 4, moving), GM_OK);
            for (size_t j = 0; j < POINTS; j++) {
                assert_true(fabs(moving[j] - rest[j]) < 1e-12);
            }
        }
        const double scale = 1.3;
        struct kdv_solution wide = kdv;
        wide.kdv.framed.lambda = 0;
        wide.velocity /= scale * scale;
        wide.position *= scale;
        const struct gm_problem scaled = ring(&wide, scale);
        const double cube = scale * scale * scale;
        assert_int_equal(after(&scaled, schemes[s], cube * dt, cube * 4, moving), GM_OK);
        for (size_t j = 0; j < POINTS; j++) {
            assert_true(fabs(scale * scale * moving[j] - rest[j]) < 1e-12);
        }
    }
    /* on nodes at rest, over which the frame travels by 40 */
    struct kdv_solution kdv = {
        .initial = KDV_SOLITON, .kdv.eta = 1.5, .kdv.mu = 0.7, .velocity = 0.8, .position = -2};
    struct gm_problem problem = ring(&kdv, 1);
    double rest[POINTS], moving[POINTS], apart = 0;
    assert_int_equal(after(&problem, "zabusky-kruskal", 0.002, 4, rest), GM_OK);
    kdv.kdv.framed.lambda = 2;
    assert_int_equal(after(&problem, "zabusky-kruskal", 0.002, 4, moving), GM_OK);
    for (size_t j = 0; j < POINTS; j++) {
        apart = fmax(apart, fabs(moving[(j + 40) % POINTS] - rest[j]));
    }
    assert_true(apart > 1e-2 && apart < 1);
}

/* Neighbours that would meet in a step: no step is made up. */
static void meeting_neighbours_are_a_failure(void **unused)
{
    (void)unused;
    const struct kdv_solution kdv = {.initial = KDV_SOLITON, .kdv.eta = 1, .kdv.mu = 1, .velocity = 4};
    const struct gm_problem problem = ring(&kdv, 1);
    double u[POINTS];
    assert_int_equal(after(&problem, "evolution-projection", 2, 8, u), GM_NO_CONVERGENCE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(symmetries_are_those_of_the_equation),
        cmocka_unit_test(leapfrog_is_made_in_its_frames),
        cmocka_unit_test(projections_solve_their_equations),
        cmocka_unit_test(runs_do_not_depend_on_the_frame),
        cmocka_unit_test(meeting_neighbours_are_a_failure),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
