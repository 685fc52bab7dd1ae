/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_ODE_PROBLEMS_PROBLEMS_H
#define GM_CORE_ODE_PROBLEMS_PROBLEMS_H

#include "core/ode/ode.h"

/* Problems with fixed structure; a scene copies one and sets m, and parameters if it has them. */

extern const struct gm_problem gm_problem_oscillator; /* (q, p), H = p^2/2 + q^2/2 */

/* y' = A y in three dimensions; parameters: A, 9 doubles row by row. */
extern const struct gm_problem gm_problem_linear;

/* The Korteweg-de Vries equation on a ring of 12 points, (u_0 .. u_11). */
extern const struct gm_problem gm_problem_ring;

/* Point vortices of equal strength *(const double *)parameters (not 0), (x_1..x_N, y_1..y_N). _four: N = 4,
   with kernels. _reduced: four with z3 = -z1, z4 = -z2 built in, (x1, x2, y1, y2), with kernels. The others
   have no kernels and may carry passive particles: set n = 2 N + 2 passive, with N any number, and N = 2
   for _reduced_carrying. _multipole: ((const double *)parameters)[1] is the tolerance, 1e-15 .. 1e-2: the
   error of a velocity is at most this part of the sum of the others' speeds at it, and round-off. */
extern const struct gm_problem gm_problem_vortices;
extern const struct gm_problem gm_problem_vortices_multipole;
extern const struct gm_problem gm_problem_vortices_four;
extern const struct gm_problem gm_problem_vortices_reduced;
extern const struct gm_problem gm_problem_vortices_reduced_carrying;

#endif
