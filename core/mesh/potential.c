/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The potential of the sine-Gordon equation and its exact mean over linear elements, m the mean and r the difference of the ends:
       sine-Gordon   w = 1 - cos(m) S(r/2),   S(h) = sin(h)/h           (Tyranowski & Desbrun 2019, eq. 170) */

#include <math.h>
#include <stdint.h>
#include <string.h>

#include "core/functions/functions.h"
#include "core/mesh/moving_mesh.h"

/* Sine-Gordon: the mean of cos over an element is cos(m) S(r / 2), S(h) = sin(h) / h, which has no 0/0 where
   the field is flat. */

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

/* Sine and cosine without a branch, so that loops over elements are vectorised; error below 1e-16 for
   arguments up to 10^5: reduction by pi/2 in two parts (Cody & Waite 1980), then Taylor's polynomials. */
static inline void sine_cosine(double x, double *sine, double *cosine)
{
    const double magic = 0x1.8p52;
    const double shifted = x * (2 / M_PI) + magic;
    const double quarters = shifted - magic;
    const double r = (x - quarters * 0x1.921fb544p0) - quarters * 0x1.0b4611a626331p-34;
    const double z = r * r;
    const double s =
        r + r * z *
                (-1. / 6 +
                 z * (1. / 120 +
                      z * (-1. / 5040 +
                           z * (1. / 362880 +
                                z * (-1. / 39916800 + z * (1. / 6227020800 + z * (-1. / 1307674368000)))))));
    const double c =
        1 - z / 2 +
        z * z *
            (1. / 24 + z * (-1. / 720 +
                            z * (1. / 40320 + z * (-1. / 3628800 +
                                                   z * (1. / 479001600 + z * (-1. / 87178291200 +
                                                                              z * (1. / 20922789888000)))))));
    uint64_t quadrant, sine_bits, cosine_bits;
    memcpy(&quadrant, &shifted, sizeof quadrant);
    memcpy(&sine_bits, &s, sizeof sine_bits);
    memcpy(&cosine_bits, &c, sizeof cosine_bits);
    const uint64_t swapped = -(quadrant & 1);
    const uint64_t first = (cosine_bits & swapped) | (sine_bits & ~swapped);
    const uint64_t second = (sine_bits & swapped) | (cosine_bits & ~swapped);
    const uint64_t sine_sign = (quadrant & 2) << 62, cosine_sign = ((quadrant + 1) & 2) << 62;
    sine_bits = first ^ sine_sign;
    cosine_bits = second ^ cosine_sign;
    memcpy(sine, &sine_bits, sizeof *sine);
    memcpy(cosine, &cosine_bits, sizeof *cosine);
}

static void sine_gordon_first(const struct gm_potential *potential, const double *restrict middle,
                              const double *restrict rise, size_t n, double *restrict w, double *restrict w_m,
                              double *restrict w_r)
{
    (void)potential;
    for (size_t e = 0; e < n; e++) {
        const double h = rise[e] / 2;
        const double z = h * h;
        double sine, cosine;
        sine_cosine(middle[e], &sine, &cosine);
        const double s = series(z);
        w[e] = 1 - cosine * s;
        w_m[e] = sine * s;
        w_r[e] = -cosine * (h * series_slope(z)) / 2;
    }
    for (size_t e = 0; e < n; e++) {
        const double h = rise[e] / 2;
        if (!(fabs(h) < wide)) {
            const double s = gm_sin(h) / h, slope = (gm_cos(h) - s) / h;
            w[e] = 1 - gm_cos(middle[e]) * s;
            w_m[e] = gm_sin(middle[e]) * s;
            w_r[e] = -gm_cos(middle[e]) * slope / 2;
        }
    }
}

static void sine_gordon_second(const struct gm_potential *potential, double middle, double rise, double *w_mm,
                               double *w_mr, double *w_rr)
{
    (void)potential;
    const double h = rise / 2, z = h * h;
    double s, slope, bend;
    if (fabs(h) < wide) {
        s = series(z);
        slope = h * series_slope(z);
        bend = series_bend(z);
    } else {
        s = gm_sin(h) / h;
        slope = (gm_cos(h) - s) / h;
        bend = -s - 2 * slope / h;
    }
    *w_mm = gm_cos(middle) * s;
    *w_mr = gm_sin(middle) * slope / 2;
    *w_rr = -gm_cos(middle) * bend / 4;
}

const struct gm_potential gm_potential_sine_gordon = {
    .name = "sine-gordon",
    .first = sine_gordon_first,
    .second = sine_gordon_second,
};
