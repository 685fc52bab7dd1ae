/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_LINEAR_CURVE_H
#define GM_CORE_LINEAR_CURVE_H

#include <stdbool.h>
#include <stddef.h>

/* Signed area within a closed smooth curve, given by `count` points x + i y at equal distances of a
   parameter from 0 to 2 pi, and its derivatives there. NaN if points and derivatives disagree: too few
   points are between two bends. */
double gm_curve_area(const double _Complex *points, const double _Complex *derivatives, size_t count);

/* The sum over closed curves (q, p) of the integral of p dq, of its magnitude, and of the magnitudes of the shares
   of all waves and of the upper half of those that the points carry. */
struct gm_loop {
    double action, magnitude, waves, short_waves;
};

/* Adds the curve through `count` points at equal distances of a parameter from 0 to 2 pi. Returns false when
   out of memory. */
bool gm_curve_add_loop(const double *q, const double *p, size_t count, struct gm_loop *loop);

/* Replaces points by derivatives of the trigonometric polynomial through them, without its alternating
   part. Returns false when out of memory. */
bool gm_curve_differentiate(double _Complex *points, size_t count);

#endif
