/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The next of values at equal distances, for first guesses of iterations. */
#ifndef GM_CORE_LINEAR_EXTRAPOLATION_H
#define GM_CORE_LINEAR_EXTRAPOLATION_H

#include <stddef.h>
#include <string.h>

/* next := the value after past[count - 1], .. past[1], past[0], of n numbers each, on the polynomial through them. Its
   weights are binomial coefficients whose signs alternate. */
static inline void gm_extrapolate(const double *const *past, size_t count, double *next, size_t n)
{
    double weight = -1;
    memset(next, 0, n * sizeof *next);
    for (size_t k = 1; k <= count; k++) {
        weight *= -(double)(count - k + 1) / (double)k;
        for (size_t i = 0; i < n; i++) {
            next[i] += weight * past[k - 1][i];
        }
    }
}

#endif
