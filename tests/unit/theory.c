/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Theory against what is known of methods, against errors planted in every coefficient, and, for splittings,
   against the coefficients of Lyndon words, which share nothing with trees. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <gsl/gsl_errno.h>

#include "core/arena.h"
#include "core/basics.h"
#include "core/ode/problems/problems.h"
#include "core/schemes.h"
#include "core/theory/certify.h"
#include "core/theory/polynomial.h"
#include "core/theory/theory.h"
#include "core/theory/trees.h"

/* "1/2, 0 | 1/4, -3/4 ; 1/2, 1/2": rows of a, then b; entries are decimals or ratios of integers */
static struct gm_coefficients tableau(struct gm_arena *arena, const char *text)
{
    struct gm_coefficients coefficients;
    struct gm_ball entries[400];
    size_t count = 0;
    int stages = 1;
    for (const char *c = text; *c != ';'; c++) {
        stages += *c == '|' ? 1 : 0;
    }
    for (const char *at = text; *at;) {
        char *end;
        const double p = strtod(at, &end);
        assert_true(end > at);
        if (*end == '/') {
            const long q = strtol(end + 1, &end, 10);
            entries[count++] = gm_ball_ratio((long)p, q);
        } else {
            entries[count++] = gm_ball_written(p);
        }
        at = end + strspn(end, " ,|;");
    }
    assert_int_equal(count, stages * stages + stages);
    gm_coefficients_open(arena, &coefficients, GM_EQUATIONS_PLAIN, stages);
    memcpy(coefficients.a[0], entries, count * sizeof entries[0]); /* b follows a */
    return coefficients;
}

static struct gm_theory theory_of(const char *text)
{
    struct gm_arena *arena = gm_arena_open();
    struct gm_coefficients coefficients = tableau(arena, text);
    const struct gm_theory theory = gm_theory_of(arena, &coefficients);
    gm_arena_close(arena);
    assert_true(theory.known);
    return theory;
}

#define EXPLICIT_4(a21, a31, a32, a41, a42, a43, b1, b2, b3, b4)                                             \
    "0,0,0,0|" a21 ",0,0,0|" a31 "," a32 ",0,0|" a41 "," a42 "," a43 ",0;" b1 "," b2 "," b3 "," b4
#define RK4 EXPLICIT_4("1/2", "0", "1/2", "0", "0", "1", "1/6", "1/3", "1/3", "1/6")
#define DORMAND_PRINCE(b7)                                                                                   \
    "0,0,0,0,0,0,0|1/5,0,0,0,0,0,0|3/40,9/40,0,0,0,0,0|44/45,-56/15,32/9,0,0,0,0|"                           \
    "19372/6561,-25360/2187,64448/6561,-212/729,0,0,0|9017/3168,-355/33,46732/5247,49/176,-5103/18656,0,0|"  \
    "35/384,0,500/1113,125/192,-2187/6784,11/84,0;" b7
#define RADAU5(sign)                                                                                         \
    "0.19681547722366044,-0.065535425850198389,0.023770974348220153|"                                        \
    "0.39442431473908727,0.29207341166522845," sign "0.041548752125997930|"                                  \
    "0.37640306270046728,0.51248582618842162,1/9;0.37640306270046728,0.51248582618842162,1/9"

