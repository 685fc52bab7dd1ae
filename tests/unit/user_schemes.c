/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Schemes of one's own: every row typed as text makes the same steps, bit for bit; wrong tableaux, as they
   stand in print and in libraries, are named with the condition that fails; what cannot be read is said with
   its place. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "core/arena.h"
#include "core/basics.h"
#include "core/ode/families/families.h"
#include "core/ode/families/runge_kutta/explicit.h"
#include "core/ode/families/runge_kutta/implicit.h"
#include "core/ode/families/runge_kutta/row.h"
#include "core/ode/families/splitting/splitting.h"
#include "core/ode/user/scheme.h"
#include "core/run.h"
#include "core/schemes.h"
#include "core/theory/certify.h"
#include "tests/common/high_order.h"
#include "tests/problems/problems.h"

static const struct gm_scheme *no_file(void *data, const char *path, char *sentence)
{
    (void)data;
    snprintf(sentence, GM_FAULT_SENTENCE, "%.40s could not be read", path);
    return NULL;
}

static const struct gm_scheme *open_text(const char *text, struct gm_fault *fault)
{
    const struct gm_user_scheme_source source = {
        .text = text, .length = strlen(text), .name = "own", .title = "own", .bring = no_file};
    return gm_user_scheme_open(&source, fault);
}

static const struct gm_scheme *open_user(const char *text)
{
    struct gm_fault fault;
    const struct gm_scheme *scheme = open_text(text, &fault);
    if (!scheme) {
        fail_msg("%s: %zu: %s", text, fault.offset, fault.sentence);
    }
    return scheme;
}

/* ---- the same steps ---- */

static void put_rows(FILE *out, int rows, int columns, const double *at, size_t stride)
{
    for (int i = 0; i < rows; i++) {
        for (int j = 0; j < columns; j++) {
            fprintf(out, "%s%.17g", j ? ", " : i ? " | " : "", at[(size_t)i * stride + (size_t)j]);
        }
    }
}

static void put_splitting(FILE *out, const struct gm_splitting *splitting)
{
    fputs("splitting(", out);
    for (int kick = 0; kick < 2; kick++) {
        const char *comma = kick ? "; " : "";
        for (int i = 0; i < splitting->count; i++) {
            if ((splitting->pieces[i].piece == GM_KICK) == kick) {
                fprintf(out, "%s%.17g", comma, splitting->pieces[i].fraction);
                comma = ", ";
            }
        }
    }
    const bool even = splitting->count % 2 == 0;
    fprintf(out, "%s)", even && splitting->pieces[0].piece == GM_KICK ? "; first: kick" : "");
}

/* Kick, drift, ..., kick, each kick the mean of the drifts next to it: several steps of Verlet's method. */
static bool is_of_verlet(const struct gm_splitting *splitting)
{
    double before = 0;
    bool good = splitting->count > 3 && splitting->count % 2 == 1;
    for (int i = 0; good && i < splitting->count; i += 2) {
        const double drift = i + 1 < splitting->count ? splitting->pieces[i + 1].fraction : 0;
        good = splitting->pieces[i].piece == GM_KICK && splitting->pieces[i].fraction == (before + drift) / 2;
        before = drift;
    }
    return good;
}

static void put_steps_of_verlet(FILE *out, const struct gm_splitting *splitting)
{
    fputs("composition(verlet", out);
    for (int i = 1; i < splitting->count; i += 2) {
        fprintf(out, "%s%.17g", i > 1 ? ", " : "; ", splitting->pieces[i].fraction);
    }
    fputs(")", out);
}

static void put_composition(FILE *out, const char *base, const struct gm_composition *composition)
{
    fprintf(out, "composition(%s", base);
    for (int i = 0; i < composition->steps; i++) {
        fprintf(out, "%s%.17g", i ? ", " : "; ", gm_composition_fraction(composition, i));
    }
    fputs(")", out);
}

/* A row as somebody would type it; NULL where it is no row of coefficients. */
static char *typed(const struct gm_scheme *scheme)
{
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    assert_non_null(out);
    if (scheme->family == &gm_family_explicit) {
        const struct gm_tableau *row = scheme->coefficients;
        fputs("explicit(", out);
        put_rows(out, row->stages, row->stages, row->a[0], GM_TABLEAU_STAGES);
        fputs("; ", out);
        put_rows(out, 1, row->stages, row->b, 0);
        fputs(")", out);
    } else if (scheme->family == &gm_family_implicit) {
        const struct gm_tableau *row = scheme->coefficients;
        if (row->composition->steps > 1) {
            put_composition(out, "midpoint", row->composition);
        } else {
            fputs("runge-kutta(", out);
            put_rows(out, row->stages, row->stages, row->a[0], GM_TABLEAU_STAGES);
            fputs("; ", out);
            put_rows(out, 1, row->stages, row->b, 0);
            fputs(")", out);
        }
    } else if (scheme->family == &gm_family_partitioned) {
        const struct gm_partitioned_row *row = scheme->coefficients;
        const int stages = (int)row->stages;
        fputs("partitioned(", out);
        put_rows(out, stages, stages, row->a[0], GM_TABLEAU_STAGES);
        fputs("; ", out);
        put_rows(out, 1, stages, row->b, 0);
        fputs("; ", out);
        put_rows(out, stages, stages, row->c[0], GM_TABLEAU_STAGES);
        fputs("; ", out);
        put_rows(out, 1, stages, row->d, 0);
        fputs(")", out);
    } else if (scheme->family == &gm_family_splitting) {
        const struct gm_splitting *row = scheme->coefficients;
        if (is_of_verlet(row)) {
            put_steps_of_verlet(out, row);
        } else {
            put_splitting(out, row);
        }
    }
    fclose(out);
    if (size == 0) {
        free(text);
        text = NULL;
    }
    return text;
}

/* The states of several members after some steps, with the counts. */
static void walk(const struct gm_problem *problem, const struct gm_scheme *scheme, bool compensated,
                 const double *start, double *end, unsigned long counts[2])
{
    const struct gm_settings settings = {.compensated = compensated};
    struct gm_run *run = gm_run_open(problem, scheme, &settings, 0, 0.05, start);
    assert_non_null(run);
    assert_int_equal(gm_run_advance(run, 37), GM_OK);
    memcpy(end, gm_run_state(run), problem->n * problem->m * sizeof *end);
    counts[0] = run->evaluations;
    counts[1] = run->iterations;
    gm_run_close(run);
}

static void same_steps(const struct gm_problem *of, const struct gm_scheme *scheme,
                       const struct gm_scheme *own)
{
    enum { MEMBERS = 7, COMPONENTS = 4 };
    static const double state[COMPONENTS] = {0.6, -0.3, 0.2, 0.4};
    for (size_t m = 1; m <= MEMBERS; m += MEMBERS - 1) {
        struct gm_problem problem = *of;
        double start[COMPONENTS * MEMBERS], end[2][COMPONENTS * MEMBERS];
        unsigned long counts[2][2];
        problem.m = m;
        for (size_t i = 0; i < problem.n * m; i++) {
            start[i] = state[i / m] + 0.01 * (double)(i % m);
        }
        for (int compensated = 0; compensated < 2; compensated++) {
            walk(&problem, scheme, compensated, start, end[0], counts[0]);
            walk(&problem, own, compensated, start, end[1], counts[1]);
            if (memcmp(end[0], end[1], problem.n * m * sizeof(double)) != 0 ||
                memcmp(counts[0], counts[1], sizeof counts[0]) != 0) {
                fail_msg("%s on %s, %zu members: another number of its own", scheme->name, problem.name, m);
            }
        }
    }
}

