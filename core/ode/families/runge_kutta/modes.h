/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_ODE_FAMILIES_RUNGE_KUTTA_MODES_H
#define GM_CORE_ODE_FAMILIES_RUNGE_KUTTA_MODES_H

#include "core/ode/families/runge_kutta/row.h"
#include "core/ode/ode.h"

/* Implicit Runge-Kutta methods for y' = L y + N(y) on a ring, one member: the iteration solves the stiff
   linear part, so that it converges if h N' is small, however large h L is. */

/* Returns the workspace; NULL: out of memory. */
void *gm_implicit_modes_open(const struct gm_problem *problem, const struct gm_tableau *row);
void gm_implicit_modes_close(void *workspace);

/* Makes all steps; the workspace is that of gm_implicit_modes_open. */
struct gm_progress gm_implicit_modes_advance(const struct gm_task *task);

#endif
