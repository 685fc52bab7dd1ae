/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Problems that the program brings, typed again as formulas: the same facets, the same numbers by every
   scheme, and the same bits where the operations are the same; and those of an ensemble for each of its
   members. Tapes that several threads ask for at once are one. */
#include <math.h>
#include <pthread.h>
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
#include "core/ode/user/lazy_tape.h"
#include "core/ode/user/problem.h"
#include "core/run.h"
#include "core/schemes.h"
#include "tests/common/typed.h"
#include "tests/problems/problems.h"

struct retyped {
    const struct gm_problem *problem;
    const char *text;
    double dt;
    bool same_bits; /* the operations are those of the kernel, one by one */
};

static const struct retyped retyped[] = {
    {&gm_problem_pendulum, "coordinates: q\nmomenta: p\nH: p^2/2 - cos(q)\nstart: q = 1, p = 0.5\n", 0.1,
     true},
    {&gm_problem_henon_heiles,
     "coordinates: q1 q2\nmomenta: p1 p2\nH: (p1^2 + p2^2)/2 + (q1^2 + q2^2)/2 + q1^2*q2 - q2^3/3\n"
     "start: q1 = 0.1, q2 = 0.2, p1 = 0.3, p2 = 0.1\n",
     0.1, false},
    {&gm_problem_kepler,
     "coordinates: q1 q2\nmomenta: p1 p2\nH: (p1^2 + p2^2)/2 - 1/sqrt(q1^2 + q2^2)\n"
     "start: q1 = 0.5, q2 = 0, p1 = 0, p2 = sqrt(3)\n",
     0.02, false},
    {&gm_problem_kepler_perturbed,
     "coordinates: q1 q2\nmomenta: p1 p2\nparameter: e = 0.01\n"
     "H: (p1^2 + p2^2)/2 - 1/sqrt(q1^2 + q2^2) - e/(q1^2 + q2^2)\n"
     "start: q1 = 0.5, q2 = 0, p1 = 0, p2 = sqrt(3)\n",
     0.02, false},
    {&gm_problem_spring_pendulum,
     "coordinates: q1 q2\nmomenta: p1 p2\nparameter: e = 0.01\n"
     "H: (p1^2 + p2^2 + e*(sqrt(q1^2 + q2^2) - 1)^2)/2 + q2\n"
     "start: q1 = 0.8, q2 = 0, p1 = 0, p2 = 0\n",
     0.05, false},
    {&gm_problem_abc,
     "components: x y z\nrate: x = A*sin(z) + C*cos(y)\nrate: y = B*sin(x) + A*cos(z)\n"
     "rate: z = C*sin(y) + B*cos(x)\nparameter: A = 0.01\nparameter: B = 0.4\nparameter: C = 0.5\n"
     "start: x = 1, y = 2, z = 3\n",
     0.1, true},
    {&gm_problem_rigid_body,
     "components: x y z\nbracket: x y = -z\nbracket: y z = -x\nbracket: z x = -y\n"
     "H: x^2/4 + y^2/2 + 3*z^2/4\nstart: x = 1, y = 0.2, z = 0.3\n",
     0.1, false},
    {&gm_problem_product, "coordinates: q\nmomenta: p\nH: (1 + q^2)*(1 + p^2)/2\nstart: q = 0.5, p = 0\n",
     0.05, false},
    {&gm_problem_fpu_1,
     "coordinates: q1 q2\nmomenta: p1 p2\nparameter: w = 0.01\n"
     "H: (p1^2 + p2^2)/2 + w^2*q2^2/2 + ((q1 - q2)^4 + (q1 + q2)^4)/4\n"
     "start: q1 = 0.5, q2 = 0.25, p1 = 1, p2 = 0.5\n",
     0.05, false},
};

enum { RETYPED = GM_COUNT(retyped), MOST = 4 };

static const double constants[] = {0.01, 0.4, 0.5};
static const struct gm_settings settings_of[2] = {{.compensated = 0, .binding = 20, .tau0 = 0.01},
                                                  {.compensated = 1, .binding = 20, .tau0 = 0.01}};

