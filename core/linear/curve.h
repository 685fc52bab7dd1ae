/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_LINEAR_CURVE_H
#define GM_CORE_LINEAR_CURVE_H

#include <stdbool.h>
#include <stddef.h>

#include "core/linear/fourier.h"

/* The sum over closed curves (q, p) of the integral of p dq, of its magnitude, and of the magnitudes of the shares
   of all waves and of the two upper octaves of those that the points carry. */
struct gm_curve_action {
    double action, magnitude, waves, middle_waves, short_waves;
};

/* Adds the curve through `count` points at equal distances of a parameter from 0 to 2 pi, with a transform of
   as many. Returns false when out of memory. */
bool gm_curve_add_action(struct gm_fourier *fourier, const double *q, const double *p, size_t count,
                         struct gm_curve_action *sum);

/* Replaces points by derivatives of the trigonometric polynomial through them, without its alternating
   part. Returns false when out of memory. */
bool gm_curve_differentiate(double _Complex *points, size_t count);

#endif
