/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Potentials that somebody wrote, on moving meshes: means by Gauss's formula against those of closed form, and the
   claims of schemes on them. */
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
#include "core/files/files.h"
#include "core/linear/banded.h"
#include "core/mesh/certify/subject.h"
#include "core/mesh/families/families.h"
#include "core/mesh/user/potential.h"
#include "core/model/equations.h"
#include "core/run.h"
#include "core/schemes.h"
#include "core/theory/certify.h"
#include "core/user/line.h"
#include "tests/common/mesh_soliton.h"

static const struct gm_settings settings = {0};

struct typed {
    struct gm_user_system system;
    struct gm_user_wave wave;
    struct gm_problem problem;
    struct gm_mesh mesh;
};

static void open_chosen(struct typed *typed, const char *text, const struct gm_user_mesh *chosen)
{
    struct gm_fault fault;
    if (!gm_equations_open(&typed->system, text, strlen(text), NULL, 0, &fault)) {
        fail_msg("%s: %s", text, fault.sentence);
    }
    assert_true(gm_user_wave_derive(&typed->wave, &typed->system));
    double *values = gm_equations_start(&typed->system, NULL);
    assert_true(gm_user_mesh_open(&typed->problem, &typed->wave, values, chosen));
    free(values);
    gm_moving_mesh_of(&typed->problem)->describe(&typed->problem, &typed->mesh);
}

static void open_typed(struct typed *typed, const char *text, double half_length, long points, double alpha)
{
    const struct gm_user_mesh chosen = {.first = -half_length,
                                        .length = 2 * half_length,
                                        .points = points,
                                        .alpha = alpha,
                                        .density = "arclength"};
    open_chosen(typed, text, &chosen);
}

static void close_typed(struct typed *typed)
{
    gm_user_line_close(&typed->problem);
    gm_system_close(&typed->system);
}

/* With a parameter the means are Gauss's: another value would make another potential. */
static const char sine_gordon[] =
    "field: u\nparameter: k = 1\nV: k*(1 - cos(u))\nlet: g = 1/sqrt(1 - 0.9^2)\n"
    "start: u = 4*atan(exp(g*x)), u_t = -1.8*g/cosh(g*x)\n";
static const char phi4[] = "field: u\nparameter: k = 1\nV: k*(u^2 - 1)^2/4\nlet: g = 1/sqrt(2*(1 - 0.5^2))\n"
                           "start: u = tanh(g*x), u_t = -0.5*g/cosh(g*x)^2\n";
static const char both[] = "field: u\nV: 1 - cos(u) + 4*(1 - cos(u/2))\nlet: g = sqrt(2)/sqrt(1 - 0.5^2)\n"
                           "start: u = 8*atan(exp(g*x)), u_t = -4*g/cosh(g*x)\n";

/* w and its derivatives over m and r of elements from flat to a whole soliton's rise */
static void means_are_those_of_closed_form(void **unused)
{
    (void)unused;
    static const struct {
        const char *text;
        const struct gm_potential *closed;
        size_t nodes;
    } list[] = {{sine_gordon, &gm_potential_sine_gordon, 10}, {phi4, &gm_potential_phi4, 3}};
    enum { COUNT = 400 }; /* more than are computed together */
    for (size_t i = 0; i < GM_COUNT(list); i++) {
        struct typed typed;
        open_typed(&typed, list[i].text, 12.5, 15, 2.5);
        assert_int_equal(gm_user_mesh_order(&typed.wave), list[i].nodes);
        double middle[COUNT], rise[COUNT], ours[3][COUNT], theirs[3][COUNT], farthest = 0;
        for (size_t k = 0; k < COUNT; k++) {
            middle[k] = 0.03 * (double)k - 3;
            rise[k] = k % 5 == 0 ? 0 : 3.2 * sin((double)k);
        }
        const struct gm_potential *own = typed.mesh.potential, *closed = list[i].closed;
        own->first(own, middle, rise, COUNT, ours[0], ours[1], ours[2]);
        closed->first(closed, middle, rise, COUNT, theirs[0], theirs[1], theirs[2]);
        for (size_t k = 0; k < COUNT; k++) {
            double second[2][3];
            own->second(own, middle[k], rise[k], &second[0][0], &second[0][1], &second[0][2]);
            closed->second(closed, middle[k], rise[k], &second[1][0], &second[1][1], &second[1][2]);
            const double scale = 1 + pow(fabs(middle[k]) + fabs(rise[k]), i == 1 ? 4 : 0);
            for (size_t c = 0; c < 3; c++) {
                farthest = fmax(farthest, fabs(ours[c][k] - theirs[c][k]) / scale);
                farthest = fmax(farthest, fabs(second[0][c] - second[1][c]) / scale);
            }
        }
        print_message("    means by %zu points: within %.1e of closed form\n", list[i].nodes, farthest);
        assert_true(farthest < 1e-14);
        close_typed(&typed);
    }
}

/* Potentials in u alone are recognised, however they are written. */
static void known_potentials_are_recognised(void **unused)
{
    (void)unused;
    static const struct {
        const char *potential;
        bool known;
    } list[] = {{"1 - cos(u)", true},           {"2*sin(u/2)^2", true}, {"(u^2 - 1)^2/4", false},
                {"u^4/4 - u^2/2 + 1/4", false}, {"-cos(u)", false},     {"(u^2 - 1)^2/2", false},
                {"k*(1 - cos(u))", false},      {"1 - cos(k*u)", false}};
    for (size_t i = 0; i < GM_COUNT(list); i++) {
        struct typed typed;
        char text[200];
        snprintf(text, sizeof text, "field: u\nparameter: k = 1\nV: %s\nstart: u = tanh(x), u_t = 0\n",
                 list[i].potential);
        open_typed(&typed, text, 6, 7, NAN);
        if (typed.wave.sine_gordon != list[i].known) {
            fail_msg("%s is taken for potential %d", list[i].potential, typed.wave.sine_gordon);
        }
        assert_int_equal(typed.mesh.potential == &gm_potential_sine_gordon, list[i].known);
        close_typed(&typed);
    }
}

