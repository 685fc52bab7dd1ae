/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pendulum with friction; see damped_pendulum.system. Areas shrink by exp(-c t). */
#include "core/ode/kernel/loops.h"
#include "core/ode/problems/problems.h"

GM_LOOPS_DECLARE(damped_pendulum)

static double friction(const struct gm_problem *problem)
{
    return *(const double *)problem->parameters;
}

const struct gm_problem gm_problem_damped_pendulum = {
    .name = "damped pendulum",
    .n = 2,
    .m = 1,
    .kind = &gm_kind_ode,
    .facets =
        &(const struct gm_ode){
            .components = "q p",
            .action = &(const struct gm_action){.friction = friction},
            .loops = GM_LOOPS(damped_pendulum),
        },
};
