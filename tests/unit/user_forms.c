/* SPDX-License-Identifier: GPL-3.0-or-later */
/* K z_t + L z_x = grad S(z) as somebody wrote it: typed again, sine-Gordon, Korteweg-de Vries and Schroedinger give the
   states of their own boxes, where all but the field is eliminated; the discrete multisymplectic law holds for what is
   skew and not for what is not; local laws err as they ought to; and what is refused. */
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
#include "core/field/families/boxes/any_form.h"
#include "core/field/families/laws/laws.h"
#include "core/field/multisymplectic.h"
#include "core/field/problems/problems.h"
#include "core/field/user/form.h"
#include "core/model/equations.h"
#include "core/run.h"
#include "core/schemes.h"
#include "core/theory/certify.h"
#include "tests/common/kdv_solutions.h"

static const struct gm_settings no_settings;
static const char *const boxes[] = {"box", "gauss-box3", "gauss-box4"};

#define WAVE                                                                                                 \
    "components: u v w\n"                                                                                    \
    "K-matrix: 0, -1, 0 | 1, 0, 0 | 0, 0, 0\n"                                                               \
    "L-matrix: 0, 0, 1 | 0, 0, 0 | -1, 0, 0\n"
#define SINE_GORDON WAVE "S: 1 - cos(u) + v^2/2 - w^2/2\n"
#define BREATHER SINE_GORDON "let: g = sqrt(1 - 1/4)\nstart: u = 0, v = 4*g/cosh(g*x), w = 0\n"
#define KINK                                                                                                 \
    SINE_GORDON "let: y = exp(x/sqrt(1 - 1/4))\n"                                                            \
                "start: u = 4*atan(y), v = -2*y/(1 + y^2)/sqrt(1 - 1/4), w = 4*y/(1 + y^2)/sqrt(1 - 1/4)\n"  \
                "jump: u = 2*pi\n"
#define KDV                                                                                                  \
    "components: phi u v w\n"                                                                                \
    "K-matrix: 0, 1/2, 0, 0 | -1/2, 0, 0, 0 | 0, 0, 0, 0 | 0, 0, 0, 0\n"                                     \
    "L-matrix: 0, 0, 0, 1 | 0, 0, -1, 0 | 0, 1, 0, 0 | -1, 0, 0, 0\n"                                        \
    "S: v^2/2 - u*w + u^3/6\n"                                                                               \
    "let: hill = 3/cosh((x + 5)/2)^2\n"                                                                      \
    "start: phi = 0, u = hill, v = -hill*tanh((x + 5)/2), w = hill/2\n"
#define SCHROEDINGER                                                                                         \
    "components: p q v w\n"                                                                                  \
    "K-matrix: 0, 1, 0, 0 | -1, 0, 0, 0 | 0, 0, 0, 0 | 0, 0, 0, 0\n"                                         \
    "L-matrix: 0, 0, -1, 0 | 0, 0, 0, -1 | 1, 0, 0, 0 | 0, 1, 0, 0\n"                                        \
    "S: (p^2 + q^2)^2/4 + (v^2 + w^2)/2\n"                                                                   \
    "start: p = sqrt(2)/cosh(x)*cos(x/2), q = sqrt(2)/cosh(x)*sin(x/2), v = 0, w = 0\n"
#define DIRAC                                                                                                \
    "components: a b c d\n"                                                                                  \
    "K-matrix: 0, -1, 0, 0 | 1, 0, 0, 0 | 0, 0, 0, -1 | 0, 0, 1, 0\n"                                        \
    "L-matrix: 0, 0, 0, -1 | 0, 0, 1, 0 | 0, -1, 0, 0 | 1, 0, 0, 0\n"                                        \
    "let: N = a^2 + b^2 - c^2 - d^2\n"                                                                       \
    "S: N/2 - N^2/4\n"                                                                                       \
    "let: k = sqrt(1 - 0.75^2)\n"                                                                            \
    "let: h = 1 + 0.75*cosh(2*k*x)\n"                                                                        \
    "start: a = sqrt(3.5)*k*cosh(k*x)/h, b = 0, c = 0, d = sqrt(0.5)*k*sinh(k*x)/h\n"