/* Lines of a file: what the ends hold, the density, where the line begins, and how long the exact solution holds. */
static void lines_describe_the_mesh(void **unused)
{
    (void)unused;
    static const char text[] =
        "field: u\nparameter: k = 3\nhalf_length: 2*k; left 0\nV: u^2/2\nends: -k, 1\n"
        "alpha: k/2; steepest 2*k; bend 5*k\nexact: u = sin(x - t)\nexact-while: k - x - t; it has an end\n";
    struct typed typed;
    open_typed(&typed, text, 6, 7, NAN);
    const struct gm_mesh *mesh = &typed.mesh;
    assert_true(mesh->left == -3 && mesh->right == 1);
    const struct gm_mesh_names *names = gm_user_mesh_names(&typed.problem);
    assert_true(names->alpha == 1.5 && names->steepest == 6 && names->bend == 15);
    const struct gm_moving_mesh *moving = gm_moving_mesh_of(&typed.problem);
    const double within = moving->exact(typed.problem.parameters, 1, 1.5);
    assert_true(fabs(within - sin(-0.5)) < 1e-15);
    assert_true(isnan(moving->exact(typed.problem.parameters, 1, 2.5)));
    double *values = gm_equations_start(&typed.system, NULL);
    assert_true(values[typed.system.velocities - 2] == 6);
    free(values);
    close_typed(&typed);
}

/* Every node of the built-in soliton, which begins at 0 and not at -half_length. */
static void typed_again_the_soliton_is_the_same(void **unused)
{
    (void)unused;
    static const char *const names[] = {"multiplier-lobatto4", "multiplier-trapezoidal",
                                        "multiplier-adaptive4", "control-gauss4", "uniform-lobatto4"};
    for (int field = 0; field < 2; field++) {
        const struct gm_soliton soliton = {.field = field,
                                           .solitons = 1,
                                           .points = 15,
                                           .velocity = field == GM_PHI4 ? 0.5 : 0.9,
                                           .length = 25,
                                           .alpha = 2.5};
        struct gm_problem problem;
        struct gm_mesh mesh;
        struct typed typed;
        gm_soliton_problem(&soliton, &problem);
        gm_moving_mesh_of(&problem)->describe(&problem, &mesh);
        open_typed(&typed, field == GM_PHI4 ? phi4 : sine_gordon, 12.5, 15, 2.5);
        for (size_t i = 0; i < GM_COUNT(names); i++) {
            const struct gm_scheme *scheme = gm_scheme_find(names[i]);
            double state[2][60], farthest = 0;
            for (int side = 0; side < 2; side++) {
                const struct gm_problem *of = side ? &typed.problem : &problem;
                assert_true(gm_mesh_start(side ? &typed.mesh : &mesh, gm_scheme_mesh(scheme),
                                          gm_moving_mesh_of(of)->start, of->parameters, state[side]));
                struct gm_run *run = gm_run_open(of, scheme, &settings, 0, 0.01, state[side]);
                assert_int_equal(gm_run_advance(run, 500), GM_OK);
                memcpy(state[side], gm_run_state(run), sizeof state[side]);
                gm_run_close(run);
            }
            for (size_t k = 0; k < 30; k++) {
                const double shift = k < 15 ? 0 : 12.5;
                farthest = fmax(farthest, fabs(state[0][k] - state[1][k] - shift));
            }
            print_message("    %-24s after 500 steps: every node within %.1e\n", names[i], farthest);
            if (!(farthest < 1e-9)) { /* equations are solved to 1e-11, and the ends differ by 1e-12 */
                fail_msg("%s: %.3g", names[i], farthest);
            }
        }
        close_typed(&typed);
    }
}

static void open_built_in(struct typed *typed, const struct gm_soliton *soliton)
{
    const struct gm_built_in *file = gm_built_in_find(GM_FILE_SYSTEM, "soliton");
    char velocity[32], length[32];
    struct gm_fault fault;
    snprintf(velocity, sizeof velocity, "%.17g", soliton->velocity);
    snprintf(length, sizeof length, "%.17g", soliton->length);
    const struct gm_system_value given[] = {{"potential", soliton->field == GM_PHI4 ? "phi4" : "sine-gordon"},
                                            {"solitons", soliton->solitons == 2 ? "2" : "1"},
                                            {"velocity", velocity},
                                            {"length", length}};
    assert_non_null(file);
    assert_true(gm_equations_open(&typed->system, file->text, file->length, given, GM_COUNT(given), &fault));
    assert_true(gm_user_wave_derive(&typed->wave, &typed->system));
    double *values = gm_equations_start(&typed->system, NULL);
    const struct gm_user_mesh chosen = {.length = 2 * values[typed->system.velocities - 2],
                                        .points = soliton->points,
                                        .alpha = NAN,
                                        .density = gm_user_densities[soliton->density]};
    assert_true(gm_user_mesh_open(&typed->problem, &typed->wave, values, &chosen));
    free(values);
    gm_moving_mesh_of(&typed->problem)->describe(&typed->problem, &typed->mesh);
}

/* Returns the largest difference of two solutions over the line, from the start to a few bounces; one that is known to
   one of them alone is a failure. */
static double apart(const struct typed *typed, const struct gm_soliton *soliton)
{
    enum { PLACES = 200 }; /* without the middle, where the image of a pair has either sign */
    const struct gm_moving_mesh *moving = gm_moving_mesh_of(&typed->problem);
    double x[PLACES], ours[3][PLACES], theirs[3][PLACES], farthest = 0;
    for (size_t i = 0; i < PLACES; i++) {
        x[i] = soliton->length * (double)i / (PLACES - 1);
    }
    moving->start(typed->problem.parameters, x, PLACES, ours[0], ours[1], ours[2]);
    gm_soliton_profile(soliton, x, PLACES, theirs[0], theirs[1], theirs[2]);
    for (size_t i = 0; i < PLACES; i++) {
        for (size_t c = 0; c < 3; c++) {
            farthest = fmax(farthest, fabs(ours[c][i] - theirs[c][i]));
        }
        for (int k = 0; k <= 40; k++) {
            const double t = 3.7 * k, own = moving->exact(typed->problem.parameters, x[i], t),
                         other = gm_soliton_exact(soliton, x[i], t);
            assert_int_equal(isnan(own), isnan(other));
            farthest = isnan(own) ? farthest : fmax(farthest, fabs(own - other));
        }
    }
    return farthest;
}

