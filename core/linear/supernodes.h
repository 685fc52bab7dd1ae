/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_LINEAR_SUPERNODES_H
#define GM_CORE_LINEAR_SUPERNODES_H

#include <stddef.h>

/* A lower triangular matrix L by supernodes: columns first[s] .. first[s + 1] have their entries in the same
   rows, row[row_start[s]] .. row[row_start[s + 1]] in increasing order, the first of which are the columns
   themselves. They stand in a panel, column by column, from value_start[s] on; what is above the diagonal of
   L in it is not read. On the diagonal stands 1 / L_ii. Values are doubles, or floats, one of which is
   NULL. */
struct gm_supernodes {
    size_t n, supernodes, most_rows;
    const int *first, *row_start, *row, *value_start;
    double *wide;
    float *narrow;
};

/* Puts 1 / L_ii on the diagonal, where L_ii stands. */
void gm_supernodes_invert_diagonal(struct gm_supernodes *triangle);
/* Makes the doubles floats in the same memory, which may then be cut to `values` floats. Both stand in the struct
   afterwards as the floats alone. */
void gm_supernodes_narrow(struct gm_supernodes *triangle, size_t values);

/* Solves L L' x = b in place. scratch: n + most_rows numbers. In the precision of the values; sums have an
   order of their own, whatever the processor. */
void gm_supernodes_solve(const struct gm_supernodes *triangle, double *x, double *scratch);

#endif
