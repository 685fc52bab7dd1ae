/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_LINEAR_CURVE_H
#define GM_CORE_LINEAR_CURVE_H

#include <stdbool.h>
#include <stddef.h>

/* Signed area within a closed smooth curve, given by `count` points x + i y at equal distances of a
   parameter from 0 to 2 pi, and its derivatives there. NaN if points and derivatives disagree: too few
   points are between two bends. */
double gm_curve_area(const double _Complex *points, const double _Complex *derivatives, size_t count);
#define GM_UNRESOLVED_EDGE "the members no longer resolve the edge of the disc"

/* Replaces points by derivatives of the trigonometric polynomial through them, without its alternating
   part. Returns false when out of memory. */
bool gm_curve_differentiate(double _Complex *points, size_t count);

#endif