/* P and its derivatives at random ends, to so much of the largest */
static void densities_agree(const struct gm_density *ours, const struct gm_density *theirs, double near)
{
    enum { ENDS = 50 };
    double at[3 * ENDS], mine[GM_DENSITY_VALUES * ENDS], other[GM_DENSITY_VALUES * ENDS], largest = 0;
    uint32_t seed = 7;
    for (size_t i = 0; i < 3 * ENDS; i++) {
        seed = seed * 1664525u + 1013904223u;
        at[i] = (double)seed / 4294967296. * 6 - 3;
    }
    assert_int_equal(ours->local, theirs->local);
    const size_t count = ENDS * (ours->local ? GM_DENSITY_VALUES : GM_DENSITY_OF_SLOPE);
    ours->values(ours, at, mine, ENDS);
    theirs->values(theirs, at, other, ENDS);
    for (size_t i = 0; i < count; i++) {
        largest = fmax(largest, fabs(other[i]));
    }
    for (size_t i = 0; i < count; i++) {
        if (!(fabs(mine[i] - other[i]) <= near * largest)) {
            fail_msg("value %zu of end %zu: %.17g instead of %.17g", i / ENDS, i % ENDS, mine[i], other[i]);
        }
    }
}

/* A density that is typed has exact derivatives, whatever it depends on. */
static void typed_densities_are_derived(void **unused)
{
    (void)unused;
    struct typed typed;
    static const struct gm_density_numbers of_all = {GM_OF_ALL, GM_SINE_GORDON, 1.3, 1, 1};
    const struct gm_user_mesh chosen = {.first = -6,
                                        .length = 12,
                                        .points = 7,
                                        .alpha = 1.3,
                                        .density =
                                            "sqrt(1 + alpha^2*u_x^2*(1 + half) + k*u^2*cos(x) + u_x*V_u/8)"};
    open_chosen(
        &typed,
        "field: u\nV: u^2/2\nparameter: k = 0.25\nlet: half = sin(x)/2\nstart: u = exp(-x^2), u_t = 0\n",
        &chosen);
    densities_agree(typed.mesh.density, gm_closed_density(&of_all), 1e-13);
    close_typed(&typed);
}

/* The built-in file against solitons in C: mesh, density, start and exact solution. */
static void the_file_describes_these_solitons(void **unused)
{
    (void)unused;
    for (int i = 0; i < 20; i++) {
        const struct gm_soliton soliton = {.field = i % 2,
                                           .solitons = 1 + i / 2 % 2,
                                           .density = i / 4,
                                           .points = 15,
                                           .velocity = i < 10 ? 0.9 : 0.4,
                                           .length = i % 5 == 0 ? 50 : 25,
                                           .alpha = NAN};
        struct gm_problem problem;
        struct gm_mesh mesh;
        struct typed typed;
        gm_soliton_problem(&soliton, &problem);
        gm_moving_mesh_of(&problem)->describe(&problem, &mesh);
        open_built_in(&typed, &soliton);
        const double ours[] = {typed.mesh.first, typed.mesh.length, typed.mesh.left, typed.mesh.right},
                     theirs[] = {mesh.first, mesh.length, mesh.left, mesh.right};
        for (size_t k = 0; k < GM_COUNT(ours); k++) {
            assert_true(fabs(ours[k] - theirs[k]) <= 1e-14 * fabs(theirs[k]));
        }
        assert_int_equal(typed.mesh.potential == &gm_potential_sine_gordon, soliton.field == GM_SINE_GORDON);
        densities_agree(typed.mesh.density, mesh.density, 1e-13);
        const double farthest = apart(&typed, &soliton);
        if (!(farthest < 1e-11)) {
            fail_msg("%d: within %.1e", i, farthest);
        }
        struct gm_soliton other = soliton; /* another one is told apart */
        other.velocity -= 1e-6;
        assert_false(apart(&typed, &other) < 1e-11);
        close_typed(&typed);
    }
}

/* The multipliers of Lobatto's method of order 4, whose coefficients have one. */
static struct gm_scheme with_a_wrong_digit(void)
{
    static struct gm_mesh_tableau tableau;
    static struct gm_mesh_row digit;
    tableau = gm_tableau_lobatto4;
    tableau.abar[2][1] += 1e-3;
    digit = *(const struct gm_mesh_row *)gm_scheme_find("multiplier-lobatto4")->coefficients;
    digit.tableau = &tableau;
    struct gm_scheme wrong = *gm_scheme_find("multiplier-lobatto4");
    wrong.coefficients = &digit;
    return wrong;
}

/* The order in the step of differences between runs, on 7 nodes. */
static double order_of(const struct typed *typed, const struct gm_scheme *scheme)
{
    struct gm_mesh_subject subject;
    double before[GM_MESH_SUBJECT_STATE] = {0}, end[GM_MESH_SUBJECT_STATE], changes[4];
    for (int i = 0; i < 4; i++) {
        const long steps = 20L << i;
        assert_true(gm_mesh_subject_open(&subject, scheme, &typed->problem, 1. / (double)steps));
        subject.trial.steps = steps;
        assert_true(gm_trial_advance(&subject.trial, subject.start, end));
        changes[i] = 0;
        for (size_t k = 0; k < typed->problem.n / 2; k++) {
            changes[i] = fmax(changes[i], fabs(end[k] - before[k]));
        }
        memcpy(before, end, sizeof before);
    }
    return log2(changes[2] / changes[3]);
}

