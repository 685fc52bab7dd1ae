/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_LINEAR_SUPERNODES_H
#define GM_CORE_LINEAR_SUPERNODES_H

#include <stddef.h>
#include <stdint.h>

/* A lower triangular matrix L by supernodes: columns first[s] .. first[s + 1] have their entries in the same
   rows, row[row_start[s]] .. row[row_start[s + 1]] in increasing order, the first of which are the columns
   themselves. The entries are a panel, column by column, from value_start[s] on. Its entries on or above the
   diagonal of L are ignored. Values are doubles, floats, or integers with a unit S_jj for each column,
   L = M S; the two other pointers are NULL. */
struct gm_supernodes {
    size_t n, supernodes, most_rows; /* most_rows: of a panel */
    const int *first, *row_start, *row, *value_start;
    double *wide;
    float *narrow;
    int16_t *whole;
    double *inverse; /* n: 1 / L_ii, or 1 / M_ii */
    double *weight;  /* n: 1 / S_ii^2; not of doubles */
};

/* Computes `inverse` from the diagonal. */
void gm_supernodes_invert_diagonal(struct gm_supernodes *triangle);
/* Converts the doubles to floats, or to integers if this number of values is then read faster, in the same
   memory. Returns the number of bytes per value. */
size_t gm_supernodes_narrow(struct gm_supernodes *triangle, size_t values);

/* Solves L L' x = b in place. scratch: n + 3 most_rows numbers. In single precision unless the
   values are doubles. The order of sums does not depend on the processor. */
void gm_supernodes_solve(const struct gm_supernodes *triangle, double *x, double *scratch);

#endif
