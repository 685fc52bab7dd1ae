/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Poisson systems: the nodes of bracket, energy and Casimirs make the field that runs use, and general
   schemes advance them; the midpoint rule keeps what is quadratic. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "core/count.h"
#include "core/formula/derivative.h"
#include "core/formula/equations.h"
#include "core/kind.h"
#include "core/ode/kernel/loops.h"
#include "core/ode/own/own.h"
#include "core/ode/problems/problems.h"
#include "core/run.h"
#include "core/schemes.h"

enum { MOST = 6 };

static const struct {
    const char *name, *text;
    bool quadratic; /* H and Casimirs are, so that the midpoint rule keeps them */
} systems[] = {
    {"rigid body",
     "parameter: I = 0.5\ncomponents: x y z\nbracket: x y = -z\nbracket: y z = -x\nbracket: z x = -y\n"
     "H: (x^2 + y^2/I + z^2/3)/2\ncasimir: C = x^2 + y^2 + z^2\nstart: x = 1, y = 0.25, z = -0.5\n",
     true},
    {"hunters", "components: x y\nbracket: x y = -x*y\nH: x - log(x) + y - 2*log(y)\nstart: x = 2, y = 2\n",
     false},
    {"hunters in a ring",
     "components: x y z\nbracket: x y = x*y\nbracket: y z = y*z\nbracket: z x = z*x\nH: x + y + z\n"
     "casimir: C = log(x) + log(y) + log(z)\nstart: x = 1, y = 2, z = 0.5\n",
     false},
    /* a top: angular momenta and the vertical in the body, so(3) with what it acts on */
    {"heavy top",
     "components: a b c u v w\nbracket: a b = -c\nbracket: b c = -a\nbracket: c a = -b\nbracket: a v = -w\n"
     "bracket: b u = w\nbracket: b w = -u\nbracket: c v = u\nbracket: c u = -v\nbracket: a w = v\n"
     "H: (a^2 + b^2 + 2*c^2)/2 + w\ncasimir: length = u^2 + v^2 + w^2\ncasimir: vertical = a*u + b*v + c*w\n"
     "start: a = 0.1, b = 0.2, c = 3, u = 0.6, v = 0, w = 0.8\n",
     true},
};
enum { SYSTEMS = GM_COUNT(systems) };

struct typed {
    struct gm_own_system system;
    struct gm_own_model model;
    struct gm_problem problem;
    double *start, *values;
    gm_node_id gradient[MOST + 8];
};

static void type(struct typed *typed, int which)
{
    struct gm_fault fault;
    bool marked[MOST + 8] = {0};
    struct gm_own_system *system = &typed->system;
    if (!gm_equations_open(system, systems[which].text, strlen(systems[which].text), NULL, 0, &fault)) {
        fail_msg("%s: %s", systems[which].name, fault.sentence);
    }
    typed->start = gm_equations_start(system, NULL);
    assert_true(gm_own_model_open(&typed->model, system));
    assert_true(gm_own_problem_open(&typed->problem, &typed->model, typed->start));
    for (size_t i = 0; i < system->n; i++) {
        marked[i] = true;
    }
    assert_true(system->jacobi == GM_ZERO_PROVED && system->n <= MOST);
    assert_true(gm_gradient(&system->graph, system->energy, marked, system->n, typed->gradient));
    typed->values = malloc(system->graph.count * sizeof *typed->values);
    assert_true(typed->start && typed->values);
}

static void untype(struct typed *typed)
{
    gm_own_problem_close(&typed->problem);
    gm_own_model_close(&typed->model);
    gm_system_close(&typed->system);
    free(typed->start);
    free(typed->values);
}

static void evaluate(struct typed *typed, const double *y)
{
    memcpy(typed->start, y, typed->system.n * sizeof *y);
    gm_formula_evaluate(&typed->system.graph, typed->system.graph.count, typed->start, typed->values);
}

static void nodes_make_the_field(void **unused)
{
    (void)unused;
    srand(7);
    for (int k = 0; k < SYSTEMS; k++) {
        struct typed typed;
        type(&typed, k);
        const struct gm_own_system *system = &typed.system;
        const size_t n = system->n;
        for (int trial = 0; trial < 20; trial++) {
            double y[MOST], f[MOST], size = 0;
            for (size_t i = 0; i < n; i++) {
                y[i] = .5 + (double)rand() / RAND_MAX;
            }
            evaluate(&typed, y);
            gm_field(&typed.problem, y, f, 1);
            for (size_t i = 0; i < n; i++) {
                size = fmax(size, fabs(f[i]));
            }
            for (size_t i = 0; i < n; i++) {
                double rate = 0;
                for (size_t j = 0; j < n; j++) {
                    const double entry = typed.values[system->bracket[i * n + j]];
                    assert_true(entry == -typed.values[system->bracket[j * n + i]]);
                    rate += entry * typed.values[typed.gradient[j]];
                }
                assert_true(fabs(rate - f[i]) <= 1e-14 * size);
            }
        }
        for (size_t i = 0; i < system->item_count; i++) {
            assert_true(system->items[i].word != GM_WORD_CASIMIR || system->items[i].check == GM_ZERO_PROVED);
        }
        untype(&typed);
    }
}