static void orders_are_claimed_ones(void **unused)
{
    (void)unused;
    static const char *const names[] = {"multiplier-lobatto4", "multiplier-lobatto2",
                                        "multiplier-trapezoidal", "control-gauss4", "uniform-gauss4"};
    static const char *const texts[] = {phi4, both};
    for (size_t which = 0; which < GM_COUNT(texts); which++) {
        struct typed typed;
        open_typed(&typed, texts[which], 6, 7, NAN);
        for (size_t i = 0; i < GM_COUNT(names); i++) {
            const struct gm_scheme *scheme = gm_scheme_find(names[i]);
            const double order = order_of(&typed, scheme);
            print_message("    %-24s order %.3f\n", names[i], order);
            if (!(fabs(order - scheme->order) < 0.15)) {
                fail_msg("%s: order %.3f", names[i], order);
            }
        }
        const struct gm_scheme wrong = with_a_wrong_digit();
        assert_false(fabs(order_of(&typed, &wrong) - 4) < 0.15);
        close_typed(&typed);
    }
}

/* The local law of the trapezoidal Lagrangian with somebody's means in it: to rounding for its own scheme, for no
   other. */
static void laws_hold_of_somebodys_potential(void **unused)
{
    (void)unused;
    static const char *const texts[] = {phi4, both};
    for (size_t which = 0; which < GM_COUNT(texts); which++) {
        struct typed typed;
        struct gm_mesh_subject subject;
        open_typed(&typed, texts[which], 6, 3, NAN);
        static const char *const names[] = {"multiplier-trapezoidal", "uniform-gauss2", "multiplier-lobatto4",
                                            "uniform-gauss4"};
        for (size_t i = 0; i < GM_COUNT(names); i++) {
            const struct gm_scheme *scheme = gm_scheme_find(names[i]);
            assert_true(gm_mesh_subject_open(&subject, scheme, &typed.problem, 0.2));
            const double defect = gm_mesh_law_defect(&subject);
            print_message("    %-24s multisymplectic law %.1e\n", names[i], defect);
            if (scheme->claims & GM_MULTISYMPLECTIC ? !(defect < 1e-9) : !(defect > 1e-6)) {
                fail_msg("%s: law %.3g", names[i], defect);
            }
        }
        close_typed(&typed);
    }
}

static struct gm_certificate certificate_of(const struct typed *typed, const struct gm_scheme *scheme)
{
    double start[4 * 3];
    assert_true(gm_mesh_start(&typed->mesh, gm_scheme_mesh(scheme), gm_moving_mesh_of(&typed->problem)->start,
                              typed->problem.parameters, start));
    const struct gm_certified_system system = {.problem = &typed->problem, .start = start, .dt = 0.1};
    return gm_certify_on(scheme, &system);
}

/* The claims of a row, measured on what somebody wrote; a wrong digit and a claim that is none are found out. */
static void schemes_are_certified_on_somebodys_potential(void **unused)
{
    (void)unused;
    static const char *const names[] = {"multiplier-lobatto4", "multiplier-trapezoidal", "control-gauss4",
                                        "uniform-gauss2", "multiplier-adaptive4"};
    static const char *const texts[] = {phi4, both};
    for (size_t which = 0; which < GM_COUNT(texts); which++) {
        struct typed typed;
        open_typed(&typed, texts[which], 6, 3, NAN);
        for (size_t i = 0; i < GM_COUNT(names); i++) {
            const struct gm_scheme *scheme = gm_scheme_find(names[i]);
            const struct gm_certificate certificate = certificate_of(&typed, scheme);
            if (!certificate.holds || !(fabs(certificate.order - scheme->order) < 0.15)) {
                fail_msg("%s: order %.3f", names[i], certificate.order);
            }
        }
        struct gm_scheme wrong = with_a_wrong_digit();
        assert_false(certificate_of(&typed, &wrong).holds);
        wrong = *gm_scheme_find("control-gauss4");
        assert_true(certificate_of(&typed, &wrong).holds);
        wrong.claims |= GM_MULTISYMPLECTIC;
        assert_false(certificate_of(&typed, &wrong).holds);
        close_typed(&typed);
    }
}

/* A kink of phi^4 over three quarters of its way: the energy swings, the less the shorter the step, and does not
   drift; with the control-theoretic strategy it does not come back. */
static void energy_is_kept(void **unused)
{
    (void)unused;
    struct typed typed;
    open_typed(&typed, phi4, 12.5, 31, NAN);
    double changes[2];
    for (int i = 0; i < 2; i++) {
        const struct gm_scheme *scheme = gm_scheme_find("multiplier-lobatto4");
        double state[4 * 31];
        assert_true(gm_mesh_start(&typed.mesh, GM_MESH_MOVING, gm_moving_mesh_of(&typed.problem)->start,
                                  typed.problem.parameters, state));
        const double initial = gm_mesh_energy(&typed.mesh, state);
        /* M gamma, of the continuum */
        assert_true(fabs(initial / (2 * M_SQRT2 / 3 / sqrt(1 - 0.25)) - 1) < 0.02);
        struct gm_run *run = gm_run_open(&typed.problem, scheme, &settings, 0, ldexp(0.1, -i), state);
        changes[i] = 0;
        for (int k = 0; k < 100; k++) {
            assert_int_equal(gm_run_advance(run, 1L << i), GM_OK);
            changes[i] = fmax(changes[i], fabs(gm_mesh_energy(&typed.mesh, gm_run_state(run)) - initial));
        }
        gm_run_close(run);
    }
    print_message("    energy changes by %.1e, with half the step %.1e\n", changes[0], changes[1]);
    assert_true(changes[0] < 1e-3);
    assert_true(changes[1] < changes[0] / 8);
    close_typed(&typed);
}

