/* SPDX-License-Identifier: GPL-3.0-or-later */
/* y' = A y in three dimensions with tr A = 0. */
#include "core/ode/kernel/loops.h"
#include "core/ode/problems/problems.h"
#include "core/ode/trace_free.h"

GM_LOOPS_DECLARE(linear)

static void flow(const struct gm_problem *problem, size_t piece, double h, double *y, size_t m)
{
    gm_trace_free_flow(problem->parameters, piece, h, y, m);
}

const struct gm_problem gm_problem_linear = {
    .name = "linear",
    .n = 3,
    .m = 1,
    .kind = &gm_kind_ode,
    .facets =
        &(const struct gm_ode){
            .components = "y1 y2 y3",
            .volume = &(const struct gm_volume){.pieces = GM_TRACE_FREE_PIECES, .flow = flow},
            .linear = true,
            .loops = GM_LOOPS(linear),
        },
};
