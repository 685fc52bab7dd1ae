/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Largest values in which a NaN is not lost, as fmax loses it. */
#ifndef GM_CORE_LARGER_H
#define GM_CORE_LARGER_H

/* The larger of both; NaN where one is. */
static inline double gm_larger(double a, double b)
{
    return a > b || a != a ? a : b;
}

#endif
