/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_TESTS_PROBLEMS_PROBLEMS_H
#define GM_TESTS_PROBLEMS_PROBLEMS_H

#include "core/ode/ode.h"

/* Problems in C beside the program's own, of which files in share/systems have the same formulas: what is read is
   compared with what is compiled. */

/* Two particles of masses 1 and 3 on a line, coupled by a hard spring, in a well:
   (q1, q2, p1, p2), H = p1^2/2 + p2^2/6 + (q1 - q2)^2/2 + (q1 - q2)^4/4 + a (q1^4 + q2^4)/4,
   a = *(const double *)parameters. For a = 0 the momentum p1 + p2 is a linear invariant. */
extern const struct gm_problem gm_problem_particles;

/* H = (1 + q^2)(1 + p^2)/2: not separable (M. Tao, Phys. Rev. E 94 (2016) 043303). */
extern const struct gm_problem gm_problem_product;

/* Light in Maxwell's fish-eye, (q1, q2, p1, p2), H = (1 + |q|^2)^2 |p|^2/8: not separable, q1 p2 - q2 p1 is kept. */
extern const struct gm_problem gm_problem_fish_eye;

/* The free rigid body, Euler's equations with moments of inertia (2, 1, 2/3): angular momentum (y1, y2, y3);
   invariants |y|^2/2 and y1^2/4 + y2^2/2 + 3 y3^2/4, both quadratic. */
extern const struct gm_problem gm_problem_rigid_body;

/* The plane Kepler problem, (q1, q2, p1, p2), H = |p|^2/2 - 1/|q|; perturbed: H - e/|q|^2,
   e = *(const double *)parameters. */
extern const struct gm_problem gm_problem_kepler;
extern const struct gm_problem gm_problem_kepler_perturbed;

/* Henon & Heiles, (q1, q2, p1, p2), H = (|p|^2 + |q|^2)/2 + q1^2 q2 - q2^3/3. */
extern const struct gm_problem gm_problem_henon_heiles;

/* The chain of Fermi, Pasta & Ulam with three stiff springs, (x1..3, y1..3, x1'..3', y1'..3') as in Hairer,
   Lubich & Wanner (2006), I.5.1: y are the scaled expansions of the stiff springs; omega is
   *(const double *)parameters. gm_problem_fpu_1 has one spring. */
extern const struct gm_problem gm_problem_fpu;
extern const struct gm_problem gm_problem_fpu_1;

/* A mass on a stiff spring of rest length 1 in gravity 1, (q1, q2, p1, p2); the stiffness is
   *(const double *)parameters. */
extern const struct gm_problem gm_problem_spring_pendulum;

extern const struct gm_problem gm_problem_pendulum; /* (q, p), H = p^2/2 - cos q */

/* The oscillator, p^2/2 + q^2/2, and the pendulum with two tangent vectors carried along: (q, xi_1, xi_2,
   p, eta_1, eta_2). The oscillator has loops of ensembles. */
extern const struct gm_problem gm_problem_oscillator_tangent;
extern const struct gm_problem gm_problem_pendulum_tangent;

/* The ABC flow, (x, y, z); parameters: A, B, C as three doubles. */
extern const struct gm_problem gm_problem_abc;

#endif
