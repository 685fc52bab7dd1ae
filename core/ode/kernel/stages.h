/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What Newton's method for the stages of a Runge-Kutta method needs. The loops over kernels include this too, so all
   of it is inline. */
#ifndef GM_CORE_ODE_KERNEL_STAGES_H
#define GM_CORE_ODE_KERNEL_STAGES_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <string.h>

#include "core/status.h"

enum { GM_TABLEAU_STAGES = 16 };

/* Solves a x = r, a an n * n matrix by rows, by Gaussian elimination with partial pivoting. a is destroyed, x
   overwrites r. False if a is singular. */
static inline bool gm_eliminate(size_t n, double *a, double *r)
{
    for (size_t k = 0; k < n; k++) {
        size_t pivot = k;
        for (size_t i = k + 1; i < n; i++) {
            pivot = fabs(a[i * n + k]) > fabs(a[pivot * n + k]) ? i : pivot;
        }
        if (!(fabs(a[pivot * n + k]) > 0)) {
            return false;
        }
        if (pivot != k) {
            for (size_t j = k; j < n; j++) {
                const double swap = a[k * n + j];
                a[k * n + j] = a[pivot * n + j];
                a[pivot * n + j] = swap;
            }
            const double swap = r[k];
            r[k] = r[pivot];
            r[pivot] = swap;
        }
        for (size_t i = k + 1; i < n; i++) {
            const double factor = a[i * n + k] / a[k * n + k];
            for (size_t j = k + 1; j < n; j++) {
                a[i * n + j] -= factor * a[k * n + j];
            }
            r[i] -= factor * r[k];
        }
    }
    for (size_t k = n; k-- > 0;) {
        for (size_t j = k + 1; j < n; j++) {
            r[k] -= a[k * n + j] * r[j];
        }
        r[k] /= a[k * n + k];
    }
    return true;
}

/* Why a matrix of so many entries was not eliminated. */
static inline enum gm_obstacle gm_obstacle_of(size_t entries, const double *matrix)
{
    double sum = 0;
    for (size_t i = 0; i < entries; i++) {
        sum += fabs(matrix[i]);
    }
    return isfinite(sum) ? GM_SINGULAR : GM_NOT_FINITE;
}

/* The sum of |h a_ij J_cd Y_jd|, the terms of h f that rounding acts on, from the matrix I - h a_ij J(Y_j) and the
   stages Y_j = y + z_j, of n components each. */
static inline double gm_rounding_of_stages(size_t size, size_t n, const double *matrix, const double *y,
                                           const double *z)
{
    double sum = 0;
    for (size_t j = 0; j < size; j += n) {
        for (size_t c = j; c < j + n; c++) {
            double terms = 0;
            for (size_t i = 0; i < size; i++) {
                terms += fabs((i == c) - matrix[i * size + c]);
            }
            sum += terms * fabs(y[c - j] + z[c]);
        }
    }
    return sum;
}

/* The weights w of z = h A f by which sum w_k z_k = h sum b_i f_i: A' w = b; of a stiffly accurate method z_s itself.
   After Newton's method steps are made of z: f(y + z) would multiply what is left of its last change by h J. False
   where A is singular, or so by rounding. */
static inline bool gm_weights_of_stages(size_t stages, const double a[][GM_TABLEAU_STAGES], const double *b,
                                        double *weights)
{
    double matrix[GM_TABLEAU_STAGES * GM_TABLEAU_STAGES], sum = 0;
    if (memcmp(a[stages - 1], b, stages * sizeof *b) == 0) {
        memset(weights, 0, stages * sizeof *b);
        weights[stages - 1] = 1;
        return true;
    }
    for (size_t i = 0; i < stages; i++) {
        for (size_t j = 0; j < stages; j++) {
            matrix[i * stages + j] = a[j][i];
        }
    }
    memcpy(weights, b, stages * sizeof *b);
    if (!gm_eliminate(stages, matrix, weights)) {
        return false;
    }
    for (size_t i = 0; i < stages; i++) {
        sum += fabs(weights[i]);
    }
    return sum < 0x1p10;
}

#endif
