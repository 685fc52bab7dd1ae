/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sparse Cholesky factors, exact and rough, against GSL's dense one. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <gsl/gsl_linalg.h>

#include "core/linear/cholesky.h"

/* A lower triangle by rows. */
struct rows {
    int n, *start, *column;
    double *value;
};

static double noise(unsigned *state)
{
    *state = *state * 1664525u + 1013904223u;
    return (double)(*state >> 8) / (1 << 24);
}

/* Springs of any strength on a grid `side` wide, its points held a little; and a last point, `hub`, that hangs on
   every third one, like the wall of a hole. */
static struct rows grid(int side, double scale)
{
    const int n = side * side + 1, hub = n - 1;
    struct rows rows = {n, malloc(((size_t)n + 1) * sizeof(int)), malloc(5 * (size_t)n * sizeof(int)),
                        malloc(5 * (size_t)n * sizeof(double))};
    double *diagonal = calloc((size_t)n, sizeof *diagonal);
    assert_true(rows.start && rows.column && rows.value && diagonal);
    unsigned state = 7;
    int used = 0;
    for (int pass = 0; pass < 2; pass++) { /* the second knows the diagonal */
        state = 7;
        used = 0;
        for (int i = 0; i < n; i++) {
            rows.start[i] = used;
            for (int j = i == hub || i < side ? 0 : i - side; j < i; j++) {
                const int x = i % side, across = i - j;
                const bool joined = i == hub ? j % 3 == 0
                                             : (across == 1 && x > 0) || across == side ||
                                                   (across == side - 1 && x < side - 1);
                if (joined) {
                    const double spring = scale * (.1 + noise(&state));
                    diagonal[i] += pass == 0 ? spring : 0;
                    diagonal[j] += pass == 0 ? spring : 0;
                    rows.column[used] = j;
                    rows.value[used++] = -spring;
                }
            }
            rows.column[used] = i;
            rows.value[used++] = diagonal[i] + 1e-3 * scale;
        }
        rows.start[n] = used;
    }
    free(diagonal);
    return rows;
}

static void rows_close(struct rows *rows)
{
    free(rows->start);
    free(rows->column);
    free(rows->value);
}

/* The largest error of the solution, relative to its largest value. */
static double error_of(const struct rows *rows, enum gm_cholesky_precision precision)
{
    const size_t n = (size_t)rows->n;
    gsl_matrix *dense = gsl_matrix_calloc(n, n);
    gsl_vector *b = gsl_vector_alloc(n), *expected = gsl_vector_alloc(n);
    unsigned state = 3;
    for (size_t i = 0; i < n; i++) {
        for (int k = rows->start[i]; k < rows->start[i + 1]; k++) {
            gsl_matrix_set(dense, i, (size_t)rows->column[k], rows->value[k]);
            gsl_matrix_set(dense, (size_t)rows->column[k], i, rows->value[k]);
        }
        gsl_vector_set(b, i, noise(&state) - .3);
    }
    gsl_linalg_cholesky_decomp1(dense);
    gsl_linalg_cholesky_solve(dense, b, expected);
    struct gm_cholesky *factor = gm_cholesky_open(n, rows->start, rows->column, rows->value, precision);
    assert_non_null(factor);
    double *x = malloc(n * sizeof *x), error = 0, size = 0;
    assert_non_null(x);
    memcpy(x, b->data, n * sizeof *x);
    gm_cholesky_solve(factor, x, x);
    for (size_t i = 0; i < n; i++) {
        error = fmax(error, fabs(x[i] - gsl_vector_get(expected, i)));
        size = fmax(size, fabs(gsl_vector_get(expected, i)));
    }
    free(x);
    gm_cholesky_close(factor);
    gsl_matrix_free(dense);
    gsl_vector_free(b);
    gsl_vector_free(expected);
    return error / size;
}

/* The size of the error of the solution whose values are all 1, relative to it. */
static double error_of_ones(const struct rows *rows, enum gm_cholesky_precision precision)
{
    const size_t n = (size_t)rows->n;
    double *x = calloc(n, sizeof *x), error = 0;
    struct gm_cholesky *factor = gm_cholesky_open(n, rows->start, rows->column, rows->value, precision);
    assert_true(x && factor);
    for (size_t i = 0; i < n; i++) {
        for (int k = rows->start[i]; k < rows->start[i + 1]; k++) {
            x[i] += rows->value[k];
            x[rows->column[k]] += rows->column[k] < (int)i ? rows->value[k] : 0;
        }
    }
    gm_cholesky_solve(factor, x, x);
    for (size_t i = 0; i < n; i++) {
        error += (x[i] - 1) * (x[i] - 1);
    }
    free(x);
    gm_cholesky_close(factor);
    return sqrt(error / (double)n);
}

/* More values than a processor keeps near itself. */
static void large_factors_are_whole_numbers(void **state)
{
    (void)state;
    struct rows rows = grid(220, 1);
    const double exact = error_of_ones(&rows, GM_CHOLESKY_EXACT),
                 rough = error_of_ones(&rows, GM_CHOLESKY_ROUGH);
    rows_close(&rows);
    if (!(exact <= 1e-9)) {
        fail_msg("error %.2e", exact);
    }
    if (!(rough <= .05)) {
        fail_msg("rough error %.2e", rough);
    }
    if (!(rough > 1e-5)) {
        fail_msg("not in whole numbers, error %.2e", rough);
    }
}

/* From panels of one column to the large ones at the end. */
static void solutions_agree(void **state)
{
    (void)state;
    const int sides[] = {1, 2, 3, 5, 12, 31};
    for (size_t i = 0; i < sizeof sides / sizeof sides[0]; i++) {
        struct rows rows = grid(sides[i], 1);
        const double exact = error_of(&rows, GM_CHOLESKY_EXACT), rough = error_of(&rows, GM_CHOLESKY_ROUGH);
        if (!(exact <= 1e-12)) {
            fail_msg("%d unknowns: error %.2e", rows.n, exact);
        }
        if (!(rough <= 1e-3)) {
            fail_msg("%d unknowns: rough error %.2e", rows.n, rough);
        }
        if (sides[i] > 3 && !(rough > 1e-9)) {
            fail_msg("%d unknowns: not in single precision, error %.2e", rows.n, rough);
        }
        rows_close(&rows);
    }
}

/* What floats cannot hold stays in doubles. */
static void rough_is_exact_where_it_must(void **state)
{
    (void)state;
    const double scales[] = {1e90, 1e-90};
    for (size_t i = 0; i < 2; i++) {
        struct rows rows = grid(12, scales[i]);
        const double error = error_of(&rows, GM_CHOLESKY_ROUGH);
        if (!(error <= 1e-12)) {
            fail_msg("scale %g: error %.2e", scales[i], error);
        }
        rows_close(&rows);
    }
}

static void indefinite_is_refused(void **state)
{
    (void)state;
    struct rows rows = grid(5, -1);
    assert_null(gm_cholesky_open((size_t)rows.n, rows.start, rows.column, rows.value, GM_CHOLESKY_EXACT));
    assert_null(gm_cholesky_open((size_t)rows.n, rows.start, rows.column, rows.value, GM_CHOLESKY_ROUGH));
    rows_close(&rows);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(solutions_agree),
        cmocka_unit_test(large_factors_are_whole_numbers),
        cmocka_unit_test(rough_is_exact_where_it_must),
        cmocka_unit_test(indefinite_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
