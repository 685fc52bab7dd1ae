/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The implicit Runge-Kutta methods that other families take steps of, and what all tableaus share. */
#ifndef GM_CORE_ODE_FAMILIES_RUNGE_KUTTA_IMPLICIT_H
#define GM_CORE_ODE_FAMILIES_RUNGE_KUTTA_IMPLICIT_H

#include "core/ode/families/runge_kutta/row.h"
#include "core/scheme.h"

extern const struct gm_tableau gm_implicit_midpoint, gm_implicit_gauss4, gm_implicit_gauss6,
    gm_implicit_gauss8;

/* gm_family.coefficients_open of a family whose rows are tableaus. */
void gm_tableau_coefficients_open(struct gm_arena *arena, const struct gm_scheme *scheme,
                                  struct gm_coefficients *coefficients);

#endif
