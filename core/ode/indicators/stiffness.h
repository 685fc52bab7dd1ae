/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Stiff motions need an implicit scheme: their neighbours decay far faster than they move. */
#ifndef GM_CORE_ODE_INDICATORS_STIFFNESS_H
#define GM_CORE_ODE_INDICATORS_STIFFNESS_H

#include "core/problem.h"

/* `fast` is the rate of the fastest decay at the start and at 4 points of a trial with gsl-msbdf over until / 100, and
   `slow` the rate of the solution after its first quarter, max |f_i| / (|y_i| + s), s the largest |y_j| of the trial. Stiff
   if fast > 1e3 slow and fast until > 1e4. */
struct gm_stiffness {
    bool stiff;
    double slow, fast;
};

/* Returns that of a motion of one member from y0; not stiff if the problem has no Jacobian, the trial fails, or when out of
   memory. */
struct gm_stiffness gm_stiffness_of(const struct gm_problem *problem, const double *y0, double until);

#endif