static void what_does_not_rest_is_refused(void **unused)
{
    (void)unused;
    static const char *const texts[] = {"field: u\nV: u^2/2\nstart: u = 1/(x^2 - 4), u_t = 0\n",
                                        "field: u\nV: u^2/2\nstart: u = exp(-x^2), u_t = 1\n",
                                        "field: u\nV: u^2/2\nstart: u = sqrt(x - 1), u_t = 0\n",
                                        "field: u\nV: u^2/2\nstart: u = 0, u_t = exp(-x^2)\n",
                                        "field: u\nV: u^2/2\nstart: u = 0, u_t = 1\nends: 0, 1/0\n",
                                        "field: u\nV: u^2/2\nstart: u = 0, u_t = 1\nends: 0, 0\nalpha: -1\n",
                                        "field: u\nV: u^2/2\nstart: u = 0, u_t = 1\nends: 0, 0\n"};
    static const char *const told[] = {"not finite where x = -2",
                                       "held at both ends",
                                       "not finite where x = -4",
                                       NULL,
                                       "ends: u would be 0 at one and inf",
                                       "alpha: is -1",
                                       NULL};
    for (size_t i = 0; i < GM_COUNT(texts); i++) {
        struct typed typed;
        struct gm_fault fault = {0};
        open_typed(&typed, texts[i], 4, 7, NAN);
        assert_int_equal(gm_user_mesh_rests(&typed.problem, &fault), !told[i]);
        if (told[i] && !strstr(fault.sentence, told[i])) {
            fail_msg("%s: %s", texts[i], fault.sentence);
        }
        close_typed(&typed);
    }
}

/* A mesh equation of every kind, with a start at rest or not. */
static const char system_a[] = "field: u\nV: u^2/2 + u^4/16\n"
                               "start: u = 1.2*exp(-(x - 0.5)^2/3), u_t = 0.2*x*exp(-x^2/2)\n",
                  nodes_alone[] = "cell: 0\nstart: X_t = exp(-x^2)\n";

static void open_kind(struct typed *typed, bool alone, double relax)
{
    struct gm_fault fault;
    const char *text = alone ? nodes_alone : system_a;
    assert_true(gm_equations_open(&typed->system, text, strlen(text), NULL, 0, &fault));
    assert_true(gm_user_wave_derive(&typed->wave, &typed->system));
    double *values = gm_equations_start(&typed->system, NULL);
    const struct gm_user_mesh chosen = {
        .first = -6,
        .length = 12,
        .points = 7,
        .alpha = 1,
        .density = alone ? "1 + 1/cosh(x)" : "sqrt(1 + 0.8*u_x^2 + 0.1*u^2)",
        .map = alone ? NULL : "X = x + 0.7*sin(pi*(x + 6)/12)*sin(1.1*t + 0.3)",
        .cell = alone ? "m_t^2*tanh(d/2) + d_t^2/(4*tanh(d/2))" : "0.05/2*(d_t/d)^2",
        .relax = relax,
    };
    assert_true(gm_user_mesh_open(&typed->problem, &typed->wave, values, &chosen));
    free(values);
    gm_moving_mesh_of(&typed->problem)->describe(&typed->problem, &typed->mesh);
}

static struct gm_run *open_kind_run(const struct typed *typed, const char *name)
{
    const struct gm_scheme *scheme = gm_scheme_find(name);
    double start[4 * 7];
    assert_true(gm_mesh_start(&typed->mesh, gm_scheme_mesh(scheme), gm_moving_mesh_of(&typed->problem)->start,
                              typed->problem.parameters, start));
    struct gm_run *run = gm_run_open(&typed->problem, scheme, &settings, 0, 0.04, start);
    assert_non_null(run);
    return run;
}

/* The matrix of a step against differences of its residual, for every kind of mesh and every tableau, at unknowns near the
   guess. */
static void matrices_are_derivatives(void **unused)
{
    (void)unused;
    static const struct {
        const char *name;
        double relax;
        bool alone;
    } list[] = {{"uniform-gauss4", 0, false},      {"given-gauss2", 0, false},
                {"given-lobatto4", 0, false},      {"control-gauss4", 0, false},
                {"control-radau5", 0, false},      {"control-lobatto4", 0, false},
                {"control-radau3", 0.3, false},    {"control-gauss4", 0.3, false},
                {"free-gauss2", 0, false},         {"free-gauss4", 0, false},
                {"free-gauss4", 0, true},          {"multiplier-lobatto2", 0, false},
                {"multiplier-lobatto4", 0, false}, {"multiplier-trapezoidal", 0, false}};
    enum { MOST = 7 * 9 };
    for (size_t i = 0; i < GM_COUNT(list); i++) {
        struct typed typed;
        open_kind(&typed, list[i].alone, list[i].relax);
        const struct gm_scheme *scheme = gm_scheme_find(list[i].name);
        struct gm_mesh_solver *solver = scheme->family->workspace_open(&typed.problem, scheme);
        double start[4 * 7], state[4 * 7] = {0}, at[MOST], sides[2][MOST], worst = 0;
        assert_true(gm_mesh_start(&typed.mesh, gm_scheme_mesh(scheme),
                                  gm_moving_mesh_of(&typed.problem)->start, typed.problem.parameters, start));
        for (size_t part = 0; part < (list[i].alone ? 2 : 4); part++) {
            memcpy(state + 7 * (list[i].alone ? 2 * part + 1 : part), start + 7 * part, 7 * sizeof *state);
        }
        gm_step_place(solver, state, 0.2, 0.04);
        gm_step_guess(solver, at);
        const size_t n = solver->matrix.n;
        for (size_t k = 0; k < n; k++) {
            /* multipliers are not 0 either; the slack is, as the matrix leaves third derivatives of ell times it out */
            const bool slack = solver->of.slack > 0 && k % solver->of.per_node == solver->of.slack;
            at[k] += slack ? 0 : 0.02 * sin(5. * (double)k);
        }
        assert_true(gm_step_residual(solver, at));
        gm_banded_clear(&solver->matrix);
        for (size_t e = 0; e <= 7; e++) {
            gm_step_matrix(solver, &(struct gm_assembly){&solver->matrix, 7, solver->of.per_node, e});
        }
        for (size_t column = 0; column < n; column++) {
            const double kept = at[column], step = 1e-5;
            for (int side = 0; side < 2; side++) {
                at[column] = kept + (side ? step : -step);
                assert_true(gm_step_residual(solver, at));
                memcpy(sides[side], solver->residual, n * sizeof *sides[side]);
            }
            at[column] = kept;
            for (size_t row = 0; row < n; row++) {
                const size_t band = solver->matrix.band, apart = row > column ? row - column : column - row;
                const double got =
                    apart > band
                        ? 0
                        : solver->matrix.values[column * solver->matrix.stride + 2 * band + row - column];
                const double wanted = (sides[1][row] - sides[0][row]) / (2 * step);
                worst = fmax(worst, fabs(got - wanted) / (1 + fabs(wanted)));
            }
        }
        print_message("    %-24s matrix within %.1e\n", list[i].name, worst);
        if (!(worst < 1e-8)) {
            fail_msg("%s: %.3g", list[i].name, worst);
        }
        scheme->family->workspace_close(solver);
        close_typed(&typed);
    }
}

