/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Phase portraits: equilibria of known systems and of random cubic fields, poles and jumps. */
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
#include "core/ode/portrait/portrait.h"
#include "tests/common/typed.h"

static void expect_near(double value, double expected, double most)
{
    if (!(fabs(value - expected) <= most)) {
        fail_msg("%.17g, not %.17g", value, expected);
    }
}

/* Opens the portrait of a text in a window {XMIN, XMAX, YMIN, YMAX}. */
static void open_text(struct gm_portrait *portrait, const char *text, const double bounds[4])
{
    struct typed typed;
    const struct gm_window window = {{bounds[0], bounds[2]}, {bounds[1], bounds[3]}};
    type(&typed, text);
    assert_true(gm_portrait_open(portrait, &typed.problem, &window));
    untype(&typed);
}

/* ---- known systems ---- */

struct known {
    double x, y;
    const char *kind;
    double eigenvalues[2][2];
};

static const struct {
    const char *text;
    double window[4];
    size_t count;
    struct known equilibria[4];
} systems[] = {
    {"components: x y\nrate: x = y\nrate: y = -sin(x) - 0.3*y\nstart: x = 1, y = 0\n",
     {-4, 4, -3, 3},
     3,
     {{-3.14159265358979, 0, "saddle", {{0.8611874, 0}, {-1.161187, 0}}},
      {0, 0, "stable focus", {{-0.15, 0.9886859}, {-0.15, -0.9886859}}},
      {3.14159265358979, 0, "saddle", {{0.8611874, 0}, {-1.161187, 0}}}}},
    {"components: x y\nrate: x = y\nrate: y = 0.5*(1 - x^2)*y - x\nstart: x = 1, y = 0\n",
     {-3, 3, -3, 3},
     1,
     {{0, 0, "unstable focus", {{0.25, 0.9682458}, {0.25, -0.9682458}}}}},
    {"components: v w\nrate: v = v - v^3/3 - w + 0.5\nrate: w = 0.08*(v + 0.7 - 0.8*w)\nstart: v = 0, w = 0\n",
     {-2.5, 2.5, -1, 2},
     1,
     {{-0.804847747, -0.131059684, "unstable focus", {{0.1441101, 0.1915469}, {0.1441101, -0.1915469}}}}},
    {"components: x y\nrate: x = x*(3 - x - 2*y)\nrate: y = y*(2 - x - y)\nstart: x = 1, y = 1\n",
     {-0.5, 3.5, -0.5, 2.5},
     4,
     {{0, 0, "unstable node", {{3, 0}, {2, 0}}},
      {0, 2, "stable node", {{-1, 0}, {-2, 0}}},
      {1, 1, "saddle", {{0.4142136, 0}, {-2.414214, 0}}},
      {3, 0, "stable node", {{-1, 0}, {-3, 0}}}}},
    {"coordinates: q\nmomenta: p\nH: p^2/2 + q^4/4 - q^2/2\nstart: q = 1, p = 0.1\n",
     {-2, 2, -2, 2},
     3,
     {{-1, 0, "centre", {{0, 1.414214}, {0, -1.414214}}},
      {0, 0, "saddle", {{1, 0}, {-1, 0}}},
      {1, 0, "centre", {{0, 1.414214}, {0, -1.414214}}}}},
    /* a Poisson system: of its energy the state (1, 2) is the least */
    {"components: x y\nbracket: x y = -x*y\nH: x - log(x) + y - 2*log(y)\nstart: x = 2, y = 2\n",
     {0.1, 4, 0.1, 4},
     1,
     {{1, 2, "centre", {{0, 1.414214}, {0, -1.414214}}}}},
    {"components: x y\nrate: x = x^2\nrate: y = -y\nstart: x = 1, y = 0\n",
     {-1.1, 1.3, -1.2, 1.5},
     1,
     {{0, 0, "degenerate", {{0, 0}, {-1, 0}}}}},
    /* triple zeros, and units in which the entries of the Jacobian differ by 10^18 */
    {"components: x y\nrate: x = y\nrate: y = -(x - 0.5)^3\nstart: x = 1, y = 0\n",
     {-2, 2, -2, 2},
     1,
     {{0.5, 0, "degenerate", {{0, 0}, {0, 0}}}}},
    {"components: x y\nrate: x = x^2 - y^2\nrate: y = x*y\nstart: x = 1, y = 0\n",
     {-2, 2, -2, 2},
     1,
     {{0, 0, "degenerate", {{0, 0}, {0, 0}}}}},
    {"components: x y\nrate: x = 1e-9*y\nrate: y = -1e9*x\nstart: x = 1, y = 0\n",
     {-2, 2, -2, 2},
     1,
     {{0, 0, "centre", {{0, 1}, {0, -1}}}}},
    {"components: x y\nrate: x = 1\nrate: y = x\nstart: x = 1, y = 0\n", {-1, 1, -1, 1}, 0, {{.kind = NULL}}},
    {"components: x y\nrate: x = y - x^2\nrate: y = y^2\nstart: x = 1, y = 1\n",
     {-2, 2, -2, 2},
     1,
     {{0, 0, "degenerate", {{0, 0}, {0, 0}}}}},
    /* a field that is small in most of the window */
    {"coordinates: q\nmomenta: p\nH: p^2/2 + 4*(1/q^12 - 1/q^6)\nstart: q = 1.2, p = 0\n",
     {0.8, 100, -3, 3},
     1,
     {{1.122462048309373, 0, "centre", {{0, 7.5595263}, {0, -7.5595263}}}}},
    {"coordinates: q\nmomenta: p\nH: p^2/2 - exp(-q^2)\nstart: q = 1, p = 0\n",
     {-10, 10, -3, 3},
     1,
     {{0, 0, "centre", {{0, 1.4142136}, {0, -1.4142136}}}}},
    {"components: x y\nrate: x = exp(-x)\nrate: y = -y\nstart: x = 1, y = 0\n",
     {-4, 400, -3, 3},
     0,
     {{.kind = NULL}}},
    {"components: x y\nrate: x = (x - 0.5)^2 + 1e-12\nrate: y = -y\nstart: x = 1, y = 0\n",
     {-4, 4, -3, 3},
     0,
     {{.kind = NULL}}},
    /* three in one cell, a trace that is not round-off, a corner */
    {"components: x y\nrate: x = (x - .1)*(x - .11)*(x - .12)\nrate: y = .3 - y\nstart: x = 1, y = 0\n",
     {-4, 4, -3, 3},
     3,
     {{.1, .3, "saddle", {{2e-4, 0}, {-1, 0}}},
      {.11, .3, "stable node", {{-1e-4, 0}, {-1, 0}}},
      {.12, .3, "saddle", {{2e-4, 0}, {-1, 0}}}}},
    {"components: x y\nrate: x = 1e-12*x - y\nrate: y = x + 1e-12*y\nstart: x = 1, y = 0\n",
     {-4, 4, -3, 3},
     1,
     {{0, 0, "unstable focus", {{1e-12, 1}, {1e-12, -1}}}}},
    {"components: x y\nrate: x = abs(x)\nrate: y = -y\nstart: x = 1, y = 0\n",
     {-4, 4, -3, 3},
     1,
     {{0, 0, "not smooth", {{NAN, NAN}, {NAN, NAN}}}}},
};

