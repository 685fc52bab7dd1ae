/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/ode/families/splitting/jacobi.h"

#include <math.h>
#include <string.h>

#include "core/functions/lanes.h"
#include "core/ode/families/splitting/kepler.h"

/* x := the differences of q to the centres of mass of the bodies before, in place; x_0 is the centre of all */
static void to_differences(const struct gm_gravity *gravity, double *q)
{
    const size_t d = gravity->dimensions;
    double centre[3] = {0};
    memcpy(centre, q, d * sizeof *centre);
    for (size_t i = 1; i < gravity->bodies; i++) {
        const double share = gravity->masses[i] / gravity->sums[i];
        for (size_t c = 0; c < d; c++) {
            q[i * d + c] -= centre[c];
            centre[c] += share * q[i * d + c];
        }
    }
    memcpy(q, centre, d * sizeof *centre);
}

/* the inverse of to_differences */
static void from_differences(const struct gm_gravity *gravity, double *x)
{
    const size_t d = gravity->dimensions;
    double centre[3] = {0};
    memcpy(centre, x, d * sizeof *centre);
    for (size_t i = gravity->bodies; i-- > 1;) {
        const double share = gravity->masses[i] / gravity->sums[i];
        for (size_t c = 0; c < d; c++) {
            centre[c] -= share * x[i * d + c];
            x[i * d + c] += centre[c];
        }
    }
    memcpy(x, centre, d * sizeof *centre);
}

void gm_jacobi_from_state(const struct gm_gravity *gravity, double *y, double *scratch)
{
    const size_t d = gravity->dimensions, half = gravity->bodies * d;
    for (size_t i = 0; i < half; i++) {
        scratch[i] = y[gravity->places[i]];
        scratch[half + i] = y[half + gravity->places[i]] / gravity->masses[i / d];
    }
    to_differences(gravity, scratch);
    to_differences(gravity, scratch + half);
    memcpy(y, scratch, 2 * half * sizeof *y);
}

void gm_jacobi_to_state(const struct gm_gravity *gravity, double *y, double *scratch)
{
    const size_t d = gravity->dimensions, half = gravity->bodies * d;
    memcpy(scratch, y, 2 * half * sizeof *scratch);
    from_differences(gravity, scratch);
    from_differences(gravity, scratch + half);
    for (size_t i = 0; i < half; i++) {
        y[gravity->places[i]] = scratch[i];
        y[half + gravity->places[i]] = scratch[half + i] * gravity->masses[i / d];
    }
}

bool gm_jacobi_kepler(const struct gm_gravity *gravity, double h, double *y)
{
    const size_t d = gravity->dimensions, half = gravity->bodies * d;
    bool found = true;
    for (size_t c = 0; c < d; c++) {
        y[c] += h * y[half + c];
    }
    for (size_t i = 1; i < gravity->bodies && found; i++) {
        found = gm_kepler_flow(d, gravity->G * gravity->sums[i], h, y + i * d, y + half + i * d);
    }
    return found;
}

/* |x|^-3 */
GM_INLINE double inverse_cube(size_t d, const double *x)
{
    double square = 0;
    for (size_t c = 0; c < d; c++) {
        square += x[c] * x[c];
    }
    return 1 / (square * sqrt(square));
}

/* The attraction of the first two bodies is the one of x_1, and is left out of both. */
GM_INLINE void find_rates(const struct gm_gravity *gravity, size_t d, const double *x, double *a, double *q)
{
    const size_t bodies = gravity->bodies;
    const double *masses = gravity->masses;
    memcpy(q, x, bodies * d * sizeof *q);
    from_differences(gravity, q);
    memset(a, 0, bodies * d * sizeof *a);
    for (size_t i = 0; i < bodies; i++) {
        for (size_t j = i == 0 ? 2 : i + 1; j < bodies; j++) {
            double apart[3];
            for (size_t c = 0; c < d; c++) {
                apart[c] = q[j * d + c] - q[i * d + c];
            }
            const double pull = gravity->G * inverse_cube(d, apart);
            for (size_t c = 0; c < d; c++) {
                a[i * d + c] += pull * masses[j] * apart[c];
                a[j * d + c] -= pull * masses[i] * apart[c];
            }
        }
    }
    to_differences(gravity, a);
    memset(a, 0, d * sizeof *a);
    for (size_t i = 2; i < bodies; i++) {
        const double pull = gravity->G * gravity->sums[i] * inverse_cube(d, x + i * d);
        for (size_t c = 0; c < d; c++) {
            a[i * d + c] += pull * x[i * d + c];
        }
    }
}

void gm_jacobi_interaction(const struct gm_gravity *gravity, const double *x, double *rates, double *scratch)
{
    if (gravity->dimensions == 2) {
        find_rates(gravity, 2, x, rates, scratch);
    } else {
        find_rates(gravity, 3, x, rates, scratch);
    }
}