static struct gm_problem built_in(int i)
{
    struct gm_problem problem = *retyped[i].problem;
    problem.parameters =
        retyped[i].problem == &gm_problem_kepler ? NULL : constants; /* without a perturbation */
    return problem;
}

static void facets_are_found(void **state)
{
    (void)state;
    for (int i = 0; i < RETYPED; i++) {
        struct typed typed;
        type(&typed, retyped[i].text);
        const struct gm_problem theirs = built_in(i);
        const unsigned mine = gm_kind_ode.facets(&typed.problem);
        const unsigned wanted = gm_kind_ode.facets(&theirs) & ~(unsigned)GM_NEEDS_MONITOR; /* none is typed */
        if ((mine & wanted) != wanted) {
            fail_msg("%s: facets %#x, wanted %#x", theirs.name, mine, wanted);
        }
        untype(&typed);
    }
}

/* Not where round-off is magnified: by an instability, by quotients of differences, by choices of order, or in a
   step tau that is to keep an energy, on which that depends as tau/4 f' H'' f: 200 times at tau = .02. */
static bool is_compared(const struct gm_scheme *scheme)
{
    static const char *const not [] = {"explicit-euler", "discrete-gradient2", "gsl-msadams", "gsl-msbdf",
                                       "symplectic-energy-momentum2"};
    for (size_t i = 0; i < GM_COUNT(not ); i++) {
        if (strcmp(scheme->name, not [i]) == 0) {
            return false;
        }
    }
    return scheme->family->kind == &gm_kind_ode;
}

static void schemes_agree(void **state)
{
    (void)state;
    int compared = 0;
    for (int i = 0; i < RETYPED; i++) {
        struct typed typed;
        type(&typed, retyped[i].text);
        const struct gm_problem theirs = built_in(i);
        for (size_t k = 0; k < 2 * gm_scheme_count(); k++) {
            const struct gm_scheme *scheme = gm_scheme_at(k / 2);
            if (!is_compared(scheme) || !gm_scheme_fits(scheme, &theirs) ||
                !gm_scheme_fits(scheme, &typed.problem)) {
                continue;
            }
            const bool compensated = k % 2 == 1 && scheme->family->parameters == gm_settings_of_sums;
            struct gm_run *a =
                gm_run_open(&typed.problem, scheme, &settings_of[compensated], 0, retyped[i].dt, typed.start);
            struct gm_run *b =
                gm_run_open(&theirs, scheme, &settings_of[compensated], 0, retyped[i].dt, typed.start);
            assert_non_null(a);
            assert_non_null(b);
            /* in two calls, the second of which goes on */
            gm_run_advance(a, 333);
            gm_run_advance(a, 667);
            gm_run_advance(b, 1000);
            double size = 1, distance = 0;
            for (size_t c = 0; c < theirs.n; c++) {
                size = fmax(size, fabs(gm_run_state(b)[c]));
                distance = fmax(distance, fabs(gm_run_state(a)[c] - gm_run_state(b)[c]));
            }
            const double most = retyped[i].same_bits ? 0 : compensated ? 1e-13 : 1e-12;
            if (a->status != b->status || a->steps != b->steps || !(distance <= most * size)) {
                fail_msg("%s on %s: %s after %ld steps, %s after %ld, %g apart", scheme->name, theirs.name,
                         gm_status_name(a->status), a->steps, gm_status_name(b->status), b->steps, distance);
            }
            if (retyped[i].same_bits) {
                assert_int_equal(a->evaluations, b->evaluations);
                assert_int_equal(a->iterations, b->iterations);
                assert_int_equal(a->solves, b->solves);
            }
            compared++;
            gm_run_close(a);
            gm_run_close(b);
        }
        untype(&typed);
    }
    assert_true(compared > 400);
}