/* The Lagrangian of a cell by z = (y0, X0, y1, X1) and their rates: what open_cell has as text. */
static const char cell_text[] = "0.3*(d_t/d)^2 + m_t^2*d*(1 + u_x^2) - u_x^3/8 + d_t*m_t*cos(d)";
static double cell_of(const double z[4], const double rate[4])
{
    const double d = z[3] - z[1], d_t = rate[3] - rate[1], m_t = (rate[1] + rate[3]) / 2,
                 s = (z[2] - z[0]) / d;
    return 0.3 * d_t * d_t / (d * d) + m_t * m_t * d * (1 + s * s) - s * s * s / 8 + d_t * m_t * cos(d);
}

/* Derivatives of density and cell at random cells, by differences: what an element has of a cell is the derivative of its
   Lagrangian by the places and velocities of both ends, and P and its derivatives fit each other. */
static void typed_derivatives_are_differences(void **unused)
{
    (void)unused;
    struct typed typed;
    const struct gm_user_mesh chosen = {.first = -6,
                                        .length = 12,
                                        .points = 1,
                                        .alpha = 1.3,
                                        .density = "sqrt(1 + alpha^2*u_x^2 + u^2*cos(x)/4 + u_x*V_u/8)",
                                        .cell = cell_text};
    open_chosen(&typed, "field: u\nV: u^2/2\nstart: u = exp(-x^2), u_t = 0\n", &chosen);
    struct gm_mesh mesh = typed.mesh;
    struct gm_elements stage, bare;
    uint32_t seed = 3;
    const double h = 1e-5;
    assert_true(gm_elements_open(&stage, &mesh));
    mesh.cell = NULL;
    assert_true(gm_elements_open(&bare, &mesh));
    for (int trial = 0; trial < 50; trial++) {
        double drawn[8];
        for (size_t i = 0; i < 8; i++) {
            seed = seed * 1664525u + 1013904223u;
            drawn[i] = (double)seed / 4294967296. * 2 - 1;
        }
        const double z[4] = {drawn[0], -2 + drawn[1], drawn[2], 1.5 + drawn[3]}, *rate = drawn + 4;
        struct gm_elements *const stages[] = {&stage, &bare};
        for (size_t k = 0; k < 2; k++) {
            struct gm_elements *of = stages[k];
            memcpy(of->y, (double[]){z[0], z[2], 0}, 3 * sizeof(double));
            memcpy(of->x, (double[]){z[1], z[3], 6}, 3 * sizeof(double));
            memcpy(of->u, (double[]){rate[0], rate[2], 0}, 3 * sizeof(double));
            memcpy(of->v, (double[]){rate[1], rate[3], 0}, 3 * sizeof(double));
            mesh.cell = k == 0 ? typed.mesh.cell : NULL;
            assert_true(gm_elements_evaluate(of, &mesh));
        }
        const double pull = stage.force_d[0] - bare.force_d[0];
        const double force[4] = {stage.force_y0[0] - bare.force_y0[0], -pull,
                                 stage.force_y1[0] - bare.force_y1[0], pull};
        const double momentum[4] = {0, stage.cell_v0[0], 0, stage.cell_v1[0]};
        for (size_t a = 0; a < 4; a++) {
            double places[2][4], rates[2][4];
            for (size_t side = 0; side < 2; side++) {
                memcpy(places[side], z, sizeof places[side]);
                memcpy(rates[side], rate, sizeof rates[side]);
                places[side][a] += side ? h : -h;
                rates[side][a] += side ? h : -h;
            }
            assert_true(fabs(force[a] - (cell_of(places[1], rate) - cell_of(places[0], rate)) / (2 * h)) <
                        1e-7);
            assert_true(fabs(momentum[a] - (cell_of(z, rates[1]) - cell_of(z, rates[0])) / (2 * h)) < 1e-7);
        }
        /* of s, u, x: the numbers of the derivatives by each of them, of P and of its first derivatives */
        static const enum gm_density_value by[4][3] = {{GM_P_S, GM_P_U, GM_P_X},
                                                       {GM_P_SS, GM_P_SU, GM_P_SX},
                                                       {GM_P_SU, GM_P_UU, GM_P_UX},
                                                       {GM_P_SX, GM_P_UX, GM_P_XX}},
                                           of[4] = {GM_P, GM_P_S, GM_P_U, GM_P_X};
        double here[GM_DENSITY_VALUES], sides[2][GM_DENSITY_VALUES];
        mesh.density->values(mesh.density, drawn, here, 1);
        for (size_t a = 0; a < 3; a++) {
            for (size_t side = 0; side < 2; side++) {
                double moved[3] = {drawn[0], drawn[1], drawn[2]};
                moved[a] += side ? h : -h;
                mesh.density->values(mesh.density, moved, sides[side], 1);
            }
            for (size_t k = 0; k < 4; k++) {
                assert_true(fabs(here[by[k][a]] - (sides[1][of[k]] - sides[0][of[k]]) / (2 * h)) < 1e-7);
            }
        }
    }
    gm_elements_close(&stage);
    gm_elements_close(&bare);
    close_typed(&typed);
}

