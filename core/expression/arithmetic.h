/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What formulas compute and the mathematical library does not, apart from the graph: loops that are built
   while the program runs need it too. */
#ifndef GM_CORE_EXPRESSION_ARITHMETIC_H
#define GM_CORE_EXPRESSION_ARITHMETIC_H

#include <math.h>

/* x^n for whole |n| <= GM_MOST_CHAINED by one chain: x^n = (x^(n/2))^2, times x where n is odd; 1 / x^-n. */
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
