/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Bodies that attract each other in Jacobi coordinates. A state has all x_i, body by body, then all w_i = x_i':
       x_i = q_i - (centre of mass of the bodies 0 .. i - 1),   x_0 = that of all
   With M_i = m_0 + ... + m_i, the energy is the sum of
       kepler        x_0'' = 0, and x_i'' = -G M_i x_i/|x_i|^3
       interaction   w_i' = a_i + G M_i x_i/|x_i|^3,  a_i: like x_i, of the accelerations
   J. Wisdom & M. Holman, Astron. J. 102 (1991) 1528; H. Rein & D. Tamayo, MNRAS 452 (2015) 376. */
#ifndef GM_CORE_ODE_FAMILIES_SPLITTING_JACOBI_H
#define GM_CORE_ODE_FAMILIES_SPLITTING_JACOBI_H

#include "core/ode/ode.h"

/* Converts a state (q, p) to x, w, and back, in place; the scratch has n numbers. */
void gm_jacobi_from_state(const struct gm_gravity *gravity, double *y, double *scratch);
void gm_jacobi_to_state(const struct gm_gravity *gravity, double *y, double *scratch);
/* y := the flow of the part kepler over h; false: it is not found. */
bool gm_jacobi_kepler(const struct gm_gravity *gravity, double h, double *y);
/* The rates of all w, n / 2, by the part interaction; the scratch has n / 2 numbers. */
void gm_jacobi_interaction(const struct gm_gravity *gravity, const double *x, double *rates, double *scratch);

#endif