/* det M of (56), and its rank where 0 to 3 nodes are straight; elimination with pivots on the whole matrix. */
static void mass_matrices_have_their_rank(void **unused)
{
    (void)unused;
    enum { N = 7, SIZE = 2 * N };
    static const size_t straight[][3] = {{0, 0, 0}, {4, 0, 0}, {2, 5, 0}, {2, 4, 6}};
    for (size_t count = 0; count < GM_COUNT(straight); count++) {
        struct typed typed;
        open_typed(&typed, "field: u\nV: u^2/2\nstart: u = 0, u_t = 0\n", 6, N, NAN);
        double y[N + 2] = {0}, x[N + 2], state[4 * N] = {0}, matrix[SIZE * SIZE], rank, condition;
        for (size_t k = 0; k <= N + 1; k++) {
            x[k] = -6 + 12 * ((double)k + 0.2 * sin(2. * (double)k) * (k % (N + 1) != 0)) / (N + 1);
            y[k] = k % (N + 1) == 0 ? 0 : 2 * cos(1.7 * (double)k);
        }
        for (size_t i = 0; i < count; i++) {
            const size_t k = straight[count][i];
            y[k] = y[k - 1] + (y[k + 1] - y[k - 1]) * (x[k] - x[k - 1]) / (x[k + 1] - x[k - 1]);
        }
        memcpy(state, y + 1, N * sizeof *y);
        memcpy(state + N, x + 1, N * sizeof *x);
        assert_true(gm_mesh_mass(&typed.mesh, state, &rank, &condition));
        assert_int_equal((int)rank, SIZE - count);
        assert_true(gm_mesh_mass_matrix(&typed.mesh, state, matrix));
        double wanted = 1. / 9, got = 1;
        for (size_t e = 0; e <= N; e++) {
            const double d = x[e + 1] - x[e];
            wanted *= e % N == 0 ? d : d * d / 12;
            if (e > 0) {
                const double jump = (y[e] - y[e - 1]) / (x[e] - x[e - 1]) - (y[e + 1] - y[e]) / d;
                wanted *= jump * jump;
            }
        }
        for (size_t j = 0; j < SIZE; j++) { /* M is symmetric and not negative: it needs no pivots */
            got *= matrix[j * SIZE + j];
            for (size_t i = j + 1; i < SIZE && count == 0; i++) {
                const double factor = matrix[i * SIZE + j] / matrix[j * SIZE + j];
                for (size_t k = j; k < SIZE; k++) {
                    matrix[i * SIZE + k] -= factor * matrix[j * SIZE + k];
                }
            }
        }
        if (count == 0) {
            print_message("    det M = %.15g, %.1e from (56)\n", got, fabs(got / wanted - 1));
            assert_true(fabs(got / wanted - 1) < 1e-11);
        }
        close_typed(&typed);
    }
}

/* Loads a snapshot of the run into a new one, which replaces it. */
static void resume(const struct typed *typed, struct gm_run **run, const char *name)
{
    void *snapshot = malloc(gm_run_snapshot_size(*run));
    struct gm_run *resumed = open_kind_run(typed, name);
    assert_non_null(snapshot);
    gm_run_save(*run, snapshot);
    assert_true(gm_run_load(resumed, snapshot));
    free(snapshot);
    gm_run_close(*run);
    *run = resumed;
}

static void change(struct gm_run **run, const char *name)
{
    struct gm_run *next = gm_run_switch(*run, gm_scheme_find(name));
    assert_non_null(next);
    assert_int_equal(next->status, GM_OK);
    gm_run_close(*run);
    *run = next;
}

/* Runs of every kind that are resumed, stepped back and switched, at t > 0, have the bits of runs that nobody disturbed;
   and a step back leads to the start if the scheme is symmetric. */
static void runs_of_every_kind_keep_their_bits(void **unused)
{
    (void)unused;
    static const struct {
        const char *name, *other; /* a run is switched to the other scheme and back */
        double relax;
        bool alone;
    } list[] = {
        {"uniform-gauss4", "given-gauss4", 0, false},     {"given-gauss2", "multiplier-lobatto4", 0, false},
        {"given-lobatto4", "free-gauss4", 0, false},      {"control-gauss4", "given-gauss4", 0, false},
        {"control-radau3", "free-gauss2", 0.3, false},    {"free-gauss4", "multiplier-lobatto4", 0, false},
        {"multiplier-lobatto4", "free-gauss2", 0, false}, {"multiplier-trapezoidal", "free-gauss4", 0, false},
        {"free-gauss4", "free-gauss2", 0, true},
    };
    for (size_t i = 0; i < GM_COUNT(list); i++) {
        struct typed typed;
        open_kind(&typed, list[i].alone, list[i].relax);
        struct gm_run *whole = open_kind_run(&typed, list[i].name),
                      *pieces = open_kind_run(&typed, list[i].name);
        const size_t size = typed.problem.n * sizeof(double);
        double start[4 * 7];
        memcpy(start, gm_run_state(whole), size);
        for (int part = 0; part < 3; part++) {
            const char *name = part == 1 ? list[i].other : list[i].name;
            assert_int_equal(gm_run_advance(whole, 12), GM_OK);
            assert_int_equal(gm_run_advance(pieces, 7), GM_OK);
            resume(&typed, &pieces, name);
            assert_int_equal(gm_run_advance(pieces, 5), GM_OK);
            assert_memory_equal(gm_run_state(whole), gm_run_state(pieces), size);
            if (part < 2) {
                change(&whole, part == 1 ? list[i].name : list[i].other);
                change(&pieces, part == 1 ? list[i].name : list[i].other);
            }
        }
        /* smoothing is a diffusion, which cannot be run back */
        const double step = list[i].relax > 0 ? 0.02 : -0.04;
        gm_run_set_step(whole, step);
        gm_run_set_step(pieces, step);
        assert_int_equal(gm_run_advance(whole, 12), GM_OK);
        assert_int_equal(gm_run_advance(pieces, 6), GM_OK);
        resume(&typed, &pieces, list[i].name);
        assert_int_equal(gm_run_advance(pieces, 6), GM_OK);
        assert_memory_equal(gm_run_state(whole), gm_run_state(pieces), size);
        gm_run_close(whole);
        whole = open_kind_run(&typed, list[i].name);
        assert_int_equal(gm_run_advance(whole, 20), GM_OK);
        gm_run_set_step(whole, step);
        assert_int_equal(gm_run_advance(whole, 20), GM_OK);
        const double back = gm_distance(gm_run_state(whole), start, typed.problem.n);
        print_message("    %-24s back at the start within %.1e\n", list[i].name, back);
        assert_true(step > 0 || back < 1e-9);
        gm_run_close(whole);
        gm_run_close(pieces);
        close_typed(&typed);
    }
}

