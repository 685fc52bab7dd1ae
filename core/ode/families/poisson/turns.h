/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The rotation of vectors, and their angular velocity under the bracket of angular momenta:
       y' = s y x grad H(y) = omega(y) x y,   omega = -s grad H,  s = +-1
   The state of several vectors is three lists, the first, second and third component of all. */
#ifndef GM_CORE_ODE_FAMILIES_POISSON_TURNS_H
#define GM_CORE_ODE_FAMILIES_POISSON_TURNS_H

#include <math.h>

#include "core/functions/functions.h"
#include "core/linear/vectors.h"
#include "core/ode/ode.h"
#include "core/scheme.h"

/* y := exp(factor a) y, the rotation by that vector, by Rodrigues' formula */
static inline void gm_turn(double factor, const double *a, double *y)
{
    const double axis[3] = {factor * a[0], factor * a[1], factor * a[2]};
    const double angle = sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]);
    const double half = angle > 0 ? gm_sin(angle / 2) / (angle / 2) : 1;
    const double across = angle > 0 ? gm_sin(angle) / angle : 1, along = half * half / 2;
    double once[3], twice[3];
    gm_cross(axis, y, once);
    gm_cross(axis, once, twice);
    for (int i = 0; i < 3; i++) {
        y[i] += across * once[i] + along * twice[i];
    }
}

/* Reads vector number i of `count` from three lists, and writes it back. */
static inline void gm_vector_take(const double *lists, size_t i, size_t count, double *vector)
{
    for (size_t c = 0; c < 3; c++) {
        vector[c] = lists[c * count + i];
    }
}

static inline void gm_vector_put(double *lists, size_t i, size_t count, const double *vector)
{
    for (size_t c = 0; c < 3; c++) {
        lists[c * count + i] = vector[c];
    }
}

/* h omega(y), as many numbers as the state has */
static inline void gm_angular_velocity(const struct gm_problem *problem, double h, const double *y, double *k,
                                       struct gm_progress *progress)
{
    const struct gm_poisson *poisson = gm_ode_of(problem)->poisson;
    poisson->gradient(problem, y, k);
    for (size_t i = 0; i < problem->n; i++) {
        k[i] *= -h * poisson->turning;
    }
    progress->evaluations++;
}

#endif