struct typed {
    struct gm_user_system system;
    struct gm_user_form form;
    struct gm_problem problem;
    double *y; /* the start */
};

static void open_typed(struct typed *typed, const char *text, size_t points, double length)
{
    struct gm_fault fault;
    if (!gm_equations_open(&typed->system, text, strlen(text), NULL, 0, &fault)) {
        fail_msg("%s: %s", text, fault.sentence);
    }
    assert_true(gm_user_form_derive(&typed->form, &typed->system));
    double *values = gm_equations_start(&typed->system, NULL);
    const struct gm_grid1 line = {points, length / (double)points, -length / 2, 0, false};
    assert_true(gm_user_form_open(&typed->problem, &typed->form, values, &line));
    if (!gm_user_form_closes(&typed->problem, &fault)) {
        fail_msg("%s: %s", text, fault.sentence);
    }
    free(values);
    typed->y = malloc(typed->problem.n * sizeof *typed->y);
    gm_user_form_start(&typed->problem, typed->y);
}

static void close_typed(struct typed *typed)
{
    free(typed->y);
    gm_user_line_close(&typed->problem);
    gm_system_close(&typed->system);
}

static struct gm_run *run_of(const struct gm_problem *problem, const char *name, double dt, const double *y)
{
    struct gm_run *run = gm_run_open(problem, gm_scheme_find_for(name, problem), &no_settings, 0, dt, y);
    assert_non_null(run);
    return run;
}

static double distance(const double *a, const double *b, size_t count)
{
    double largest = 0;
    for (size_t i = 0; i < count; i++) {
        largest = fmax(largest, fabs(a[i] - b[i]));
    }
    return largest;
}

enum { POINTS = 201, STEPS = 60 };

/* Both runs, from one level or from the two that the typed one has made. */
static void agree(struct typed *typed, const struct gm_problem *built_in, size_t component, size_t fields,
                  double dt, bool two_levels)
{
    double *y = calloc(built_in->n, sizeof *y);
    const double *field = typed->y + component * POINTS;
    struct gm_run *ours = run_of(&typed->problem, "box", dt, typed->y);
    memcpy(y, field, fields * POINTS * sizeof *y);
    if (two_levels) {
        assert_int_equal(gm_run_advance(ours, 1), GM_OK);
        memcpy(y, gm_run_state(ours) + component * POINTS, POINTS * sizeof *y);
        memcpy(y + POINTS, field, POINTS * sizeof *y);
    }
    if (fields == 1) {
        y[2 * POINTS] = -dt;
    }
    struct gm_run *theirs = run_of(built_in, "box", dt, y);
    assert_int_equal(gm_run_advance(ours, STEPS), GM_OK);
    assert_int_equal(gm_run_advance(theirs, STEPS), GM_OK);
    const double apart =
        distance(gm_run_state(ours) + component * POINTS, gm_run_state(theirs), fields * POINTS);
    const double moved = distance(gm_run_state(ours) + component * POINTS, field, fields * POINTS);
    if (!(apart <= 1e-12 && moved > 0.1)) {
        fail_msg("%s: %.2e apart, %.2e moved", built_in->name, apart, moved);
    }
    gm_run_close(ours);
    gm_run_close(theirs);
    free(y);
}

