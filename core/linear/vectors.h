/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Vectors in space. */
#ifndef GM_CORE_LINEAR_VECTORS_H
#define GM_CORE_LINEAR_VECTORS_H

#include <math.h>

#include "core/functions/functions.h"

static inline double gm_dot(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* c = a x b */
static inline void gm_cross(const double *a, const double *b, double *c)
{
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        c[i] = a[j] * b[k] - a[k] * b[j];
    }
}

/* d = b - a */
static inline void gm_subtract(const double *b, const double *a, double *d)
{
    for (int i = 0; i < 3; i++) {
        d[i] = b[i] - a[i];
    }
}

/* The length, also of a vector whose square is too large or too small. */
static inline double gm_length(const double *a)
{
    return gm_hypot(gm_hypot(a[0], a[1]), a[2]);
}

#endif
