/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Explicit Runge-Kutta methods:
       k_i = f(y0 + h sum_{j<i} a_ij k_j)
       y1  = y0 + h sum_i b_i k_i
   E. Hairer, S.P. Norsett & G. Wanner, Solving Ordinary Differential Equations I (1993), section II.1. The
   rows are in explicit_runge_kutta.def, which the loops over kernels include as well. */
#include "core/ode/families/explicit_runge_kutta.h"

#include <stdlib.h>

#include "core/ode/families/families.h"
#include "core/ode/families/runge_kutta_any.h"
#include "core/ode/kernel/loops.h"

static const enum gm_explicit_row rows[GM_EXPLICIT_COUNT] = {
#define GM_EXPLICIT(identifier, ...) GM_EXPLICIT_##identifier,
#include "core/ode/families/explicit_runge_kutta.def"
#undef GM_EXPLICIT
};

static const struct gm_scheme schemes[] = {
#define GM_EXPLICIT(identifier, order_, claims_, tableau_, name_, title_, formula_, reference_)              \
    {                                                                                                        \
        .name = name_,                                                                                       \
        .title = title_,                                                                                     \
        .formula = formula_,                                                                                 \
        .reference = reference_,                                                                             \
        .family = &gm_family_explicit_runge_kutta,                                                           \
        .coefficients = &rows[GM_EXPLICIT_##identifier],                                                     \
        .order = order_,                                                                                     \
        .claims = claims_,                                                                                   \
    },
#include "core/ode/families/explicit_runge_kutta.def"
#undef GM_EXPLICIT
};

const struct gm_family gm_family_explicit_runge_kutta = {
    .kind = &gm_kind_ode,
    .over_kernels = GM_OVER_EXPLICIT,
    .title = "explicit Runge-Kutta",
    .schemes = schemes,
    .count = GM_EXPLICIT_COUNT,
    .parameters = gm_settings_of_sums,
    .loop = gm_explicit_any_loop,
    .carries_passive = true,
    .workspace_open = gm_explicit_any_open,
    .workspace_close = free,
};
