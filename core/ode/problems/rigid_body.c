/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The free rigid body: Euler's equations y_1' = (1/I_3 - 1/I_2) y_2 y_3 and cyclic, I = (2, 1, 2/3).
   Hairer, Lubich & Wanner (2006), IV.1. */
#include "core/ode/kernel/loops.h"
#include "core/ode/problems/problems.h"

GM_LOOPS_DECLARE(rigid_body)

const struct gm_problem gm_problem_rigid_body = {
    .name = "rigid-body",
    .n = 3,
    .m = 1,
    .kind = &gm_kind_ode,
    .facets =
        &(const struct gm_ode){
            .components = "y1 y2 y3",
            .quadratic = true,
            .loops = GM_LOOPS(rigid_body),
        },
};
