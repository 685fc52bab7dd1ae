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
#include <gsl/gsl_eigen.h>
#include <gsl/gsl_sf_elljac.h>

#include "core/basics.h"
#include "core/expression/derivative.h"
#include "core/kind.h"
#include "core/model/equations.h"
#include "core/ode/kernel/loops.h"
#include "core/ode/user/problem.h"
#include "core/run.h"
#include "core/schemes.h"
#include "core/theory/certify.h"
#include "tests/problems/problems.h"

enum { MOST = 12 };

/* Four spins in a ring, each turned by its neighbours. */
#define SPINS                                                                                                \
    "components: x[1..4] y[1..4] z[1..4]\n"                                                                  \
    "bracket: i = 1 .. 4; x[i] y[i] = z[i], y[i] z[i] = x[i], z[i] x[i] = y[i]\n"                            \
    "H: -sum(i = 1 .. 4, x[i]*x[mod(i, 4) + 1] + y[i]*y[mod(i, 4) + 1] + 0.7*z[i]*z[mod(i, 4) + 1])\n"       \
    "casimir: i = 1 .. 4; length[i] = x[i]^2 + y[i]^2 + z[i]^2\n"                                            \
    "start: x[i] = 0.3*i, y[i] = 1 - 0.4*i, z[i] = 0.2*i\n"

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
    {"spins", SPINS, true},
};
enum { SYSTEMS = GM_COUNT(systems) };

struct typed {
    struct gm_user_system system;
    struct gm_user_model model;
    struct gm_problem problem;
    double *start, *values;
    gm_node_id gradient[MOST + 8];
};

static void type_words(struct typed *typed, const char *name, const char *text)
{
    struct gm_fault fault;
    bool marked[MOST + 8] = {0};
    struct gm_user_system *system = &typed->system;
    if (!gm_equations_open(system, text, strlen(text), NULL, 0, &fault)) {
        fail_msg("%s: %s", name, fault.sentence);
    }
    typed->start = gm_equations_start(system, NULL);
    assert_true(gm_user_model_open(&typed->model, system));
    assert_true(gm_user_problem_open(&typed->problem, &typed->model, typed->start));
    for (size_t i = 0; i < system->n; i++) {
        marked[i] = true;
    }
    assert_true(system->jacobi == GM_ZERO_PROVED && system->n <= MOST);
    assert_true(gm_gradient(&system->graph, system->energy, marked, system->n, typed->gradient));
    typed->values = malloc(system->graph.count * sizeof *typed->values);
    assert_true(typed->start && typed->values);
}

static void type(struct typed *typed, int which)
{
    type_words(typed, systems[which].name, systems[which].text);
}

static void untype(struct typed *typed)
{
    gm_user_problem_close(&typed->problem);
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
        const struct gm_user_system *system = &typed.system;
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
        const struct gm_user_system *system = &typed.system;
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
            const bool turns = scheme->needs & (GM_NEEDS_ROTATIONS | GM_NEEDS_AXES | GM_NEEDS_FREE_BODY |
                                                GM_NEEDS_GROUP | GM_NEEDS_PIECES),
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
    static const char *const schemes[] = {
        "rotations2",        "spherical-midpoint2", "rkmk4",
        "crouch-grossman3",  "crouch-grossman4",    "discrete-moser-veselov2",
        "bracket-splitting2"};
    static const struct gm_settings settings = {0};
    static const char backwards[] =
        "components: x y z\nbracket: x y = z\nbracket: y z = x\nbracket: z x = y\n"
        "H: (x^2/2 + y^2 + 1.5*z^2)/2\nstart: x = 0.9, y = 0.5, z = -0.7\n";
    struct gm_user_system system;
    struct gm_user_model model;
    struct gm_problem back;
    struct gm_fault fault;
    assert_true(gm_equations_open(&system, backwards, strlen(backwards), NULL, 0, &fault));
    double *start = gm_equations_start(&system, NULL);
    assert_true(start && gm_user_model_open(&model, &system) && gm_user_problem_open(&back, &model, start));
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
        const double energy =
            gm_ode_of(forth)->poisson->energy(forth, y) - gm_ode_of(forth)->poisson->energy(forth, start);
        assert_true(!(scheme->claims & GM_KEEPS_ENERGY) || fabs(energy) < 1e-12);
        gm_run_close(a);
        gm_run_close(b);
    }
    free(start);
    gm_user_problem_close(&back);
    gm_system_close(&system);
}

