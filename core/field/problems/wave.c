/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Wave equations u_tt - u_xx + V'(u) = 0 in multisymplectic form, s = (u, v, w):
       -v_t + w_x = V'(u)
        u_t       = v
       -u_x       = -w
       S = V(u) + v^2/2 - w^2/2
   T.J. Bridges & S. Reich, Phys. Lett. A 284 (2001) 184; Razafindralandy et al. (2018). */
#include <math.h>

#include "core/field/problems/problems.h"
#include "core/functions/functions.h"
#include "core/functions/rows.h"

static const double m[9] = {0, -1, 0, 1, 0, 0, 0, 0, 0};
static const double k[9] = {0, 0, 1, 0, 0, 0, -1, 0, 0};
const struct gm_form gm_form_of_waves = {.dimension = 3, .m = m, .k = k};

/* sin x / x and its derivative; series where the quotient would cancel */
static double sinc(double x)
{
    return fabs(x) < 1e-4 ? 1 - x * x / 6 : gm_sin(x) / x;
}

static double sinc_slope(double x)
{
    return fabs(x) < 1e-3 ? -x / 3 + x * x * x / 30 : (gm_cos(x) - gm_sin(x) / x) / x;
}

static double potential(const struct gm_problem *problem, double u)
{
    (void)problem;
    return 1 - gm_cos(u);
}

static double curvature(const struct gm_problem *problem, double u)
{
    (void)problem;
    return gm_cos(u);
}

static void slopes(const struct gm_problem *problem, const double *u, double *slope, size_t count)
{
    (void)problem;
    gm_function_rows()->sin(slope, u, false, u, false, count);
}

/* -(cos a - cos b) / (a - b) */
static double quotient(const struct gm_problem *problem, double a, double b)
{
    (void)problem;
    return gm_sin((a + b) / 2) * sinc((a - b) / 2);
}

static double quotient_slope(const struct gm_problem *problem, double a, double b)
{
    (void)problem;
    const double mean = (a + b) / 2, half = (a - b) / 2;
    return (gm_cos(mean) * sinc(half) + gm_sin(mean) * sinc_slope(half)) / 2;
}

static double none(const struct gm_problem *problem, double u)
{
    return (void)problem, (void)u, 0;
}

static double none_between(const struct gm_problem *problem, double a, double b)
{
    return (void)problem, (void)a, (void)b, 0;
}

static void no_slopes(const struct gm_problem *problem, const double *u, double *slope, size_t count)
{
    (void)problem;
    (void)u;
    for (size_t i = 0; i < count; i++) {
        slope[i] = 0;
    }
}

static const struct gm_wave sine_gordon = {
    .potential = potential,
    .curvature = curvature,
    .slopes = slopes,
    .quotient = quotient,
    .quotient_slope = quotient_slope,
};

static const struct gm_wave linear = {
    .potential = none,
    .curvature = none,
    .slopes = no_slopes,
    .quotient = none_between,
    .quotient_slope = none_between,
};

const struct gm_problem gm_problem_sine_gordon = {
    .name = "sine-Gordon",
    .kind = &gm_kind_field,
    .facets = &(const struct gm_field){.form = &gm_form_of_waves, .wave = &sine_gordon},
    .m = 1,
    .bound = 1e3,
};
const struct gm_problem gm_problem_wave = {
    .name = "wave equation",
    .kind = &gm_kind_field,
    .facets = &(const struct gm_field){.form = &gm_form_of_waves, .wave = &linear},
    .m = 1,
    .bound = 1e3,
};
