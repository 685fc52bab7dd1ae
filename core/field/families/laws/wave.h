/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_FIELD_FAMILIES_LAWS_WAVE_H
#define GM_CORE_FIELD_FAMILIES_LAWS_WAVE_H

#include "core/field/multisymplectic.h"

/* What u_tt - u_xx + V'(u) = 0 conserves, on a grid. `y` is the state of a
   wave problem: two levels, u and the other, o, and the time between them, dt.
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

#endif
