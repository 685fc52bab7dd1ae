/* SPDX-License-Identifier: GPL-3.0-or-later */
/* y' = A y in three dimensions. */
#include "core/ode/kernel/loops.h"
#include "core/ode/problems/problems.h"

GM_LOOPS_DECLARE(linear)

const struct gm_problem gm_problem_linear = {
    .name = "linear",
    .n = 3,
    .m = 1,
    .kind = &gm_kind_ode,
    .facets =
        &(const struct gm_ode){
            .components = "y1 y2 y3",
            .linear = true,
            .loops = GM_LOOPS(linear),
        },
};
