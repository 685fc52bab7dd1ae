/* SPDX-License-Identifier: GPL-3.0-or-later */
/* GMRES with Arnoldi's basis by Gram & Schmidt, and Givens rotations for the small least squares problem. */
#include "core/linear/gmres.h"

#include <math.h>
#include <string.h>

enum { M = GM_GMRES_BASIS };

size_t gm_gmres_scratch(size_t n)
{
    return (M + 4) * n;
}

static double dot(const double *a, const double *b, size_t n)
{
    double sum = 0;
    for (size_t i = 0; i < n; i++) {
        sum += a[i] * b[i];
    }
    return sum;
}

static void add(double *y, double factor, const double *x, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        y[i] += factor * x[i];
    }
}

/* One cycle on the residual r: adds its correction to x. The residual's norm by the recurrence. */
static double cycle(const struct gm_system *system, const double *r, double *x, double small, double *scratch,
                    unsigned long *iterations)
{
    const size_t n = system->n;
    double *basis = scratch, *w = scratch + (M + 1) * n, *z = scratch + (M + 2) * n;
    double h[M + 1][M], c[M], s[M], g[M + 1] = {0}, y[M];
    double norm = sqrt(dot(r, r, n));
    g[0] = norm;
    for (size_t i = 0; i < n; i++) {
        basis[i] = r[i] / norm;
    }
    int m = 0;
    while (m < M && norm > small) {
        system->precondition(system->data, basis + (size_t)m * n, z);
        system->apply(system->data, z, w);
        for (int i = 0; i <= m; i++) {
            h[i][m] = dot(w, basis + (size_t)i * n, n);
            add(w, -h[i][m], basis + (size_t)i * n, n);
        }
        const double length = sqrt(dot(w, w, n));
        h[m + 1][m] = length;
        for (size_t i = 0; i < n; i++) {
            basis[(size_t)(m + 1) * n + i] = length > 0 ? w[i] / length : 0;
        }
        for (int i = 0; i < m; i++) {
            const double a = h[i][m], b = h[i + 1][m];
            h[i][m] = c[i] * a + s[i] * b;
            h[i + 1][m] = c[i] * b - s[i] * a;
        }
        const double radius = hypot(h[m][m], h[m + 1][m]);
        if (!(radius > 0)) {
            break;
        }
        c[m] = h[m][m] / radius;
        s[m] = h[m + 1][m] / radius;
        h[m][m] = radius;
        g[m + 1] = -s[m] * g[m];
        g[m] *= c[m];
        norm = fabs(g[m + 1]);
        m++;
        (*iterations)++;
    }
    for (int i = m - 1; i >= 0; i--) {
        y[i] = g[i];
        for (int k = i + 1; k < m; k++) {
            y[i] -= h[i][k] * y[k];
        }
        y[i] /= h[i][i];
    }
    memset(w, 0, n * sizeof *w);
    for (int i = 0; i < m; i++) {
        add(w, y[i], basis + (size_t)i * n, n);
    }
    system->precondition(system->data, w, z);
    add(x, 1, z, n);
    return norm;
}

bool gm_gmres(const struct gm_system *system, const double *b, double *x, double small, double *scratch,
              unsigned long *iterations)
{
    const size_t n = system->n;
    double *r = scratch + (M + 3) * n;
    double norm = sqrt(dot(b, b, n));
    memset(x, 0, n * sizeof *x);
    memcpy(r, b, n * sizeof *r);
    for (int i = 0; i < GM_GMRES_CYCLES && norm > small; i++) {
        const double left = cycle(system, r, x, small, scratch, iterations);
        if (!(left <= norm / 2)) {
            return false; /* it stagnates */
        }
        norm = left;
        if (norm > small) {
            system->apply(system->data, x, r);
            for (size_t k = 0; k < n; k++) {
                r[k] = b[k] - r[k];
            }
        }
    }
    return norm <= small;
}