static void test_known_equilibria(void **state)
{
    (void)state;
    for (size_t i = 0; i < GM_COUNT(systems); i++) {
        struct gm_portrait portrait;
        open_text(&portrait, systems[i].text, systems[i].window);
        assert_int_equal(portrait.count, systems[i].count);
        for (size_t k = 0; k < portrait.count; k++) {
            const struct known *known = &systems[i].equilibria[k];
            const struct gm_equilibrium *found = &portrait.equilibria[k];
            expect_near(found->at[0], known->x, 1e-9);
            expect_near(found->at[1], known->y, 1e-9);
            assert_string_equal(gm_equilibrium_kind_name(found->kind), known->kind);
            for (size_t j = 0; j < 4; j++) {
                const double expected = known->eigenvalues[j / 2][j % 2];
                if (isnan(expected)) {
                    assert_true(isnan(found->eigenvalues[j / 2][j % 2]));
                    continue;
                }
                expect_near(found->eigenvalues[j / 2][j % 2], expected, 1e-6 * fmax(1, fabs(expected)));
            }
        }
        gm_portrait_close(&portrait);
    }
}

/* The places of double zeros are known to 1e-8 only: there f is round-off. */
static void test_double_zeros(void **state)
{
    (void)state;
    struct gm_portrait portrait;
    open_text(&portrait, "components: x y\nrate: x = x^4 - 2*x^2 + 1\nrate: y = -y\nstart: x = 0, y = 1\n",
              (const double[]){-3, 4, -1, 3});
    assert_int_equal(portrait.count, 2);
    for (size_t k = 0; k < portrait.count; k++) {
        const struct gm_equilibrium *found = &portrait.equilibria[k];
        expect_near(found->at[0], k == 0 ? -1 : 1, 1e-8);
        expect_near(found->at[1], 0, 1e-9);
        assert_int_equal(found->kind, GM_DEGENERATE);
        expect_near(found->eigenvalues[0][0], 0, 1e-9);
        expect_near(found->eigenvalues[1][0], -1, 1e-6);
    }
    gm_portrait_close(&portrait);
}

