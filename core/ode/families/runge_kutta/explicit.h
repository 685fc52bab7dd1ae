/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Explicit Runge-Kutta methods:
       k_i = f(y0 + h sum_{j<i} a_ij k_j)
       y1  = y0 + h sum_i b_i k_i
   A scheme is one row of core/ode/families/runge_kutta/explicit.def. */
#ifndef GM_CORE_ODE_FAMILIES_RUNGE_KUTTA_EXPLICIT_H
#define GM_CORE_ODE_FAMILIES_RUNGE_KUTTA_EXPLICIT_H

#include "core/ode/families/runge_kutta/row.h"

/* The most stages of a row of the list. */
enum { GM_EXPLICIT_LISTED_STAGES = 4 };

/* The number of a row in the list. */
enum gm_explicit_row {
    GM_EXPLICIT_NOT_LISTED,
#define GM_EXPLICIT(identifier, ...) GM_EXPLICIT_##identifier,
#include "core/ode/families/runge_kutta/explicit.def"
#undef GM_EXPLICIT
};

/* The rows as compile-time constants: in a loop made for one row its zeros vanish. */
#define GM_EXPLICIT(identifier, ...)                                                                         \
    __attribute__((unused)) static const struct gm_tableau gm_explicit_##identifier = {                      \
        .listed = GM_EXPLICIT_##identifier, __VA_ARGS__};
#include "core/ode/families/runge_kutta/explicit.def"
#undef GM_EXPLICIT

#endif
