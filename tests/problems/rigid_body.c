/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The free rigid body: Euler's equations y_1' = (1/I_3 - 1/I_2) y_2 y_3 and cyclic, I = (2, 1, 2/3).
   Hairer, Lubich & Wanner (2006), IV.1. */
#include <math.h>

#include "core/functions/functions.h"
#include "core/ode/kernel/loops.h"
#include "tests/problems/problems.h"

GM_LOOPS_DECLARE(rigid_body)

static double energy(const struct gm_problem *problem, const double *y)
{
    (void)problem;
    return y[0] * y[0] / 4 + y[1] * y[1] / 2 + 3 * y[2] * y[2] / 4;
}

static void gradient(const struct gm_problem *problem, const double *y, double *slope)
{
    (void)problem;
    slope[0] = y[0] / 2;
    slope[1] = y[1];
    slope[2] = 3 * y[2] / 2;
}

static void bracket(const struct gm_problem *problem, const double *y, double *matrix)
{
    (void)problem;
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        matrix[3 * i + i] = 0;
        matrix[3 * i + j] = -y[k];
        matrix[3 * j + i] = y[k];
    }
}

/* That of y_i^2 / (2 I_i) turns about axis i at the rate y_i / I_i. */
static void flow(const struct gm_problem *problem, size_t piece, double h, double *y)
{
    static const double inverse[3] = {0.5, 1, 1.5};
    const size_t j = (piece + 1) % 3, k = (piece + 2) % 3;
    const double angle = h * inverse[piece] * y[piece], c = gm_cos(angle), s = gm_sin(angle), before = y[j];
    (void)problem;
    y[j] = c * before + s * y[k];
    y[k] = c * y[k] - s * before;
}

const struct gm_problem gm_problem_rigid_body = {
    .name = "rigid-body",
    .n = 3,
    .m = 1,
    .kind = &gm_kind_ode,
    .facets =
        &(const struct gm_ode){
            .components = "y1 y2 y3",
            .quadratic = true,
            .poisson =
                &(const struct gm_poisson){
                    .energy = energy,
                    .gradient = gradient,
                    .bracket = bracket,
                    .turning = 1,
                    .spins = 1,
                    .axes = true,
                    .moments = {2, 1, 2. / 3},
                    .pieces = 3,
                    .flow = flow,
                },
            .loops = GM_LOOPS(rigid_body),
        },
};