static void typed_again_they_are_the_built_in_equations(void **unused)
{
    (void)unused;
    struct typed typed;
    static const char *const waves[] = {BREATHER, KINK};
    for (size_t i = 0; i < GM_COUNT(waves); i++) {
        struct gm_problem wave = gm_problem_sine_gordon;
        open_typed(&typed, waves[i], POINTS, 40);
        wave.line = typed.problem.line;
        wave.line.jump = i * 2 * M_PI;
        wave.n = gm_wave_size(POINTS);
        agree(&typed, &wave, 0, 1, 0.05, true);
        close_typed(&typed);
    }
    static const struct kdv_solution soliton = {.kdv.eta = 1, .kdv.mu = 1, .velocity = 1, .position = -5};
    struct gm_problem kdv = gm_problem_kdv;
    open_typed(&typed, KDV, POINTS, 40);
    kdv.parameters = &soliton;
    kdv.line = typed.problem.line;
    kdv.n = gm_wave_size(POINTS);
    agree(&typed, &kdv, 1, 1, 0.05, false);
    close_typed(&typed);
    struct gm_problem nls = gm_problem_nls;
    open_typed(&typed, SCHROEDINGER, POINTS, 40);
    nls.line = typed.problem.line;
    nls.n = 2 * POINTS;
    agree(&typed, &nls, 0, 2, 0.02, false);
    close_typed(&typed);
}

/* The law after ten steps, of the linearised scheme and of differences of its own steps; an even number of points,
   too. */
static void the_multisymplectic_law_holds(void **unused)
{
    (void)unused;
    static const char *const texts[] = {BREATHER, KDV, SCHROEDINGER};
    static const double steps[] = {0.05, 0.05, 0.02};
    for (size_t i = 0; i < GM_COUNT(texts); i++) {
        for (size_t s = 0; s < GM_COUNT(boxes); s++) {
            struct typed typed;
            open_typed(&typed, texts[i], 100 + s % 2, 40);
            struct gm_run *run = run_of(&typed.problem, boxes[s], steps[i], typed.y);
            assert_int_equal(gm_run_advance(run, 10), GM_OK);
            const struct gm_scheme *scheme = gm_scheme_find_for(boxes[s], &typed.problem);
            const double exact = gm_form_residual((struct gm_law){&typed.problem, scheme, steps[i],
                                                                  gm_run_state(run), gm_run_memory(run),
                                                                  .by_differences = false}),
                         own = gm_form_residual((struct gm_law){&typed.problem, scheme, steps[i],
                                                                gm_run_state(run), gm_run_memory(run),
                                                                .by_differences = true});
            if (!(exact < 1e-10 && own < 1e-8)) {
                fail_msg("%s, %zu: %.2e, %.2e", boxes[s], i, exact, own);
            }
            gm_run_close(run);
            close_typed(&typed);
        }
    }
}

/* The control: with friction, which is no skew matrix, there is no law. */
static void friction_breaks_it(void **unused)
{
    (void)unused;
    enum { NODES = 101 };
    struct typed typed;
    open_typed(&typed, DIRAC, NODES, 40.4);
    struct gm_form form = *gm_field_of(&typed.problem)->form;
    struct gm_field facets = {.form = &form};
    struct gm_problem problem = typed.problem;
    double m[16];
    memcpy(m, form.m, sizeof m);
    m[0] += 0.01;
    problem.facets = &facets;
    for (size_t s = 0; s < GM_COUNT(boxes); s++) {
        for (int rubbed = 0; rubbed < 2; rubbed++) {
            form.m = rubbed ? m : gm_field_of(&typed.problem)->form->m;
            struct gm_run *run = run_of(&problem, boxes[s], 0.1, typed.y);
            assert_int_equal(gm_run_advance(run, 5), GM_OK);
            const double law = gm_form_residual(
                (struct gm_law){&problem, gm_scheme_find_for(boxes[s], &problem), 0.1, gm_run_state(run),
                                gm_run_memory(run), .by_differences = true});
            if (!(rubbed ? law > 1e-6 : law < 1e-9)) {
                fail_msg("%s%s: %.2e", boxes[s], rubbed ? " with friction" : "", law);
            }
            gm_run_close(run);
        }
    }
    close_typed(&typed);
}

