/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_LINEAR_COMPLEX_MATRIX_H
#define GM_CORE_LINEAR_COMPLEX_MATRIX_H

#include <stdbool.h>
#include <stddef.h>

/* Small complex matrices, row by row, for waves of one wave number in several fields. */
enum { GM_COMPLEX_LARGEST = 4, GM_PHI_MOST = 4 };

/* Solves a x = r by elimination with partial pivoting, of any n. a is destroyed, x overwrites r. Returns
   false if a is singular. */
bool gm_complex_eliminate(size_t n, double _Complex *a, double _Complex *r);

/* phi_0 .. phi_(count - 1) of z, n * n each, one after the other:
       phi_0(z) = exp(z),   phi_k(z) = (phi_(k-1)(z) - 1/(k-1)!) / z,   phi_k(0) = 1/k!
   n is at most GM_COMPLEX_LARGEST, count GM_PHI_MOST. To rounding, times the binary logarithm of |z| where
   n > 1. */
void gm_complex_phi(size_t n, const double _Complex *z, size_t count, double _Complex *phi);

/* y := a x, which do not overlap. */
void gm_complex_multiply(size_t n, const double _Complex *a, const double _Complex *x, double _Complex *y);

#endif