static void known_methods(void **unused)
{
    (void)unused;
    static const struct {
        const char *tableau;
        int order, b, c;
    } known[] = {
        {RK4, 4, 4, 1},
        {EXPLICIT_4("1/3", "-1/3", "1", "1", "-1", "1", "1/8", "3/8", "3/8", "1/8"), 4, 4,
         1},                                            /* Kutta's 3/8 */
        {"0,0,0|1/3,0,0|0,2/3,0;1/4,0,3/4", 3, 3, 1},   /* Heun 3 */
        {"0,0,0|1/2,0,0|0,3/4,0;2/9,1/3,4/9", 3, 3, 1}, /* Ralston 3 */
        {DORMAND_PRINCE("35/384,0,500/1113,125/192,-2187/6784,11/84,0"), 5, 5, 1},
        {DORMAND_PRINCE("5179/57600,0,7571/16695,393/640,-92097/339200,187/2100,1/40"), 4, 4, 1},
        {"1/6,-1/3,1/6|1/6,5/12,-1/12|1/6,2/3,1/6;1/6,2/3,1/6", 4, 4, 2}, /* Lobatto IIIC */
        {"0,0,0|5/24,1/3,-1/24|1/6,2/3,1/6;1/6,2/3,1/6", 4, 4, 3},        /* Lobatto IIIA */
        {RADAU5("-"), 5, 5, 3},
    };
    for (size_t i = 0; i < GM_COUNT(known); i++) {
        const struct gm_theory theory = theory_of(known[i].tableau);
        assert_int_equal(theory.order, known[i].order);
        assert_int_equal(theory.b, known[i].b);
        assert_int_equal(theory.c, known[i].c);
        assert_false(theory.symplectic);
    }
    /* the principal error of RK4 as Prince and Dormand measure it is .0145 */
    assert_float_equal(theory_of(RK4).error_constant, 0.014504582343198202 * 256, 1e-12);
}

/* As they stand in print and in libraries: what fails is named. */
static void wrong_methods(void **unused)
{
    (void)unused;
    static const struct {
        const char *tableau;
        int order;
        const char *condition;
    } wrong[] = {
        /* weights exchanged */
        {EXPLICIT_4("1/2", "0", "1/2", "0", "0", "1", "1/3", "1/6", "1/3", "1/6"), 1, "t[t]"},
        {EXPLICIT_4("1/2", "0", "1/2", "0", "0", "1", "1/6", "1/3", "1/6", "1/3"), 1, "t[t]"},
        /* Kutta's 3/8 with a sign lost, in the third stage and in the fourth */
        {EXPLICIT_4("1/3", "1/3", "1", "1", "-1", "1", "1/8", "3/8", "3/8", "1/8"), 1, "t[t]"},
        {EXPLICIT_4("1/3", "-1/3", "1", "1", "1", "1", "1/8", "3/8", "3/8", "1/8"), 1, "t[t]"},
        /* the third stage of RK4 takes both slopes: consistent, of order 3 no longer */
        {EXPLICIT_4("1/2", "1/4", "1/4", "0", "0", "1", "1/6", "1/3", "1/3", "1/6"), 2, "t[t[t]]"},
        /* Heun's nodes with the weights of Simpson's rule */
        {"0,0,0|1/3,0,0|0,2/3,0;1/6,2/3,1/6", 1, "t[t]"},
        /* a stage knows the wrong one of two: all rows sum to the right nodes */
        {"0,0,0|1/3,0,0|2/3,0,0;1/4,0,3/4", 2, "t[t[t]]"},
        /* Dormand and Prince's pair: -212/729 has lost its sign, and a digit is wrong in -5103/18656 */
        {"0,0,0,0,0,0|1/5,0,0,0,0,0|3/40,9/40,0,0,0,0|44/45,-56/15,32/9,0,0,0|"
         "19372/6561,-25360/2187,64448/6561,212/729,0,0|9017/3168,-355/33,46732/5247,49/176,-5103/18656,0;"
         "35/384,0,500/1113,125/192,-2187/6784,11/84",
         1, "t[t]"},
        {"0,0,0,0,0,0|1/5,0,0,0,0,0|3/40,9/40,0,0,0,0|44/45,-56/15,32/9,0,0,0|"
         "19372/6561,-25360/2187,64448/6561,-212/729,0,0|9017/3168,-355/33,46732/5247,49/176,-5103/18657,0;"
         "35/384,0,500/1113,125/192,-2187/6784,11/84",
         1, "t[t]"},
        /* Radau IIA with a sign lost */
        {RADAU5(""), 1, "t[t]"},
        /* the first row of Lobatto IIIA as it stands in IIIC */
        {"1/6,-1/3,1/6|5/24,1/3,-1/24|1/6,2/3,1/6;1/6,2/3,1/6", 3, "t[t[t,t]]"},
    };
    for (size_t i = 0; i < GM_COUNT(wrong); i++) {
        const struct gm_theory theory = theory_of(wrong[i].tableau);
        assert_int_equal(theory.order, wrong[i].order);
        assert_string_equal(theory.condition, wrong[i].condition);
    }
}

