/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every scheme held to its row; and wrong rows, which must be refused. Usage: claims [all]; without `all` a third of
   the schemes, another one each day, is given one order too many. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <time.h>

#include <cmocka.h>

#include "core/aliases.h"
#include "core/basics.h"
#include "core/field/families/families.h"
#include "core/field/families/two_step.h"
#include "core/field/families/waves/lobatto.h"
#include "core/field/problems/problems.h"
#include "core/flow/families/families.h"
#include "core/mesh/families/families.h"
#include "core/ode/families/compositions.h"
#include "core/ode/families/families.h"
#include "core/ode/families/runge_kutta/implicit.h"
#include "core/ode/families/splitting/parts.h"
#include "core/ode/families/variational/discrete_lagrangian.h"
#include "core/ode/kernel/loops.h"
#include "core/ode/kernel/members.h"
#include "core/schemes.h"
#include "core/theory/certify.h"
#include "tests/problems/problems.h"

static bool all;

static void every_row_holds(void **unused)
{
    (void)unused;
    assert_true(gm_scheme_count() >= 57);
    for (size_t i = 0; i < gm_scheme_count(); i++) {
        const struct gm_certificate certificate = gm_certify(gm_scheme_at(i));
        if (!certificate.holds) {
            fail_msg("%s breaks a claim; its order is %.3f", gm_scheme_at(i)->name, certificate.order);
        }
    }
}

static struct gm_scheme changed(const char *name)
{
    const struct gm_scheme *scheme = gm_scheme_find(name);
    assert_non_null(scheme);
    return *scheme;
}

/* The half and the whole of Verlet exchanged. */
static void verlet_with_halves_exchanged(void **unused)
{
    (void)unused;
    static const struct gm_splitting exchanged = {3, {{GM_KICK, 1}, {GM_DRIFT, 0.5}, {GM_KICK, 1}}};
    struct gm_scheme wrong = changed("verlet");
    wrong.coefficients = &exchanged;
    const struct gm_certificate certificate = gm_certify(&wrong);
    assert_false(certificate.order_holds);
    assert_false(certificate.holds);
    assert_true(certificate.claims[0].holds); /* any composition of shears is symplectic */
}

static void order_that_is_not_reached(void **unused)
{
    (void)unused;
    struct gm_scheme wrong = changed("rk4");
    wrong.order = 5;
    assert_false(gm_certify(&wrong).holds);
}

static void symplecticity_that_is_false(void **unused)
{
    (void)unused;
    const char *const names[] = {"explicit-euler",
                                 "implicit-euler",
                                 "trapezoidal",
                                 "rk2",
                                 "rk4",
                                 "radau3",
                                 "radau5",
                                 "sdirk2",
                                 "kahan2",
                                 "avf2",
                                 "discrete-gradient2",
                                 "gautschi2",
                                 "gsl-rk4"};
    for (size_t i = 0; i < GM_COUNT(names); i++) {
        struct gm_scheme wrong = changed(names[i]);
        wrong.claims |= GM_SYMPLECTIC;
        const struct gm_certificate certificate = gm_certify(&wrong);
        assert_true(certificate.order_holds);
        assert_false(certificate.holds);
        assert_true(certificate.claims[0].defect > 1e-6);
    }
}

