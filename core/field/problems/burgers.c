/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Burgers' equation and its exact solutions (burgers.h): Razafindralandy et al. (2018), eqs. 93 to 96, 125
   and 127; in (127) as printed the argument of tanh lacks t. */
#include "core/field/problems/burgers.h"

#include <math.h>

double gm_burgers_t0(const struct gm_burgers *burgers)
{
    return burgers->test == GM_BURGERS_SHOCK ? 1 : 0;
}

/* lambda = 0; without overflow for any viscosity, which for 0 means the limit */
static double unboosted(const struct gm_burgers *burgers, double x, double t)
{
    const double nu = burgers->viscosity;
    if (burgers->test == GM_BURGERS_SHOCK) {
        const double jump = nu > 0 ? tanh(x / (2 * nu * t)) : (double)((x > 0) - (x < 0));
        return (x - jump) / t;
    }
    if (nu == 0) {
        return (double)((x < 0) - (x > 0));
    }
    const double e = exp(-fabs(x) / nu);
    return copysign((1 - e) / (1 + e + 2 * exp(-fabs(x) / (2 * nu) - t / (4 * nu))), -x);
}

double gm_burgers_exact(const struct gm_burgers *burgers, bool fixed, double x, double t)
{
    const double back = fixed ? burgers->lambda * (t - gm_burgers_t0(burgers)) : 0;
    return unboosted(burgers, x - back, t) + burgers->lambda;
}

size_t gm_burgers_size(const struct gm_burgers *burgers, size_t points)
{
    return burgers->lambda != 0 ? 2 * points + 1 : points;
}

const struct gm_problem gm_problem_burgers = {
    .name = "Burgers",
    .kind = &gm_kind_field,
    .facets = &(const struct gm_field){.equation = GM_NEEDS_BURGERS},
    .m = 1,
    .bound = 1e3,
};