static void numbers_of_trees(void **unused)
{
    (void)unused;
    static const int rooted[] = {1, 1, 2, 4, 9, 20, 48, 115, 286, 719};
    struct gm_arena *arena = gm_arena_open();
    struct gm_trees trees = gm_trees_open(arena, GM_EQUATIONS_PLAIN);
    for (int order = 1; order <= GM_TREES_ORDER; order++) {
        gm_trees_grow(&trees);
        assert_int_equal(trees.first[order + 1] - trees.first[order], rooted[order - 1]);
        /* Cayley's formula: n! / (sigma gamma) = alpha orderings, (n - 1)! in all; n^(n-1) labelled ones */
        double orderings = 0, labelled = 0;
        for (int i = trees.first[order]; i < trees.first[order + 1]; i++) {
            const struct gm_tree *tree = &trees.trees[i];
            orderings += tgamma(order + 1) / (tree->symmetry * gm_tree_density(tree));
            labelled += tgamma(order + 1) / tree->symmetry;
        }
        assert_float_equal(orderings, tgamma(order), 1e-9 * tgamma(order));
        assert_float_equal(labelled, pow(order, order - 1), 1e-9 * pow(order, order - 1));
    }
    char text[40];
    gm_tree_print(&trees, 7, text, sizeof text);
    assert_string_equal(text, "t[t,t,t]");
    trees = gm_trees_open(arena, GM_EQUATIONS_PARTITIONED);
    for (int order = 1; order <= 8; order++) {
        gm_trees_grow(&trees);
    }
    assert_int_equal(trees.first[9], 24314);
    gm_arena_close(arena);
}

static void every_row(void **unused)
{
    (void)unused;
    size_t rows = 0;
    for (size_t i = 0; i < gm_scheme_count(); i++) {
        const struct gm_scheme *scheme = gm_scheme_at(i);
        struct gm_coefficients coefficients;
        if (!scheme->family->coefficients_open) {
            continue;
        }
        rows++;
        struct gm_arena *arena = gm_arena_open();
        scheme->family->coefficients_open(arena, scheme, &coefficients);
        const struct gm_theory theory = gm_theory_of(arena, &coefficients);
        gm_arena_close(arena);
        const bool right = theory.known && theory.order == scheme->order &&
                           theory.symplectic == ((scheme->claims & GM_SYMPLECTIC) != 0) &&
                           theory.symmetric == ((scheme->claims & GM_SYMMETRIC) != 0);
        if (!right) {
            fail_msg("%s: order %d, symplectic %d, symmetric %d by theory", scheme->name, theory.order,
                     theory.symplectic, theory.symmetric);
        }
    }
    assert_true(rows >= 37);
}

/* Whether an error of a part in 10^9, half a unit of the tenth digit or more, is found: an order, symmetry or
   symplecticity is lost. */
static bool is_found(struct gm_arena *arena, struct gm_coefficients *coefficients, struct gm_ball *entry,
                     const struct gm_scheme *scheme)
{
    const struct gm_ball before = *entry;
    *entry = gm_ball_multiply(before, gm_ball_of(1 + 1e-9));
    const struct gm_theory theory = gm_theory_of(arena, coefficients);
    *entry = before;
    return theory.order < scheme->order || theory.symplectic != ((scheme->claims & GM_SYMPLECTIC) != 0) ||
           theory.symmetric != ((scheme->claims & GM_SYMMETRIC) != 0);
}

