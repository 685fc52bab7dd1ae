/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The Korteweg-de Vries equation on a ring of twelve points, dx = 1:
       u_t + u u_x + u_xxx/2 = 0,   u u_x = (u_{i+1} + u_i + u_{i-1}) (u_{i+1} - u_{i-1})/6
       u_xxx = (u_{i+2} - 2 u_{i+1} + 2 u_{i-1} - u_{i-2})/2
   It keeps the sums of u and of u^2. */
#include <complex.h>
#include <math.h>

#include "core/functions/functions.h"
#include "core/ode/kernel/loops.h"
#include "core/ode/problems/problems.h"

enum { POINTS = 12 };

GM_LOOPS_DECLARE(ring)

static void symbol(const struct gm_problem *problem, size_t mode, double complex *matrix)
{
    (void)problem;
    const double angle = 2 * M_PI * (double)mode / POINTS;
    matrix[0] = -I * (gm_sin(2 * angle) - 2 * gm_sin(angle)) / 2;
}

static void nonlinear(const struct gm_problem *problem, const double *y, double *rest)
{
    (void)problem;
    for (size_t i = 0; i < POINTS; i++) {
        const double left = y[(i + POINTS - 1) % POINTS], right = y[(i + 1) % POINTS];
        rest[i] = -(right + y[i] + left) * (right - left) / 6;
    }
}

const struct gm_problem gm_problem_ring = {
    .name = "ring",
    .n = POINTS,
    .m = 1,
    .kind = &gm_kind_ode,
    .facets =
        &(const struct gm_ode){
            .components = "u[]",
            .quadratic = true,
            .semilinear = &(const struct gm_semilinear){1, symbol, nonlinear},
            .loops = GM_LOOPS(ring),
        },
};
