/* SPDX-License-Identifier: GPL-3.0-or-later */
/* (q, p), H = (1 + q^2)(1 + p^2)/2: a Hamiltonian that is not separable.
   M. Tao, Phys. Rev. E 94 (2016) 043303. */
#include "core/ode/kernel/loops.h"
#include "tests/problems/energy.h"
#include "tests/problems/problems.h"

GM_LOOPS_DECLARE(product)
GM_ENERGY_DECLARE(product)

const struct gm_problem gm_problem_product = {
    .name = "product",
    .n = 2,
    .m = 1,
    .kind = &gm_kind_ode,
    .facets =
        &(const struct gm_ode){
            .components = "q p",
            .hamiltonian =
                &(const struct gm_hamiltonian){.energy = gm_energy_product, .formula = gm_formula_product},
            .loops = GM_LOOPS(product),
        },
};