/* Of order 1 implicit Euler asks for b alone: another a is another scheme of order 1. */
static void planted_errors(void **unused)
{
    (void)unused;
    size_t planted = 0;
    for (size_t i = 0; i < gm_scheme_count(); i++) {
        const struct gm_scheme *scheme = gm_scheme_at(i);
        struct gm_coefficients coefficients;
        if (!scheme->family->coefficients_open) {
            continue;
        }
        struct gm_arena *arena = gm_arena_open();
        scheme->family->coefficients_open(arena, scheme, &coefficients);
        const int s = coefficients.stages;
        for (int side = 0; side < gm_coefficients_sides(&coefficients); side++) {
            for (int k = 0; k < s * s + s; k++) {
                struct gm_ball *entry = &coefficients.a[side][k];
                /* a splitting's entries are its fractions, which stand in b */
                const bool copy = coefficients.equations >= GM_EQUATIONS_SEPARABLE && k < s * s;
                if (gm_ball_may_vanish(*entry) || copy) {
                    continue;
                }
                planted++;
                const bool another = strcmp(scheme->name, "implicit-euler") == 0 && k < s * s;
                if (is_found(arena, &coefficients, entry, scheme) == another) {
                    fail_msg("%s: an error in entry %d of side %d", scheme->name, k, side);
                }
            }
        }
        gm_arena_close(arena);
    }
    assert_true(planted > 300);
}

/* A row that claims more than its coefficients give. */
static void wrong_claims(void **unused)
{
    (void)unused;
    struct gm_scheme wrong = *gm_scheme_find("rk4");
    assert_true(gm_certify(&wrong).holds);
    wrong.order = 5;
    assert_false(gm_certify(&wrong).theory_holds);
    wrong = *gm_scheme_find("trapezoidal");
    wrong.claims |= GM_SYMPLECTIC;
    assert_false(gm_certify(&wrong).theory_holds);
    wrong = *gm_scheme_find("ruth3");
    wrong.claims |= GM_SYMMETRIC;
    assert_false(gm_certify(&wrong).theory_holds);
}

static void stability(void **unused)
{
    (void)unused;
    const struct gm_theory_stability rk4 = theory_of(RK4).stability;
    assert_float_equal(rk4.real, 2.78529356340528, 1e-13);
    assert_float_equal(rk4.imaginary, 2 * sqrt(2), 1e-13);
    assert_false(rk4.a_stable);
    const struct gm_theory_stability radau = theory_of(RADAU5("-")).stability;
    assert_true(radau.l_stable && isinf(radau.real) && isinf(radau.imaginary));
    const struct gm_theory_stability gauss = theory_of("1/2;1").stability;
    assert_true(gauss.a_stable && !gauss.l_stable);
    const struct gm_theory_stability sdirk =
        theory_of("0.29289321881345247560,0|0.70710678118654752440,0.29289321881345247560;"
                  "0.70710678118654752440,0.29289321881345247560")
            .stability;
    assert_true(sdirk.l_stable);
    const struct gm_theory_stability euler = theory_of("0;1").stability;
    assert_true(euler.real == 2 && euler.imaginary == 0);
    /* R = (1 + 2z) / (1 + z): |R| = 1 at z = -2/3, before its pole */
    const struct gm_theory_stability backwards = theory_of("-1;1").stability;
    assert_false(backwards.a_stable);
    assert_float_equal(backwards.real, 2. / 3, 1e-15);
}

/* R of Euler's method extrapolated to order `most` from 1 .. most steps: sum_k w_k (1 + z / k)^k. */
static double extrapolated(int most, const double *weights, double z)
{
    double sum = 0;
    for (int k = 1; k <= most; k++) {
        sum += weights[k] * pow(1 + z / k, k);
    }
    return sum;
}

