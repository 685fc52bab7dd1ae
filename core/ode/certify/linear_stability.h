/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_ODE_CERTIFY_LINEAR_STABILITY_H
#define GM_CORE_ODE_CERTIFY_LINEAR_STABILITY_H

#include "core/scheme.h"

/* The growth factor of a scheme's solutions of a linear test equation in a step of length 1:
       y' = z y, z complex               for schemes that take any ordinary differential equation
       q' = p, p' = -w^2 q, z = i w      for schemes that take H = T(p) + V(q) */

enum gm_linear_test { GM_TEST_NONE, GM_TEST_PLANE /* y' = z y */, GM_TEST_OSCILLATOR };

enum gm_linear_test gm_linear_test_of(const struct gm_scheme *scheme);

/* Returns |y| after a step divided by |y| before it, found by stepping: the geometric mean over `steps`
   steps; multistep methods need several. NAN if a step fails. re, im: z; the oscillator takes re = 0. */
double gm_linear_growth(const struct gm_scheme *scheme, double re, double im, int64_t steps);

/* Returns the growth from the coefficients: |R(z)| of a Runge-Kutta method, the spectral radius of a
   splitting. NAN for other families. */
double gm_linear_growth_known(const struct gm_scheme *scheme, double re, double im);

/* Returns the distance from 0 along the direction (re, im), of length 1, up to which nothing grows, at most
   `reach`. Growth below the rounding of a symplectic map, 1e-7, does not count; but if the excess over 1
   falls from there towards 0 like a power of the distance, every step grows and the limit is 0. */
double gm_linear_limit(const struct gm_scheme *scheme, double re, double im, double reach, int64_t steps);

#endif
