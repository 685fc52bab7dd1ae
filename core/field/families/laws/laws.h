/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Conserved quantities of fields on a grid, and local laws. */
#ifndef GM_CORE_FIELD_FAMILIES_LAWS_LAWS_H
#define GM_CORE_FIELD_FAMILIES_LAWS_LAWS_H

#include "core/field/multisymplectic.h"

/* Measures the residual of a local law of the scheme: of a box over a step in every cell, the next one, or of a wave the last
   one,
       energy     [S(b) - S(a) - (b - a)' grad S((a + b)/2)] / dt    from a = A_x s^n to b = A_x s^{n+1}
       momentum   the same over dx                                   from a = A_t s_i to b = A_t s_{i+1}
       A f = (f_i + f_{i+1})/2
   which is 0 if S is quadratic and else of second order, and round-off for mass or charge; of two-step schemes for waves at
   every node. Returns false if the scheme has no such law, when out of memory or if the step fails. */
bool gm_local_laws(const struct gm_problem *problem, const struct gm_scheme *scheme, double dt,
                   const double *y, enum gm_local_law law, double *residual);

/* Energy and momentum of u_tt - u_xx + V'(u) = 0 on a grid. `y` is the state of a wave problem: two levels, u and the
   other, o, and the time between them, dt.
       D f = (f_{i+1} - f_i)/dx,   A f = (f_i + f_{i+1})/2 */

/* dx sum [ ((u - o)/dt)^2 / 2 + D u D o / 2 + (V(u) + V(o)) / 2 ] */
double gm_wave_energy(const struct gm_problem *problem, const double *y);
/* dx sum over cells [ (A(u - o)/dt)^2 / 2 + (D(u + o)/2)^2 / 2 + V(A(u + o)/2) ] */
double gm_wave_cell_energy(const struct gm_problem *problem, const double *y);
/* The energy that belongs to the scheme's own laws: of nodes, of cells or of its family's stages. `memory` is
   that of a run at y. */
double gm_wave_own_energy(const struct gm_problem *problem, const struct gm_scheme *scheme, const double *y,
                          const double *memory);
/* -dx sum (u - o)/dt (u_{i+1} - u_{i-1} + o_{i+1} - o_{i-1}) / (4 dx) */
double gm_wave_momentum(const struct gm_problem *problem, const double *y);

/* The longest stable step about the state y by linear theory; NaN if the scheme has no limit. */
double gm_wave_longest_step(const struct gm_problem *problem, const struct gm_scheme *scheme,
                            const double *y);

/* A field on a ring as a scheme represents it, for integrals: `points` values, then `points` slopes. For
   cells, means and differences; for Fourier modes, their polynomial at the nodes; for nodes, the values
   and their differences. False when out of memory. */
bool gm_field_profile(const struct gm_problem *problem, const struct gm_scheme *scheme, const double *u,
                      double *values);

#endif