/* One claim too many, each on a scheme that has not the property. */
static void properties_that_are_false(void **unused)
{
    (void)unused;
    const struct {
        const char *scheme;
        enum gm_claim claim;
    } wrong[] = {
        {"symplectic-euler", GM_SYMMETRIC},
        {"rk4", GM_SYMMETRIC},
        {"rk4", GM_REVERSIBLE},
        {"midpoint", GM_KEEPS_ENERGY},
        {"verlet", GM_KEEPS_ENERGY},
        {"rk4", GM_KEEPS_QUADRATIC},
        {"trapezoidal", GM_KEEPS_QUADRATIC},
        {"lobatto4", GM_KEEPS_QUADRATIC},
        {"avf2", GM_KEEPS_QUADRATIC},
        {"discrete-gradient2", GM_KEEPS_QUADRATIC},
        {"tao2", GM_KEEPS_ENERGY},
        {"kahan2", GM_KEEPS_ENERGY},
        {"midpoint", GM_KEEPS_VOLUME},
        {"rk4", GM_KEEPS_VOLUME},
        {"gauss4", GM_KEEPS_VOLUME},
        {"volume-splitting1", GM_SYMMETRIC},
        {"radau5", GM_SYMMETRIC},
        {"ruth3", GM_SYMMETRIC},
        {"ruth3", GM_REVERSIBLE},
        {"impulse2", GM_KEEPS_ENERGY},
        {"wisdom-holman2", GM_KEEPS_ENERGY},
        {"logh2", GM_KEEPS_ENERGY},
        {"levi-civita", GM_KEEPS_ENERGY},
        {"variational-midpoint", GM_KEEPS_ENERGY},
        {"tao2", GM_KEEPS_QUADRATIC},
        {"energy-conserving", GM_MULTISYMPLECTIC},
        {"heat-ftcs", GM_EQUIVARIANT},
        {"zabusky-kruskal", GM_EQUIVARIANT},
        {"evolution-projection", GM_KEEPS_LINEAR},
        {"leapfrog", GM_KEEPS_ENERGY},
        {"box", GM_KEEPS_ENERGY},
        {"gauss-box3", GM_KEEPS_ENERGY},
        {"midpoint-box", GM_SYMMETRIC},
        {"box", GM_KEEPS_QUADRATIC},
        {"semi-implicit", GM_KEEPS_QUADRATIC},
        {"steady", GM_KEEPS_LINEAR},
        {"rk4", GM_KEEPS_BILINEAR},
        {"rk4", GM_KEEPS_MOMENTUM_MAPS},
        {"variational-simpson4", GM_KEEPS_ENERGY},
        {"shake2", GM_KEEPS_HIDDEN},
        {"shake2", GM_SYMMETRIC},
        {"rkmk4", GM_POISSON_MAP},
        {"crouch-grossman4", GM_SYMMETRIC},
        {"midpoint", GM_POISSON_MAP},
        {"rotations2", GM_KEEPS_ENERGY},
        {"bracket-splitting4", GM_KEEPS_ENERGY},
        {"projected-gauss4", GM_SYMPLECTIC},
        {"projected-gauss6", GM_SYMMETRIC},
        {"projected-rk4", GM_KEEPS_MOMENTUM_MAPS},
        {"variational-newmark2", GM_KEEPS_ENERGY},
        {"symplectic-energy-momentum2", GM_KEEPS_ENERGY},
        {"energy-collocation4", GM_POISSON_MAP},
        {"trapezoidal", GM_KEEPS_BILINEAR},
        {"avf2", GM_KEEPS_BILINEAR},
        {"discrete-gradient2", GM_KEEPS_BILINEAR},
        {"tao2", GM_KEEPS_BILINEAR},
        {"gsl-rk4", GM_KEEPS_BILINEAR},
        {"variational-rectangle", GM_SYMMETRIC},
        {"variational-rectangle", GM_REVERSIBLE},
        {"variational-rectangle-restart", GM_SYMMETRIC},
        {"uniform-gauss4", GM_MULTISYMPLECTIC},
        {"uniform-lobatto4", GM_MULTISYMPLECTIC},
        {"control-gauss2", GM_MULTISYMPLECTIC},
        {"multiplier-adaptive4", GM_SYMPLECTIC},
    };
    for (size_t i = 0; i < GM_COUNT(wrong); i++) {
        struct gm_scheme scheme = changed(wrong[i].scheme);
        scheme.claims |= wrong[i].claim;
        if (gm_certify(&scheme).holds) {
            fail_msg("%s: claim %#x holds", wrong[i].scheme, (unsigned)wrong[i].claim);
        }
    }
}

/* The Burgers rows, found for that problem where a name has another row too, and caught by their defect. */
static void equivariance_that_is_false(void **unused)
{
    (void)unused;
    static const struct gm_burgers front = {.framed.viscosity = 0.1};
    struct gm_problem problem = gm_problem_burgers;
    problem.parameters = &front;
    static const char *const names[] = {"ftcs", "lax-wendroff", "crank-nicolson"};
    for (size_t i = 0; i < 3; i++) {
        struct gm_scheme wrong = *gm_scheme_find_for(names[i], &problem);
        assert_ptr_equal(wrong.family, &gm_family_burgers);
        wrong.claims |= GM_EQUIVARIANT;
        const struct gm_certificate certificate = gm_certify(&wrong);
        assert_true(certificate.order_holds);
        assert_true(certificate.claims[8].measured && certificate.claims[8].defect > 1e-6);
        assert_false(certificate.holds);
    }
}

/* A claim that no problem here can measure is no claim. */
static void what_cannot_be_measured(void **unused)
{
    (void)unused;
    struct gm_scheme wrong = changed("verlet");
    wrong.claims |= GM_MULTISYMPLECTIC;
    const struct gm_certificate certificate = gm_certify(&wrong);
    assert_true(certificate.order_holds);
    assert_false(certificate.holds);
}