/* ---- random cubic fields ---- */

enum { FIELDS = 200, TERMS = 10, GRID = 200 };

struct cubic {
    double coefficients[2][TERMS];
};

/* x^i over x, i times x^(i - 1), or x^i itself. */
static double power(double x, int i, bool derived)
{
    double product = derived ? i : 1;
    for (int k = derived ? 1 : 0; k < i; k++) {
        product *= x;
    }
    return product;
}

/* The polynomial, or its derivative over x (1) or y (2). */
static double value_of(const double *coefficients, double x, double y, int over)
{
    double sum = 0;
    size_t k = 0;
    for (int i = 0; i <= 3; i++) {
        for (int j = 0; i + j <= 3; j++, k++) {
            sum += coefficients[k] * power(x, i, over == 1) * power(y, j, over == 2);
        }
    }
    return sum;
}

static void write_cubic(const struct cubic *cubic, char *text, size_t size)
{
    size_t used = (size_t)snprintf(text, size, "components: x y\n");
    for (size_t c = 0; c < 2; c++) {
        used += (size_t)snprintf(text + used, size - used, "rate: %s = 0", c ? "y" : "x");
        size_t k = 0;
        for (int i = 0; i <= 3; i++) {
            for (int j = 0; i + j <= 3; j++, k++) {
                used += (size_t)snprintf(text + used, size - used, " + (%.17g)*x^%d*y^%d",
                                         cubic->coefficients[c][k], i, j);
            }
        }
        used += (size_t)snprintf(text + used, size - used, "\n");
    }
    snprintf(text + used, size - used, "start: x = 0.3, y = 0.2\n");
}

/* Moves the middle of a box to a zero by Newton's method. Returns true if there is one near the box. */
static bool settle_box(const struct cubic *cubic, double *x, double *y)
{
    const double size = 4. / GRID, x0 = *x, y0 = *y;
    for (int i = 0; i < 50; i++) {
        double f[2], j[4];
        for (int c = 0; c < 2; c++) {
            f[c] = value_of(cubic->coefficients[c], *x, *y, 0);
            j[2 * c] = value_of(cubic->coefficients[c], *x, *y, 1);
            j[2 * c + 1] = value_of(cubic->coefficients[c], *x, *y, 2);
        }
        const double det = j[0] * j[3] - j[1] * j[2];
        *x -= (f[0] * j[3] - f[1] * j[1]) / det;
        *y -= (f[1] * j[0] - f[0] * j[2]) / det;
    }
    const bool is_zero = fabs(value_of(cubic->coefficients[0], *x, *y, 0)) < 1e-12 &&
                         fabs(value_of(cubic->coefficients[1], *x, *y, 0)) < 1e-12;
    return is_zero && fabs(*x - x0) < 2 * size && fabs(*y - y0) < 2 * size;
}