/* The largest residual of a law after t = 2. */
static double residual_of(const char *text, size_t points, double dt, enum gm_local_law law)
{
    struct typed typed;
    open_typed(&typed, text, points, 40);
    struct gm_run *run = run_of(&typed.problem, "box", dt, typed.y);
    double *residual = malloc(points * sizeof *residual), largest = 0;
    assert_int_equal(gm_run_until(run, 2), GM_OK);
    assert_true(gm_local_laws(&typed.problem, gm_scheme_find_for("box", &typed.problem), dt,
                              gm_run_state(run), law, residual));
    for (size_t i = 0; i < points; i++) {
        largest = fmax(largest, fabs(residual[i]));
    }
    free(residual);
    gm_run_close(run);
    close_typed(&typed);
    return largest;
}

/* Of second order, and of a quadratic S what rounding leaves. */
static void local_laws_err_by_the_second_order(void **unused)
{
    (void)unused;
    static const enum gm_local_law laws[] = {GM_LAW_OF_ENERGY, GM_LAW_OF_MOMENTUM};
    for (size_t i = 0; i < GM_COUNT(laws); i++) {
        const double coarse = residual_of(BREATHER, 401, 0.05, laws[i]),
                     fine = residual_of(BREATHER, 801, 0.025, laws[i]);
        if (!(coarse > 1e-6 && fabs(log2(coarse / fine) - 2) < 0.15)) {
            fail_msg("law %zu: %.2e, %.2e", i, coarse, fine);
        }
        const double linear = residual_of(
            WAVE "S: u^2/2 + v^2/2 - w^2/2\nstart: u = 0, v = exp(-x^2), w = 0\n", 401, 0.05, laws[i]);
        if (!(linear < 1e-12)) {
            fail_msg("law %zu, linear: %.2e", i, linear);
        }
    }
}

/* The energy of Korteweg and de Vries' equation holds its potential, whose constant is free: it may not wander. It errs
   by the order of the scheme, of which boxes of several stages have more than means in cells show. */
static void the_constant_of_a_potential_stays(void **unused)
{
    (void)unused;
    static const double most[] = {3e-3, 3e-3, 3e-4, 3e-5};
    for (size_t s = 0; s < GM_COUNT(boxes); s++) {
        struct typed typed;
        open_typed(&typed, KDV, POINTS, 40);
        const struct gm_scheme *scheme = gm_scheme_find_for(boxes[s], &typed.problem);
        struct gm_run *run = run_of(&typed.problem, boxes[s], 0.05, typed.y);
        const double before = gm_form_energy(&typed.problem, scheme, gm_run_memory(run));
        assert_int_equal(gm_run_advance(run, 200), GM_OK);
        const double change = fabs(gm_form_energy(&typed.problem, scheme, gm_run_memory(run)) / before - 1);
        if (!(change < most[s])) {
            fail_msg("%s: %.2e", boxes[s], change);
        }
        gm_run_close(run);
        close_typed(&typed);
    }
}

/* Where boxes have their field, what they lose of the energy falls with their order in time, also on few cells. */
static void energies_fall_with_the_order_of_the_step(void **unused)
{
    (void)unused;
    static const double steps[] = {0.1, 0.05}, orders[] = {2, 4, 6};
    for (size_t s = 0; s < GM_COUNT(boxes); s++) {
        double change[2];
        for (size_t k = 0; k < 2; k++) {
            struct typed typed;
            open_typed(&typed, BREATHER, 80, 40);
            const struct gm_scheme *scheme = gm_scheme_find_for(boxes[s], &typed.problem);
            struct gm_run *run = run_of(&typed.problem, boxes[s], steps[k], typed.y);
            const double before = gm_form_energy(&typed.problem, scheme, gm_run_memory(run));
            change[k] = 0;
            while (run->t < 6 && gm_run_advance(run, 1) == GM_OK) {
                const double energy = gm_form_energy(&typed.problem, scheme, gm_run_memory(run));
                change[k] = fmax(change[k], fabs(energy / before - 1));
            }
            assert_int_equal(run->status, GM_OK);
            gm_run_close(run);
            close_typed(&typed);
        }
        print_message("%s: %.2e, %.2e\n", boxes[s], change[0], change[1]);
        assert_true(fabs(log2(change[0] / change[1]) - orders[s]) < 0.3);
    }
}

