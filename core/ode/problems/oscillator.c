/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The harmonic oscillator, H = p^2/2 + q^2/2, with and without two tangent vectors. */
#include "core/ode/hamiltonian.h"
#include "core/ode/kernel/loops.h"
#include "core/ode/problems/problems.h"

GM_LOOPS_DECLARE(oscillator)
GM_LOOPS_DECLARE(oscillator_tangent)

static void energy(const struct gm_problem *problem, const double *y, double *value, size_t m)
{
    const double *momentum = y + problem->n / 2 * m;
    for (size_t i = 0; i < m; i++) {
        const double q = y[i], p = momentum[i];
        value[i] = 0.5 * p * p + 0.5 * q * q;
    }
}

static bool formula(const struct gm_problem *problem, struct gm_formula *graph, gm_node_id *node)
{
    return gm_hamiltonian_read(problem, "(p^2 + q^2)/2", graph, node);
}

static void potential(const struct gm_problem *problem, double q, double values[3])
{
    (void)problem;
    values[0] = q * q / 2;
    values[1] = q;
    values[2] = 1;
}

const struct gm_problem gm_problem_oscillator = {
    .name = "oscillator",
    .n = 2,
    .m = 1,
    .kind = &gm_kind_ode,
    .facets =
        &(const struct gm_ode){
            .components = "q p",
            .quadratic = true,
            .split = &(const struct gm_split){.nystrom = true},
            .hamiltonian = &(const struct gm_hamiltonian){.energy = energy, .formula = formula},
            .lagrangian = &(const struct gm_lagrangian){.potential = potential},
            .loops = GM_LOOPS(oscillator),
        },
};

const struct gm_problem gm_problem_oscillator_tangent = {
    .name = "oscillator",
    .n = 6,
    .m = 1,
    .kind = &gm_kind_ode,
    .facets =
        &(const struct gm_ode){
            .components = "q xi1 xi2 p eta1 eta2",
            .quadratic = true,
            .split = &(const struct gm_split){.nystrom = true},
            .hamiltonian =
                &(const struct gm_hamiltonian){.energy = energy, .partial = true, .formula = formula},
            .loops = GM_LOOPS(oscillator_tangent),
        },
};
