/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/functions/complex.h"

#include <complex.h>
#include <float.h>
#include <math.h>
#include <stdbool.h>

#include "core/functions/functions.h"

/* (a + i b) / (c + i d) for |c| >= |d|. The quotient d/c may vanish where b d/c does not. */
static double complex quotient(double a, double b, double c, double d)
{
    const double ratio = d / c, below = c + d * ratio;
    const bool good = fabs(ratio) > DBL_MIN;
    return __builtin_complex((good ? a + b * ratio : a + d * (b / c)) / below,
                             (good ? b - a * ratio : b - d * (a / c)) / below);
}

double complex gm_cdivide(double complex x, double complex y)
{
    const double large = DBL_MAX / 2, small = DBL_EPSILON, most = large * small;
    double a = creal(x), b = cimag(x), c = creal(y), d = cimag(y);
    const double size = fmax(fabs(c), fabs(d)), halved = size >= large ? .5 : 1;
    a *= halved, b *= halved, c *= halved, d *= halved;
    const bool tiny = (fabs(a) < DBL_MIN && fabs(b) < most) || (fabs(b) < DBL_MIN && fabs(a) < most);
    const double grown = size < small || (tiny && size < most) ? 1 / small : 1;
    a *= grown, b *= grown, c *= grown, d *= grown;
    return fabs(c) < fabs(d) ? quotient(b, -a, d, -c) : quotient(a, b, c, d);
}

double gm_cabs(double complex z)
{
    return gm_hypot(creal(z), cimag(z));
}

double gm_carg(double complex z)
{
    return gm_atan2(cimag(z), creal(z));
}

double complex gm_cexp(double complex z)
{
    const double size = gm_exp(creal(z));
    return size * gm_cos(cimag(z)) + I * (size * gm_sin(cimag(z)));
}

double complex gm_cpow(double complex z, double n)
{
    return gm_cexp(n * (gm_log(gm_cabs(z)) + I * gm_carg(z)));
}

double complex gm_csqrt(double complex z)
{
    const double x = creal(z), y = cimag(z), half = sqrt((fabs(x) + gm_cabs(z)) / 2),
                 other = half > 0 ? fabs(y) / (2 * half) : 0;
    return x < 0 ? other + I * copysign(half, y) : half + I * copysign(other, y);
}