/* An ensemble that fills no whole number of tiles: each member as if it were alone. */
static void members_are_alone(void **state)
{
    (void)state;
    enum { MEMBERS = 141, STEPS = 7 };
    for (int i = 0; i < RETYPED; i++) {
        struct typed typed;
        type(&typed, retyped[i].text);
        struct gm_problem many = typed.problem;
        many.m = MEMBERS;
        for (size_t k = 0; k < 2 * gm_scheme_count(); k++) {
            const struct gm_scheme *scheme = gm_scheme_at(k / 2);
            const struct gm_settings *settings = &settings_of[k % 2];
            if (scheme->family->kind != &gm_kind_ode || scheme->family->adaptive ||
                !gm_scheme_fits(scheme, &typed.problem)) {
                continue;
            }
            double start[MOST * MEMBERS];
            for (size_t c = 0; c < many.n; c++) {
                for (size_t l = 0; l < MEMBERS; l++) {
                    start[c * MEMBERS + l] = typed.start[c] + 0.001 * (double)l;
                }
            }
            struct gm_run *all = gm_run_open(&many, scheme, settings, 0, retyped[i].dt, start);
            assert_non_null(all);
            assert_int_equal(gm_run_advance(all, STEPS), GM_OK);
            for (size_t l = 0; l < MEMBERS; l += 10) {
                double one[MOST];
                for (size_t c = 0; c < many.n; c++) {
                    one[c] = start[c * MEMBERS + l];
                }
                struct gm_run *run = gm_run_open(&typed.problem, scheme, settings, 0, retyped[i].dt, one);
                assert_non_null(run);
                gm_run_advance(run, STEPS);
                for (size_t c = 0; c < many.n; c++) {
                    if (gm_run_state(run)[c] != gm_run_state(all)[c * MEMBERS + l]) {
                        fail_msg("%s on %s: member %zu of an ensemble differs", scheme->name,
                                 retyped[i].problem->name, l);
                    }
                }
                gm_run_close(run);
            }
            gm_run_close(all);
        }
        untype(&typed);
    }
}

/* Who asks for a tape, when all are there. */
struct asking {
    struct gm_late_tape *late;
    pthread_barrier_t *all;
    const struct gm_tape *tape;
    double value;
};

static void *ask(void *data)
{
    struct asking *asking = data;
    const double at[] = {3, 4};
    pthread_barrier_wait(asking->all);
    asking->tape = gm_late_tape(asking->late);
    gm_late_tape_values(asking->late, at, &asking->value, 1);
    return NULL;
}

static void threads_share_a_late_tape(void **state)
{
    (void)state;
    enum { THREADS = 4, ROUNDS = 200 };
    struct gm_formula graph;
    gm_formula_open(&graph);
    const gm_node_id x = gm_formula_variable(&graph, 0), y = gm_formula_variable(&graph, 1),
                     node = gm_formula_apply(
                         &graph, GM_OPERATION_SQRT,
                         gm_formula_apply(&graph, GM_OPERATION_ADD,
                                          gm_formula_apply(&graph, GM_OPERATION_MULTIPLY, x, x),
                                          gm_formula_apply(&graph, GM_OPERATION_MULTIPLY, y, y)),
                         0);
    pthread_barrier_t all;
    assert_int_equal(pthread_barrier_init(&all, NULL, THREADS), 0);
    for (int round = 0; round < ROUNDS; round++) {
        struct gm_late_tape late = {.graph = &graph, .nodes = &node, .count = 1, .inputs = 2};
        struct asking asking[THREADS];
        pthread_t threads[THREADS];
        for (int i = 0; i < THREADS; i++) {
            asking[i] = (struct asking){.late = &late, .all = &all};
            assert_int_equal(pthread_create(&threads[i], NULL, ask, &asking[i]), 0);
        }
        for (int i = 0; i < THREADS; i++) {
            assert_int_equal(pthread_join(threads[i], NULL), 0);
            assert_non_null(asking[i].tape);
            assert_ptr_equal(asking[i].tape, asking[0].tape);
            assert_true(asking[i].value == 5);
        }
        gm_late_tape_close(&late);
    }
    pthread_barrier_destroy(&all);
    gm_formula_close(&graph);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(facets_are_found),
        cmocka_unit_test(schemes_agree),
        cmocka_unit_test(members_are_alone),
        cmocka_unit_test(threads_share_a_late_tape),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
