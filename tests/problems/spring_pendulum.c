/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A mass on a stiff spring of rest length 1 in gravity; see spring_pendulum.kernel.h. */
#include <math.h>
#include <stdio.h>

#include "core/ode/hamiltonian.h"
#include "core/ode/kernel/loops.h"
#include "tests/problems/problems.h"

GM_LOOPS_DECLARE(spring_pendulum)

static void energy(const struct gm_problem *problem, const double *y, double *value, size_t m)
{
    const double stiffness = *(const double *)problem->parameters;
    for (size_t i = 0; i < m; i++) {
        const double q1 = y[i], q2 = y[m + i], p1 = y[2 * m + i], p2 = y[3 * m + i];
        const double expansion = sqrt(q1 * q1 + q2 * q2) - 1;
        value[i] = (p1 * p1 + p2 * p2 + stiffness * expansion * expansion) / 2 + q2;
    }
}

static bool formula(const struct gm_problem *problem, struct gm_formula *graph, gm_node_id *node)
{
    char text[128];
    snprintf(text, sizeof text, "(p1^2 + p2^2 + %.17g*(sqrt(q1^2 + q2^2) - 1)^2)/2 + q2",
             *(const double *)problem->parameters);
    return gm_hamiltonian_read(problem, text, graph, node);
}

const struct gm_problem gm_problem_spring_pendulum = {
    .name = "spring-pendulum",
    .n = 4,
    .m = 1,
    .kind = &gm_kind_ode,
    .facets =
        &(const struct gm_ode){
            .components = "q1 q2 p1 p2",
            .stiff = true,
            .split = &(const struct gm_split){.nystrom = true},
            .hamiltonian = &(const struct gm_hamiltonian){.energy = energy, .formula = formula},
            .loops = GM_LOOPS(spring_pendulum),
        },
};