static void schemes_advance_them(void **unused)
{
    (void)unused;
    static const struct gm_settings settings = {.binding = 1};
    for (int k = 0; k < SYSTEMS; k++) {
        struct typed typed;
        type(&typed, k);
        const struct gm_own_system *system = &typed.system;
        double reference[MOST];
        int count = 0;
        for (size_t s = 0; s < gm_scheme_count(); s++) {
            /* the first that is run is the reference of the others */
            const struct gm_scheme *scheme = s == 0 ? gm_scheme_find("gauss8") : gm_scheme_at(s);
            if (scheme->family->kind != &gm_kind_ode || !gm_scheme_fits(scheme, &typed.problem)) {
                continue;
            }
            double *start = gm_equations_start(system, NULL);
            struct gm_run *run = gm_run_open(&typed.problem, scheme, &settings, 0, 0.01, start);
            assert_true(start && run);
            assert_int_equal(gm_run_advance(run, 1000), GM_OK);
            double distance = 0;
            for (size_t i = 0; i < system->n; i++) {
                reference[i] = s == 0 ? gm_run_state(run)[i] : reference[i];
                distance = fmax(distance, fabs(gm_run_state(run)[i] - reference[i]));
            }
            if (!(distance <= (scheme->order == 1 ? 2 : .02))) {
                fail_msg("%s, %s: %g from the reference", systems[k].name, scheme->name, distance);
            }
            const bool turns = scheme->needs & GM_NEEDS_ROTATIONS,
                       collocation =
                           strncmp(scheme->name, "energy-collocation", strlen("energy-collocation")) == 0;
            if (turns || collocation || (systems[k].quadratic && strcmp(scheme->name, "midpoint") == 0)) {
                evaluate(&typed, start);
                double before[MOST];
                for (size_t i = 0; i < system->item_count; i++) {
                    before[i] = typed.values[system->items[i].nodes[0]];
                }
                const double energy = typed.values[system->energy];
                evaluate(&typed, gm_run_state(run));
                assert_true(turns || fabs(typed.values[system->energy] - energy) <= 1e-12 * fabs(energy));
                for (size_t i = 0; i < system->item_count && (turns || systems[k].quadratic); i++) {
                    assert_true(fabs(typed.values[system->items[i].nodes[0]] - before[i]) <= 1e-12);
                }
            }
            gm_run_close(run);
            free(start);
            count++;
        }
        assert_true(count >= 15);
        untype(&typed);
    }
}

/* A million steps; and the bracket the other way round is the motion backwards. */
static void bodies_turn(void **unused)
{
    (void)unused;
    static const char *const schemes[] = {"rotations2", "spherical-midpoint2", "rkmk4", "crouch-grossman3",
                                          "crouch-grossman4"};
    static const struct gm_settings settings = {0};
    static const char backwards[] =
        "components: x y z\nbracket: x y = z\nbracket: y z = x\nbracket: z x = y\n"
        "H: (x^2/2 + y^2 + 1.5*z^2)/2\nstart: x = 0.9, y = 0.5, z = -0.7\n";
    struct gm_own_system system;
    struct gm_own_model model;
    struct gm_problem back;
    struct gm_fault fault;
    assert_true(gm_equations_open(&system, backwards, strlen(backwards), NULL, 0, &fault));
    double *start = gm_equations_start(&system, NULL);
    assert_true(start && gm_own_model_open(&model, &system) && gm_own_problem_open(&back, &model, start));
    const double casimir = start[0] * start[0] + start[1] * start[1] + start[2] * start[2];
    for (size_t i = 0; i < GM_COUNT(schemes); i++) {
        const struct gm_problem *forth = &gm_problem_rigid_body;
        const struct gm_scheme *scheme = gm_scheme_find(schemes[i]);
        assert_true(gm_scheme_fits(scheme, forth) && gm_scheme_fits(scheme, &back));
        struct gm_run *a = gm_run_open(forth, scheme, &settings, 0, 0.1, start);
        struct gm_run *b = gm_run_open(&back, scheme, &settings, 0, -0.1, start);
        assert_true(a && b);
        assert_int_equal(gm_run_advance(a, 100), GM_OK);
        assert_int_equal(gm_run_advance(b, 100), GM_OK);
        for (int c = 0; c < 3; c++) {
            assert_float_equal(gm_run_state(a)[c], gm_run_state(b)[c], 1e-13);
        }
        assert_int_equal(gm_run_advance(a, 1000000), GM_OK);
        const double *y = gm_run_state(a);
        const double moved = fabs(y[0] * y[0] + y[1] * y[1] + y[2] * y[2] - casimir);
        if (!(moved < 1e-11)) {
            fail_msg("%s: the Casimir moved by %.1e", schemes[i], moved);
        }
        gm_run_close(a);
        gm_run_close(b);
    }
    free(start);
    gm_own_problem_close(&back);
    gm_own_model_close(&model);
    gm_system_close(&system);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nodes_make_the_field),
        cmocka_unit_test(schemes_advance_them),
        cmocka_unit_test(bodies_turn),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