/* b with 2^(1/2) for 2^(1/3), as printed: symplectic still, but of order 2. */
static void the_misprint_of_rk4sym(void **unused)
{
    (void)unused;
    const double root = sqrt(2), b = (2 + root + 1 / root) / 3;
    const struct gm_composition printed = {3, {b, 1 - 2 * b}};
    const struct gm_tableau misprint = {.stages = 1, .a = {{0.5}}, .b = {1}, .composition = &printed};
    struct gm_scheme wrong = changed("rk4sym");
    wrong.coefficients = &misprint;
    const struct gm_certificate certificate = gm_certify(&wrong);
    assert_false(certificate.order_holds);
    assert_true(certificate.claims[0].holds);
    wrong.order = 2;
    assert_true(gm_certify(&wrong).order_holds);
}

/* A wrong digit in Gauss' tableau costs the order or the symplecticity. */
static void a_wrong_digit_of_gauss4(void **unused)
{
    (void)unused;
    const struct gm_tableau *right = gm_scheme_find("gauss4")->coefficients;
    struct gm_tableau digit = *right;
    digit.a[0][1] += 1e-4;
    struct gm_scheme wrong = changed("gauss4");
    wrong.coefficients = &digit;
    assert_false(gm_certify(&wrong).holds);
}

/* Three stages of Lobatto in time with other weights are not multisymplectic. */
static void wrong_weights_of_lobatto_in_time(void **unused)
{
    (void)unused;
    struct gm_lobatto_row row = *(const struct gm_lobatto_row *)gm_scheme_find("lobatto-box4")->coefficients;
    row.kick[0] = row.kick[2] = 0.25;
    row.kick[1] = 0.5;
    struct gm_scheme wrong = changed("lobatto-box4");
    wrong.coefficients = &row;
    const struct gm_certificate certificate = gm_certify(&wrong);
    assert_false(certificate.holds);
    assert_true(certificate.claims[7].measured && certificate.claims[7].defect > 1e-6);
}

/* What is claimed of constraints, of friction and of what does not separate, by schemes that know nothing of it. */
static void structure_that_is_not_asked_for(void **unused)
{
    (void)unused;
    static const struct {
        unsigned facet;
        enum gm_claim claim;
        unsigned bit;
    } wrong[] = {{GM_NEEDS_CONSTRAINTS, GM_KEEPS_CONSTRAINTS, 15},
                 {GM_NEEDS_CONSTRAINTS, GM_KEEPS_HIDDEN, 16},
                 {GM_NEEDS_CONSTRAINTS, GM_SYMPLECTIC, 0},
                 {GM_NEEDS_CONSTRAINTS, GM_KEEPS_MOMENTUM_MAPS, 13},
                 {GM_NEEDS_FRICTION, GM_CONFORMAL, 14},
                 {GM_NEEDS_INSEPARABLE, GM_KEEPS_BILINEAR, 12},
                 {GM_NEEDS_DEGENERATE, GM_SYMPLECTIC, 0},
                 {GM_NEEDS_ROTATIONS, GM_KEEPS_CASIMIRS, 17},
                 {GM_NEEDS_ROTATIONS, GM_POISSON_MAP, 18},
                 {GM_NEEDS_GROUP, GM_KEEPS_CASIMIRS, 17},
                 {GM_NEEDS_PIECES, GM_KEEPS_CASIMIRS, 17},
                 {GM_NEEDS_PIECES, GM_POISSON_MAP, 18}};
    for (size_t i = 0; i < GM_COUNT(wrong); i++) {
        struct gm_scheme scheme = changed("rk4");
        scheme.needs = wrong[i].facet;
        scheme.claims = wrong[i].claim;
        const struct gm_certificate certificate = gm_certify(&scheme);
        assert_true(certificate.order_holds);
        assert_false(certificate.holds);
        assert_true(certificate.claims[wrong[i].bit].measured);
        assert_true(certificate.claims[wrong[i].bit].defect > 1e-11);
    }
}

