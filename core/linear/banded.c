/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Gaussian elimination within a band, rows exchanged for the largest pivot (Golub & Van Loan, Matrix
   Computations, 4.3). Blocking would not be faster: bands are 1 to 17 wide here. */
#include "core/linear/banded.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/basics.h"

bool gm_banded_open(struct gm_banded *matrix, size_t n, size_t band)
{
    *matrix = (struct gm_banded){.n = n, .band = band, .stride = 3 * band + 1};
    matrix->values = calloc(n * matrix->stride, sizeof *matrix->values);
    matrix->pivots = calloc(3 * n, sizeof *matrix->pivots);
    if (!matrix->values || !matrix->pivots) {
        gm_banded_close(matrix);
        return false;
    }
    matrix->above = matrix->pivots + n;
    matrix->below = matrix->above + n;
    return true;
}

void gm_banded_close(struct gm_banded *matrix)
{
    free(matrix->values);
    free(matrix->pivots);
    *matrix = (struct gm_banded){0};
}

void gm_banded_clear(struct gm_banded *matrix)
{
    memset(matrix->values, 0, matrix->n * matrix->stride * sizeof *matrix->values);
}

static size_t least(size_t a, size_t b)
{
    return a < b ? a : b;
}

/* y -= factor x */
static inline void subtract(double *restrict y, const double *restrict x, double factor, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        y[i] -= factor * x[i];
    }
}

/* y -= factor x after `other` has taken the place of y[pivot - 1]; nothing takes one where the pivot is 0.
   A single number that is written first would delay the registers that are read next. */
static inline void subtract_swapped(double *restrict y, const double *restrict x, double factor, size_t count,
                                    double other, size_t pivot)
{
    if (pivot == 0) {
        subtract(y, x, factor, count);
        return;
    }
    for (size_t i = 0; i < count; i++) {
        y[i] = (i == pivot - 1 ? other : y[i]) - factor * x[i];
    }
    if (pivot > count) {
        y[pivot - 1] = other;
    }
}

/* Returns the number of entries values[0], values[step], ... up to the last one that is not 0. */
static inline size_t without_zeros(const double *values, ptrdiff_t step, size_t count)
{
    while (count > 0 && values[(ptrdiff_t)(count - 1) * step] == 0) {
        count--;
    }
    return count;
}

/* Unknowns of nodes leave the corners of a band empty, and without row exchanges its upper third is empty,
   too. Zeros there are skipped, which can change only the sign of a 0. */
GM_CLONES bool gm_banded_factor(struct gm_banded *matrix)
{
    const size_t n = matrix->n, band = matrix->band, step = matrix->stride - 1;
    size_t last = 0; /* the last column that the rows used so far reach */
    for (size_t j = 0; j < n; j++) {
        double *diagonal = matrix->values + j * matrix->stride + 2 * band;
        const size_t below = least(band, n - 1 - j);
        size_t pivot = 0;
        for (size_t i = 1; i <= below; i++) {
            pivot = fabs(diagonal[i]) > fabs(diagonal[pivot]) ? i : pivot;
        }
        matrix->pivots[j] = j + pivot;
        if (!(fabs(diagonal[pivot]) > 0) || !isfinite(diagonal[pivot])) {
            return false;
        }
        const size_t reach = least(j + pivot + band, n - 1);
        last = reach > last ? reach : last;
        const double held = diagonal[0];
        diagonal[0] = diagonal[pivot];
        diagonal[pivot] = held;
        const double inverse = 1 / diagonal[0];
        const size_t filled = without_zeros(diagonal + 1, 1, below);
        for (size_t i = 1; i <= filled; i++) {
            diagonal[i] *= inverse;
        }
        matrix->above[j] = without_zeros(diagonal - 1, -1, least(2 * band, j));
        matrix->below[j] = filled;
        /* along a row, one column on is `step` on */
        for (size_t k = 1; k <= last - j; k++) {
            double *column = diagonal + k * step;
            const double other = column[0];
            column[0] = column[pivot];
            if (column[0] != 0) {
                subtract_swapped(column + 1, diagonal + 1, column[0], filled, other, pivot);
            } else {
                column[pivot] = other;
            }
        }
    }
    return true;
}

/* Numbers next to the diagonal that are held beside x, so that no column waits for what the one before has
   written. */
enum { HELD = 3 };

GM_CLONES void gm_banded_solve(const struct gm_banded *matrix, double *x)
{
    const size_t n = matrix->n, band = matrix->band;
    for (size_t j = 0; j < n; j++) {
        const size_t pivot = matrix->pivots[j], below = matrix->below[j];
        const double *column = matrix->values + j * matrix->stride + 2 * band + 1;
        const double value = x[pivot], other = x[j];
        x[j] = value;
        subtract_swapped(x + j + 1, column, value, below, other, pivot - j);
    }
    for (size_t j = n; j-- > 0;) {
        const double *diagonal = matrix->values + j * matrix->stride + 2 * band;
        x[j] /= diagonal[0];
        if (matrix->above[j] < HELD) {
            subtract(x + j - matrix->above[j], diagonal - matrix->above[j], x[j], matrix->above[j]);
            continue;
        }
        double known = x[j], first = x[j - 1], second = x[j - 2], third = x[j - 3];
        for (;;) {
            const size_t above = matrix->above[j];
            first -= known * diagonal[-1];
            second -= known * diagonal[-2];
            third -= known * diagonal[-3];
            subtract(x + j - above, diagonal - above, known, above - HELD);
            diagonal -= matrix->stride;
            if (matrix->above[--j] < HELD) {
                break;
            }
            x[j] = known = first / diagonal[0];
            first = second;
            second = third;
            third = x[j - HELD];
        }
        x[j] = first;
        x[j - 1] = second;
        x[j - 2] = third;
        j++;
    }
}
