/* SPDX-License-Identifier: GPL-3.0-or-later */
/* (q, p), H = (1 + q^2)(1 + p^2)/2: a Hamiltonian that is not separable.
   M. Tao, Phys. Rev. E 94 (2016) 043303. */
#include "core/ode/hamiltonian.h"
#include "core/ode/kernel/loops.h"
#include "core/ode/problems/problems.h"

GM_LOOPS_DECLARE(product)

static void energy(const struct gm_problem *problem, const double *y, double *value, size_t m)
{
    (void)problem;
    for (size_t i = 0; i < m; i++) {
        value[i] = 0.5 * (1 + y[i] * y[i]) * (1 + y[m + i] * y[m + i]);
    }
}

static bool formula(const struct gm_problem *problem, struct gm_formula *graph, gm_node_id *node)
{
    return gm_hamiltonian_read(problem, "(1 + q^2)*(1 + p^2)/2", graph, node);
}

const struct gm_problem gm_problem_product = {
    .name = "product",
    .n = 2,
    .m = 1,
    .kind = &gm_kind_ode,
    .facets =
        &(const struct gm_ode){
            .components = "q p",
            .hamiltonian = &(const struct gm_hamiltonian){.energy = energy, .formula = formula},
            .loops = GM_LOOPS(product),
        },
};
