/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Newton's method for dL/dv = p, and the elimination that it needs. */
#include "core/model/legendre.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_STEPS = 100, MOST_HALVINGS = 40 };

bool gm_mass_open(struct gm_mass *mass, size_t n)
{
    *mass = (struct gm_mass){n, calloc(n * n, sizeof(double)), calloc(n, sizeof(size_t))};
    if (!mass->entries || !mass->pivots) {
        gm_mass_close(mass);
        return false;
    }
    return true;
}

void gm_mass_close(struct gm_mass *mass)
{
    free(mass->entries);
    free(mass->pivots);
    *mass = (struct gm_mass){0};
}

bool gm_mass_factor(struct gm_mass *mass, double least)
{
    const size_t n = mass->n;
    double *a = mass->entries, largest = 0;
    for (size_t i = 0; i < n * n && least > 0; i++) {
        largest = fmax(largest, fabs(a[i]));
    }
    for (size_t k = 0; k < n; k++) {
        size_t pivot = k;
        for (size_t i = k + 1; i < n; i++) {
            pivot = fabs(a[i * n + k]) > fabs(a[pivot * n + k]) ? i : pivot;
        }
        mass->pivots[k] = pivot;
        if (!(fabs(a[pivot * n + k]) > least * largest) || !isfinite(a[pivot * n + k])) {
            return false;
        }
        for (size_t j = 0; j < n && pivot != k; j++) {
            const double kept = a[k * n + j];
            a[k * n + j] = a[pivot * n + j];
            a[pivot * n + j] = kept;
        }
        for (size_t i = k + 1; i < n; i++) {
            const double factor = a[i * n + k] /= a[k * n + k];
            for (size_t j = k + 1; j < n; j++) {
                a[i * n + j] -= factor * a[k * n + j];
            }
        }
    }
    return true;
}

void gm_mass_solve(const struct gm_mass *factors, double *x)
{
    const size_t n = factors->n;
    const double *a = factors->entries;
    for (size_t k = 0; k < n; k++) {
        const double kept = x[factors->pivots[k]];
        x[factors->pivots[k]] = x[k];
        x[k] = kept;
    }
    for (size_t i = 1; i < n; i++) {
        for (size_t j = 0; j < i; j++) {
            x[i] -= a[i * n + j] * x[j];
        }
    }
    for (size_t i = n; i-- > 0;) {
        for (size_t j = i + 1; j < n; j++) {
            x[i] -= a[i * n + j] * x[j];
        }
        x[i] /= a[i * n + i];
    }
}

static double distance(const double *a, const double *b, size_t n)
{
    double sum = 0;
    for (size_t i = 0; i < n; i++) {
        sum += fabs(a[i] - b[i]);
    }
    return sum;
}

static double length(const double *a, size_t n)
{
    double sum = 0;
    for (size_t i = 0; i < n; i++) {
        sum += fabs(a[i]);
    }
    return sum;
}

bool gm_legendre_solve(size_t n, bool linear, gm_legendre_momenta *momenta, void *data, const double *p,
                       struct gm_mass *mass, double *scratch, double *v)
{
    double *here = scratch, *step = scratch + n, *trial = scratch + 2 * n;
    double previous = INFINITY;
    momenta(data, v, here, mass);
    bool solved = false;
    for (int count = 0; count < MOST_STEPS && !solved && gm_mass_factor(mass, 0); count++) {
        for (size_t i = 0; i < n; i++) {
            step[i] = p[i] - here[i];
        }
        gm_mass_solve(mass, step);
        const double change = length(step, n), off = distance(p, here, n);
        /* at the level of round-off a step no longer shrinks: v is as good as it gets */
        solved = linear || change <= 0x1p-52 * length(v, n) ||
                 (change <= 0x1p-40 * length(v, n) && change >= previous);
        previous = change;
        if (solved) {
            for (size_t i = 0; i < n; i++) {
                v[i] += step[i];
            }
            break;
        }
        bool nearer = false;
        double factor = 1;
        for (int half = 0; half < MOST_HALVINGS && !nearer; half++, factor /= 2) {
            for (size_t i = 0; i < n; i++) {
                trial[i] = v[i] + factor * step[i];
            }
            momenta(data, trial, here, mass);
            nearer = distance(p, here, n) <= off || change <= 0x1p-26 * length(v, n);
        }
        if (!nearer) {
            break;
        }
        memcpy(v, trial, n * sizeof *v);
    }
    for (size_t i = 0; i < n; i++) {
        v[i] = solved ? v[i] : NAN;
    }
    return solved && isfinite(length(v, n));
}