/* The midpoint rule, which moves time by what is no constant of the motion; and rotations about the axes. */
static void moser_and_veselov_with_other_steps(void **unused)
{
    (void)unused;
    const struct gm_scheme *right = gm_scheme_find("discrete-moser-veselov");
    static const struct {
        const char *steps;
        unsigned broken;
    } wrong[] = {{"midpoint", GM_POISSON_MAP}, {"rotations2", GM_KEEPS_ENERGY | GM_KEEPS_QUADRATIC}};
    assert_string_equal(right->name, "discrete-moser-veselov2");
    for (size_t i = 0; i < GM_COUNT(wrong); i++) {
        struct gm_scheme scheme = changed(wrong[i].steps);
        scheme.needs = right->needs;
        scheme.claims = right->claims;
        const struct gm_certificate certificate = gm_certify(&scheme);
        assert_true(certificate.order_holds && !certificate.holds);
        for (unsigned bit = 0; bit < GM_CLAIM_COUNT; bit++) {
            const bool claimed = right->claims >> bit & 1, broken = wrong[i].broken >> bit & 1;
            assert_true(!claimed || certificate.claims[bit].holds != broken);
        }
    }
}

/* Weights of which the mean of the squared velocities is another one, or the mean of the velocities. */
static void newmark_with_other_weights(void **unused)
{
    (void)unused;
    struct gm_scheme wrong = changed("variational-newmark2");
    struct gm_variational_row row = *(const struct gm_variational_row *)wrong.coefficients;
    wrong.coefficients = &row;
    row.b[0] += 0.01; /* of one end more than of the other */
    row.b[2] -= 0.01;
    assert_false(gm_certify(&wrong).order_holds);
    row.b[1] = row.b[3] = -0.4;
    row.b[0] = row.b[2] = 0.9;
    const struct gm_certificate certificate = gm_certify(&wrong);
    assert_false(certificate.order_holds);
    assert_true(certificate.claims[0].holds);
}

/* An ordinary control of the error is not the same way back; parts of another order or kind are caught. */
static void steps_that_remember(void **unused)
{
    (void)unused;
    struct gm_scheme wrong = changed("error-controlled-verlet");
    wrong.claims |= GM_SYMMETRIC | GM_REVERSIBLE;
    const struct gm_certificate certificate = gm_certify(&wrong);
    assert_true(certificate.order_holds);
    assert_false(certificate.claims[1].holds);
    assert_false(certificate.claims[2].holds);
    wrong = changed("controlled-blanes-moan4");
    wrong.coefficients = gm_scheme_find("controlled-verlet2")->coefficients;
    assert_false(gm_certify(&wrong).order_holds);
    wrong = changed("poincare-gauss6");
    wrong.coefficients = gm_scheme_find("gauss4")->coefficients;
    assert_false(gm_certify(&wrong).order_holds);
    wrong = changed("poincare-gauss4");
    wrong.coefficients = gm_scheme_find("radau3")->coefficients;
    wrong.order = 3;
    assert_true(gm_certify(&wrong).order_holds);
    assert_false(gm_certify(&wrong).claims[1].holds);
}

/* A weight of a quadrature, a point of it, friction as a force like others. */
static void a_wrong_digit_of_a_discrete_lagrangian(void **unused)
{
    (void)unused;
    static const char *const names[] = {"variational-simpson4", "variational-galerkin4",
                                        "variational-galerkin6", "constrained-lobatto4",
                                        "constrained-lobatto6"};
    for (size_t i = 0; i < GM_COUNT(names); i++) {
        struct gm_scheme wrong = changed(names[i]);
        struct gm_variational_row digit = *(const struct gm_variational_row *)wrong.coefficients;
        digit.b[0] += 1e-3;
        digit.b[1] -= 2e-3;
        digit.b[2] += 1e-3;
        wrong.coefficients = &digit;
        const struct gm_certificate certificate = gm_certify(&wrong);
        if (certificate.order_holds || !certificate.claims[0].holds) {
            fail_msg("%s with wrong weights: order %.2f", names[i], certificate.order);
        }
    }
    struct gm_scheme wrong = changed("conformal-midpoint2");
    struct gm_variational_row plain = *(const struct gm_variational_row *)wrong.coefficients;
    plain.damped = false;
    wrong.coefficients = &plain;
    const struct gm_certificate certificate = gm_certify(&wrong);
    assert_true(certificate.order_holds);
    assert_false(certificate.holds);
    assert_true(certificate.claims[14].defect > 1e-6);
}

/* One order more than it has is found out for every scheme, whatever its family measures it by. */
static void one_order_too_many(void **unused)
{
    (void)unused;
    const size_t stride = all ? 1 : 3;
    for (size_t i = (size_t)(time(NULL) / 86400) % stride; i < gm_scheme_count(); i += stride) {
        struct gm_scheme wrong = *gm_scheme_at(i);
        if (wrong.order > 0 && wrong.order < 5) {
            wrong.order++;
            assert_false(gm_certify(&wrong).order_holds);
        }
    }
}

