/* SPDX-License-Identifier: GPL-3.0-or-later */
/* GMRES with Arnoldi's basis by Gram & Schmidt, and Givens rotations for the small least squares problem.
   What the preconditioner made of the basis is kept: it may be another one each time, and the correction is
   their sum. */
#include "core/linear/gmres.h"

#include <math.h>
#include <string.h>

#include "core/functions/functions.h"

enum { M = GM_GMRES_BASIS };

size_t gm_gmres_scratch(size_t n)
{
    return (2 * M + 3) * n; /* a product, the residual, M + 1 of the basis, M of what it became */
}

static double dot(const double *a, const double *b, size_t n)
{
    enum { LANES = 4 }; /* sums that do not wait for each other */
    double sum[LANES] = {0};
    size_t i = 0;
    for (; i + LANES <= n; i += LANES) {
        for (size_t k = 0; k < LANES; k++) {
            sum[k] += a[i + k] * b[i + k];
        }
    }
    for (; i < n; i++) {
        sum[0] += a[i] * b[i];
    }
    return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

static void add(double *y, double factor, const double *x, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        y[i] += factor * x[i];
    }
}

/* One cycle on the residual r: adds its correction to x. Returns the residual's norm from the recurrence.
   Memory after the computed vectors is not touched. */
static double cycle(const struct gm_system *system, const double *r, double *x, double small, double *scratch,
                    unsigned long *iterations)
{
    const size_t n = system->n;
    double *w = scratch, *basis[M + 1], *made[M];
    for (size_t i = 0; i <= M; i++) {
        basis[i] = scratch + (2 + 2 * i) * n;
    }
    for (size_t i = 0; i < M; i++) {
        made[i] = basis[i] + n;
    }
    double h[M + 1][M], c[M], s[M], g[M + 1] = {0}, y[M];
    double norm = sqrt(dot(r, r, n));
    g[0] = norm;
    for (size_t i = 0; i < n; i++) {
        basis[0][i] = r[i] / norm;
    }
    int m = 0;
    while (m < M && norm > small) {
        system->precondition(system->data, basis[m], made[m]);
        system->apply(system->data, made[m], w);
        for (int i = 0; i <= m; i++) {
            h[i][m] = dot(w, basis[i], n);
            add(w, -h[i][m], basis[i], n);
        }
        const double length = sqrt(dot(w, w, n));
        h[m + 1][m] = length;
        for (size_t i = 0; i < n; i++) {
            basis[m + 1][i] = length > 0 ? w[i] / length : 0;
        }
        for (int i = 0; i < m; i++) {
            const double a = h[i][m], b = h[i + 1][m];
            h[i][m] = c[i] * a + s[i] * b;
            h[i + 1][m] = c[i] * b - s[i] * a;
        }
        const double radius = gm_hypot(h[m][m], h[m + 1][m]);
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
    for (int i = 0; i < m; i++) {
        add(x, y[i], made[i], n);
    }
    return norm;
}

bool gm_gmres(const struct gm_system *system, const double *b, double *x, double small, double *scratch,
              unsigned long *iterations)
{
    const size_t n = system->n;
    double *r = scratch + n;
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
