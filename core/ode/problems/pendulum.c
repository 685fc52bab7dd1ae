/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pendulum, H = p^2/2 - cos q, with and without two tangent vectors. */
#include <math.h>

#include "core/ode/hamiltonian.h"
#include "core/ode/kernel/loops.h"
#include "core/ode/problems/problems.h"

GM_LOOPS_DECLARE(pendulum)
GM_LOOPS_DECLARE(pendulum_tangent)

static void energy(const struct gm_problem *problem, const double *y, double *value, size_t m)
{
    const double *momentum = y + problem->n / 2 * m;
    for (size_t i = 0; i < m; i++) {
        const double q = y[i], p = momentum[i];
        value[i] = 0.5 * p * p - cos(q);
    }
}

static bool formula(const struct gm_problem *problem, struct gm_formula *graph, gm_node_id *node)
{
    return gm_hamiltonian_read(problem, "p^2/2 - cos(q)", graph, node);
}

static void potential(const struct gm_problem *problem, double q, double values[3])
{
    (void)problem;
    values[0] = -cos(q);
    values[1] = sin(q);
    values[2] = cos(q);
}

const struct gm_problem gm_problem_pendulum = {
    .name = "pendulum",
    .n = 2,
    .m = 1,
    .kind = &gm_kind_ode,
    .facets =
        &(const struct gm_ode){
            .components = "q p",
            .split = &(const struct gm_split){.nystrom = true},
            .hamiltonian = &(const struct gm_hamiltonian){.energy = energy, .formula = formula},
            .lagrangian = &(const struct gm_lagrangian){.potential = potential},
            .loops = GM_LOOPS(pendulum),
        },
};

const struct gm_problem gm_problem_pendulum_tangent = {
    .name = "pendulum",
    .n = 6,
    .m = 1,
    .kind = &gm_kind_ode,
    .facets =
        &(const struct gm_ode){
            .components = "q xi1 xi2 p eta1 eta2",
            .split = &(const struct gm_split){.nystrom = true},
            .hamiltonian =
                &(const struct gm_hamiltonian){.energy = energy, .partial = true, .formula = formula},
            .loops = GM_LOOPS(pendulum_tangent),
        },
};
