/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The heat equation, eq. 73 of Razafindralandy et al. (2018), and its exact solutions (heat.h). Its boosts
   are those of P.J. Olver, Applications of Lie Groups to Differential Equations (1993), ex. 2.41. */
#include "core/field/problems/heat.h"

#include <math.h>

static double kernel(double nu, double x, double age, double t)
{
    return sqrt(age / (age + t)) * exp(-x * x / (4 * nu * (age + t)));
}

static double unboosted(const struct gm_heat *heat, double x, double t)
{
    const double nu = heat->diffusivity, age = heat->age;
    switch (heat->start) {
    case GM_HEAT_KERNEL:
        return kernel(nu, x, age, t);
    case GM_HEAT_TWO:
        return kernel(nu, x + 1.5, age, t) + 0.6 * kernel(nu, x - 1.5, 3 * age, t);
    default:
        return 0.1 + 0.45 * erfc(x / sqrt(4 * nu * (age + t)));
    }
}

double gm_heat_factor(const struct gm_heat *heat, bool fixed, double x, double t)
{
    const double lambda = heat->lambda, original = fixed ? x - lambda * t : x;
    return exp(-lambda / (4 * heat->diffusivity) * (2 * original + lambda * t));
}

double gm_heat_exact(const struct gm_heat *heat, bool fixed, double x, double t)
{
    const double original = fixed ? x - heat->lambda * t : x;
    return unboosted(heat, original, t) * gm_heat_factor(heat, fixed, x, t);
}

const struct gm_problem gm_problem_heat = {
    .name = "heat",
    .kind = &gm_kind_field,
    .facets = &(const struct gm_field){.equation = GM_NEEDS_HEAT},
    .m = 1,
    .bound = 1e200,
};
