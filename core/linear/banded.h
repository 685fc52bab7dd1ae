/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_LINEAR_BANDED_H
#define GM_CORE_LINEAR_BANDED_H

#include <stdbool.h>
#include <stddef.h>

/* A square banded matrix of order n with equally many diagonals, `band`, below and above the main one, and
   its LU factors with partial pivoting: unsymmetric saddle points need it. Column by column, as LAPACK's
   dgbtrf stores it, so that both sweeps of a solve run along columns. */
struct gm_banded {
    size_t n, band;
    size_t stride;  /* stride of a column: 3 band + 1, of which `band` are for the fill-in of pivoting */
    double *values; /* stride * n */
    size_t *pivots; /* n */
    size_t *above,
        *below; /* factors' entries of each column above and below the diagonal, without outer zeros */
};

/* Returns false when out of memory; then nothing is allocated. */
bool gm_banded_open(struct gm_banded *matrix, size_t n, size_t band);
void gm_banded_close(struct gm_banded *matrix);

void gm_banded_clear(struct gm_banded *matrix);

static inline void gm_banded_add(struct gm_banded *matrix, size_t row, size_t column, double value)
{
    matrix->values[column * matrix->stride + 2 * matrix->band + row - column] += value;
}

/* The matrix becomes its factors; false if it is singular to the last digit. */
bool gm_banded_factor(struct gm_banded *matrix);

/* x := A^-1 x, n numbers, by the factors. */
void gm_banded_solve(const struct gm_banded *matrix, double *x);

#endif
