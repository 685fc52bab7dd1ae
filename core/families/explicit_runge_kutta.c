/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Explicit Runge-Kutta methods:  k_i = f(y + h sum_{j<i} a_ij k_j),  y' = y + h sum_i b_i k_i.
   Hairer, Norsett & Wanner, Solving Ordinary Differential Equations I, section II.1. */
#include "core/families/explicit_runge_kutta.h"

#include <stdlib.h>

#include "core/families/families.h"
#include "core/families/runge_kutta_any.h"

static const enum gm_explicit_row rows[GM_EXPLICIT_COUNT] = {
#define GM_EXPLICIT(identifier, ...) GM_EXPLICIT_##identifier,
#include "core/families/explicit_runge_kutta.def"
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
        .needs = GM_NEEDS_ODE,                                                                               \
        .claims = claims_,                                                                                   \
    },
#include "core/families/explicit_runge_kutta.def"
#undef GM_EXPLICIT
};

const struct gm_family gm_family_explicit_runge_kutta = {
    .id = GM_FAMILY_explicit_runge_kutta,
    .title = "explicit Runge-Kutta",
    .schemes = schemes,
    .count = GM_EXPLICIT_COUNT,
    .parameters = gm_settings_of_sums,
    .loop = gm_explicit_any_loop,
    .carries_passive = true,
    .workspace_open = gm_explicit_any_open,
    .workspace_close = free,
};