/* w of Korteweg and de Vries' equation has no rate of its own, and is u/2 of a soliton. What waves too fast for a step
   have of the start may not add up in it, however short steps are, nor rounding over dt keep one from being solved. */
static void a_component_without_a_rate_stays_what_the_equations_say(void **unused)
{
    (void)unused;
    static const struct {
        const char *scheme;
        double dt;
        long steps;
        double error;
    } runs[] = {{"gauss-box3", 0.05, 40, 3e-4},
                {"gauss-box3", 0.005, 200, 3e-4},
                {"gauss-box3", 0.0005, 20, 3e-4},
                {"gauss-box4", 0.005, 100, 1e-4},
                {"gauss-box4", 0.0005, 10, 1e-4}};
    for (size_t k = 0; k < GM_COUNT(runs); k++) {
        struct typed typed;
        open_typed(&typed, KDV, POINTS, 40);
        struct gm_run *run = run_of(&typed.problem, runs[k].scheme, runs[k].dt, typed.y);
        assert_int_equal(gm_run_advance(run, runs[k].steps), GM_OK);
        const double *w = gm_run_state(run) + 3 * POINTS, t = (double)runs[k].steps * runs[k].dt;
        double apart = 0;
        for (size_t i = 0; i < POINTS; i++) {
            const double x = gm_grid1_node(&typed.problem.line, i) + 5 - t;
            apart = fmax(apart, fabs(w[i] - 1.5 / pow(cosh(x / 2), 2)));
        }
        if (!(apart < runs[k].error)) {
            fail_msg("%s, dt = %g: w is %.2e off", runs[k].scheme, runs[k].dt, apart);
        }
        gm_run_close(run);
        close_typed(&typed);
    }
}

/* A part that alternates from node to node is no mean of cells: on an even ring it is left out at once, on an odd one
   there is none. */
static void what_alternates_is_left_out(void **unused)
{
    (void)unused;
    struct typed typed;
    open_typed(&typed, BREATHER, 100, 40);
    double alternating = 0;
    for (size_t i = 0; i < 100; i++) {
        typed.y[100 + i] += i % 2 ? -0.01 : 0.01;
    }
    struct gm_run *run = run_of(&typed.problem, "box", 0.05, typed.y);
    assert_int_equal(gm_run_advance(run, 20), GM_OK);
    for (size_t i = 0; i < 100; i++) {
        alternating += (i % 2 ? -1 : 1) * gm_run_state(run)[100 + i] / 100;
    }
    assert_true(fabs(alternating) < 1e-14);
    gm_run_close(run);
    close_typed(&typed);
}