static struct gm_progress late(const struct gm_task *task)
{
    struct gm_task other = *task;
    other.dt *= 1.001;
    other.scheme = gm_scheme_find("rk4");
    return gm_scheme_loop(other.scheme, task->problem)(&other);
}

static struct gm_progress of_rk2(const struct gm_task *task)
{
    struct gm_task other = *task;
    other.scheme = gm_scheme_find("rk2");
    return gm_scheme_loop(other.scheme, task->problem)(&other);
}

static struct gm_progress of_euler(const struct gm_task *task)
{
    struct gm_task other = *task;
    other.scheme = gm_scheme_find("explicit-euler");
    return gm_scheme_loop(other.scheme, task->problem)(&other);
}

/* Theory sees the tableau alone: a loop that does not do what the right tableau says is found by
   measuring. */
static void a_wrong_loop_of_a_right_tableau(void **unused)
{
    (void)unused;
    gm_loop *const loops[] = {late, of_euler, of_rk2};
    for (size_t i = 0; i < GM_COUNT(loops); i++) {
        struct gm_scheme wrong = changed("rk4");
        struct gm_family family = *wrong.family;
        family.over_kernels = 0;
        family.loop = loops[i];
        wrong.family = &family;
        const struct gm_certificate certificate = gm_certify(&wrong);
        assert_true(certificate.theory.known && certificate.theory_holds);
        if (certificate.order_holds || fabs(certificate.order - (double)i) > 0.1) {
            fail_msg("wrong loop %zu: order %.2f", i, certificate.order);
        }
    }
}

/* A digit of one fraction changed: the composition stays symplectic and symmetric, and drops to order 2. */
static void a_wrong_digit_of_a_composition(void **unused)
{
    (void)unused;
    const char *const names[] = {
        "yoshida4", "suzuki4",   "mclachlan4",    "pefrl4",    "blanes-moan4",
        "yoshida6", "kahan-li6", "suzuki-umeno8", "kahan-li8", "blanes-moan-nystrom6"};
    for (size_t i = 0; i < GM_COUNT(names); i++) {
        struct gm_splitting digit = *(const struct gm_splitting *)gm_scheme_find(names[i])->coefficients;
        const int last = digit.count - 1;
        /* a drift and its mirror image grow, the two next ones shrink */
        const int drift = digit.pieces[0].piece == GM_DRIFT ? 0 : 1;
        const double change = 1e-4;
        digit.pieces[drift].fraction += change;
        digit.pieces[drift + 2].fraction -= change;
        digit.pieces[last - drift].fraction += change;
        digit.pieces[last - drift - 2].fraction -= change;
        struct gm_scheme wrong = changed(names[i]);
        wrong.coefficients = &digit;
        const struct gm_certificate certificate = gm_certify(&wrong);
        if (certificate.order_holds || !certificate.claims[0].holds || !certificate.claims[1].holds) {
            fail_msg("%s with a wrong digit: order %.2f", names[i], certificate.order);
        }
    }
}

/* Flows of pieces in wrong proportions are still Poisson maps, and symmetric, but not of that order. */
static void a_wrong_digit_of_a_bracket_splitting(void **unused)
{
    (void)unused;
    static const char *const names[] = {"bracket-splitting4", "bracket-splitting6"};
    for (size_t i = 0; i < GM_COUNT(names); i++) {
        struct gm_scheme wrong = changed(names[i]);
        struct gm_parts_row row = *(const struct gm_parts_row *)wrong.coefficients;
        struct gm_composition digit = *row.of_pieces;
        digit.gammas[0] += 1e-3;
        digit.gammas[1] -= 1e-3;
        row.of_pieces = &digit;
        wrong.coefficients = &row;
        const struct gm_certificate certificate = gm_certify(&wrong);
        assert_true(!certificate.order_holds && !certificate.holds);
        assert_true(certificate.claims[1].holds && certificate.claims[17].holds &&
                    certificate.claims[18].holds);
    }
}

