/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The harmonic oscillator with two tangent vectors. */
#include "core/ode/kernel/loops.h"
#include "tests/problems/energy.h"
#include "tests/problems/problems.h"

GM_LOOPS_DECLARE(oscillator_tangent)
GM_ENERGY_DECLARE(oscillator_tangent)

const struct gm_problem gm_problem_oscillator_tangent = {
    .name = "oscillator",
    .n = 6,
    .m = 1,
    .kind = &gm_kind_ode,
    .facets =
        &(const struct gm_ode){
            .components = "q xi1 xi2 p eta1 eta2",
            .quadratic = true,
            .linear = true,
            .split = &(const struct gm_split){.nystrom = true},
            .hamiltonian = &(const struct gm_hamiltonian){.energy = gm_energy_oscillator_tangent,
                                                          .partial = true,
                                                          .formula = gm_formula_oscillator_tangent},
            .loops = GM_LOOPS(oscillator_tangent),
        },
};
