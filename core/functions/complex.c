/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/functions/complex.h"

#include <complex.h>
#include <math.h>

#include "core/functions/functions.h"

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