static void every_row_retyped(void **unused)
{
    (void)unused;
    const struct gm_problem *const problems[] = {&gm_problem_pendulum, &gm_problem_henon_heiles,
                                                 &gm_problem_product};
    int rows = 0, walks = 0;
    for (size_t i = 0; i < gm_scheme_count(); i++) {
        const struct gm_scheme *scheme = gm_scheme_at(i);
        char *text = typed(scheme);
        if (!text) {
            continue;
        }
        const struct gm_scheme *own = open_user(text);
        rows++;
        for (size_t k = 0; k < GM_COUNT(problems); k++) {
            if (gm_scheme_fits(scheme, problems[k]) && gm_scheme_fits(own, problems[k])) {
                same_steps(problems[k], scheme, own);
                walks++;
            }
        }
        /* digits that are written say what the row claims, but for a quadratic T */
        if (!(scheme->needs & GM_NEEDS_NYSTROM)) {
            assert_int_equal(own->order, scheme->order);
            assert_int_equal(own->claims & GM_SYMPLECTIC, scheme->claims & GM_SYMPLECTIC);
            assert_int_equal(own->claims & GM_SYMMETRIC, scheme->claims & GM_SYMMETRIC);
        }
        gm_user_scheme_close(own);
        free(text);
    }
    assert_true(rows >= 37 && walks >= 2 * rows);
}

/* Of more stages than the loops know: the three-eighths rule with stages that nobody asks for. */
static void many_stages(void **unused)
{
    (void)unused;
    const struct gm_scheme *small =
        open_user("explicit(0,0,0,0|1/3,0,0,0|-1/3,1,0,0|1,-1,1,0;1/8,3/8,3/8,1/8)");
    const struct gm_scheme *large = open_user(
        "explicit(0,0,0,0,0,0|1/3,0,0,0,0,0|-1/3,1,0,0,0,0|1,-1,1,0,0,0|0,0,0,1/2,0,0|0,0,0,0,1/2,0;"
        "1/8,3/8,3/8,1/8,0,0)");
    const struct gm_scheme *gauss = open_user("runge-kutta(1/4,1/4-sqrt(3)/6|1/4+sqrt(3)/6,1/4;1/2,1/2)");
    const struct gm_scheme *wide = open_user("runge-kutta(1/4,1/4-sqrt(3)/6,0,0,0|1/4+sqrt(3)/6,1/4,0,0,0|"
                                             "0,0,1,0,0|0,0,0,1,0|0,0,0,0,1/2;1/2,1/2,0,0,0)");
    const double start[4] = {0.1, -0.2, 0.3, 0.1};
    double end[4][4];
    unsigned long counts[2];
    struct gm_problem problem = gm_problem_henon_heiles;
    problem.m = 1;
    walk(&problem, small, false, start, end[0], counts);
    walk(&problem, large, false, start, end[1], counts);
    assert_memory_equal(end[0], end[1], sizeof end[0]);
    assert_int_equal(counts[0], 6 * 37);
    walk(&problem, gauss, false, start, end[2], counts);
    walk(&problem, wide, false, start, end[3], counts);
    for (int c = 0; c < 4; c++) {
        assert_float_equal(end[2][c], end[3][c], 1e-14);
    }
    assert_int_equal(wide->order, 4);
    gm_user_scheme_close(small);
    gm_user_scheme_close(large);
    gm_user_scheme_close(gauss);
    gm_user_scheme_close(wide);
}

/* ---- schemes of schemes ---- */

static void equal_walks(const char *text, const char *other, const struct gm_problem *of, double tolerance)
{
    const struct gm_scheme *own = open_user(text);
    const struct gm_scheme *known = gm_scheme_find(other), *second = known ? NULL : open_user(other);
    const double start[4] = {0.1, -0.2, 0.3, 0.1};
    double end[2][4];
    unsigned long counts[2];
    struct gm_problem problem = *of;
    problem.m = 1;
    walk(&problem, own, false, start, end[0], counts);
    walk(&problem, known ? known : second, false, start, end[1], counts);
    for (size_t c = 0; c < problem.n; c++) {
        if (!(fabs(end[0][c] - end[1][c]) <= tolerance)) {
            fail_msg("%s is not %s: %g", text, other, end[0][c] - end[1][c]);
        }
    }
    gm_user_scheme_close(own);
    if (second) {
        gm_user_scheme_close(second);
    }
}

static void schemes_of_schemes(void **unused)
{
    (void)unused;
    const struct gm_problem *henon = &gm_problem_henon_heiles;
    equal_walks("adjoint(explicit-euler)", "implicit-euler", henon, 1e-15);
    equal_walks("adjoint(adjoint(rk4))", "rk4", henon, 1e-15);
    equal_walks("adjoint(symplectic-euler)", "symplectic-euler-adjoint", henon, 0);
    equal_walks("adjoint(verlet)", "verlet", henon, 0);
    equal_walks("adjoint(gauss6)", "gauss6", henon, 0);
    equal_walks("adjoint(kahan2)", "kahan2", henon, 0);
    equal_walks("composition(kahan2; 1/2, 1/2)", "composition(composition(kahan2; 1); 1/2, 1/2)", henon, 0);
    /* kick, drift, kick of Verlet's method */
    equal_walks("composition(composition(verlet; 1/2, 1/2); 1)", "splitting(1/2, 1/2; 1/4, 1/2, 1/4)", henon,
                0);
    /* kick and drift of the processor undone, the kernel, and the processor */
    equal_walks("processed(verlet; splitting(0.1; 0.2))", "splitting(-0.1, 1, 0.1; -0.2, 1/2, 1/2, 0.2)",
                henon, 0);
    equal_walks("processed(rk4; splitting(0; 0))", "rk4", henon, 1e-15);
    const struct gm_scheme *yoshida =
        open_user("composition(verlet; let: g = 1/(2 - 2^(1/3)); g, 1 - 2*g, g)");
    assert_true(yoshida->family == &gm_family_splitting && yoshida->order == 4);
    const struct gm_theory theory = gm_scheme_theory(yoshida);
    assert_true(theory.order == 4 && theory.symplectic && theory.symmetric);
    /* its word makes it again */
    const struct gm_scheme *again = open_user(yoshida->word);
    assert_string_equal(again->word, yoshida->word);
    assert_string_equal(again->title, yoshida->title);
    assert_memory_equal(again->coefficients, yoshida->coefficients, sizeof(struct gm_splitting));
    gm_user_scheme_close(again);
    gm_user_scheme_close(yoshida);
    /* titles that follow from the text stand in the word: a splitting's in that of what it is a part of */
    const struct gm_scheme *part = open_user("processed(verlet; splitting(0.1; 0.2))");
    const struct gm_scheme *by_word = open_user(part->word);
    assert_string_equal(by_word->word, part->word);
    gm_user_scheme_close(by_word);
    gm_user_scheme_close(part);
    /* the adjoint of a composition that is no splitting: its parts' adjoints, backwards; there and back */
    equal_walks("adjoint(composition(rk4; 1/3, 2/3))", "composition(adjoint(rk4); 2/3, 1/3)", henon, 0);
    equal_walks("adjoint(adjoint(composition(rk4; 1/3, 2/3)))", "composition(rk4; 1/3, 2/3)", henon, 1e-14);
    const struct gm_scheme *both = open_user("composition(composition(rk4; 1/3, 2/3); 1/2, 1/2)");
    const struct gm_scheme *turned = open_user("adjoint(composition(explicit-euler; 1/3, 2/3))");
    assert_true(gm_scheme_theory(both).order == 4 && gm_scheme_theory(turned).order == 1);
    gm_user_scheme_close(both);
    gm_user_scheme_close(turned);
    /* the same composition of any base has the order that the steps give */
    static const char *const bases[] = {"midpoint", "trapezoidal",
                                        "runge-kutta(1/4, 0 | 1/2, 1/4; 1/2, 1/2)"};
    for (size_t i = 0; i < GM_COUNT(bases); i++) {
        char text[200];
        snprintf(text, sizeof text, "composition(%s; let: g = 1/(2 - 2^(1/3)); g, 1 - 2*g, g)", bases[i]);
        const struct gm_scheme *own = open_user(text);
        assert_int_equal(own->order, 4);
        assert_true(own->claims & GM_SYMMETRIC);
        gm_user_scheme_close(own);
    }
}