#define START "start: u = 0, v = 0, w = 0\n"
static const struct {
    const char *text, *sentence;
    const char *at; /* where it is */
} refused[] = {
    {"components: u v w\nK-matrix: 0, 1, 0 | 1, 0, 0 | 0, 0, 0\nL-matrix: 0, 0, 1 | 0, 0, 0 | -1, 0, 0\nS: v^2\n" START,
     "K has to be skew: entry 2, 1 is not minus entry 1, 2", "1, 0, 0 | 0, 0, 0\nL"},
    {"components: u v w\nK-matrix: 0, -1, 0 | 1, 0, 0 | 0, 0, 0\nL-matrix: 0, 0, 1 | 0, 2, 0 | -1, 0, 0\nS: v^2\n" START,
     "L has to be skew: entry 2, 2 is not 0", "2, 0 |"},
    {"components: u v w z\nK-matrix: 0, -1, 0 | 1, 0, 0 | 0, 0, 0\nL-matrix: 0\nS: v^2\n" START,
     "row 1 of K-matrix has 3 entries for 4 components", "0, -1, 0"},
    {"components: u v w\nK-matrix: 0, -1, 0 | 1, 0, 0\nL-matrix: 0\nS: v^2\n" START,
     "K-matrix has 2 rows for 3 components", "0, -1, 0"},
    {WAVE "S: abs(u) + v^2/2 - w^2/2\n" START, "S has to be smooth, and abs is not", "abs"},
    {WAVE "S: max(u, 0)^2 + v^2/2 - w^2/2\n" START, "S has to be smooth, and max is not", "max"},
    {WAVE "S: mod(u, 1) + v^2/2 - w^2/2\n" START, "S has to be smooth, and mod is not", "mod"},
    {WAVE "S: v^2/2 + x\n" START, "S does not hold x", "v^2/2 + x"},
    {"components: u v w\nK-matrix: 0, -1, 0 | 1, 0, 0 | 0, 0, 0\nL-matrix: 0, 0, 0 | 0, 0, 0 | 0, 0, 0\nS: u^2 + "
     "v^2\n" START,
     "the equations do not determine w", "u^2 + v^2"},
    {"components: u v w\nK-matrix: 0, u, 0 | -u, 0, 0 | 0, 0, 0\nL-matrix: 0, 0, 1 | 0, 0, 0 | -1, 0, 0\nS: v\n" START,
     "an entry of a matrix does not hold u", NULL},
    {WAVE START, "needs a line \"S\"", NULL},
    {"L-matrix: 0, 1 | -1, 0\nS: u\n", "needs lines \"K-matrix\", \"L-matrix\" and \"S\"", NULL},
    {"components: u\nK-matrix: 0\nL-matrix: 0\nS: u^2\nstart: u = 0\n", "there are 2 to 8 components", NULL},
    {WAVE "S: v^2/2 - w^2/2\nH: u\n" START, "a system with K-matrix has no line \"H\"", NULL},
};

static void what_is_wrong_is_said(void **unused)
{
    (void)unused;
    for (size_t i = 0; i < GM_COUNT(refused); i++) {
        struct gm_user_system system;
        struct gm_fault fault;
        const char *text = refused[i].text;
        if (gm_equations_open(&system, text, strlen(text), NULL, 0, &fault)) {
            fail_msg("accepted: %s", text);
        }
        if (!strstr(fault.sentence, refused[i].sentence)) {
            fail_msg("%s: %s", text, fault.sentence);
        }
        if (refused[i].at && strncmp(text + fault.offset, refused[i].at, strlen(refused[i].at)) != 0) {
            fail_msg("%s: told at %.20s", fault.sentence, text + fault.offset);
        }
        gm_system_close(&system);
    }
}

static void a_start_that_does_not_close_is_refused(void **unused)
{
    (void)unused;
    static const struct {
        const char *text, *sentence;
    } starts[] = {
        {SINE_GORDON "start: u = 4*atan(exp(x)), v = 0, w = 0\n",
         "u at the start does not close on the ring"},
        {SINE_GORDON "start: u = 4*atan(exp(x)), v = 0, w = 0\njump: u = 6\n",
         "u at the start does not close"},
        {SINE_GORDON "start: u = x/10, v = 0, w = 0.1\njump: u = 4\n", "does not repeat after the jumps"},
        {SINE_GORDON "start: u = 1/x, v = 0, w = 0\n", "u at the start is not finite where x = 0"},
        {KDV "jump: phi = 5\n",
         "phi gains 12 around the ring, which follows from the others at the start, and not 5"},
        {"components: u v\nK-matrix: 0, -1 | 1, 0\nL-matrix: 0, 0 | 0, 0\nS: u^2 + v^2\nstart: u = 0, v = 0\n",
         "L is 0 with these values, and nothing changes in space"},
    };
    for (size_t i = 0; i < GM_COUNT(starts); i++) {
        struct gm_user_system system;
        struct gm_user_form form;
        struct gm_problem problem;
        struct gm_fault fault;
        const struct gm_grid1 line = {100, 0.4, -20, 0, false};
        assert_true(gm_equations_open(&system, starts[i].text, strlen(starts[i].text), NULL, 0, &fault));
        assert_true(gm_user_form_derive(&form, &system));
        double *values = gm_equations_start(&system, NULL);
        assert_true(gm_user_form_open(&problem, &form, values, &line));
        if (gm_user_form_closes(&problem, &fault) || !strstr(fault.sentence, starts[i].sentence)) {
            fail_msg("%s: %s", starts[i].text, fault.sentence);
        }
        free(values);
        gm_user_line_close(&problem);
        gm_system_close(&system);
    }
}

