/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Stiff problems: some motions decay much faster than the solution changes. */
#ifndef GM_CORE_ODE_INDICATORS_STIFFNESS_H
#define GM_CORE_ODE_INDICATORS_STIFFNESS_H

#include "core/problem.h"

/* Returns true if a > 1e3 b and a until > 1e4, where a is the rate of the fastest decay, max(-Re eig J) at the start and at
   4 points of a trial with gsl-msbdf over until / 100, and b the rate of the solution after its first quarter, max |f_i| /
   (|y_i| + s), s the largest |y_j| of the trial. False if the problem has no Jacobian, the trial fails, or when out of
   memory. y0: one member. */
bool gm_is_stiff(const struct gm_problem *problem, const double *y0, double until);

#endif