/* Returns true if a polynomial, given at the corners of the grid, changes its sign at those of a box. */
static bool changes_sign(const double *values, int box)
{
    const double *low = values + box / GRID * (GRID + 1) + box % GRID, *high = low + GRID + 1;
    const int above = (low[0] > 0) + (low[1] > 0) + (high[0] > 0) + (high[1] > 0);
    return above > 0 && above < 4;
}

static bool has(const struct gm_portrait *portrait, double x, double y)
{
    for (size_t k = 0; k < portrait->count; k++) {
        const double *at = portrait->equilibria[k].at;
        if (fabs(at[0] - x) < 1e-6 && fabs(at[1] - y) < 1e-6) {
            return true;
        }
    }
    return false;
}

/* Returns the number of zeros in the window [-2, 2] x [-2, 2] that a dense grid finds; each is an equilibrium. */
static size_t compare_with_grid(const struct cubic *cubic, const struct gm_portrait *portrait)
{
    static double values[2][(GRID + 1) * (GRID + 1)];
    const double size = 4. / GRID;
    size_t zeros = 0;
    for (int k = 0; k < 2 * (GRID + 1) * (GRID + 1); k++) {
        const int corner = k / 2;
        values[k % 2][corner] = value_of(cubic->coefficients[k % 2], -2 + size * (corner % (GRID + 1)),
                                         -2 + size * (corner / (GRID + 1)), 0);
    }
    for (int k = 0; k < GRID * GRID; k++) {
        double x = -2 + size * (0.5 + k % GRID), y = -2 + size * (0.5 + k / GRID);
        if (!changes_sign(values[0], k) || !changes_sign(values[1], k)) {
            continue;
        }
        if (settle_box(cubic, &x, &y) && fabs(x) < 2 - 1e-6 && fabs(y) < 2 - 1e-6) {
            zeros++;
            assert_true(has(portrait, x, y));
        }
    }
    return zeros;
}

static void test_random_cubics(void **state)
{
    (void)state;
    const double window[4] = {-2, 2, -2, 2};
    size_t zeros = 0;
    srand(7);
    for (int field = 0; field < FIELDS; field++) {
        struct cubic cubic;
        char text[2048];
        for (size_t k = 0; k < 2 * TERMS; k++) {
            cubic.coefficients[k / TERMS][k % TERMS] = 2. * rand() / RAND_MAX - 1;
        }
        write_cubic(&cubic, text, sizeof text);
        struct gm_portrait portrait;
        open_text(&portrait, text, window);
        zeros += compare_with_grid(&cubic, &portrait);
        for (size_t k = 0; k < portrait.count; k++) {
            const double *at = portrait.equilibria[k].at;
            double j[4], det, trace;
            for (size_t i = 0; i < k; i++) { /* each is found once */
                const double *other = portrait.equilibria[i].at;
                assert_true(hypot(at[0] - other[0], at[1] - other[1]) > 1e-6);
            }
            for (int c = 0; c < 2; c++) {
                expect_near(value_of(cubic.coefficients[c], at[0], at[1], 0), 0, 1e-9);
                j[2 * c] = value_of(cubic.coefficients[c], at[0], at[1], 1);
                j[2 * c + 1] = value_of(cubic.coefficients[c], at[0], at[1], 2);
            }
            det = j[0] * j[3] - j[1] * j[2];
            trace = j[0] + j[3];
            const char *kind = gm_equilibrium_kind_name(portrait.equilibria[k].kind);
            const char *shape = trace * trace >= 4 * det ? "node" : "focus";
            assert_true((strcmp(kind, "saddle") == 0) == (det < 0));
            assert_true(det < 0 || strstr(kind, shape));
            assert_true(det < 0 || (strncmp(kind, "stable", 6) == 0) == (trace < 0));
        }
        gm_portrait_close(&portrait);
    }
    assert_in_range(zeros, FIELDS, 9 * FIELDS);
}