#define TEN_STEPS "let: g = 1/(4 - 4^(1/3)); g/2, g/2, g/2, g/2, (1-4*g)/2, (1-4*g)/2, g/2, g/2, g/2, g/2)"
#define EULERS_IN_TURNS "composition(explicit-euler, implicit-euler; " TEN_STEPS

/* After a step of -h of the scheme's adjoint a step of h is undone. */
static void undone(const char *text, const struct gm_problem *problem)
{
    char other[300];
    double y[4] = {0.1, -0.2, 0.3, 0.1};
    const double start[4] = {0.1, -0.2, 0.3, 0.1};
    snprintf(other, sizeof other, "adjoint(%s)", text);
    const struct gm_scheme *schemes[2] = {open_user(text), open_user(other)};
    for (int i = 0; i < 2; i++) {
        struct gm_run *run =
            gm_run_open(problem, schemes[i], &(struct gm_settings){0}, 0, i == 0 ? 0.2 : -0.2, y);
        assert_int_equal(gm_run_advance(run, 1), GM_OK);
        assert_true(i == 1 || gm_distance(gm_run_state(run), start, problem->n) > 1e-2);
        memcpy(y, gm_run_state(run), problem->n * sizeof *y);
        gm_run_close(run);
        gm_user_scheme_close(schemes[i]);
    }
    if (!(gm_distance(y, start, problem->n) < 1e-13)) {
        fail_msg("%s is not undone: %g", text, gm_distance(y, start, problem->n));
    }
}

static void bases_in_turns(void **unused)
{
    (void)unused;
    const struct gm_problem *henon = &gm_problem_henon_heiles, *kepler = &gm_problem_kepler;
    equal_walks("composition(explicit-euler, implicit-euler; 1/2, 1/2)", "trapezoidal", henon, 1e-13);
    equal_walks("composition(implicit-euler, explicit-euler; 1/2, 1/2)", "midpoint", henon, 1e-13);
    equal_walks("composition(symplectic-euler, adjoint(symplectic-euler); 1/2, 1/2)", "verlet", henon, 1e-14);
    equal_walks(
        "kind: composition\nbase: symplectic-euler, # half a step\n adjoint(symplectic-euler) # back\n"
        "steps: 1/2, 1/2\n",
        "verlet", henon, 1e-14);
    equal_walks("composition(adjoint(symplectic-euler), symplectic-euler; 1/2, 1/2)", "verlet-position",
                henon, 1e-14);
    equal_walks("composition(verlet, composition(kahan2, rk4; 1/3, 2/3); 1/2, 1/2)",
                "composition(verlet, kahan2, rk4; 1/2, 1/6, 1/3)", henon, 1e-14);
    undone("composition(rk4, verlet, midpoint; 0.3, 0.5, 0.2)", henon);
    undone("composition(explicit-euler, symplectic-euler; 1/3, 1/6, 1/4, 1/4)", henon);
    /* its word makes it again */
    const struct gm_scheme *mixed = open_user("composition(rk4, adjoint(rk4), composition(verlet, midpoint; "
                                              "1/2, 1/2); 0.3, 0.5, 0.2)");
    const struct gm_scheme *again = open_user(mixed->word);
    assert_string_equal(again->word, mixed->word);
    gm_user_scheme_close(again);
    gm_user_scheme_close(mixed);
    /* one period of an orbit of eccentricity 0.3; the errors are those of a program without this one's code */
    static const double errors[] = {3.1163466585e-06, 1.9128172225e-07, 1.1900648113e-08};
    const struct gm_scheme *turns = open_user(EULERS_IN_TURNS);
    const double start[4] = {0.7, 0, 0, sqrt(1.3 / 0.7)};
    for (int i = 0; i < 3; i++) {
        const int steps = 100 << i;
        struct gm_run *run = gm_run_open(kepler, turns, &(struct gm_settings){0}, 0, 2 * M_PI / steps, start);
        assert_int_equal(gm_run_advance(run, steps), GM_OK);
        assert_float_equal(gm_distance(gm_run_state(run), start, 4) / errors[i], 1, 1e-4);
        gm_run_close(run);
    }
    gm_user_scheme_close(turns);
}

/* Theory in the equations that all bases are made for, and claims of bases without coefficients. */
static void claims_in_turns(void **unused)
{
    (void)unused;
    enum { S = GM_SYMPLECTIC, R = GM_SYMMETRIC };
    static const struct {
        const char *text;
        int order;
        unsigned claims;
        bool known, holds;
    } schemes[] = {
        {EULERS_IN_TURNS, 4, R, true, true},
        {"composition(symplectic-euler, adjoint(symplectic-euler); " TEN_STEPS, 4, S | R, true, true},
        {"composition(midpoint, lobatto2, midpoint; 0.3, 0.4, 0.3)", 2, S | R, true, true},
        {"composition(gauss4, verlet, gauss4; 0.3, 0.4, 0.3)", 2, S | R, true, true},
        {"composition(gauss4, yoshida4, gauss4; let: g = 1/(2 - 2^(1/5)); g, 1 - 2*g, g)", 4, S | R, true,
         true},
        {"composition(blanes-moan-nystrom6, gauss6; 1/3, 2/3)", 6, S, true, true},
        {"composition(rk4, lobatto4, yoshida4; 1/3, 1/3, 1/3)", 4, 0, true, true},
        /* stages that are equal are one: these three are the midpoint rule and Verlet's */
        {"composition(implicit-euler, explicit-euler, verlet; 1/4, 1/4, 1/2)", 2, S, true, true},
        {"composition(midpoint, avf2, midpoint; 1/4, 1/2, 1/4)", 2, R, false, true},
        {"composition(symplectic-euler, avf2, symplectic-euler-adjoint; 1/4, 1/2, 1/4)", 2, R, false, true},
        {"composition(symplectic-euler, avf2, symplectic-euler; 1/4, 1/2, 1/4)", 1, 0, false, true},
        {"composition(composition(avf2, rk4; 1/3, 2/3), adjoint(composition(avf2, rk4; 1/3, 2/3)); 1/2, 1/2)",
         2, R, false, true},
        {"composition(variational-midpoint2, verlet; 1/2, 1/2)", 2, S, false, true},
        /* steps exchanged; a method without its adjoint; bases exchanged in one place; too much claimed */
        {"composition(explicit-euler, implicit-euler; order: 4; claims: symmetric; let: g = 1/(4 - 4^(1/3)); "
         "g/2, g/2, g/2, (1-4*g)/2, g/2, (1-4*g)/2, g/2, g/2, g/2, g/2)",
         4, R, true, false},
        {"composition(explicit-euler; order: 4; claims: none; " TEN_STEPS, 4, 0, true, false},
        {"composition(explicit-euler, rk4; order: 2; claims: none; " TEN_STEPS, 2, 0, true, false},
        {"composition(rk4, verlet; claims: symplectic; 1/2, 1/2)", 2, S, true, false},
        {"composition(midpoint, verlet; claims: symmetric; 1/2, 1/2)", 2, R, true, false},
        {"composition(midpoint, avf2; claims: symplectic; 1/2, 1/2)", 2, S, false, false},
        {"composition(symplectic-euler, avf2, symplectic-euler; order: 2; 1/4, 1/2, 1/4)", 2, 0, false,
         false},
    };
    for (size_t i = 0; i < GM_COUNT(schemes); i++) {
        const struct gm_scheme *own = open_user(schemes[i].text);
        const struct gm_certificate certificate = gm_certify(own);
        if (own->order != schemes[i].order || own->claims != schemes[i].claims ||
            certificate.theory.known != schemes[i].known || certificate.holds != schemes[i].holds) {
            fail_msg("%s: order %d, claims %x, theory %d, holds %d", schemes[i].text, own->order, own->claims,
                     certificate.theory.known, certificate.holds);
        }
        gm_user_scheme_close(own);
    }
}

