/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_LINEAR_EIGENVALUES_H
#define GM_CORE_LINEAR_EIGENVALUES_H

#include <stdbool.h>
#include <stddef.h>

/* The eigenvalues of a real matrix, n * n row by row, which is destroyed: n real and n imaginary parts.
   Returns false when out of memory, or if they are not found. */
bool gm_eigenvalues(double *matrix, size_t n, double *real, double *imaginary);

#endif
