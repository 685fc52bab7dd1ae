/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The harmonic oscillator, H = p^2/2 + q^2/2. */
#include "core/ode/hamiltonian.h"
#include "core/ode/kernel/loops.h"
#include "core/ode/problems/problems.h"

GM_LOOPS_DECLARE(oscillator)
GM_ENERGY_DECLARE(oscillator)

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
            .hamiltonian = &(const struct gm_hamiltonian){.energy = gm_energy_oscillator,
                                                          .formula = gm_formula_oscillator},
            .lagrangian = &(const struct gm_lagrangian){.potential = gm_potential_oscillator},
            .loops = GM_LOOPS(oscillator),
        },
};
