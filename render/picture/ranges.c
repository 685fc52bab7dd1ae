/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Ranges of axes: widened by values, then rounded. */
#include <math.h>

#include "render/picture/picture.h"

#define PI 3.14159265358979323846

void gm_range_add(double *low, double *high, double value)
{
    if (!isfinite(value)) {
        return;
    }
    if (*low > *high) {
        *low = *high = value;
        return;
    }
    *low = fmin(*low, value);
    *high = fmax(*high, value);
}

/* Returns the smallest of 1, 2, 5 times a power of ten that is not below value > 0. */
static double round_up(double value)
{
    const double power = pow(10.0, floor(log10(value)));
    const double mantissa = value / power;
    const double rounding = 1.0 + 1e-9;
    return power * (mantissa <= rounding         ? 1.0
                    : mantissa <= 2.0 * rounding ? 2.0
                    : mantissa <= 5.0 * rounding ? 5.0
                                                 : 10.0);
}

/* Widens to multiples of a round step of about a quarter of the range. If the wider range has the next larger
   step, this is repeated, so that rounding twice changes nothing. */
static void round_linear(double *low, double *high, double unit)
{
    if (*low == *high) {
        const double around = *low != 0.0 ? 0.1 * fabs(*low) : 1.0;
        *low -= around;
        *high += around;
    }
    const double from = *low / unit, to = *high / unit;
    double a = from, b = to;
    for (int pass = 0; pass < 4; pass++) {
        const double step = round_up((b - a) / 4.0);
        const double next_a = step * floor(from / step + 1e-9), next_b = step * ceil(to / step - 1e-9);
        if (!isfinite(next_a) || !isfinite(next_b) || (next_a == a && next_b == b)) {
            break;
        }
        a = next_a;
        b = next_b;
    }
    *low = fmin(*low, a * unit);
    *high = fmax(*high, b * unit);
}

/* Widens to 1, 2, 5 times powers of ten up to two decades, to whole decades beyond. */
static void round_log(double *low, double *high)
{
    if (!(*low > 0.0)) {
        *low = *high > 0.0 ? *high / 10.0 : 0.1;
        *high = *high > 0.0 ? *high : 1.0;
    }
    if (*low == *high) {
        *low /= 2.0;
        *high *= 2.0;
    }
    if (log10(*high / *low) <= 2.0) {
        *high = fmax(*high, round_up(*high));
        /* The largest round value not above low is the inverse of the smallest not below its inverse. */
        *low = fmin(*low, 1.0 / round_up(1.0 / *low));
    } else {
        *low = fmin(*low, pow(10.0, floor(log10(*low) + 1e-9)));
        *high = fmax(*high, pow(10.0, ceil(log10(*high) - 1e-9)));
    }
}

void gm_range_round(double *low, double *high, enum gm_scale scale)
{
    if (!(*low <= *high) || !isfinite(*low) || !isfinite(*high)) {
        *low = scale == GM_LOG ? 0.1 : 0.0;
        *high = 1.0;
        return;
    }
    if (scale == GM_LOG) {
        round_log(low, high);
    } else {
        round_linear(low, high, scale == GM_PI ? PI : 1.0);
    }
}
