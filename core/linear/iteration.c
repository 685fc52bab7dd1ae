/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sweeps, and Newton's method with halved steps (Deuflhard, Newton Methods for Nonlinear Problems (2004), 3.1). */
#include "core/linear/iteration.h"

bool gm_sweeps_solve(const struct gm_implicit_equations *equations, double *scratch, double *restrict z,
                     struct gm_progress *progress)
{
    enum { MOST = 150 };
    double *restrict next = scratch, previous = INFINITY, before_previous = INFINITY;
    for (int iteration = 0; iteration < MOST; iteration++) {
        double scale = 0, change = 0;
        if (!equations->sweep(equations->data, z, next, &scale)) {
            return false;
        }
        for (size_t i = 0; i < equations->size; i++) {
            change += fabs(next[i] - z[i]);
            z[i] = next[i];
        }
        progress->iterations++;
        const double roundoff = equations->roundoff * scale, before = previous;
        if (gm_is_settled(change, roundoff, &previous)) {
            return true;
        }
        progress->unsolved = gm_unsolved_by(change, scale);
        if (!(change < 1e100) ||
            (equations->linear && !GM_SWEEPS_CONTRACT(change, before_previous, roundoff))) {
            return false;
        }
        before_previous = before;
    }
    return false;
}

bool gm_newton_solve(const struct gm_implicit_equations *equations, double *scratch, double *z,
                     struct gm_progress *progress)
{
    return gm_newton_solve_by(equations, equations->linear, scratch, z, progress);
}
