/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The implicit Runge-Kutta methods that other families take steps of. */
#ifndef GM_CORE_ODE_FAMILIES_RUNGE_KUTTA_IMPLICIT_H
#define GM_CORE_ODE_FAMILIES_RUNGE_KUTTA_IMPLICIT_H

#include "core/ode/families/runge_kutta/row.h"

extern const struct gm_implicit_row gm_implicit_midpoint, gm_implicit_gauss4, gm_implicit_gauss6,
    gm_implicit_gauss8;

#endif
