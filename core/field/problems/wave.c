/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Wave equations u_tt - u_xx + V'(u) = 0 in multisymplectic form, s = (u, v, w):
       -v_t + w_x = V'(u)
        u_t       = v
       -u_x       = -w
       S = V(u) + v^2/2 - w^2/2
   T.J. Bridges & S. Reich, Phys. Lett. A 284 (2001) 184; Razafindralandy et al. (2018). */
#include <math.h>

#include "core/basics.h"
#include "core/field/problems/problems.h"
#include "core/functions/functions.h"
#include "core/functions/rows.h"

static const double m[9] = {0, -1, 0, 1, 0, 0, 0, 0, 0};
static const double k[9] = {0, 0, 1, 0, 0, 0, -1, 0, 0};
const struct gm_form gm_form_of_waves = {.dimension = 3, .m = m, .k = k, .kept = 2};

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

/* With m = (a + b)/2 and d = (a - b)/2, -(cos a - cos b)/(a - b) = sin m sinc d, and its derivative in a. Series
   where sinc d = sin d / d and its derivative would cancel. */
GM_CLONES static void products(const double *restrict half, const double *restrict sine,
                               const double *restrict cosine, double *restrict quotient,
                               double *restrict slope, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        const double d = half[i], ratio = sine[count + i] / d, sinc = fabs(d) < 1e-4 ? 1 - d * d / 6 : ratio,
                     change = fabs(d) < 1e-3 ? -d / 3 + d * d * d / 30 : (cosine[count + i] - ratio) / d;
        quotient[i] = sine[i] * sinc;
        slope[i] = (cosine[i] * sinc + sine[i] * change) / 2;
    }
}

static void quotients(const struct gm_problem *problem, const double *a, const double *b, double *quotient,
                      double *slope, size_t count)
{
    enum { BLOCK = 64 };
    (void)problem;
    for (size_t first = 0; first < count; first += BLOCK) {
        const size_t size = count - first < BLOCK ? count - first : BLOCK;
        double angles[2 * BLOCK], sine[2 * BLOCK], cosine[2 * BLOCK], unused[BLOCK];
        for (size_t i = 0; i < size; i++) {
            angles[i] = (a[first + i] + b[first + i]) / 2;
            angles[size + i] = (a[first + i] - b[first + i]) / 2;
        }
        gm_function_rows()->sine_and_cosine(sine, cosine, angles, 2 * size);
        products(angles + size, sine, cosine, quotient + first, slope ? slope + first : unused, size);
    }
}

static double none(const struct gm_problem *problem, double u)
{
    return (void)problem, (void)u, 0;
}

static void no_slopes(const struct gm_problem *problem, const double *u, double *slope, size_t count)
{
    (void)problem;
    (void)u;
    for (size_t i = 0; i < count; i++) {
        slope[i] = 0;
    }
}

static void no_quotients(const struct gm_problem *problem, const double *a, const double *b, double *quotient,
                         double *slope, size_t count)
{
    (void)b;
    no_slopes(problem, a, quotient, count);
    if (slope) {
        no_slopes(problem, a, slope, count);
    }
}

static const struct gm_wave sine_gordon = {
    .potential = potential,
    .curvature = curvature,
    .slopes = slopes,
    .quotients = quotients,
};

static const struct gm_wave linear = {
    .potential = none,
    .curvature = none,
    .slopes = no_slopes,
    .quotients = no_quotients,
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
