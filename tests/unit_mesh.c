/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The r-adaptive schemes against an independent implementation's values of every node. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "core/problems/soliton.h"
#include "core/run.h"
#include "tests/reference_soliton.h"

static const struct gm_settings settings = {0};

static struct gm_run *open_soliton(const struct gm_soliton *soliton, struct gm_problem *problem, const char *name,
                                   double dt)
{
    gm_soliton_problem(soliton, problem);
    const struct gm_scheme *scheme = gm_scheme_find(name);
    assert_non_null(scheme);
    struct gm_mesh mesh;
    problem->moving_mesh->describe(problem, &mesh);
    double *state = malloc(problem->n * sizeof *state);
    assert_non_null(state);
    assert_true(gm_mesh_start(&mesh, gm_scheme_mesh(scheme), gm_soliton_profile, soliton, state));
    struct gm_run *run = gm_run_open(problem, scheme, &settings, 0, dt, state);
    free(state);
    assert_non_null(run);
    assert_int_equal(run->status, GM_OK);
    return run;
}

static const struct gm_soliton reference = {.solitons = 1, .points = 15, .velocity = 0.9, .length = 25, .alpha = 2.5};

static void every_node_of_the_reference(void **unused)
{
    (void)unused;
    for (size_t i = 0; i < sizeof reference_soliton / sizeof reference_soliton[0]; i++) {
        struct gm_problem problem;
        struct gm_run *run = open_soliton(&reference, &problem, reference_soliton[i].scheme, 0.01);
        struct gm_mesh mesh;
        problem.moving_mesh->describe(&problem, &mesh);
        assert_true(fabs(gm_mesh_energy(&mesh, gm_run_state(run)) - reference_soliton[i].energy) < 1e-11);
        for (size_t s = 0; s < 3; s++) {
            const long steps = lround(reference_soliton[i].snap[s].t / 0.01);
            gm_run_advance(run, steps - run->steps);
            assert_int_equal(run->status, GM_OK);
            double farthest = 0;
            for (size_t k = 0; k < 15; k++) {
                farthest = fmax(farthest, fabs(gm_run_state(run)[k] - reference_soliton[i].snap[s].y[k + 1]));
                farthest = fmax(farthest, fabs(gm_run_state(run)[15 + k] - reference_soliton[i].snap[s].x[k + 1]));
            }
            if (getenv("SHOW")) printf("%s %g %.2e  (%.2e) it %.2f fact %g\n", reference_soliton[i].scheme, reference_soliton[i].snap[s].t, farthest, reference_soliton[i].snap[s].spread, (double)run->evaluations/(double)run->steps, gm_mesh_factorisations(run));
            if (!(farthest < fmax(1e-9, 10 * reference_soliton[i].snap[s].spread))) {
                fail_msg("%s at t = %g: %.3g", reference_soliton[i].scheme, reference_soliton[i].snap[s].t, farthest);
            }
        }
        gm_run_close(run);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_node_of_the_reference),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
