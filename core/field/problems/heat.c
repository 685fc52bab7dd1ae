/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The heat equation, eq. 73 of Razafindralandy et al. (2018). Its boosts are those of P.J. Olver, Applications of Lie Groups
   to Differential Equations (1993), ex. 2.41. */
#include "core/field/problems/heat.h"

#include <math.h>

#include "core/functions/functions.h"

double gm_heat_factor(const struct gm_heat *heat, bool fixed, double x, double t)
{
    const double lambda = heat->framed.lambda, passed = t - heat->framed.line.begin;
    const double original = fixed ? x - lambda * passed : x;
    return gm_exp(-lambda / (4 * heat->diffusivity) * (2 * original + lambda * passed));
}

const struct gm_problem gm_problem_heat = {
    .name = "heat",
    .kind = &gm_kind_field,
    .facets = &(const struct gm_field){.equation = GM_NEEDS_HEAT},
    .m = 1,
    .bound = 1e200,
};