/* Decimals of 15 digits and large weights of both signs: what is known of R is enough for its interval. */
static void stability_of_decimals(void **unused)
{
    (void)unused;
    enum { MOST = 6, STAGES = 1 + MOST * (MOST - 1) / 2 };
    double weights[MOST + 1] = {0}, low = 0.1, high = 20;
    struct gm_coefficients coefficients;
    struct gm_arena *arena = gm_arena_open();
    gm_coefficients_open(arena, &coefficients, GM_EQUATIONS_PLAIN, STAGES);
    for (int k = 1, first = 1; k <= MOST; first += k++ - 1) {
        weights[k] = ((MOST - k) % 2 ? -1 : 1) * pow(k, MOST - 1) / (tgamma(k) * tgamma(MOST - k + 1));
        /* the first of k steps is the one from y0, which all share */
        for (int i = 0; i < k; i++) {
            struct gm_ball *b = &coefficients.b[0][i ? first + i - 1 : 0];
            *b = gm_ball_add(*b, gm_ball_written(weights[k] / k));
            for (int j = 0; j < i; j++) {
                coefficients.a[0][(first + i - 1) * STAGES + (j ? first + j - 1 : 0)] =
                    gm_ball_written(1. / k);
            }
        }
    }
    while (high - low > 1e-12) {
        const double middle = (low + high) / 2;
        *(fabs(extrapolated(MOST, weights, -middle)) <= 1 ? &low : &high) = middle;
    }
    const struct gm_theory theory = gm_theory_of(arena, &coefficients);
    gm_arena_close(arena);
    assert_int_equal(theory.order, MOST);
    assert_true(theory.stability.known);
    assert_float_equal(theory.stability.real, low, 1e-9);
}

/* 1 - 3 x + 2 x^2 and (1 - x)^2 (3 - x), which touches zero at 1 */
static void signs(void **unused)
{
    (void)unused;
    struct gm_polynomial p = {.degree = 2, .at = {gm_ball_of(1), gm_ball_of(-3), gm_ball_of(2)}};
    assert_float_equal(gm_polynomial_first_negative(&p), 0.5, 1e-15);
    struct gm_polynomial touching = {.degree = 3,
                                     .at = {gm_ball_of(3), gm_ball_of(-7), gm_ball_of(5), gm_ball_of(-1)}};
    for (int k = 0; k <= 3; k++) {
        touching.at[k].radius = 1e-15;
    }
    assert_float_equal(gm_polynomial_first_negative(&touching), 3, 1e-14);
    assert_false(gm_polynomial_is_hurwitz(&p));
    struct gm_polynomial left = {.degree = 3,
                                 .at = {gm_ball_of(6), gm_ball_of(11), gm_ball_of(6), gm_ball_of(1)}};
    assert_true(gm_polynomial_is_hurwitz(&left));
    left.at[0] = gm_ball_of(70);
    assert_false(gm_polynomial_is_hurwitz(&left));
}

static void balls(void **unused)
{
    (void)unused;
    const struct gm_ball third = gm_ball_ratio(1, 3), one = gm_ball_of(1);
    const struct gm_ball nothing = gm_ball_subtract(gm_ball_multiply(third, gm_ball_of(3)), one);
    assert_true(gm_ball_may_vanish(nothing));
    assert_true(nothing.radius > 0 && nothing.radius < 1e-75);
    assert_int_equal(gm_ball_sign(gm_ball_subtract(third, gm_ball_of(1. / 3))), 1);
    const struct gm_ball written = gm_ball_written(1. / 3);
    assert_true(gm_ball_is_same(&third, &written));
    assert_true(gm_ball_written(0.75).radius == 0 && gm_ball_written(-0.123456).radius == 0.5e-15);
}