/* ---- by theory ---- */

#define RK4_C "; c: 0, 1/2, 1/2, 1"
#define RADAU(sign)                                                                                          \
    "runge-kutta(order: 5; (88-7*sqrt(6))/360, (296-169*sqrt(6))/1800, (-2+3*sqrt(6))/225 |"                 \
    "(296+169*sqrt(6))/1800, (88+7*sqrt(6))/360, " sign "(2+3*sqrt(6))/225 |"                                \
    "(16-sqrt(6))/36, (16+sqrt(6))/36, 1/9; (16-sqrt(6))/36, (16+sqrt(6))/36, 1/9)"
#define DOPRI(fourth, fifth)                                                                                 \
    "explicit(order: 5; 0,0,0,0,0,0 | 1/5,0,0,0,0,0 | 3/40,9/40,0,0,0,0 | 44/45,-56/15,32/9,0,0,0 |"         \
    "19372/6561,-25360/2187,64448/6561," fourth ",0,0 | 9017/3168,-355/33,46732/5247,49/176," fifth ",0;"    \
    "35/384,0,500/1113,125/192,-2187/6784,11/84)"

static void wrong_schemes(void **unused)
{
    (void)unused;
    static const struct {
        const char *text;
        int order; /* by theory; 0 is that of the right one */
        const char *condition;
    } schemes[] = {
        {"explicit(order: 4; 0,0,0,0|1/2,0,0,0|0,1/2,0,0|0,0,1,0; 1/6,1/3,1/3,1/6" RK4_C ")", 4, ""},
        {RADAU("-"), 5, ""},
        {DOPRI("-212/729", "-5103/18656"), 5, ""},
        /* weights exchanged */
        {"explicit(order: 4; 0,0,0,0|1/2,0,0,0|0,1/2,0,0|0,0,1,0; 1/3,1/6,1/3,1/6)", 1, "t[t]"},
        /* the three-eighths rule with a sign lost, in the third stage and in the fourth */
        {"explicit(order: 4; 0,0,0,0|1/3,0,0,0|1/3,1,0,0|1,-1,1,0; 1/8,3/8,3/8,1/8)", 1, "t[t]"},
        {"explicit(order: 4; 0,0,0,0|1/3,0,0,0|-1/3,1,0,0|1,1,1,0; 1/8,3/8,3/8,1/8)", 1, "t[t]"},
        /* Heun's stages, the second one's slope taken for the first one's */
        {"explicit(order: 3; 0,0,0|1/3,0,0|2/3,0,0; 1/4,0,3/4)", 2, "t[t[t]]"},
        /* Dormand and Prince: a sign lost, a digit wrong */
        {DOPRI("212/729", "-5103/18656"), 1, "t[t]"},
        {DOPRI("-212/729", "-5103/18657"), 1, "t[t]"},
        /* Radau IIA: a sign lost */
        {RADAU(""), 1, "t[t]"},
        /* Lobatto IIIA with the first row of IIIC */
        {"runge-kutta(order: 4; 1/6,-1/3,1/6|5/24,1/3,-1/24|1/6,2/3,1/6; 1/6,2/3,1/6)", 3, "t[t[t,t]]"},
        /* an order claimed too high: Ralston's method */
        {"explicit(order: 3; 0,0|2/3,0; 1/4,3/4)", 2, "t[t[t]]"},
        /* the exponent 1/2 for 1/3: a misprint in the constant of the triple jump */
        {"composition(midpoint; order: 4; let: g = 1/(2 - 2^(1/2)); g, 1 - 2*g, g)", 2, "t[t[t]]"},
        /* Ruth's method, two kicks exchanged */
        {"splitting(1, -2/3, 2/3; -1/24, 7/24, 3/4; order: 3)", 1, NULL},
        /* the tenth digit of a step */
        {"composition(verlet; order: 4; 1.35120719295966, -1.70241438591932, 1.35120719295966)", 2, NULL},
    };
    for (size_t i = 0; i < GM_COUNT(schemes); i++) {
        const struct gm_scheme *own = open_user(schemes[i].text);
        const struct gm_theory theory = gm_scheme_theory(own);
        const bool right = schemes[i].condition && !schemes[i].condition[0];
        if (theory.order != schemes[i].order || (theory.order < own->order) == right ||
            (schemes[i].condition && !right && strcmp(theory.condition, schemes[i].condition) != 0)) {
            fail_msg("%s: order %d, %s by %g", schemes[i].text, theory.order, theory.condition,
                     theory.residual);
        }
        assert_true(right || theory.condition[0]);
        gm_user_scheme_close(own);
    }
    /* once through the whole certificate, where a measurement sees it too */
    const struct gm_scheme *wrong = open_user(schemes[3].text);
    const struct gm_certificate certificate = gm_certify(wrong);
    assert_false(certificate.holds || certificate.theory_holds || certificate.order_holds);
    gm_user_scheme_close(wrong);
}

/* Within half a unit of the last digit, and no further: a digit less is still of order 4, one that is wrong
   is not. */
static void digits(void **unused)
{
    (void)unused;
    static const struct {
        const char *steps;
        int order;
    } typed_steps[] = {
        {"1.35120719195966, -1.70241438391932, 1.35120719195966", 4},
        {"1.351207192, -1.702414384, 1.351207192", 4},
        {"1.3512, -1.7024, 1.3512", 4},
        {"1.351207195, -1.702414390, 1.351207195", 2},
        {"1.35, -1.70, 1.35", 2}, /* three digits are what is meant */
        /* a decimal that occurs several times is one number: its ninth digit, wrong by one, is seen */
        {"let: g = 1.35120719; g, 1 - 2*g, g", 4},
        {"let: g = 1.35120720; g, 1 - 2*g, g", 2},
        {"let: g = 1.35120718; g, 1 - 2*g, g", 2},
        /* whole numbers are exact, however long: a wrong last one is seen */
        {"1351207191959657634047687808971/1000000000000000000000000000000, "
         "-1702414383919315268095375617942/1000000000000000000000000000000, "
         "1351207191959657634047687808971/1000000000000000000000000000000",
         2},
    };
    for (size_t i = 0; i < GM_COUNT(typed_steps); i++) {
        char text[400];
        snprintf(text, sizeof text, "composition(verlet; %s)", typed_steps[i].steps);
        const struct gm_scheme *own = open_user(text);
        if (own->order != typed_steps[i].order) {
            fail_msg("%s: order %d", text, own->order);
        }
        gm_user_scheme_close(own);
    }
}

/* The order by theory of steps of a base whose fractions have so many correct digits; 0 digits: all. */
static int order_of_steps(const char *base, const struct gm_ball *fractions, const char *formulas, int count,
                          int digits)
{
    char text[400], number[64];
    int used = snprintf(text, sizeof text, "composition(%s; %s", base, digits > 0 ? "" : formulas);
    for (int i = 0; digits > 0 && i < count; i++) {
        gm_ball_print(fractions[i], digits, number, sizeof number);
        used += snprintf(text + used, sizeof text - (size_t)used, "%s%s", i > 0 ? ", " : "", number);
    }
    snprintf(text + used, sizeof text - (size_t)used, ")");
    const struct gm_scheme *own = open_user(text);
    const struct gm_theory theory = gm_scheme_theory(own);
    gm_user_scheme_close(own);
    return theory.known ? theory.order : -1;
}

