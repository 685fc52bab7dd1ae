/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_ODE_TRACE_FREE_H
#define GM_CORE_ODE_TRACE_FREE_H

#include <stddef.h>

/* y' = A y in three dimensions with tr A = 0, as a sum of plane linear fields without divergence:
       piece j = 1, 2:   y_j' = (A y)_j,   y_3' = -a_jj y_3  (+ a_31 y_1 + a_32 y_2 in the last piece)
   Feng & Shang, Numer. Math. 71 (1995) 451; Hairer, Lubich & Wanner (2006), VI.9. */
enum { GM_TRACE_FREE_PIECES = 2 };

/* Moves m states by the exact flow of a piece, of number 0 or 1; the matrix is written row by row. */
void gm_trace_free_flow(const double a[9], size_t piece, double h, double *y, size_t m);

#endif