/* The rows of implicit Runge-Kutta methods, each with one wrong digit. */
static void a_wrong_digit_of_a_tableau(void **unused)
{
    (void)unused;
    const char *const names[] = {"gauss6",
                                 "gauss8",
                                 "radau3",
                                 "radau5",
                                 "sdirk2",
                                 "midpoint-suzuki4",
                                 "midpoint-kahan-li6",
                                 "midpoint-kahan-li8"};
    for (size_t i = 0; i < GM_COUNT(names); i++) {
        const struct gm_tableau *right = gm_scheme_find(names[i])->coefficients;
        struct gm_tableau digit = *right;
        struct gm_composition composition = *right->composition;
        if (composition.steps > 1) {
            composition.gammas[0] += 1e-4;
            composition.gammas[1] -= 1e-4;
            digit.composition = &composition;
        } else {
            digit.a[digit.stages - 1][0] += 1e-3;
        }
        struct gm_scheme wrong = changed(names[i]);
        wrong.coefficients = &digit;
        const struct gm_certificate certificate = gm_certify(&wrong);
        if (certificate.order_holds) {
            fail_msg("%s with a wrong digit: order %.2f", names[i], certificate.order);
        }
    }
}

/* Runge-Kutta-Nystrom coefficients are of no use where T is not quadratic, and are not offered there. */
static void nystrom_needs_a_quadratic_kinetic_energy(void **unused)
{
    (void)unused;
    const struct gm_split general = {.nystrom = false};
    struct gm_problem problem = gm_problem_pendulum;
    struct gm_ode facets = *gm_ode_of(&problem);
    assert_true(gm_scheme_fits(gm_scheme_find("blanes-moan-nystrom4"), &problem));
    facets.split = &general;
    problem.facets = &facets;
    assert_false(gm_scheme_fits(gm_scheme_find("blanes-moan-nystrom4"), &problem));
    assert_true(gm_scheme_fits(gm_scheme_find("blanes-moan4"), &problem));
}

/* One name, one row for each structure; another name for the same row. */
static void names_find_the_row_that_fits(void **unused)
{
    (void)unused;
    const struct gm_scheme *separable = gm_scheme_find_for("symplectic-euler", &gm_problem_pendulum);
    const struct gm_scheme *other = gm_scheme_find_for("symplectic-euler", &gm_problem_product);
    assert_ptr_not_equal(separable, other);
    assert_true(gm_scheme_fits(separable, &gm_problem_pendulum) &&
                gm_scheme_fits(other, &gm_problem_product));
    assert_null(gm_scheme_find_for("symplectic-oyler", &gm_problem_product));
    assert_false(gm_scheme_fits(gm_scheme_find_for("verlet", &gm_problem_product), &gm_problem_product));
    assert_ptr_equal(gm_scheme_find("midpoint-yoshida4"), gm_scheme_find("rk4sym"));
    /* in any letter case; a scheme of that name has precedence where it fits */
    assert_ptr_equal(gm_scheme_find("Velocity-Verlet"), gm_scheme_find("verlet"));
    assert_ptr_equal(gm_scheme_find("RK4"), gm_scheme_find("rk4"));
    assert_string_equal(gm_scheme_find("leapfrog")->name, "leapfrog");
    assert_string_equal(gm_scheme_find_for("leapfrog", &gm_problem_pendulum)->name, "verlet");
    assert_string_equal(gm_scheme_find_for("leapfrog", &gm_problem_product)->name, "leapfrog");
    assert_true(gm_scheme_fits(gm_scheme_find("lobatto2"), &gm_problem_product));
    assert_false(gm_scheme_fits(gm_scheme_find("lobatto2"), &gm_problem_pendulum));
}

/* An alias has one meaning, and hides no scheme that fits where the meaning does. */
static void aliases_are_unambiguous(void **unused)
{
    (void)unused;
    for (size_t i = 0; i < gm_alias_count; i++) {
        const struct gm_alias *alias = &gm_aliases[i];
        for (size_t k = 0; k < i; k++) {
            assert_string_not_equal(alias->typed, gm_aliases[k].typed);
        }
        const struct gm_scheme *meant = gm_scheme_find(alias->scheme), *named = gm_scheme_find(alias->typed);
        if (meant) { /* a build without GSL lacks some */
            assert_string_equal(meant->name, alias->scheme);
            assert_true(named == meant || named->family->kind != meant->family->kind);
        }
    }
}

/* Leapfrog with a little friction, which no law survives. */
static enum gm_status rubbed(struct gm_two_step_work *work, const struct gm_problem *problem, double dt,
                             struct gm_progress *progress)
{
    const double *past = work->level[0], *now = work->level[1];
    double *next = work->level[2];
    const struct gm_two_step_row *leapfrog = gm_scheme_find("leapfrog")->coefficients;
    const enum gm_status status = leapfrog->step(work, problem, dt, progress);
    for (size_t i = 0; i < work->points; i++) {
        next[i] -= 1e-4 * (now[i] - past[i]);
    }
    return status;
}