/* More digits that are right never lower an order, whatever is known of the rows that they stand beside. */
static void digits_over_every_base(void **unused)
{
    (void)unused;
    enum { MOST_STAGES = 12 }; /* of the base: more take long */
    static const int digit_counts[] = {12, 15, 16, 17, 18, 20, 30};
    const struct gm_ball third = gm_ball_ratio(1, 3);
    const struct gm_ball thirds[] = {third, gm_ball_add(third, third)};
    int bases = 0;
    for (size_t i = 0; i < gm_scheme_count(); i++) {
        const struct gm_scheme *base = gm_scheme_at(i);
        struct gm_coefficients exact;
        if (base->family->kind != &gm_kind_ode || base->family->by_tolerance ||
            base != gm_scheme_find(base->name) || !gm_scheme_has_coefficients(base)) {
            continue;
        }
        struct gm_arena *arena = gm_arena_open();
        gm_scheme_coefficients_open(arena, base, &exact);
        const int stages = exact.stages, order = base->order;
        gm_arena_close(arena);
        if (stages > MOST_STAGES) {
            continue;
        }
        bases++;
        /* a triple jump leads from an even order to the next one */
        const struct gm_ball two = gm_ball_of(2), one = gm_ball_of(1);
        const struct gm_ball root =
            gm_ball_exp(gm_ball_multiply(gm_ball_ratio(1, order + 1), gm_ball_log(two)));
        const struct gm_ball jump = gm_ball_divide(one, gm_ball_subtract(two, root));
        const struct gm_ball jumps[] = {jump, gm_ball_subtract(one, gm_ball_add(jump, jump)), jump};
        char formulas[200];
        snprintf(formulas, sizeof formulas, "let: g = 1/(2 - 2^(1/%d)); g, 1 - 2*g, g", order + 1);
        const bool jumping = base->claims & GM_SYMMETRIC && order <= 4;
        const int whole = order_of_steps(base->name, thirds, "1/3, 2/3", 2, 0);
        const int higher = jumping ? order_of_steps(base->name, jumps, formulas, 3, 0) : 0;
        assert_true(whole >= order && (!jumping || higher >= order + 2));
        for (size_t k = 0; k < GM_COUNT(digit_counts); k++) {
            const int told = order_of_steps(base->name, thirds, NULL, 2, digit_counts[k]);
            const int jumped = jumping ? order_of_steps(base->name, jumps, NULL, 3, digit_counts[k]) : 0;
            if (told < whole || jumped < higher) {
                fail_msg("%s, %d digits: order %d of %d, %d of %d", base->name, digit_counts[k], told, whole,
                         jumped, higher);
            }
        }
    }
    assert_true(bases > 20);
    /* and one that is wrong is still seen: beside exact rows in the last place, beside others in the 15th */
    static const char *const wrong[] = {
        "composition(rk4; 0.333333333333333333, 0.666666666666666669)",
        "composition(gauss4; 0.333333333333333333, 0.666666666666700000)",
        "composition(pefrl4; 0.333333333333, 0.666666666669)",
        "explicit(0, 0 | 1, 0; 0.5, 0.500000000000000001)",
    };
    for (size_t i = 0; i < GM_COUNT(wrong); i++) {
        const struct gm_scheme *own = open_user(wrong[i]);
        if (gm_scheme_theory(own).order != 0) {
            fail_msg("%s: order %d", wrong[i], gm_scheme_theory(own).order);
        }
        gm_user_scheme_close(own);
    }
}

/* Compositions that stretch phase space a thousandfold, and orders beyond what errors show: measured as far
   as that goes, and what theory proves is not refuted by what cannot be seen. */
static void honest(void **unused)
{
    (void)unused;
    static const struct {
        const char *text;
        bool holds;
    } schemes[] = {
        {"composition(verlet; 2, -3, 2)", true},
        {"composition(verlet; 2.5, -4, 2.5)", true},
        {"composition(verlet; 5, -9, 5)", true},
        {"composition(gauss4; 5, -9, 5)", true},
        {"composition(trapezoidal; 3, -5, 3; claims: symplectic)", false},
        {"composition(rk4; 5, -9, 5; claims: symplectic)", false},
        {"composition(rk4; 5, -9, 5; claims: symmetric)", false},
        {"splitting(10, -20, 11; 5, -9, 5; claims: symmetric)", false},
        {"composition(verlet; 2, -3, 2; order: 3)", false},
    };
    for (size_t i = 0; i < GM_COUNT(schemes); i++) {
        const struct gm_scheme *own = open_user(schemes[i].text);
        if (gm_certify(own).holds != schemes[i].holds) {
            fail_msg("%s %s", schemes[i].text, schemes[i].holds ? "is called broken" : "is let through");
        }
        gm_user_scheme_close(own);
    }
}

/* Thirty-two steps of RK4 have 128 stages: polynomials and sums of a composition take no longer than its
   parts. */
static void long_compositions(void **unused)
{
    (void)unused;
    char text[1000];
    size_t used = (size_t)sprintf(text, "composition(rk4; 1/8");
    for (int i = 1; i < 8; i++) {
        used += (size_t)sprintf(text + used, ", 1/8");
    }
    sprintf(text + used, ")");
    const struct gm_scheme *own = open_user(text);
    const struct gm_theory theory = gm_scheme_theory(own);
    assert_true(theory.order == 4 && theory.stability.known && !theory.stability.a_stable);
    assert_float_equal(theory.stability.real, 8 * 2.78529356340528, 1e-6);
    assert_float_equal(theory.stability.imaginary, 8 * 2 * sqrt(2), 1e-6);
    gm_user_scheme_close(own);
    used = (size_t)sprintf(text, "composition(rk4; 1/64");
    for (int i = 1; i < 64; i++) {
        used += (size_t)sprintf(text + used, ", 1/64");
    }
    sprintf(text + used, ")");
    const struct gm_scheme *longer = open_user(text);
    assert_int_equal(longer->order, 4);
    gm_user_scheme_close(longer);
}

/* ---- Nystrom ---- */

#define NYSTROM5(second)                                                                                     \
    "nystrom(0,0,0,0 | 1/50,0,0,0 | -1/27," second                                                           \
    ",0,0 | 3/10,-2/35,9/35,0; 14/336,100/336,54/336,0; 14/336,125/336,162/336,35/336; 0,1/5,2/3,1)"

static void nystrom(void **unused)
{
    (void)unused;
    static const struct {
        const char *text;
        int order;
        bool symplectic, symmetric;
    } schemes[] = {
        {NYSTROM5("7/27"), 5, false, false},
        {NYSTROM5("-7/27"), 2, false, false}, /* a sign lost: a_ij stand in the conditions from order 3 on */
        /* Nystrom's method of order 4 */
        {"nystrom(0,0,0 | 1/8,0,0 | 0,1/2,0; 1/6,1/3,0; 1/6,2/3,1/6; 0,1/2,1)", 4, false, false},
        /* Verlet's method in this form, and its weights exchanged */
        {"nystrom(0,0 | 1/2,0; 1/2,0; 1/2,1/2; 0,1)", 2, true, true},
        {"nystrom(0,0 | 1/2,0; 0,1/2; 1/2,1/2; 0,1)", 2, false, false},
        /* Gauss's method of order 4 for q'' = g(q): its a squared */
        {"nystrom(let: s = sqrt(3); 1/24, 1/8 - s/12 | 1/8 + s/12, 1/24; 1/4 + s/12, 1/4 - s/12; 1/2, 1/2; "
         "1/2 - s/6, 1/2 + s/6)",
         4, true, true},
    };
    for (size_t i = 0; i < GM_COUNT(schemes); i++) {
        const struct gm_scheme *own = open_user(schemes[i].text);
        const struct gm_theory theory = gm_scheme_theory(own);
        if (theory.order != schemes[i].order || theory.symplectic != schemes[i].symplectic ||
            theory.symmetric != schemes[i].symmetric || !gm_certify(own).holds) {
            fail_msg("%s: order %d (%s), symplectic %d, symmetric %d", schemes[i].text, theory.order,
                     theory.condition, theory.symplectic, theory.symmetric);
        }
        gm_user_scheme_close(own);
    }
    /* they make the steps of the methods that they are */
    const struct gm_problem *henon = &gm_problem_henon_heiles;
    equal_walks(schemes[3].text, "verlet", henon, 1e-14);
    equal_walks(schemes[5].text, "gauss4", henon, 1e-14);
    equal_walks(schemes[3].text, "verlet", &gm_problem_pendulum, 1e-14);
    equal_walks("adjoint(adjoint(" NYSTROM5("7/27") "))", NYSTROM5("7/27"), henon, 1e-14);
    const struct gm_scheme *turned = open_user("adjoint(" NYSTROM5("7/27") ")");
    assert_true(turned->order == 5 && gm_certify(turned).holds);
    gm_user_scheme_close(turned);
}

