/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Newton's method with halved steps (Deuflhard, Newton Methods for Nonlinear Problems (2004), 3.1). */
#include "core/linear/ring/newton.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/basics.h"

bool gm_ring_newton_open(struct gm_ring_newton *newton, size_t count, size_t parts, size_t reach)
{
    const size_t n = count * parts;
    *newton = (struct gm_ring_newton){.n = n, .trial = malloc(3 * n * sizeof(double))};
    if (!newton->trial || !gm_ring_band_open(&newton->band, count, parts, reach)) {
        free(newton->trial);
        *newton = (struct gm_ring_newton){0};
        return false;
    }
    newton->residual = newton->trial + n;
    newton->change = newton->residual + n;
    return true;
}

void gm_ring_newton_close(struct gm_ring_newton *newton)
{
    gm_ring_band_close(&newton->band);
    free(newton->trial);
}

static double largest(const double *x, size_t n)
{
    double most = 0;
    for (size_t i = 0; i < n; i++) {
        most = gm_larger(fabs(x[i]), most);
    }
    return most;
}

/* The sum of the squares of the residual. */
static double find_residual(struct gm_ring_newton *newton, const struct gm_ring_equations *equations,
                            const double *u, struct gm_progress *progress)
{
    double sum = 0;
    equations->residual(equations->context, u, newton->residual);
    progress->evaluations++;
    for (size_t i = 0; i < newton->n; i++) {
        sum += newton->residual[i] * newton->residual[i];
    }
    return sum;
}

enum gm_status gm_ring_newton_solve(struct gm_ring_newton *newton, const struct gm_ring_equations *equations,
                                    double *u, struct gm_progress *progress)
{
    enum { MOST = 100, HALVINGS = 20 };
    const size_t n = newton->n;
    double sum = find_residual(newton, equations, u, progress);
    for (int k = 0; k < MOST; k++) {
        gm_ring_band_clear(&newton->band);
        equations->jacobian(equations->context, &newton->band);
        memcpy(newton->change, newton->residual, n * sizeof *u);
        progress->iterations++;
        progress->solves++;
        if (!gm_ring_band_factor(&newton->band)) {
            return GM_NO_CONVERGENCE;
        }
        gm_ring_band_solve(&newton->band, newton->change);
        const double scale = largest(u, n), change = largest(newton->change, n);
        if (!isfinite(change)) {
            return GM_NO_CONVERGENCE;
        }
        if (change <= 1e-8 * fmax(scale, 1e-3)) {
            /* quadratic convergence: what is left is below rounding */
            for (size_t i = 0; i < n; i++) {
                u[i] += newton->change[i];
            }
            return GM_OK;
        }
        double part = 1, next = INFINITY;
        for (int h = 0; h < HALVINGS && !(next < sum); h++, part /= 2) {
            for (size_t i = 0; i < n; i++) {
                newton->trial[i] = u[i] + part * newton->change[i];
            }
            next = find_residual(newton, equations, newton->trial, progress);
        }
        if (!(next < sum)) {
            return GM_NO_CONVERGENCE;
        }
        memcpy(u, newton->trial, n * sizeof *u);
        sum = next;
    }
    return GM_NO_CONVERGENCE;
}
