/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Stiff problems: some motions decay much faster than the solution changes. */
#ifndef GM_CORE_ODE_INDICATORS_STIFFNESS_H
#define GM_CORE_ODE_INDICATORS_STIFFNESS_H

#include "core/problem.h"

/* Rates in 1 / model time: of the fastest decay, max(-Re eig J) at the start and at 4 points of a trial with gsl-msbdf
   over until / 100; and of the solution after its first quarter, max |f_i| / (|y_i| + s), s the largest |y_j| of the
   trial. */
struct gm_stiffness {
    double fast, slow;
    bool is_stiff; /* fast > 1e3 slow, and fast until > 1e4 */
};

/* Returns zeros if the problem has no Jacobian, the trial fails, or when out of memory. y0: one member. */
struct gm_stiffness gm_stiffness_of(const struct gm_problem *problem, const double *y0, double until);

#endif