/* Of matrices and a function: the order by three grids, the law, the charge that a kept quantity tells of, and potentials
   that are left out. */
static double mass_of(const void *data, const double *y, const double *memory)
{
    (void)memory;
    const struct gm_problem *problem = data;
    double sum = 0;
    for (size_t i = 0; i < problem->line.points; i++) {
        sum += y[problem->line.points + i];
    }
    return sum * problem->line.dx;
}

static void schemes_are_certified_on_somebodys_form(void **unused)
{
    (void)unused;
    static const struct {
        const char *text;
        double length;
        bool mass; /* of the second component */
    } cases[] = {{BREATHER, 40, false}, {KDV, 50, true}};
    enum {
        GRIDS = 4,
        LAST = 3
    }; /* boxes of four stages take long, and those of three for the second equation */
    for (size_t which = 0; which < GM_COUNT(cases); which++) {
        struct typed typed[GRIDS];
        struct gm_certified_system system[GRIDS];
        struct gm_kept mass = {"mass", mass_of, &typed[0].problem};
        for (size_t k = 0; k < GRIDS; k++) {
            open_typed(&typed[k], cases[which].text, (size_t)POINTS << k, cases[which].length);
            typed[k].problem.name = "typed";
            system[k] = (struct gm_certified_system){.problem = &typed[k].problem,
                                                     .start = typed[k].y,
                                                     .dt = ldexp(0.08, -(int)k),
                                                     .kept = &mass,
                                                     .kept_count = cases[which].mass ? 1 : 0,
                                                     .finer = k + 1 < GRIDS ? &system[k + 1] : NULL};
        }
        for (size_t i = 0; i < LAST - which; i++) {
            const struct gm_scheme *scheme = gm_scheme_find_for(boxes[i], &typed[0].problem);
            struct gm_certificate certificate = gm_certify_on(scheme, system);
            const struct gm_verdict *linear = gm_certificate_claim(&certificate, GM_KEEPS_LINEAR);
            if (!certificate.holds || !(fabs(certificate.order - scheme->order) < 0.15) ||
                !gm_certificate_claim(&certificate, GM_MULTISYMPLECTIC)->holds ||
                linear->measured != cases[which].mass || !linear->holds != !cases[which].mass) {
                fail_msg("%s, %zu: order %.3f", boxes[i], which, certificate.order);
            }
        }
        struct gm_scheme wrong = *gm_scheme_find_for("box", &typed[0].problem);
        wrong.claims |= GM_KEEPS_ENERGY;
        assert_false(gm_certify_on(&wrong, system).holds);
        wrong.order = 3;
        assert_false(gm_certify_on(&wrong, system).order_holds);
        for (size_t k = 0; k < GRIDS; k++) {
            close_typed(&typed[k]);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(typed_again_they_are_the_built_in_equations),
        cmocka_unit_test(the_multisymplectic_law_holds),
        cmocka_unit_test(friction_breaks_it),
        cmocka_unit_test(local_laws_err_by_the_second_order),
        cmocka_unit_test(the_constant_of_a_potential_stays),
        cmocka_unit_test(energies_fall_with_the_order_of_the_step),
        cmocka_unit_test(a_component_without_a_rate_stays_what_the_equations_say),
        cmocka_unit_test(what_alternates_is_left_out),
        cmocka_unit_test(what_is_wrong_is_said),
        cmocka_unit_test(a_start_that_does_not_close_is_refused),
        cmocka_unit_test(schemes_are_certified_on_somebodys_form),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