#define VERLET_AS_NYSTROM "nystrom(0,0 | 1/2,0; 1/2,0; 1/2,1/2; 0,1)"
#define GAUSS4_AS_NYSTROM                                                                                    \
    "nystrom(let: s = sqrt(3); 1/24, 1/8 - s/12 | 1/8 + s/12, 1/24; 1/4 + s/12, 1/4 - s/12; 1/2, 1/2; "      \
    "1/2 - s/6, 1/2 + s/6)"
#define TRIPLE_JUMP(base, order) "composition(" base "; let: g = 1/(2 - 2^(1/" order ")); g, 1 - 2*g, g)"

/* Compositions of Nystrom methods have the theory of what they equal. */
static void nystrom_compositions(void **unused)
{
    (void)unused;
    static const struct {
        const char *text, *equals; /* a splitting for quadratic T, or NULL */
        int order;
        bool symplectic, symmetric;
    } schemes[] = {
        {TRIPLE_JUMP(VERLET_AS_NYSTROM, "3"), TRIPLE_JUMP("verlet", "3"), 4, true, true},
        {TRIPLE_JUMP(TRIPLE_JUMP(VERLET_AS_NYSTROM, "3"), "5"), NULL, 6, true, true},
        {TRIPLE_JUMP(GAUSS4_AS_NYSTROM, "5"), NULL, 6, true, true},
        {TRIPLE_JUMP(GAUSS4_AS_NYSTROM, "3"), NULL, 4, true, true}, /* the root that order 2 has */
        {"composition(" VERLET_AS_NYSTROM "; 1/2, 1/4, 1/4)", "composition(verlet; 1/2, 1/4, 1/4)", 2, true,
         false},
        {"composition(" VERLET_AS_NYSTROM "; 1.35120719195966, -1.70241438391932, 1.35120719195966)", NULL, 4,
         true, true},
        {"composition(" VERLET_AS_NYSTROM "; 1.35120719295966, -1.70241438591932, 1.35120719295966)", NULL, 2,
         true, true},
        {"composition(" NYSTROM5("7/27") "; 1/2, 1/2)", NULL, 5, false, false},
        {"adjoint(composition(" NYSTROM5("7/27") "; 1/3, 2/3))", NULL, 5, false, false},
        /* with bases of other kinds that are the same for a quadratic T */
        {"composition(verlet, " VERLET_AS_NYSTROM "; 1/4, 1/2, 1/8, 1/8)",
         "composition(verlet; 1/4, 1/2, 1/8, 1/8)", 2, true, false},
        {"composition(gauss4, " GAUSS4_AS_NYSTROM ", gauss4; let: g = 1/(2 - 2^(1/5)); g, 1 - 2*g, g)", NULL,
         6, true, true},
        {"composition(lobatto2, " VERLET_AS_NYSTROM ", verlet; let: g = 1/(2 - 2^(1/3)); g, 1 - 2*g, g)",
         NULL, 4, true, true},
        {"composition(rk4, " VERLET_AS_NYSTROM "; 1/2, 1/2)", NULL, 2, false, false},
        /* no identity up to h^2: a processor that costs an order, which is measured too */
        {"processed(" VERLET_AS_NYSTROM "; nystrom(0; 1/4; 1/2; 1/2))", NULL, 1, true, false},
    };
    for (size_t i = 0; i < GM_COUNT(schemes); i++) {
        const struct gm_scheme *own = open_user(schemes[i].text);
        const struct gm_theory theory = gm_scheme_theory(own);
        if (!theory.known || theory.order != schemes[i].order || theory.symplectic != schemes[i].symplectic ||
            theory.symmetric != schemes[i].symmetric) {
            fail_msg("%s: order %d (%s), symplectic %d, symmetric %d", schemes[i].text, theory.order,
                     theory.condition, theory.symplectic, theory.symmetric);
        }
        if (schemes[i].equals) {
            const struct gm_scheme *other = open_user(schemes[i].equals);
            const struct gm_theory same = gm_scheme_theory(other);
            assert_true(same.order == theory.order && fabs(same.residual - theory.residual) < 1e-14);
            assert_string_equal(same.condition, theory.condition);
            gm_user_scheme_close(other);
        }
        gm_user_scheme_close(own);
    }
    const struct gm_scheme *wrong =
        open_user("composition(" VERLET_AS_NYSTROM
                  "; order: 4; 1.35120719295966, -1.70241438591932, 1.35120719295966)");
    assert_false(gm_certify(wrong).holds);
    gm_user_scheme_close(wrong);
}

/* ---- orders 9, 10 and beyond ---- */

static void high_orders(void **unused)
{
    (void)unused;
    static const struct {
        const char *text;
        int order;
        bool at_least;
        const char *condition;
    } schemes[] = {
        {radau9, 9, false, NULL},
        {gauss10, 10, false, "B(11)"},
        {gauss12, 12, false, "B(13)"}, /* by B(12), C(6), D(6) */
        {TRIPLE_JUMP("gauss6", "7"), 8, false, NULL},
        {TRIPLE_JUMP("gauss8", "9"), 10, false, NULL},
        {TRIPLE_JUMP("gauss8", "7"), 8, false, NULL}, /* the root that order 6 has */
        {TRIPLE_JUMP("kahan-li8", "9"), 10, true, ""},
        {"adjoint(radau5)", 5, false, NULL},
    };
    for (size_t i = 0; i < GM_COUNT(schemes); i++) {
        const struct gm_scheme *own = open_user(schemes[i].text);
        const struct gm_theory theory = gm_scheme_theory(own);
        const char *condition = schemes[i].condition;
        if (theory.order != schemes[i].order || theory.at_least != schemes[i].at_least ||
            (condition && strcmp(theory.condition, condition) != 0)) {
            fail_msg("%.60s: order %d, at least %d (%s)", schemes[i].text, theory.order, theory.at_least,
                     theory.condition);
        }
        gm_user_scheme_close(own);
    }
}

/* Whether a claim of this order holds by theory. */
static bool may_claim(const char *text, int order)
{
    const struct gm_scheme *own = open_user(text);
    struct gm_scheme claiming = *own;
    claiming.order = order;
    const bool holds = gm_certify(&claiming).theory_holds;
    gm_user_scheme_close(own);
    return holds;
}

static void high_claims(void **unused)
{
    (void)unused;
    assert_true(may_claim(gauss10, 10));
    assert_false(may_claim(gauss10, 11));
    assert_true(may_claim(gauss12, 12));
    assert_false(may_claim(gauss12, 13));
    assert_false(may_claim(radau9, 10));
}