/* McLachlan's splitting holds what it claims, and is not the method whose name it has here. */
static void a_name_of_another_method(void **unused)
{
    (void)unused;
    struct gm_scheme wrong = changed("mclachlan2");
    wrong.name = "variational-trapezoidal2";
    const struct gm_certificate certificate = gm_certify(&wrong);
    assert_true(certificate.order_holds && certificate.theory_holds);
    assert_string_equal(certificate.same.other->name, "verlet");
    assert_true(certificate.same.difference > 1e-6);
    assert_false(certificate.same.holds);
    assert_false(certificate.holds);
}

static void a_wave_with_friction(void **unused)
{
    (void)unused;
    struct gm_two_step_row row = *(const struct gm_two_step_row *)gm_scheme_find("leapfrog")->coefficients;
    row.step = rubbed;
    struct gm_scheme wrong = changed("leapfrog");
    wrong.coefficients = &row;
    const struct gm_certificate certificate = gm_certify(&wrong);
    assert_false(certificate.holds);
    assert_false(certificate.claims[7].holds); /* multisymplectic */
    assert_false(certificate.claims[1].holds); /* symmetric */
}

/* Leapfrog has a law of nodes, not the box's law of cells. */
static void the_law_of_another_scheme(void **unused)
{
    (void)unused;
    struct gm_two_step_row row = *(const struct gm_two_step_row *)gm_scheme_find("leapfrog")->coefficients;
    row.law = GM_LAW_CELLS;
    struct gm_scheme wrong = changed("leapfrog");
    wrong.coefficients = &row;
    assert_false(gm_certify(&wrong).claims[7].holds);
}

/* The logarithmic Hamiltonian with the whole drift first: symplectic Euler, which no step undoes. */
static void half_drifts_as_one(const struct gm_problem *problem, double ds, double binding, double *y,
                               double *t)
{
    double f[4], potential;
    const double d = ds / ((y[2] * y[2] + y[3] * y[3]) / 2 + binding);
    y[0] += d * y[2];
    y[1] += d * y[3];
    *t += d;
    gm_field(problem, y, f, 1);
    gm_ode_of(problem)->kepler_split->potential(problem, y, &potential, 1);
    y[2] -= ds * f[2] / potential;
    y[3] -= ds * f[3] / potential;
}

/* The kick of the right scheme, turned a little out of the line to the centre. */
static void kick_aside(const struct gm_problem *problem, double ds, double binding, double *y, double *t)
{
    half_drifts_as_one(problem, ds, binding, y, t);
    y[2] += 1e-6 * ds * y[1];
    y[3] -= 1e-6 * ds * y[0];
}

typedef void fictitious_step(const struct gm_problem *problem, double ds, double binding, double *y,
                             double *t);

/* A step of logh2's or levi-civita's family that is made in one of these ways; its memory begins with B. */
static enum gm_status make_wrong(fictitious_step *made, const struct gm_task *task,
                                 struct gm_members *members, struct gm_progress *progress)
{
    double passed = 0;
    made(task->problem, task->dt, members->memory[0], members->y, &passed);
    progress->t += passed;
    progress->evaluations++;
    return passed * task->dt > 0 ? GM_OK : GM_STEP_COLLAPSE;
}

static enum gm_status make_one_drift(const struct gm_task *task, struct gm_members *members,
                                     struct gm_progress *progress)
{
    return make_wrong(half_drifts_as_one, task, members, progress);
}

static enum gm_status make_aside(const struct gm_task *task, struct gm_members *members,
                                 struct gm_progress *progress)
{
    return make_wrong(kick_aside, task, members, progress);
}

static void a_logarithmic_hamiltonian_gone_wrong(void **unused)
{
    (void)unused;
    struct gm_scheme wrong = changed("logh2");
    struct gm_family family = *wrong.family;
    struct gm_member_family members = *family.members;
    wrong.family = &family;
    wrong.order = 1;
    family.members = &members;
    members.step = make_one_drift;
    struct gm_certificate certificate = gm_certify(&wrong);
    assert_true(certificate.order_holds);
    assert_true(certificate.claims[12].holds);                                          /* bilinear */
    assert_true(certificate.claims[1].measured && certificate.claims[1].defect > 1e-6); /* symmetric */
    assert_false(certificate.claims[1].holds);
    assert_true(certificate.claims[2].measured); /* reversible */
    assert_false(certificate.claims[2].holds);
    members.step = make_aside;
    certificate = gm_certify(&wrong);
    assert_true(certificate.claims[12].measured && certificate.claims[12].defect > 1e-9);
    assert_false(certificate.claims[12].holds);
    assert_false(certificate.claims[1].holds || certificate.claims[2].holds);
}