/* The state after a step whose equations are solved to round-off, not to 1e-11. */
static void step_sharply(struct gm_mesh_solver *solver, double t, double h, const double *state, double *next)
{
    const struct gm_elements *ends = &solver->ends;
    const double *const parts[] = {ends->y, ends->x, ends->u, ends->v};
    double multiplier;
    gm_step_place(solver, state, t, h);
    gm_step_guess(solver, solver->unknowns);
    for (int iteration = 0; iteration < 12; iteration++) {
        assert_true(gm_step_residual(solver, solver->unknowns));
        gm_banded_clear(&solver->matrix);
        for (size_t e = 0; e <= 7; e++) {
            gm_step_matrix(solver, &(struct gm_assembly){&solver->matrix, 7, solver->of.per_node, e});
        }
        assert_true(gm_banded_factor(&solver->matrix));
        gm_banded_solve(&solver->matrix, solver->residual);
        for (size_t k = 0; k < solver->matrix.n; k++) {
            solver->unknowns[k] -= solver->residual[k];
        }
    }
    assert_true(gm_step_residual(solver, solver->unknowns));
    assert_int_equal(gm_step_end(solver, &multiplier), GM_OK);
    for (size_t part = 0; part < 4; part++) {
        memcpy(next + 7 * part, parts[part] + 1, 7 * sizeof *next);
    }
}

/* The discrete Euler-Lagrange equations of the midpoint rule in the cells (Tyranowski & Desbrun 2019, eq. 109), from three
   states: what they leave, as a part of the largest term. A momentum has the terms d y'/h and d y/h of its two states. */
static double cells_leave(const struct typed *typed, const char *name)
{
    const struct gm_scheme *scheme = gm_scheme_find(name);
    struct gm_mesh_solver *solver = scheme->family->workspace_open(&typed->problem, scheme);
    const double h = 0.05;
    double states[3][4 * 7], rest[9] = {0}, largest = 0, worst = 0;
    struct gm_elements at;
    assert_true(gm_elements_open(&at, &typed->mesh));
    assert_true(gm_mesh_start(&typed->mesh, GM_MESH_GIVEN, gm_moving_mesh_of(&typed->problem)->start,
                              typed->problem.parameters, states[0]));
    for (size_t step = 0; step < 2; step++) {
        const double t = (double)step * h, sign = step == 0 ? 1 : -1;
        step_sharply(solver, t, h, states[step], states[step + 1]);
        gm_mesh_known(&typed->mesh, GM_MESH_GIVEN, t + h / 2, &at);
        for (size_t k = 0; k < 7; k++) {
            at.y[k + 1] = (states[step][k] + states[step + 1][k]) / 2;
            at.u[k + 1] = (states[step + 1][k] - states[step][k]) / h;
        }
        assert_true(gm_elements_evaluate(&at, &typed->mesh));
        for (size_t e = 0; e <= 7; e++) {
            rest[e] += h / 2 * at.force_y0[e] + sign * at.momentum_u0[e];
            rest[e + 1] += h / 2 * at.force_y1[e] + sign * at.momentum_u1[e];
            largest = fmax(largest, at.width[e] / h * fmax(fabs(at.y[e]), fabs(at.y[e + 1])) / 3);
        }
    }
    for (size_t k = 1; k <= 7; k++) {
        worst = fmax(worst, fabs(rest[k]));
    }
    gm_elements_close(&at);
    scheme->family->workspace_close(solver);
    return worst / largest;
}

static void known_meshes_obey_the_cells_equations(void **unused)
{
    (void)unused;
    static const struct {
        const char *name;
        double least, most;
    } list[] = {{"given-gauss2", 0, 3e-16}, {"given-lobatto2", 1e-5, 1}, {"given-gauss4", 1e-5, 1}};
    struct typed typed;
    open_kind(&typed, false, 0);
    typed.mesh.cell = NULL;
    for (size_t i = 0; i < GM_COUNT(list); i++) {
        const double rest = cells_leave(&typed, list[i].name);
        print_message("    %-24s leaves %.1e of the largest term\n", list[i].name, rest);
        assert_true(rest >= list[i].least && rest <= list[i].most);
    }
    close_typed(&typed);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(means_are_those_of_closed_form),
        cmocka_unit_test(known_potentials_are_recognised),
        cmocka_unit_test(lines_describe_the_mesh),
        cmocka_unit_test(typed_again_the_soliton_is_the_same),
        cmocka_unit_test(typed_densities_are_derived),
        cmocka_unit_test(the_file_describes_these_solitons),
        cmocka_unit_test(orders_are_claimed_ones),
        cmocka_unit_test(laws_hold_of_somebodys_potential),
        cmocka_unit_test(schemes_are_certified_on_somebodys_potential),
        cmocka_unit_test(energy_is_kept),
        cmocka_unit_test(what_does_not_rest_is_refused),
        cmocka_unit_test(matrices_are_derivatives),
        cmocka_unit_test(known_meshes_obey_the_cells_equations),
        cmocka_unit_test(typed_derivatives_are_differences),
        cmocka_unit_test(mass_matrices_have_their_rank),
        cmocka_unit_test(runs_of_every_kind_keep_their_bits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