/* One more in the tenth decimal of each number of the tableau: its order is 9 or 10 no longer. */
static void wrong_tenth_digits(void **unused)
{
    (void)unused;
    static const struct {
        const char *text;
        int order;
    } schemes[] = {{radau9, 9}, {gauss10, 10}};
    for (size_t i = 0; i < GM_COUNT(schemes); i++) {
        char *text = strdup(schemes[i].text);
        int planted = 0;
        for (char *digits = strstr(text, "0."); digits; digits = strstr(digits + 2, "0.")) {
            char *digit = digits + 2 + 9;
            const char before = *digit;
            *digit = before == '9' ? '8' : (char)(before + 1);
            const struct gm_scheme *own = open_user(text);
            const struct gm_theory theory = gm_scheme_theory(own);
            if (theory.order >= schemes[i].order || theory.condition[0] == '\0') {
                fail_msg("order %d with %.20s", theory.order, digits);
            }
            gm_user_scheme_close(own);
            *digit = before;
            planted++;
        }
        assert_int_equal(planted, 30);
        free(text);
    }
}

/* ---- on one system ---- */

static double first(const void *data, const double *y, const double *memory)
{
    (void)memory;
    return (void)data, y[0] * y[0] + y[0];
}

static void on_a_system(void **unused)
{
    (void)unused;
    struct gm_problem problem = gm_problem_henon_heiles;
    problem.m = 1;
    const double start[4] = {0.1, -0.2, 0.3, 0.1};
    const struct gm_kept kept = {"first", first, NULL}; /* quadratic, and kept by nothing */
    const struct gm_certified_system system = {
        .problem = &problem, .start = start, .dt = 0.1, .kept = &kept, .kept_count = 1};
    const struct gm_certificate verlet = gm_certify_on(gm_scheme_find("verlet"), &system);
    assert_true(verlet.holds && fabs(verlet.order - 2) < 0.05 && verlet.claims[0].measured);
    assert_true(verlet.claims[4].measured && !verlet.claims[4].holds &&
                strcmp(verlet.claims[4].problem, "first") == 0);
    assert_true(!verlet.claims[5].measured && verlet.claims[5].reason);
    struct gm_scheme wrong = *gm_scheme_find("rk4");
    wrong.claims |= GM_SYMPLECTIC;
    assert_false(gm_certify_on(&wrong, &system).holds);
}

/* ---- polished ---- */

static void polished(void **unused)
{
    (void)unused;
    static const struct {
        const char *text;
        int order;
    } schemes[] = {
        {"composition(verlet; order: 4; 1.3512, -1.7024, 1.3512)", 4},
        {"composition(verlet; order: 4; let: g = 1.35120719; g, 1 - 2*g, g)", 4},
        {"runge-kutta(order: 4; claims: symplectic symmetric; 0.2500, -0.03868 | 0.53868, 0.2500; 0.5, 0.5)",
         4},
        {"splitting(order: 4; claims: symplectic; 0.6756, -0.17560, -0.1756, 0.6756; 1.3512, -1.7024, 1.3512)",
         4},
        /* c: follows, also that of a base; what is exact stays as it is written */
        {"runge-kutta(order: 4; 0.2500, -0.03868 | 0.53868, 0.2500; 0.5, 0.5; 0.21132, 0.7887)", 4},
        {"explicit(order: 3; let: g = 0.66667; 0, 0, 0 | 1/3, 0, 0 | 0, g, 0; 1/4, 0, 3/4; 0, 1/3, g)", 3},
        {"composition(runge-kutta(order: 4; claims: symplectic symmetric; 0.2500, -0.03868 | 0.53868, 0.2500; "
         "0.5, 0.5; 0.2113, 0.7887); order: 4; claims: symplectic symmetric; 1/2, 1/2)",
         4},
    };
    /* over rows of the program, which are exact or known to 15 digits, which those that are solved for are then */
    static const struct {
        const char *text, *polished;
        int order;
    } over_rows[] = {
        {"composition(rk4; order: 4; 0.3334, 0.6667)", "0.333349999999999999996", 4},
        {"composition(gauss4; order: 6; 1.1747, -1.3493, 1.1747)", "; 1.17467175808936, -1.34934351617873, ",
         6},
        {"composition(pefrl4; order: 6; 1.1747, -1.3493, 1.1747)", "; 1.17467175808936, -1.34934351617873, ",
         6},
    };
    for (size_t i = 0; i < GM_COUNT(over_rows); i++) {
        const struct gm_user_scheme_source source = {
            .text = over_rows[i].text, .length = strlen(over_rows[i].text), .name = "own", .bring = no_file};
        struct gm_polish polish;
        struct gm_fault fault;
        char *text = gm_user_scheme_polish(&source, &polish, &fault);
        if (!text || !strstr(text, over_rows[i].polished)) {
            fail_msg("%s: %s", over_rows[i].text, text ? text : fault.sentence);
        }
        const struct gm_scheme *own = open_user(text);
        assert_int_equal(gm_scheme_theory(own).order, over_rows[i].order);
        gm_user_scheme_close(own);
        free(text);
    }
    for (size_t i = 0; i < GM_COUNT(schemes); i++) {
        const struct gm_user_scheme_source source = {
            .text = schemes[i].text, .length = strlen(schemes[i].text), .name = "own", .bring = no_file};
        struct gm_polish polish;
        struct gm_fault fault;
        char *text = gm_user_scheme_polish(&source, &polish, &fault);
        if (!text) {
            fail_msg("%s: %s", schemes[i].text, fault.sentence);
        }
        assert_true(polish.before > 1e-9 && polish.after < 1e-45 && polish.change < 1e-3);
        const struct gm_scheme *own = open_user(text);
        const struct gm_theory theory = gm_scheme_theory(own);
        if (theory.order != schemes[i].order) {
            fail_msg("%s: order %d", text, theory.order);
        }
        gm_user_scheme_close(own);
        free(text);
    }
    static const char *const hopeless[][2] = {
        {"composition(verlet; order: 4; 0.50001, 0.49999)", "no coefficients near these"},
        {"composition(verlet; order: 2; 1/2, 1/2)", "nothing to polish"},
        {"composition(kahan2; 0.50001, 0.49999)", "theory knows no conditions"},
        {"composition(gauss4; order: 6; 0.5001, 0.4999)", "no coefficients near these"},
    };
    for (size_t i = 0; i < GM_COUNT(hopeless); i++) {
        const struct gm_user_scheme_source source = {
            .text = hopeless[i][0], .length = strlen(hopeless[i][0]), .name = "own", .bring = no_file};
        struct gm_polish polish;
        struct gm_fault fault;
        assert_null(gm_user_scheme_polish(&source, &polish, &fault));
        if (!strstr(fault.sentence, hopeless[i][1])) {
            fail_msg("%s: %s", hopeless[i][0], fault.sentence);
        }
    }
}

/* ---- what cannot be read ---- */