static void a_fictitious_time_gone_wrong(void **unused)
{
    (void)unused;
    struct gm_scheme wrong = changed("levi-civita");
    struct gm_family family = *wrong.family;
    struct gm_member_family members = *family.members;
    wrong.family = &family;
    wrong.order = 1;
    family.members = &members;
    members.step = make_one_drift;
    struct gm_certificate certificate = gm_certify(&wrong);
    assert_true(certificate.order_holds);
    assert_true(certificate.claims[12].holds);                                          /* bilinear */
    assert_true(certificate.claims[1].measured && certificate.claims[1].defect > 1e-6); /* symmetric */
    assert_false(certificate.claims[2].holds);                                          /* reversible */
    assert_false(certificate.holds);
    members.step = make_aside;
    certificate = gm_certify(&wrong);
    assert_true(certificate.claims[12].measured && certificate.claims[12].defect > 1e-9);
    assert_false(certificate.claims[12].holds);
    static const char *const composed[] = {"logh-suzuki4", "logh-kahan-li6", "logh-kahan-li8",
                                           "logh-sofroniou-spaletta10"};
    for (size_t i = 0; i < GM_COUNT(composed); i++) {
        wrong = changed(composed[i]);
        struct gm_composition digit = *(const struct gm_composition *)wrong.coefficients;
        digit.gammas[1] += 1e-4;
        wrong.coefficients = &digit;
        certificate = gm_certify(&wrong);
        assert_false(certificate.order_holds);
        assert_true(certificate.claims[1].holds && certificate.claims[12].holds);
    }
}

/* The midpoint rule of a uniform mesh with its stage a little late: no discrete Lagrangian has it. */
static void a_stage_that_is_late(void **unused)
{
    (void)unused;
    struct gm_mesh_tableau late = gm_tableau_gauss2;
    late.a[0][0] += 1e-4;
    late.abar[0][0] += 1e-4;
    struct gm_mesh_row row = *(const struct gm_mesh_row *)gm_scheme_find("uniform-gauss2")->coefficients;
    row.tableau = &late;
    struct gm_scheme wrong = changed("uniform-gauss2");
    wrong.coefficients = &row;
    const struct gm_certificate certificate = gm_certify(&wrong);
    assert_true(certificate.claims[7].measured && certificate.claims[7].defect > 1e-7);
    assert_false(certificate.claims[7].holds);
    assert_false(certificate.claims[1].holds);
}

int main(int argc, char *argv[])
{
    all = argc > 1 && strcmp(argv[1], "all") == 0;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_row_holds),
        cmocka_unit_test(verlet_with_halves_exchanged),
        cmocka_unit_test(order_that_is_not_reached),
        cmocka_unit_test(symplecticity_that_is_false),
        cmocka_unit_test(properties_that_are_false),
        cmocka_unit_test(equivariance_that_is_false),
        cmocka_unit_test(what_cannot_be_measured),
        cmocka_unit_test(the_misprint_of_rk4sym),
        cmocka_unit_test(a_wrong_digit_of_gauss4),
        cmocka_unit_test(wrong_weights_of_lobatto_in_time),
        cmocka_unit_test(structure_that_is_not_asked_for),
        cmocka_unit_test(moser_and_veselov_with_other_steps),
        cmocka_unit_test(newmark_with_other_weights),
        cmocka_unit_test(steps_that_remember),
        cmocka_unit_test(a_wrong_digit_of_a_discrete_lagrangian),
        cmocka_unit_test(one_order_too_many),
        cmocka_unit_test(a_wrong_loop_of_a_right_tableau),
        cmocka_unit_test(a_wrong_digit_of_a_composition),
        cmocka_unit_test(a_wrong_digit_of_a_bracket_splitting),
        cmocka_unit_test(a_wrong_digit_of_a_tableau),
        cmocka_unit_test(nystrom_needs_a_quadratic_kinetic_energy),
        cmocka_unit_test(names_find_the_row_that_fits),
        cmocka_unit_test(aliases_are_unambiguous),
        cmocka_unit_test(a_name_of_another_method),
        cmocka_unit_test(a_wave_with_friction),
        cmocka_unit_test(the_law_of_another_scheme),
        cmocka_unit_test(a_logarithmic_hamiltonian_gone_wrong),
        cmocka_unit_test(a_fictitious_time_gone_wrong),
        cmocka_unit_test(a_stage_that_is_late),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
