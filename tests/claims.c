/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every scheme held to its row; and wrong rows, which must be refused. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "core/certify.h"
#include "core/families/implicit_runge_kutta.h"
#include "core/families/splitting.h"

static void every_row_holds(void **unused) {
    (void)unused;
    assert_true(gm_scheme_count() >= 11);
    for (size_t i = 0; i < gm_scheme_count(); i++) {
        const struct gm_certificate certificate = gm_certify(gm_scheme_at(i));
        if (!certificate.holds) {
            fail_msg("%s breaks a claim; its order is %.3f", gm_scheme_at(i)->name, certificate.order);
        }
    }
}

static struct gm_scheme changed(const char *name) {
    const struct gm_scheme *scheme = gm_scheme_find(name);
    assert_non_null(scheme);
    return *scheme;
}

/* The half and the whole of Verlet exchanged. */
static void verlet_with_halves_exchanged(void **unused) {
    (void)unused;
    static const struct gm_splitting exchanged = {3, {{GM_KICK, 1}, {GM_DRIFT, 0.5}, {GM_KICK, 1}}};
    struct gm_scheme wrong = changed("verlet");
    wrong.coefficients = &exchanged;
    const struct gm_certificate certificate = gm_certify(&wrong);
    assert_false(certificate.order_holds);
    assert_false(certificate.holds);
    assert_true(certificate.claims[0].holds); /* any composition of shears is symplectic */
}

static void order_that_is_not_reached(void **unused) {
    (void)unused;
    struct gm_scheme wrong = changed("rk4");
    wrong.order = 5;
    assert_false(gm_certify(&wrong).holds);
}

static void symplecticity_that_is_false(void **unused) {
    (void)unused;
    const char *const names[] = {"explicit-euler", "implicit-euler", "trapezoidal", "rk2", "rk4"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        struct gm_scheme wrong = changed(names[i]);
        wrong.claims |= GM_SYMPLECTIC;
        const struct gm_certificate certificate = gm_certify(&wrong);
        assert_true(certificate.order_holds);
        assert_false(certificate.holds);
        assert_true(certificate.claims[0].defect > 1e-6);
    }
}

/* One claim too many, each on a scheme that has not the property. */
static void properties_that_are_false(void **unused) {
    (void)unused;
    const struct {
        const char *scheme;
        enum gm_claim claim;
    } wrong[] = {
        {"symplectic-euler", GM_SYMMETRIC},  {"rk4", GM_SYMMETRIC},       {"rk4", GM_REVERSIBLE},
        {"midpoint", GM_KEEPS_ENERGY},       {"verlet", GM_KEEPS_ENERGY}, {"rk4", GM_KEEPS_QUADRATIC},
        {"trapezoidal", GM_KEEPS_QUADRATIC}, {"semi-implicit", GM_KEEPS_QUADRATIC},
        {"steady", GM_KEEPS_LINEAR},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        struct gm_scheme scheme = changed(wrong[i].scheme);
        scheme.claims |= wrong[i].claim;
        assert_false(gm_certify(&scheme).holds);
    }
}

/* A claim that no problem here can measure is no claim. */
static void what_cannot_be_measured(void **unused) {
    (void)unused;
    struct gm_scheme wrong = changed("verlet");
    wrong.claims |= GM_MULTISYMPLECTIC;
    const struct gm_certificate certificate = gm_certify(&wrong);
    assert_true(certificate.order_holds);
    assert_false(certificate.holds);
}

/* b with 2^(1/2) for 2^(1/3), as printed: symplectic still, but of order 2. */
static void the_misprint_of_rk4sym(void **unused) {
    (void)unused;
    const double root = sqrt(2), b = (2 + root + 1 / root) / 3;
    const struct gm_implicit_row misprint = {
        .stages = 1, .a = {{0.5}}, .b = {1}, .substeps = 3, .fractions = {b, 1 - 2 * b, b}};
    struct gm_scheme wrong = changed("rk4sym");
    wrong.coefficients = &misprint;
    const struct gm_certificate certificate = gm_certify(&wrong);
    assert_false(certificate.order_holds);
    assert_true(certificate.claims[0].holds);
    wrong.order = 2;
    assert_true(gm_certify(&wrong).order_holds);
}

/* A wrong digit in Gauss' tableau costs the order or the symplecticity. */
static void a_wrong_digit_of_gauss4(void **unused) {
    (void)unused;
    const struct gm_implicit_row *right = gm_scheme_find("gauss4")->coefficients;
    struct gm_implicit_row digit = *right;
    digit.a[0][1] += 1e-4;
    struct gm_scheme wrong = changed("gauss4");
    wrong.coefficients = &digit;
    assert_false(gm_certify(&wrong).holds);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_row_holds),           cmocka_unit_test(verlet_with_halves_exchanged),
        cmocka_unit_test(order_that_is_not_reached), cmocka_unit_test(symplecticity_that_is_false),
        cmocka_unit_test(properties_that_are_false), cmocka_unit_test(what_cannot_be_measured),
        cmocka_unit_test(the_misprint_of_rk4sym),    cmocka_unit_test(a_wrong_digit_of_gauss4),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
