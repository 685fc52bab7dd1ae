/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Kahan's method for a quadratic field:
       y1 = y0 + h (I - h/2 f'(y0))^-1 f(y0)
   Products u v of the field become (u0 v1 + u1 v0)/2, which is linearly implicit and its own adjoint. The time, of which
   the field need not be a polynomial, is that of the middle.
   W. Kahan, Unconventional numerical methods for trajectory calculations (1993); E. Celledoni,
   R.I. McLachlan, B. Owren & G.R.W. Quispel, J. Phys. A 46 (2013) 025201. */
#include "core/ode/families/family.h"

static enum gm_status step(const struct gm_task *task, struct gm_members *members,
                           struct gm_progress *progress)
{
    const size_t n = members->n;
    double *f = members->scratch, *matrix = f + n;
    const bool timed = gm_has_time(task->problem);
    const double t = members->y[n - 1];
    members->y[n - 1] = timed ? t + 0.5 * task->dt : t;
    gm_field(task->problem, members->y, f, 1);
    const bool found = gm_jacobian(task->problem, members->y, matrix);
    members->y[n - 1] = t;
    if (!found) {
        return GM_NO_CONVERGENCE;
    }
    for (size_t i = 0; i < n * n; i++) {
        const double slope = timed && i % n == n - 1 ? 0 : matrix[i];
        matrix[i] = (i % (n + 1) == 0 ? 1 : 0) - 0.5 * task->dt * slope;
    }
    progress->evaluations++;
    progress->solves++;
    if (!gm_eliminate(n, matrix, f)) {
        progress->unsolved.obstacle = GM_SINGULAR;
        return GM_NO_CONVERGENCE;
    }
    for (size_t c = 0; c < n; c++) {
        members->y[c] += task->dt * f[c];
    }
    return GM_OK;
}

const struct gm_family gm_family_kahan = {
    .title = "Kahan",
    GM_MEMBERS(kahan, .step = step, .vectors = 1, .squares = 1),
};
