/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Linear stability of a scheme, by stepping a test equation, and of a Runge-Kutta method by its stability
   function with the tableau A, b,
       R(z) = 1 + z b' (I - z A)^-1 (1, ..., 1)'.
   E. Hairer & G. Wanner, Solving Ordinary Differential Equations II (1996), IV.2, IV.3. */
#include "core/ode/certify/linear_stability.h"
#include "core/functions/complex.h"
#include "core/functions/functions.h"
#include "core/linear/complex_matrix.h"

#include <complex.h>
#include <math.h>
#include <string.h>

#include "core/ode/families/composition.h"
#include "core/ode/families/families.h"
#include "core/ode/families/runge_kutta/explicit.h"
#include "core/ode/families/runge_kutta/implicit.h"
#include "core/ode/families/splitting/splitting.h"
#include "core/ode/problems/problems.h"
#include "core/run.h"

enum gm_linear_test gm_linear_test_of(const struct gm_scheme *scheme)
{
    if (scheme->family->adaptive || scheme->family->by_tolerance) {
        return GM_TEST_NONE;
    }
    return gm_scheme_fits(scheme, &gm_problem_linear)       ? GM_TEST_PLANE
           : gm_scheme_fits(scheme, &gm_problem_oscillator) ? GM_TEST_OSCILLATOR
                                                            : GM_TEST_NONE;
}

/* |y| after `steps` steps from y, all of length h. */
static double grown(const struct gm_problem *problem, const struct gm_scheme *scheme, double h,
                    const double *y, int64_t steps, double *end)
{
    const struct gm_settings settings = {.binding = 20, .tau0 = 0.1, .newmark_beta = 0.25};
    struct gm_run *run = gm_run_open(problem, scheme, &settings, 0, h, y);
    double size = NAN;
    if (run) {
        run->limit = 1e200;
        if (gm_run_advance(run, steps) == GM_OK) {
            size = 0;
            for (size_t i = 0; i < problem->n; i++) {
                size = gm_hypot(size, gm_run_state(run)[i]);
                end[i] = gm_run_state(run)[i];
            }
        }
    }
    gm_run_close(run);
    return size;
}

static double spectral_radius(double a, double b, double c, double d)
{
    const double half = (a + d) / 2, determinant = a * d - b * c, square = half * half - determinant;
    return square < 0 ? sqrt(determinant) : fabs(half) + sqrt(square);
}

double gm_linear_growth(const struct gm_scheme *scheme, double re, double im, int64_t steps)
{
    const enum gm_linear_test test = gm_linear_test_of(scheme);
    double ends[2][3];
    if (test == GM_TEST_PLANE) {
        /* the third component stays 0 */
        const double matrix[9] = {re, -im, 0, im, re, 0, 0, 0, 0}, y[3] = {1, 0, 0};
        struct gm_problem problem = gm_problem_linear;
        problem.parameters = matrix;
        return gm_pow(grown(&problem, scheme, 1, y, steps, ends[0]), 1 / (double)steps);
    }
    /* the oscillator of frequency 1 with the step w, that is h w; the matrix of one step by its columns */
    for (int k = 0; k < 2; k++) {
        const double start[2] = {k == 0, k == 1};
        if (test == GM_TEST_NONE || !isfinite(grown(&gm_problem_oscillator, scheme, im, start, 1, ends[k]))) {
            return NAN;
        }
    }
    return spectral_radius(ends[0][0], ends[1][0], ends[0][1], ends[1][1]);
}

/* R(z) = 1 + z b k of one tableau, (1 - z A) k = 1. */
static double complex stability_function(const struct gm_tableau *tableau, double complex z)
{
    const int stages = tableau->stages;
    double complex matrix[GM_TABLEAU_STAGES * GM_TABLEAU_STAGES], k[GM_TABLEAU_STAGES], sum = 1;
    for (int i = 0; i < stages; i++) {
        k[i] = 1;
        for (int j = 0; j < stages; j++) {
            matrix[i * stages + j] = (i == j ? 1 : 0) - z * tableau->a[i][j];
        }
    }
    if (!gm_complex_eliminate((size_t)stages, matrix, k)) {
        return INFINITY; /* a pole */
    }
    for (int i = stages - 1; i >= 0; i--) {
        sum += z * tableau->b[i] * k[i];
    }
    return sum;
}

/* A composition of shears of the oscillator of frequency w, step 1. */
static double splitting_radius(const struct gm_splitting *table, double w)
{
    double columns[2][2] = {{1, 0}, {0, 1}}; /* (q, p) of the two starts */
    for (int i = 0; i < table->count; i++) {
        const double c = table->pieces[i].fraction * w;
        for (int k = 0; k < 2; k++) {
            double *q = &columns[k][0], *p = &columns[k][1];
            if (table->pieces[i].piece == GM_DRIFT) {
                *q += c * *p;
            } else {
                *p -= c * *q;
            }
        }
    }
    return spectral_radius(columns[0][0], columns[1][0], columns[0][1], columns[1][1]);
}

double gm_linear_growth_known(const struct gm_scheme *scheme, double re, double im)
{
    const double complex z = re + im * I;
    if (scheme->family == &gm_family_explicit || scheme->family == &gm_family_implicit) {
        const struct gm_tableau *row = scheme->coefficients;
        const struct gm_composition *steps = row->composition ? row->composition : &gm_composition_none;
        double complex product = 1;
        for (int i = 0; i < steps->steps; i++) {
            product *= stability_function(row, gm_composition_fraction(steps, i) * z);
        }
        return gm_cabs(product);
    }
    if (gm_scheme_is_composition(scheme)) {
        const struct gm_substeps *substeps = scheme->coefficients;
        double product = gm_linear_test_of(scheme) == GM_TEST_PLANE ? 1 : NAN;
        for (int i = 0; i < substeps->count; i++) {
            const double fraction = substeps->at[i].fraction;
            product *= gm_linear_growth_known(substeps->at[i].scheme, fraction * re, fraction * im);
        }
        return product;
    }
    return scheme->family == &gm_family_splitting ? splitting_radius(scheme->coefficients, im) : NAN;
}

/* Returns the growth of a step minus 1 at the distance x. */
static double excess(const struct gm_scheme *scheme, double re, double im, double x, int64_t steps)
{
    const double growth = gm_linear_growth(scheme, x * re, x * im, steps);
    return isnan(growth) ? INFINITY : growth - 1;
}

double gm_linear_limit(const struct gm_scheme *scheme, double re, double im, double reach, int64_t steps)
{
    enum { SAMPLES = 5000, HALVINGS = 40 };
    const double rounding = 1e-7, noise = 1e-12;
    double inside = 0, outside = 0;
    for (int i = 1; i <= SAMPLES && outside == 0; i++) {
        const double x = reach * i / SAMPLES;
        if (excess(scheme, re, im, x, steps) > rounding) {
            outside = x;
        } else {
            inside = x;
        }
    }
    if (outside == 0) {
        return reach;
    }
    /* towards 0 by factors of sqrt 2, until rounding is reached or growth ends */
    double before = excess(scheme, re, im, outside, steps);
    for (double x = outside / sqrt(2);; x /= sqrt(2)) {
        const double now = excess(scheme, re, im, x, steps);
        if (now <= noise) {
            if (before < rounding / 10) {
                return 0;
            }
            break;
        }
        if (!(now < before)) {
            break;
        }
        before = now;
    }
    for (int i = 0; i < HALVINGS; i++) {
        const double middle = (inside + outside) / 2;
        if (excess(scheme, re, im, middle, steps) > rounding) {
            outside = middle;
        } else {
            inside = middle;
        }
    }
    return inside;
}
