/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The harmonic oscillator, H = p^2/2 + q^2/2. */
#include "core/ode/hamiltonian.h"
#include "core/ode/kernel/loops.h"
#include "core/ode/problems/problems.h"

GM_LOOPS_DECLARE(oscillator)

static void energy(const struct gm_problem *problem, const double *y, double *value, size_t m)
{
    (void)problem;
    for (size_t i = 0; i < m; i++) {
        value[i] = (y[m + i] * y[m + i] + y[i] * y[i]) / 2;
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
            .linear = true,
            .split = &(const struct gm_split){.nystrom = true},
            .hamiltonian = &(const struct gm_hamiltonian){.energy = energy, .formula = formula},
            .lagrangian = &(const struct gm_lagrangian){.potential = potential},
            .loops = GM_LOOPS(oscillator),
        },
};
