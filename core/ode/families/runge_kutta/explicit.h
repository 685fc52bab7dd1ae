/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Explicit Runge-Kutta methods:
       k_i = f(y0 + h sum_{j<i} a_ij k_j)
       y1  = y0 + h sum_i b_i k_i
   A scheme is one row of core/ode/families/runge_kutta/explicit.def. */
#ifndef GM_CORE_ODE_FAMILIES_RUNGE_KUTTA_EXPLICIT_H
#define GM_CORE_ODE_FAMILIES_RUNGE_KUTTA_EXPLICIT_H

/* The most stages of a row of the list, and of any scheme. */
enum { GM_EXPLICIT_LISTED_STAGES = 4, GM_EXPLICIT_STAGES = 16 };

struct gm_explicit_tableau {
    int stages;
    double a[GM_EXPLICIT_STAGES][GM_EXPLICIT_STAGES];
    double b[GM_EXPLICIT_STAGES];
};

/* The rows as compile-time constants: in a loop made for one row its zeros vanish. */
#define GM_TABLEAU(...) __VA_ARGS__
#define GM_EXPLICIT(identifier, order_, claims_, tableau_, ...)                                              \
    __attribute__((unused)) static const struct gm_explicit_tableau gm_explicit_##identifier = {tableau_};
#include "core/ode/families/runge_kutta/explicit.def"
#undef GM_EXPLICIT

/* The row of a scheme, in the order of the list. */
enum gm_explicit_row {
#define GM_EXPLICIT(identifier, ...) GM_EXPLICIT_##identifier,
#include "core/ode/families/runge_kutta/explicit.def"
#undef GM_EXPLICIT
    GM_EXPLICIT_COUNT,
    GM_EXPLICIT_USER = GM_EXPLICIT_COUNT /* not in the list: a struct gm_explicit_user */
};

/* A user-defined method, whose tableau is known at run time only. */
struct gm_explicit_user {
    enum gm_explicit_row row; /* GM_EXPLICIT_USER */
    struct gm_explicit_tableau tableau;
};

/* Returns the tableau of a scheme's coefficients: a row of the list, or a user-defined one. */
const struct gm_explicit_tableau *gm_explicit_tableau_of(const enum gm_explicit_row *row);

#endif
