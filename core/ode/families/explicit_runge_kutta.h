/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Explicit Runge-Kutta methods:
       k_i = f(y0 + h sum_{j<i} a_ij k_j)
       y1  = y0 + h sum_i b_i k_i
   A scheme is one row of core/ode/families/explicit_runge_kutta.def. */
#ifndef GM_CORE_ODE_FAMILIES_EXPLICIT_RUNGE_KUTTA_H
#define GM_CORE_ODE_FAMILIES_EXPLICIT_RUNGE_KUTTA_H

enum { GM_EXPLICIT_STAGES = 4 };

struct gm_explicit_tableau {
    int stages;
    double a[GM_EXPLICIT_STAGES][GM_EXPLICIT_STAGES];
    double b[GM_EXPLICIT_STAGES];
};

/* The rows as compile-time constants: in a loop made for one row its zeros vanish. */
#define GM_TABLEAU(...) __VA_ARGS__
#define GM_EXPLICIT(identifier, order_, claims_, tableau_, ...)                                              \
    __attribute__((unused)) static const struct gm_explicit_tableau gm_explicit_##identifier = {tableau_};
#include "core/ode/families/explicit_runge_kutta.def"
#undef GM_EXPLICIT

/* Which row a scheme is: the order of the list. */
enum gm_explicit_row {
#define GM_EXPLICIT(identifier, ...) GM_EXPLICIT_##identifier,
#include "core/ode/families/explicit_runge_kutta.def"
#undef GM_EXPLICIT
    GM_EXPLICIT_COUNT
};

/* The row's tableau. */
const struct gm_explicit_tableau *gm_explicit_tableau_of(enum gm_explicit_row row);

#endif