/* A decimal is what its digits say, whatever double lies next to it; what stands behind it is none of it. */
static void decimals(void **unused)
{
    (void)unused;
    static const struct {
        const char *text;
        double radius, beyond; /* of the double */
    } typed[] = {
        {"0.5", 0, 0},
        {"0.50000000000000000000", 0, 0},
        {"5000000e-7", 0, 0},
        {"0.50000000000000001", 0.5e-15, 1e-17},
        {"0.500000000000000001", 0.5e-18, 1e-18},
        {"0.99999999999999999999", 0.5e-20, -1e-20},
        {"1.00000000000000000000001", 0.5e-23, 1e-23},
        {"0.281250000000000000000000000001, 7", 0.5e-30, 1e-30},
    };
    for (size_t i = 0; i < GM_COUNT(typed); i++) {
        const double value = strtod(typed[i].text, NULL);
        const struct gm_ball ball =
            gm_ball_decimal(typed[i].text, strspn(typed[i].text, "0123456789.e-"), value);
        const double beyond = gm_ball_midpoint(gm_ball_subtract(ball, gm_ball_of(value)));
        if (fabs(ball.radius - typed[i].radius) > 1e-9 * typed[i].radius ||
            fabs(beyond - typed[i].beyond) > 1e-9 * fabs(typed[i].beyond)) {
            fail_msg("%s: radius %g, %g beyond its double", typed[i].text, ball.radius, beyond);
        }
    }
    /* longer than any number has to be: known by its digits too */
    char text[600] = "0.5";
    memset(text + 3, '0', 500);
    strcpy(text + 503, "1");
    assert_true(gm_ball_decimal(text, strlen(text), 0.5).radius > 0);
    static const struct {
        const char *text, *printed;
        int digits;
    } prints[] = {
        {"0", "0.00", 3},       {"12345", "12345", 3},      {"-1.5", "-1.50", 3},
        {"0.5", "0.500", 3},    {"0.0625", "0.0625000", 6}, {"-0.0009765625", "-0.0009765625", 7},
        {"99.996", "100.0", 4}, {"0.099996", "0.1000", 4},  {"1.3512071919596576", "1.35120719195965760", 18},
    };
    for (size_t i = 0; i < GM_COUNT(prints); i++) {
        const char *const typed_text = prints[i].text;
        gm_ball_print(gm_ball_decimal(typed_text, strlen(typed_text), strtod(typed_text, NULL)),
                      prints[i].digits, text, sizeof text);
        assert_string_equal(text, prints[i].printed);
    }
}

/* The coefficient of a word in the product of the flows exp(c_i X_i), against 1 / n! of exp(A + B): a
   splitting is of order p if, and only if, that of every Lyndon word of at most p letters is right. Hairer,
   Lubich & Wanner (2006), III.5.3; Murua & Sanz-Serna, Phil. Trans. R. Soc. A 357 (1999) 1079. */
static long double word_defect(const struct gm_coefficients *coefficients, unsigned word, int letters)
{
    long double part[12] = {1}, factorial = 1;
    for (int i = 0; i < coefficients->stages; i++) {
        const int piece = gm_ball_may_vanish(coefficients->b[GM_SIDE_Q][i]) ? GM_SIDE_P : GM_SIDE_Q;
        const long double c = gm_ball_midpoint(coefficients->b[piece][i]);
        for (int end = letters; end > 0; end--) {
            long double term = 1;
            for (int begin = end - 1; begin >= 0 && (int)(word >> begin & 1) == piece; begin--) {
                term *= c / (end - begin);
                part[end] += part[begin] * term;
            }
        }
    }
    for (int k = 2; k <= letters; k++) {
        factorial *= k;
    }
    return part[letters] - 1 / factorial;
}

/* smaller than each of its proper rotations; letters from bit 0 on */
static bool is_lyndon(unsigned word, int letters)
{
    for (int shift = 1; shift < letters; shift++) {
        int difference = 0;
        for (int k = 0; k < letters && difference == 0; k++) {
            difference = (int)(word >> k & 1) - (int)(word >> ((k + shift) % letters) & 1);
        }
        if (difference >= 0) {
            return false;
        }
    }
    return true;
}

