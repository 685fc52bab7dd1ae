/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The ABC flow; see abc.system. Its three components are shears, whose flows are exact. */
#include <math.h>

#include "core/functions/functions.h"
#include "core/ode/kernel/loops.h"
#include "tests/problems/problems.h"

GM_LOOPS_DECLARE(abc)

static void flow(const struct gm_problem *problem, size_t piece, double h, double *state, size_t m)
{
    const double *abc = problem->parameters;
    double *x = state, *y = state + m, *z = state + 2 * m;
    for (size_t i = 0; i < m; i++) {
        switch (piece) {
        case 0:
            x[i] += h * (abc[0] * gm_sin(z[i]) + abc[2] * gm_cos(y[i]));
            break;
        case 1:
            y[i] += h * (abc[1] * gm_sin(x[i]) + abc[0] * gm_cos(z[i]));
            break;
        default:
            z[i] += h * (abc[2] * gm_sin(y[i]) + abc[1] * gm_cos(x[i]));
        }
    }
}

const struct gm_problem gm_problem_abc = {
    .name = "abc",
    .n = 3,
    .m = 1,
    .kind = &gm_kind_ode,
    .facets =
        &(const struct gm_ode){
            .components = "x y z",
            .volume = &(const struct gm_volume){.pieces = 3, .flow = flow},
            .loops = GM_LOOPS(abc),
        },
};