/* Inertia (1, 2, 3), faster about the third axis than about the second: L.D. Landau & E.M. Lifshitz, Mechanics
   (1976), section 37. */
static void by_elliptic_functions(double t, double energy, double square, double *y)
{
    const double I[3] = {1, 2, 3}, low = 2 * energy * I[2] - square, high = square - 2 * energy * I[0];
    const double rate = sqrt((I[2] - I[1]) * high / (I[0] * I[1] * I[2]));
    double sn, cn, dn;
    gsl_sf_elljac_e(rate * t, (I[1] - I[0]) * low / ((I[2] - I[1]) * high), &sn, &cn, &dn);
    y[0] = I[0] * sqrt(low / (I[0] * (I[2] - I[0]))) * cn;
    y[1] = I[1] * sqrt(low / (I[1] * (I[2] - I[1]))) * sn;
    y[2] = I[2] * sqrt(high / (I[2] * (I[2] - I[0]))) * dn;
}

static double error_of(const struct gm_problem *problem, const struct gm_scheme *scheme, double dt,
                       long steps, const double *start, const double *end)
{
    static const struct gm_settings settings = {0};
    double error = 0;
    struct gm_run *run = gm_run_open(problem, scheme, &settings, 0, dt, start);
    assert_non_null(run);
    assert_int_equal(gm_run_advance(run, steps), GM_OK);
    for (size_t i = 0; i < problem->n; i++) {
        error = fmax(error, fabs(gm_run_state(run)[i] - end[i]));
    }
    gm_run_close(run);
    return error;
}

static void bodies_by_elliptic_functions(void **unused)
{
    (void)unused;
    static const char *const schemes[] = {
        "rotations2",          "spherical-midpoint2", "rkmk4",
        "crouch-grossman3",    "crouch-grossman4",    "discrete-moser-veselov2",
        "energy-collocation2", "energy-collocation4", "midpoint",
        "bracket-splitting2",  "bracket-splitting4",  "bracket-splitting6"};
    static const char text[] = "components: x y z\nbracket: x y = -z\nbracket: y z = -x\nbracket: z x = -y\n"
                               "H: (x^2 + y^2/2 + z^2/3)/2\nstart: x = 0.8, y = 0, z = 1.5\n";
    struct typed typed;
    type_words(&typed, "a body of three moments", text);
    double exact[3], start[3];
    by_elliptic_functions(0, (0.64 + 0.75) / 2, 0.64 + 2.25, start);
    by_elliptic_functions(10, (0.64 + 0.75) / 2, 0.64 + 2.25, exact);
    assert_true(fabs(start[0] - 0.8) < 1e-15 && start[1] == 0 && fabs(start[2] - 1.5) < 1e-15);
    for (size_t i = 0; i < GM_COUNT(schemes); i++) {
        const struct gm_scheme *scheme = gm_scheme_find(schemes[i]);
        assert_true(gm_scheme_fits(scheme, &typed.problem));
        const double coarse = error_of(&typed.problem, scheme, 0.1, 100, start, exact),
                     fine = error_of(&typed.problem, scheme, 0.05, 200, start, exact),
                     slope = log2(coarse / fine);
        if (!(fabs(slope - scheme->order) < 0.2)) {
            fail_msg("%s: slope %.2f, errors %.2e and %.2e", schemes[i], slope, coarse, fine);
        }
    }
    untype(&typed);
}

/* The top of these moments, its weight 1: bracket and energy are those of the system in share/systems. */
static const char top[] =
    "components: a b c u v w\nparameter: I1 = 1\nparameter: I3 = 0.5\n"
    "bracket: a b = -c\nbracket: b c = -a\nbracket: c a = -b\nbracket: a v = -w\n"
    "bracket: b u = w\nbracket: b w = -u\nbracket: c v = u\nbracket: c u = -v\nbracket: a w = v\n"
    "H: (a^2 + b^2)/(2*I1) + c^2/(2*I3) + w\n"
    "start: a = 0, b = 0, c = 1, u = 0.6, v = 0, w = 0.8\n";

static double vertical(const void *data, const double *y, const double *memory)
{
    (void)memory;
    (void)data;
    return y[0] * y[3] + y[1] * y[4] + y[2] * y[5];
}

static double upright(const void *data, const double *y, const double *memory)
{
    (void)memory;
    (void)data;
    return y[3] * y[3] + y[4] * y[4] + y[5] * y[5];
}

