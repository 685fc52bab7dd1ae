/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_ODE_PROBLEMS_FLUIDS_LOGARITHMS_H
#define GM_CORE_ODE_PROBLEMS_FLUIDS_LOGARITHMS_H

#include <math.h>

#include "core/functions/functions.h"

/* A sum of logarithms, evaluated as the logarithm of products as long as these are neither tiny nor huge. */
struct gm_logarithms {
    double sum, product; /* 0 and 1 at first */
};

static inline void gm_logarithms_add(struct gm_logarithms *logarithms, double number)
{
    const double longer = logarithms->product * number;
    if (longer > 1e-150 && longer < 1e150) {
        logarithms->product = longer;
    } else {
        logarithms->sum += gm_log(logarithms->product) + gm_log(number);
        logarithms->product = 1;
    }
}

static inline double gm_logarithms_sum(const struct gm_logarithms *logarithms)
{
    return logarithms->sum + gm_log(logarithms->product);
}

#endif