/* ---- poles ---- */

/* Where the field changes its sign by a pole or a jump, it is marked; of tan(x) the zero is left. */
static void test_poles(void **state)
{
    (void)state;
    static const struct {
        const char *rate;
        double low, high; /* of the window along x */
        bool is_finite;
        size_t points;
    } rates[] = {{"1/x", -2, 2.1, true, 0},
                 {"x/abs(x) + 0.3", -2, 2.1, true, 0},
                 {"tan(x)", -2, 2.1, true, 1},
                 {"sqrt(1.5 - x)", 2, 3, false, 0}};
    for (size_t i = 0; i < GM_COUNT(rates); i++) {
        char text[256];
        struct gm_portrait portrait;
        snprintf(text, sizeof text, "components: x y\nrate: x = %s\nrate: y = -y\nstart: x = 1, y = 0\n",
                 rates[i].rate);
        open_text(&portrait, text, (const double[]){rates[i].low, rates[i].high, -1, 1.2});
        assert_int_equal(portrait.missing == NULL, rates[i].is_finite);
        const size_t row = GM_PORTRAIT_COLUMNS + 1;
        size_t changes = 0;
        for (size_t k = 1; k < row; k++) { /* along the lowest row */
            const double *values = portrait.fields[0] + k;
            changes += isfinite(values[-1]) && isfinite(values[0]) && (values[-1] > 0) != (values[0] > 0);
        }
        assert_int_equal(changes, rates[i].points);
        assert_int_equal(portrait.count, rates[i].points);
        gm_portrait_close(&portrait);
    }
}

/* Equilibria that fill a line or a circle are not listed; isolated ones beside them are. */
static void test_curves_of_equilibria(void **state)
{
    (void)state;
    static const struct {
        const char *rates;
        size_t count;
        bool fills_curve;
    } curves[] = {{"rate: x = y\nrate: y = y*x\n", 0, true},
                  {"rate: x = y*(x^2 + y^2 - 1)\nrate: y = -x*(x^2 + y^2 - 1)\n", 1, true},
                  {"rate: x = x*(y - 1)\nrate: y = x*(y + 1)\n", 0, true},
                  {"rate: x = 0\nrate: y = 0\n", 0, true},
                  {"rate: x = x^2\nrate: y = y^2\n", 1, false},
                  {"rate: x = x^2\nrate: y = -y\n", 1, false},
                  {"rate: x = x^3 - y\nrate: y = -y\n", 1, false}};
    for (size_t i = 0; i < sizeof curves / sizeof *curves; i++) {
        struct gm_portrait portrait;
        char text[256];
        snprintf(text, sizeof text, "components: x y\n%sstart: x = 1, y = 1\n", curves[i].rates);
        open_text(&portrait, text, (const double[]){-1, 2, -1.2, 2});
        assert_int_equal(portrait.count, curves[i].count);
        assert_int_equal(portrait.missing != NULL, curves[i].fills_curve);
        gm_portrait_close(&portrait);
    }
}

/* A portrait that is full says so. */
static void test_many_equilibria(void **state)
{
    (void)state;
    struct gm_portrait portrait;
    open_text(&portrait, "components: x y\nrate: x = sin(x)\nrate: y = sin(y)\nstart: x = 1, y = 1\n",
              (const double[]){-16, 15, -16, 15});
    assert_int_equal(portrait.count, GM_MOST_EQUILIBRIA);
    assert_non_null(strstr(portrait.missing, "64"));
    gm_portrait_close(&portrait);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_known_equilibria),     cmocka_unit_test(test_double_zeros),
        cmocka_unit_test(test_random_cubics),        cmocka_unit_test(test_poles),
        cmocka_unit_test(test_curves_of_equilibria), cmocka_unit_test(test_many_equilibria),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