/* Steady precession: the axis goes round at a constant tilt, I1 P^2 cos(tilt) + 1 = I3 spin P. */
static void tops_precess(void **unused)
{
    (void)unused;
    static const struct gm_settings settings = {0};
    const double I1 = 1, I3 = 0.5, tilt = 1, P = 0.7, spin = (I1 * P * P * cos(tilt) + 1) / (I3 * P);
    const double start[6] = {I1 * P * sin(tilt), 0, I3 * spin, sin(tilt), 0, cos(tilt)};
    struct typed typed;
    type_words(&typed, "top", top);
    const struct gm_scheme *scheme = gm_scheme_find("rotations2");
    assert_true(gm_scheme_fits(scheme, &typed.problem));
    assert_false(gm_scheme_fits(gm_scheme_find("spherical-midpoint2"), &typed.problem));
    assert_false(gm_scheme_fits(gm_scheme_find("discrete-moser-veselov2"), &typed.problem));
    double errors[3];
    for (int finer = 0; finer < 3; finer++) {
        const long steps = 500 << finer;
        struct gm_run *run = gm_run_open(&typed.problem, scheme, &settings, 0, 0.1 / (1 << finer), start);
        assert_non_null(run);
        double angle = 0;
        for (long n = 0; n < steps; n++) {
            const double *y = gm_run_state(run);
            angle += (y[0] * y[3] + y[1] * y[4]) / (I1 * (y[3] * y[3] + y[4] * y[4])) / (double)steps;
            assert_int_equal(gm_run_advance(run, 1), GM_OK);
        }
        errors[finer] = fabs(angle - P);
        gm_run_close(run);
    }
    if (!(fabs(log2(errors[0] / errors[1]) - 2) < 0.1 && fabs(log2(errors[1] / errors[2]) - 2) < 0.1)) {
        fail_msg("the rate errs by %g, %g, %g", errors[0], errors[1], errors[2]);
    }
    untype(&typed);
}

/* M := the derivative of a step over a, b, u, v at the top that sleeps, by differences that are extrapolated */
static void derive(const struct gm_problem *problem, double dt, const double *sleeping, double *M)
{
    static const int moved[] = {0, 1, 3, 4};
    static const struct gm_settings settings = {0};
    memset(M, 0, 16 * sizeof *M);
    for (int k = 0; k < 4; k++) {
        for (int finer = 0; finer < 2; finer++) {
            for (int sign = -1; sign <= 1; sign += 2) {
                const double push = 3e-4 / (1 + finer),
                             weight = (finer ? 4. / 3 : -1. / 3) * sign / (2 * push);
                double y[6];
                memcpy(y, sleeping, sizeof y);
                y[moved[k]] += sign * push;
                struct gm_run *run = gm_run_open(problem, gm_scheme_find("rotations2"), &settings, 0, dt, y);
                assert_non_null(run);
                assert_int_equal(gm_run_advance(run, 1), GM_OK);
                for (int i = 0; i < 4; i++) {
                    M[4 * i + k] += weight * gm_run_state(run)[moved[i]];
                }
                gm_run_close(run);
            }
        }
    }
}

/* Whether a step from nearby leads away. */
static bool falls(const struct gm_problem *problem, double dt, double spin)
{
    const double sleeping[6] = {0, 0, 0.5 * spin, 0, 0, 1};
    double M[16], largest = 0;
    derive(problem, dt, sleeping, M);
    gsl_matrix_view view = gsl_matrix_view_array(M, 4, 4);
    gsl_vector_complex *values = gsl_vector_complex_alloc(4);
    gsl_eigen_nonsymm_workspace *workspace = gsl_eigen_nonsymm_alloc(4);
    assert_int_equal(gsl_eigen_nonsymm(&view.matrix, values, workspace), 0);
    for (size_t i = 0; i < 4; i++) {
        const gsl_complex value = gsl_vector_complex_get(values, i);
        largest = fmax(largest, hypot(GSL_REAL(value), GSL_IMAG(value)));
    }
    gsl_eigen_nonsymm_free(workspace);
    gsl_vector_complex_free(values);
    return largest > 1 + 1e-5;
}

