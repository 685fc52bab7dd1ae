/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Exact values in frames of reference. The heat equation is eq. 73 of Razafindralandy et al. (2018); its boosts are those
   of P.J. Olver, Applications of Lie Groups to Differential Equations (1993), ex. 2.41. */
#include "core/field/problems/moving_frames.h"

double gm_frame_exact(const struct gm_framed *framed, double speed, double x, double t)
{
    const double event[] = {x + speed * (t - framed->line.begin), t};
    double value;
    gm_user_line_events(&framed->line, event, 1, &value);
    return value;
}

double gm_heat_factor(const struct gm_framed *framed, bool fixed, double x, double t)
{
    const double lambda = framed->lambda, passed = t - framed->line.begin;
    const double original = fixed ? x - lambda * passed : x;
    return exp(-lambda / (4 * framed->viscosity) * (2 * original + lambda * passed));
}

const struct gm_problem gm_problem_burgers = {
    .name = "Burgers",
    .kind = &gm_kind_field,
    .facets = &(const struct gm_field){.equation = GM_NEEDS_BURGERS},
    .m = 1,
    .bound = 1e3,
};

const struct gm_problem gm_problem_heat = {
    .name = "heat",
    .kind = &gm_kind_field,
    .facets = &(const struct gm_field){.equation = GM_NEEDS_HEAT},
    .m = 1,
    .bound = 1e200,
};
