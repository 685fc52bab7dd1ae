/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_PROBLEMS_H
#define GM_CORE_PROBLEMS_H

#include "core/problem.h"

/* Problems with fixed structure; a scene copies one and sets m (and parameters, where it says so). */

extern const struct gm_problem gm_problem_oscillator; /* (q, p), H = p^2/2 + q^2/2 */
extern const struct gm_problem gm_problem_pendulum;   /* (q, p), H = p^2/2 - cos q */

/* The same with two tangent vectors carried along: (q, xi_1, xi_2, p, eta_1, eta_2). */
extern const struct gm_problem gm_problem_oscillator_tangent;
extern const struct gm_problem gm_problem_pendulum_tangent;

/* Two particles of masses 1 and 3 on a line, coupled by a hard spring, in a well:
   (q1, q2, p1, p2), H = p1^2/2 + p2^2/6 + (q1 - q2)^2/2 + (q1 - q2)^4/4 + a (q1^4 + q2^4)/4,
   a = *(const double *)parameters. For a = 0 the momentum p1 + p2 is a linear invariant. */
extern const struct gm_problem gm_problem_particles;

/* H = (1 + q^2)(1 + p^2)/2: not separable (M. Tao, Phys. Rev. E 94 (2016) 043303). */
extern const struct gm_problem gm_problem_product;

/* The free rigid body, Euler's equations with moments of inertia (2, 1, 2/3): angular momentum (y1, y2, y3);
   invariants |y|^2/2 and y1^2/4 + y2^2/2 + 3 y3^2/4, both quadratic. */
extern const struct gm_problem gm_problem_rigid_body;

/* u_tt - u_xx + V'(u) = 0, V = -cos u or V = 0: the caller sets line and n = gm_wave_size(line.points). */
extern const struct gm_problem gm_problem_sine_gordon; /* parameters: struct gm_sine_gordon */
extern const struct gm_problem gm_problem_wave;

#endif
