/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Henon & Heiles, (q1, q2, p1, p2), H = (|p|^2 + |q|^2)/2 + q1^2 q2 - q2^3/3. Astron. J. 69 (1964) 73. */
#include "core/ode/hamiltonian.h"
#include "core/ode/kernel/loops.h"
#include "core/ode/problems/problems.h"

GM_LOOPS_DECLARE(henon_heiles)

static void energy(const struct gm_problem *problem, const double *y, double *value, size_t m)
{
    (void)problem;
    for (size_t i = 0; i < m; i++) {
        const double q1 = y[i], q2 = y[m + i], p1 = y[2 * m + i], p2 = y[3 * m + i];
        value[i] = (p1 * p1 + p2 * p2 + q1 * q1 + q2 * q2) / 2 + q1 * q1 * q2 - q2 * q2 * q2 / 3;
    }
}

static bool formula(const struct gm_problem *problem, struct gm_formula *graph, gm_node_id *node)
{
    return gm_hamiltonian_read(problem, "(p1^2 + p2^2 + q1^2 + q2^2)/2 + q1^2*q2 - q2^3/3", graph, node);
}

const struct gm_problem gm_problem_henon_heiles = {
    .name = "henon-heiles",
    .n = 4,
    .m = 1,
    .kind = &gm_kind_ode,
    .facets =
        &(const struct gm_ode){
            .components = "q1 q2 p1 p2",
            .quadratic = true,
            .split = &(const struct gm_split){.nystrom = true, .unit_mass = true},
            .hamiltonian = &(const struct gm_hamiltonian){.energy = energy, .formula = formula},
            .loops = GM_LOOPS(henon_heiles),
        },
};
