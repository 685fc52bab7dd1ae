/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The discrete motion of Moser and Veselov of a free rigid body, y' = s y x I^-1 y, H = y . I^-1 y / 2. The
   attitudes R move such that sum trace(R_k J R_{k+1}') is stationary, J the matrix whose inertia is I; with
   the rotation of a step as Cayley's of a vector c that is
       s h/2 (1 + |c|^2) y_0 = I c + c x I c
       y_1 = y_0 - 4/(s h) c x I c / (1 + |c|^2)
   a Poisson map. Both y_0 and y_1 are multiples of I c + c x I c and I c - c x I c, with c x I c and
   I^-1 (c x I c) such that the energy and the Casimir |y|^2 do not change: only the time moves, by a function
   of these two. Without 1 + |c|^2 it is the midpoint rule, which conserves both but is not a Poisson map.
   J. Moser & A.P. Veselov, Commun. Math. Phys. 139 (1991) 217; R.I. McLachlan & A. Zanna, Found. Comput. Math.
   5 (2005) 87. */
#include "core/ode/families/family.h"

struct rotation {
    const double *inertia;
    double m[3], across[3]; /* h/2 y_0, c x I c */
};

/* (1 + |c|^2) m - I c - c x I c, and c x I c */
static bool linear(void *data, const double *c, double *residual, double *matrix, double *scale)
{
    struct rotation *rotation = data;
    const double *inertia = rotation->inertia, *m = rotation->m;
    const double length = 1 + c[0] * c[0] + c[1] * c[1] + c[2] * c[2];
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        const double apart = inertia[k] - inertia[j];
        rotation->across[i] = apart * c[j] * c[k];
        residual[i] = length * m[i] - (inertia[i] * c[i] + rotation->across[i]);
        matrix[3 * i + i] = inertia[i] - 2 * m[i] * c[i];
        matrix[3 * i + j] = apart * c[k] - 2 * m[i] * c[j];
        matrix[3 * i + k] = apart * c[j] - 2 * m[i] * c[k];
        *scale += fabs(c[i]);
    }
    return true;
}

/* Makes a step by Newton's method from the rotation of a short step; a large step has no solution. */
static enum gm_status step(const struct gm_task *task, struct gm_members *members,
                           struct gm_progress *progress)
{
    const struct gm_poisson *poisson = gm_ode_of(task->problem)->poisson;
    const double h = poisson->turning * task->dt;
    double *y = members->y, c[3], scratch[18], unused = 0;
    struct rotation rotation = {.inertia = poisson->moments};
    const struct gm_implicit_equations equations = {
        .linear = linear, .size = 3, .data = &rotation, .counted = 3, .least = 0x1p-52, .roundoff = 0x1p-46};
    for (int i = 0; i < 3; i++) {
        rotation.m[i] = h / 2 * y[i];
        c[i] = rotation.m[i] / rotation.inertia[i];
    }
    progress->evaluations++;
    if (!gm_newton_solve(&equations, scratch, c, progress)) {
        return GM_NO_CONVERGENCE;
    }
    linear(&rotation, c, scratch, scratch + 3, &unused);
    const double length = 1 + c[0] * c[0] + c[1] * c[1] + c[2] * c[2];
    for (int i = 0; i < 3 && h != 0; i++) {
        y[i] -= 4 / h * rotation.across[i] / length;
    }
    return GM_OK;
}

const struct gm_family gm_family_moser_veselov = {
    .title = "discrete Moser-Veselov",
    GM_MEMBERS(moser_veselov, .step = step),
};
