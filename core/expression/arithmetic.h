/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Functions of formulas that the mathematical library lacks. Loops compiled at run time need them without the
   graph. */
#ifndef GM_CORE_EXPRESSION_ARITHMETIC_H
#define GM_CORE_EXPRESSION_ARITHMETIC_H

#include <math.h>

#include "core/functions/functions.h"

/* x^n for whole |n| <= GM_MOST_CHAINED by one chain: x^n = (x^(n/2))^2, times x if n is odd; 1 / x^-n if n <
   0. */
enum { GM_MOST_CHAINED = 16 };
static inline double gm_whole_power(double x, double n)
{
    double power = 1;
    const int whole = (int)fabs(n);
    for (int bit = GM_MOST_CHAINED; bit > 0; bit /= 2) {
        power = power == 1 ? 1 : power * power;
        power = whole & bit ? (whole < 2 * bit ? x : power * x) : power;
    }
    return n < 0 ? 1 / power : power;
}

/* a - b floor(a / b), exact */
static inline double gm_modulo(double a, double b)
{
    const double rest = fmod(a, b);
    return rest != 0 && (rest < 0) != (b < 0) ? rest + b : rest;
}

#endif
