/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_LINEAR_EIGENVALUES_H
#define GM_CORE_LINEAR_EIGENVALUES_H

#include <stdbool.h>
#include <stddef.h>

/* The eigenvalues of a real matrix, n * n row by row, which is destroyed: n real and n imaginary parts.
   Returns false when out of memory, or if they are not found. */
bool gm_eigenvalues(double *matrix, size_t n, double *real, double *imaginary);

/* Replaces x, the right side, by the shortest x with the smallest |matrix x - right side|, n * n row by row, without the
   singular values below `cutoff` times the largest. The matrix is destroyed. Returns false when out of memory, or if
   the values are not found. */
bool gm_singular_solve(double *matrix, size_t n, double cutoff, double *x);

#endif
