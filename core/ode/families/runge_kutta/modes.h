/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_ODE_FAMILIES_RUNGE_KUTTA_MODES_H
#define GM_CORE_ODE_FAMILIES_RUNGE_KUTTA_MODES_H

#include "core/ode/kernel/members.h"

/* Implicit Runge-Kutta steps for y' = L y + N(y) on a ring, one member: the iteration solves the stiff linear part, so
   that it converges if h N' is small, however large h L is. */
extern const struct gm_member_family gm_implicit_modes;

#endif
