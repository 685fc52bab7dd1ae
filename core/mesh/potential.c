/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The potential of the sine-Gordon equation and its exact mean over linear elements, m the mean and r the difference of
   the ends:
       w = 1 - cos(m) S(r/2),   S(h) = sin(h)/h           (Tyranowski & Desbrun 2019, eq. 170)
   which has no 0/0 where the field is flat. */
#include <math.h>

#include "core/functions/functions.h"
#include "core/functions/rows.h"
#include "core/mesh/moving_mesh.h"

/* S, S' / h and S'' for |h| < 1/2 by their series in z = h^2. */
static inline double series(double z)
{
    return 1 +
           z * (-1. / 6 + z * (1. / 120 +
                               z * (-1. / 5040 + z * (1. / 362880 + z * (-1. / 39916800 + z / 6227020800)))));
}

static inline double series_slope(double z)
{
    return -1. / 3 + z * (1. / 30 + z * (-1. / 840 + z * (1. / 45360 + z * (-1. / 3991680 + z / 518918400))));
}

static inline double series_bend(double z)
{
    return -1. / 3 + z * (1. / 10 + z * (-1. / 168 + z * (1. / 6480 + z * (-1. / 443520 + z / 47174400))));
}

static const double wide = 0.5;

struct sinc {
    double s, slope, bend; /* S, S', S'' */
};

static struct sinc sinc_of(double h)
{
    const double z = h * h;
    if (fabs(h) < wide) {
        return (struct sinc){series(z), h * series_slope(z), series_bend(z)};
    }
    const double s = gm_sin(h) / h, slope = (gm_cos(h) - s) / h;
    return (struct sinc){s, slope, -s - 2 * slope / h};
}

static void sine_gordon_first(const struct gm_potential *potential, const double *restrict middle,
                              const double *restrict rise, size_t n, double *restrict w, double *restrict w_m,
                              double *restrict w_r)
{
    (void)potential;
    gm_function_rows()->sine_and_cosine(w_m, w, middle, n);
    for (size_t e = 0; e < n; e++) { /* without a branch, so that it is vectorised */
        const double h = rise[e] / 2, z = h * h, s = series(z), cosine = w[e];
        w[e] = 1 - cosine * s;
        w_m[e] = w_m[e] * s;
        w_r[e] = -cosine * (h * series_slope(z)) / 2;
    }
    for (size_t e = 0; e < n; e++) {
        if (!(fabs(rise[e] / 2) < wide)) {
            const struct sinc of = sinc_of(rise[e] / 2);
            w[e] = 1 - gm_cos(middle[e]) * of.s;
            w_m[e] = gm_sin(middle[e]) * of.s;
            w_r[e] = -gm_cos(middle[e]) * of.slope / 2;
        }
    }
}

static void sine_gordon_second(const struct gm_potential *potential, double middle, double rise, double *w_mm,
                               double *w_mr, double *w_rr)
{
    (void)potential;
    const struct sinc of = sinc_of(rise / 2);
    *w_mm = gm_cos(middle) * of.s;
    *w_mr = gm_sin(middle) * of.slope / 2;
    *w_rr = -gm_cos(middle) * of.bend / 4;
}

const struct gm_potential gm_potential_sine_gordon = {
    .name = "sine-gordon",
    .first = sine_gordon_first,
    .second = sine_gordon_second,
};