static void refusals(void **unused)
{
    (void)unused;
    static const struct {
        const char *text, *at, *sentence; /* `at`: the text from the place on */
    } wrong[] = {
        {"runge-kutta(1, 2; 1)", "1, 2;", "it is not square"},
        {"runge-kutta(1, 2 | 3; 1, 1)", "3; 1", "row 2 of a has 1 entries, the first has 2"},
        {"runge-kutta(1/2; 1, 1)", "1, 1)", "b has 2 entries; the rows of a make 1 stages"},
        {"runge-kutta(1/2; 1; 1/3)", "1/3)", "row 1 of a sums to 0.5, c says 0.333333333333333"},
        {"explicit(0, 1 | 1, 0; 1/2, 1/2)", "1 | 1", "entry 1, 2 is above the diagonal"},
        {"explicit(1/2; 1)", "1/2;", "entry 1, 1 is on the diagonal"},
        {"runge-kutta(1/0; 1)", "1/0", "no finite number"},
        {"runge-kutta(log(-1); 1)", "log", "not a number"},
        {"runge-kutta(1e300; 1)", "1e300", "no finite number"},
        {"runge-kutta(1/2; 1", "(1/2", "not closed"},
        {"runge-kutta(1/2; 1) x", " x", "ends before this"},
        {"runge-kutta(1/2)", "runge", "needs b:"},
        {"runge-kutta(1/2; 1; 1/2; 4)", "4)", "more between the parentheses"},
        {"runge-kutta(2x; 1)", "x; 1", "a product is written with *"},
        {"runge-kutta(tan(1); 1)", "tan", "coefficients are made of"},
        {"runge-kutta(s; 1)", "s; 1", "s"},
        {"runge-kutta(let: s = t; let: t = s; s; 1)", "s = t", "defined by itself"},
        {"runge-kutta(let: s = 1; let: s = 1; s; 1)", "s = 1; s;", "defined twice"},
        {"runge-kutta(let: sin = 1; 1/2; 1)", "sin", "reserved"},
        {"composition(verlet; 1, 1)", "1, 1)", "the steps sum to 2, not to 1"},
        {"composition(verlat; 1)", "verlat", "did you mean verlet"},
        {"composition(zabusky-kruskal; 1)", "zabusky-kruskal",
         "not a scheme for ordinary differential equations"},
        {"composition(tao2; 1)", "tao2", "cannot be a part"},
        {"composition(rk4, logh2; 1/2, 1/2)", "logh2", "cannot be a part of a step: it is adaptive"},
        {"processed(verlet; logh2)", "logh2", "cannot be a part"},
        {"composition(rk4, rk5; 1/2, 1/2)", "rk5", "there is no scheme \"rk5\""},
        {"composition(rk4, composition(verlet, rk5; 1/2, 1/2); 1/2, 1/2)", "rk5", "there is no scheme"},
        {"composition(rk4, verlet; 1/7, 1/7, 1/7, 1/7, 1/7, 1/7, 1/7)", "1/7, 1/7, 1/7, 1/7, 1/7, 1/7, 1/7)",
         "7 steps cannot be shared by 2 bases in turns"},
        {"composition(rk4, verlet; 1)", "1)", "1 step cannot be shared by 2 bases in turns"},
        {"composition(rk4, verlet; 0.4, 0.5)", "0.4", "the steps sum to 0.9, not to 1"},
        {"composition(rk4, ; 1/2, 1/2)", ", ;", "nothing follows this ,"},
        {"composition(rk4, , verlet; 1/4, 1/4, 1/2)", ", verlet", "there is no scheme"},
        {"composition(; 1)", "; 1", "there is no scheme"},
        {"adjoint(rk4, verlet)", "verlet)", "base: names one scheme"},
        {"processed(verlet, rk4; verlet)", "rk4", "kernel: names one scheme"},
        {"composition(./a.scheme; 1)", "./a", "could not be read"},
        {"adjoint(avf2)", "", ""}, /* symmetric: its own adjoint */
        {"splitting(1, 1, 1; 1)", "1)", "cannot take turns"},
        {"splitting(1/2, 1/4; 1)", "1/2", "the drifts sum to 0.75, not to 1"},
        {"splitting(1/2, 1/2; 2)", "2)", "the kicks sum to 2, not to 1"},
        {"runge-kutta(1/2; 2)", "2)", "the weights sum to 2, not to 1"},
        {"nystrom(0; 1/2; 2; 0)", "2; 0", "the weights sum to 2, not to 1"},
        {"nystrom(0; 1/2; 1)", "nystrom", "needs c:"},
        {"nystrom(0; 1/2; 1, 1; 0)", "1, 1", "bv has 2 entries"},
        {"composition(verlet; 1/2, 1/2,)", ",)", "nothing follows this ,"},
        {"runge-kutta(1/2 |; 1)", "|", "nothing follows this |"},
        {"runge-kutta(kind: explicit; 1/2; 1)", "explicit",
         "the word says that it is of the kind runge-kutta"},
        {"runge-kutta(1/1000000000000000000000000000000000000000000000000000000000000000000000000000000000; 1)",
         "10000", "at most 77 digits"},
        {"splitting(1, 1; 1; first: kick)", "kick", "a drift is first"},
        {"splitting(1; 1; for: fun)", "fun", "for: is nystrom"},
        {"runge-kutta(order: 99; 1/2; 1)", "99", "from 1 to 20"},
        {"runge-kutta(claims: symplectik; 1/2; 1)", "symplectik", "a claim was expected"},
        {"runge-kutta(claims: symplectic symplectik; 1/2; 1)", "symplectik", "a claim was expected"},
        {"runge-kutta(steps: 1; 1/2; 1)", "1; 1/2", "has no steps:"},
        {"runge-kutta(oder: 1; 1/2; 1)", "oder", "did you mean order"},
        {"geomint: 1\na: 1/2\nb: 1\n", "geomint", "what kind of scheme"},
        {"kind: runge-cutta\na: 1/2\nb: 1\n", "runge-cutta", "did you mean runge-kutta"},
        {"kind: explicit\nkind: explicit\n", "kind: explicit\n", "given twice"},
        {"geomint: 2\nkind: runge-kutta\na: 1/2\nb: 1\n", "2\nkind", "later format"},
        {"kind: runge-kutta\na:\nb: 1\n", "\nb: 1", "has no value"},
        {"kind: runge-kutta\na: 1/2\nb: \033[31m1\n", "\033", ""},
        {"kind: runge-kutta\ntitle: [f(a)) b\na: 1/2\nb: 1\n", "[f(a)) b", "closes its parentheses"},
        {"kind: runge-kutta\ntitle: a; b\na: 1/2\nb: 1\n", "a; b", "no semicolon"},
        {"kind: runge-kutta\ntitle: Kutta]s\na: 1/2\nb: 1\n", "Kutta]s",
         "closes its parentheses and brackets"},
        {"nonsense", "", "a line needs a word and a colon"},
    };
    for (size_t i = 0; i < GM_COUNT(wrong); i++) {
        struct gm_fault fault;
        const struct gm_scheme *own = open_text(wrong[i].text, &fault);
        const char *at = wrong[i].text + fault.offset;
        if (!wrong[i].at[0] && !wrong[i].sentence[0]) {
            assert_non_null(own);
        } else if (own || strncmp(at, wrong[i].at, strlen(wrong[i].at)) != 0 ||
                   !strstr(fault.sentence, wrong[i].sentence)) {
            fail_msg("%s: at \"%s\": %s", wrong[i].text, own ? "" : at, own ? "it was made" : fault.sentence);
        }
        if (own) {
            gm_user_scheme_close(own);
        }
    }
}

/* A million entries are refused at the seventeenth. */
static void large(void **unused)
{
    (void)unused;
    enum { ENTRIES = 400000 };
    static char text[2 * ENTRIES + 100];
    size_t used = (size_t)sprintf(text, "runge-kutta(0");
    for (int i = 0; i < ENTRIES; i++) {
        used += (size_t)sprintf(text + used, ",0");
    }
    sprintf(text + used, ";1)");
    struct gm_fault fault;
    assert_null(open_text(text, &fault));
    assert_string_equal(fault.sentence, "a scheme has at most 16 stages");
    assert_int_equal(fault.offset, strlen("runge-kutta(") + 32);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_row_retyped),
        cmocka_unit_test(many_stages),
        cmocka_unit_test(schemes_of_schemes),
        cmocka_unit_test(bases_in_turns),
        cmocka_unit_test(claims_in_turns),
        cmocka_unit_test(wrong_schemes),
        cmocka_unit_test(digits),
        cmocka_unit_test(digits_over_every_base),
        cmocka_unit_test(honest),
        cmocka_unit_test(long_compositions),
        cmocka_unit_test(nystrom),
        cmocka_unit_test(nystrom_compositions),
        cmocka_unit_test(high_orders),
        cmocka_unit_test(high_claims),
        cmocka_unit_test(wrong_tenth_digits),
        cmocka_unit_test(on_a_system),
        cmocka_unit_test(polished),
        cmocka_unit_test(refusals),
        cmocka_unit_test(large),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