static void lyndon_words(void **unused)
{
    (void)unused;
    size_t words = 0, splittings = 0;
    for (int letters = 1; letters <= 10; letters++) {
        for (unsigned word = 0; word < 1u << letters; word++) {
            words += is_lyndon(word, letters) ? 1 : 0;
        }
    }
    assert_int_equal(words, 226);
    for (size_t i = 0; i < gm_scheme_count(); i++) {
        const struct gm_scheme *scheme = gm_scheme_at(i);
        struct gm_coefficients coefficients;
        if (!scheme->family->coefficients_open) {
            continue;
        }
        struct gm_arena *arena = gm_arena_open();
        scheme->family->coefficients_open(arena, scheme, &coefficients);
        if (coefficients.equations == GM_EQUATIONS_SEPARABLE) {
            int order = 0;
            bool holds = true;
            while (holds && order < 10) {
                for (unsigned word = 0; word < 1u << (order + 1); word++) {
                    holds = holds && (!is_lyndon(word, order + 1) ||
                                      fabsl(word_defect(&coefficients, word, order + 1)) < 1e-13L);
                }
                order += holds ? 1 : 0;
            }
            assert_int_equal(order, gm_theory_of(arena, &coefficients).order);
            splittings++;
        }
        gm_arena_close(arena);
    }
    assert_true(splittings >= 15);
}

/* The exponentials of a wide ball are within its bound. */
static void wide_balls_hold_their_exponentials(void **unused)
{
    (void)unused;
    for (int k = -4; k <= 4; k++) {
        struct gm_ball wide = gm_ball_of(k / 2.);
        wide.radius = 1;
        const struct gm_ball found = gm_ball_exp(wide);
        for (int j = -1; j <= 1; j++) {
            assert_true(fabs(exp(k / 2. + j) - gm_ball_midpoint(found)) < found.radius);
        }
        assert_true(found.radius < 4 * exp(k / 2.)); /* the slope is e times the exponential at most */
    }
}

/* Verlet with the step turned around comes back; from an end that was pushed it comes back elsewhere. */
static void trials_turn_where_they_are_pushed(void **unused)
{
    (void)unused;
    static const struct gm_settings settings;
    const struct gm_trial trial = {&gm_problem_oscillator, gm_scheme_find("verlet"), &settings, 0.1, 7};
    const double start[] = {1, 0}, push = 0.125;
    double back[2], pushed[2];
    assert_int_equal(gm_problem_oscillator.n, 2);
    assert_true(gm_trial_turn(&trial, start, false, 0, back));
    assert_true(gm_trial_turn(&trial, start, false, push, pushed));
    assert_true(fabs(back[0] - 1) < 1e-14 && fabs(back[1]) < 1e-14);
    /* linear: what comes back of the push alone; its length changes by less than the square of the step */
    const double moved = hypot(pushed[0] - back[0], pushed[1] - back[1]);
    assert_true(fabs(moved - push) < 0.01 * push);
}

static int small_cosine(double t, const double *y, double *rate, void *size)
{
    (void)y;
    rate[0] = *(const double *)size * 40 * cos(40 * t);
    return GSL_SUCCESS;
}

/* Solutions far below 1 have as many digits as others, from a start that is 0, too. */
static void small_solutions_are_exact(void **unused)
{
    (void)unused;
    double size = 1e-12, y = 0;
    const gsl_odeiv2_system equations = {small_cosine, NULL, 1, &size};
    assert_true(gm_certify_solve(&equations, 1e-10, 2, &y));
    assert_true(fabs(y - size * sin(80)) < 1e-8 * size);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(balls),
        cmocka_unit_test(decimals),
        cmocka_unit_test(signs),
        cmocka_unit_test(numbers_of_trees),
        cmocka_unit_test(known_methods),
        cmocka_unit_test(wrong_methods),
        cmocka_unit_test(every_row),
        cmocka_unit_test(lyndon_words),
        cmocka_unit_test(planted_errors),
        cmocka_unit_test(stability),
        cmocka_unit_test(stability_of_decimals),
        cmocka_unit_test(wrong_claims),
        cmocka_unit_test(wide_balls_hold_their_exponentials),
        cmocka_unit_test(trials_turn_where_they_are_pushed),
        cmocka_unit_test(small_solutions_are_exact),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