/* A top sleeps upright while 4 I1 < I3^2 spin^2, here while it spins faster than 4. */
static void tops_sleep(void **unused)
{
    (void)unused;
    struct typed typed;
    double errors[3];
    type_words(&typed, "top", top);
    for (int finer = 0; finer < 3; finer++) {
        double slow = 3, fast = 5;
        const double dt = 0.2 / (1 << finer);
        assert_true(falls(&typed.problem, dt, slow) && !falls(&typed.problem, dt, fast));
        while (fast - slow > 1e-8) {
            const double spin = (slow + fast) / 2;
            *(falls(&typed.problem, dt, spin) ? &slow : &fast) = spin;
        }
        errors[finer] = fabs(slow - 4);
    }
    if (!(fabs(log2(errors[0] / errors[1]) - 2) < 0.1 && fabs(log2(errors[1] / errors[2]) - 2) < 0.1)) {
        fail_msg("the threshold errs by %g, %g, %g", errors[0], errors[1], errors[2]);
    }
    untype(&typed);
}

static void advance(const struct typed *typed, const char *name, double dt, long steps, double *end)
{
    static const struct gm_settings settings = {0};
    const struct gm_scheme *scheme = gm_scheme_find_for(name, &typed->problem);
    assert_true(scheme && gm_scheme_fits(scheme, &typed->problem));
    struct gm_run *run = gm_run_open(&typed->problem, scheme, &settings, 0, dt, typed->start);
    assert_non_null(run);
    assert_int_equal(gm_run_advance(run, steps), GM_OK);
    memcpy(end, gm_run_state(run), typed->problem.n * sizeof *end);
    gm_run_close(run);
}

static double apart(const double *a, const double *b, size_t n)
{
    double largest = 0;
    for (size_t i = 0; i < n; i++) {
        largest = fmax(largest, isfinite(a[i]) ? fabs(a[i] - b[i]) : INFINITY);
    }
    return largest;
}

/* Orders of all that fit where several are turned at once, and what motions of space keep: against Gauss' method. */
static void groups_act(void **unused)
{
    (void)unused;
    static const struct {
        const char *text, *name;
        int order;
    } rows[] = {{SPINS, "spherical-midpoint2", 2}, {SPINS, "rkmk4", 4},
                {SPINS, "crouch-grossman3", 3},    {SPINS, "crouch-grossman4", 4},
                {SPINS, "bracket-splitting2", 2},  {SPINS, "bracket-splitting4", 4},
                {SPINS, "bracket-splitting6", 6},  {top, "rkmk4", 4},
                {top, "crouch-grossman3", 3},      {top, "crouch-grossman4", 4},
                {top, "bracket-splitting2", 2},    {top, "bracket-splitting4", 4},
                {top, "bracket-splitting6", 6}};
    for (size_t i = 0; i < GM_COUNT(rows); i++) {
        struct typed typed;
        double exact[MOST], end[MOST], errors[2];
        type_words(&typed, rows[i].name, rows[i].text);
        const size_t n = typed.problem.n;
        advance(&typed, "gauss8", 0.01, 200, exact);
        for (int finer = 0; finer < 2; finer++) {
            advance(&typed, rows[i].name, 0.1 / (1 + finer), 20 * (1 + finer), end);
            errors[finer] = apart(end, exact, n);
        }
        if (!(fabs(log2(errors[0] / errors[1]) - rows[i].order) < 0.35)) {
            fail_msg("%s: errors %.2e and %.2e", rows[i].name, errors[0], errors[1]);
        }
        /* short steps, and some that turn by more than a radian */
        for (int longer = 0; longer < 2; longer++) {
            advance(&typed, rows[i].name, longer ? 0.4 : 0.01, 20000, end);
            for (size_t k = 0; k < n / 3 && n > 6; k++) {
                const double *y = typed.start;
                const double before = y[k] * y[k] + y[4 + k] * y[4 + k] + y[8 + k] * y[8 + k],
                             after = end[k] * end[k] + end[4 + k] * end[4 + k] + end[8 + k] * end[8 + k];
                assert_true(fabs(after - before) < 1e-12);
            }
            if (n == 6) {
                assert_true(fabs(upright(NULL, end, NULL) - upright(NULL, typed.start, NULL)) < 1e-12);
                assert_true(fabs(vertical(NULL, end, NULL) - vertical(NULL, typed.start, NULL)) < 1e-12);
            }
        }
        untype(&typed);
    }
}

/* The spherical midpoint rule keeps the sum of spins that turn one another, as it does every linear law. */
static void spins_keep_their_sum(void **unused)
{
    (void)unused;
    struct typed typed;
    double end[MOST];
    type(&typed, SYSTEMS - 1);
    advance(&typed, "spherical-midpoint2", 0.1, 10000, end);
    double before = 0, after = 0;
    for (int i = 0; i < 4; i++) {
        before += typed.start[8 + i];
        after += end[8 + i];
    }
    assert_true(fabs(after - before) < 1e-12);
    untype(&typed);
}

/* What a splitting is where its flows are known: rotations, Verlet's kicks and drifts, exponentials. */
static void pieces_are_exact(void **unused)
{
    (void)unused;
    struct typed typed, canonical;
    double one[MOST], other[MOST];
    type(&typed, 0);
    advance(&typed, "bracket-splitting2", 0.1, 100, one);
    advance(&typed, "rotations2", 0.1, 100, other);
    assert_true(apart(one, other, 3) < 1e-13);
    untype(&typed);
    type_words(&canonical, "a pendulum",
               "components: q p\nbracket: q p = 1\nH: p^2/2 - cos(q)\n"
               "start: q = 1, p = 0.5\n");
    advance(&canonical, "bracket-splitting2", 0.1, 100, one);
    double q = 1, p = 0.5;
    for (int n = 0; n < 100; n++) { /* q is the first piece, -cos(q), and so kicks come first */
        p -= 0.05 * sin(q);
        q += 0.1 * p;
        p -= 0.05 * sin(q);
    }
    assert_true(fabs(one[0] - q) < 1e-13 && fabs(one[1] - p) < 1e-13);
    untype(&canonical);
    type(&typed, 1);
    advance(&typed, "bracket-splitting2", 0.1, 100, one);
    double x = 2, y = 2;
    for (int n = 0; n < 100; n++) { /* H = x - log(x) + y - 2 log(y), {x, y} = -x y */
        y *= exp(0.05 * (x - 1));
        x *= exp(-0.1 * (y - 2));
        y *= exp(0.05 * (x - 1));
    }
    assert_true(fabs(one[0] - x) < 1e-12 && fabs(one[1] - y) < 1e-12);
    untype(&typed);
}

/* Where energies do not fall into pieces, or pieces are not linear, the splitting does not fit. */
static void what_has_no_pieces(void **unused)
{
    (void)unused;
    static const char *const texts[] = {
        "components: x y z\nbracket: x y = z, y z = x, z x = y\nH: x*y + z^2\nstart: x = 1, y = 1, z = 1\n",
        "components: x y\nbracket: x y = y^2\nH: x + y\nstart: x = 1, y = 1\n"};
    const struct gm_scheme *scheme = gm_scheme_find("bracket-splitting2");
    for (size_t i = 0; i < GM_COUNT(texts); i++) {
        struct typed typed;
        type_words(&typed, "no pieces", texts[i]);
        assert_false(gm_scheme_fits(scheme, &typed.problem));
        assert_non_null(strstr(gm_scheme_lacks(scheme, &typed.problem), "whose flows are exact"));
        untype(&typed);
    }
}

/* The exact pieces of a top make a Poisson map; RK4 that claims as much is refused. */
static void tops_are_certified(void **unused)
{
    (void)unused;
    struct typed typed;
    type_words(&typed, "top", top);
    typed.start[0] = 0.4;
    const struct gm_kept kept[] = {{"vertical", vertical, NULL}, {"upright", upright, NULL}};
    const struct gm_certified_system system = {
        .problem = &typed.problem, .start = typed.start, .dt = 0.1, .kept = kept, .kept_count = 2};
    struct gm_scheme scheme = *gm_scheme_find("rotations2");
    struct gm_certificate on = gm_certify_on(&scheme, &system);
    assert_true(on.holds && on.ladder.settled && fabs(on.order - 2) < 0.05);
    assert_true(on.claims[17].measured && on.claims[17].holds && on.claims[18].measured);
    struct gm_scheme wrong = *gm_scheme_find("rk4");
    wrong.claims = scheme.claims;
    on = gm_certify_on(&wrong, &system);
    assert_true(!on.holds && !on.claims[17].holds && !on.claims[18].holds);
    untype(&typed);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nodes_make_the_field), cmocka_unit_test(schemes_advance_them),
        cmocka_unit_test(bodies_turn),          cmocka_unit_test(bodies_by_elliptic_functions),
        cmocka_unit_test(tops_precess),         cmocka_unit_test(tops_sleep),
        cmocka_unit_test(tops_are_certified),   cmocka_unit_test(groups_act),
        cmocka_unit_test(spins_keep_their_sum), cmocka_unit_test(pieces_are_exact),
        cmocka_unit_test(what_has_no_pieces),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
