/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pendulum, H = p^2/2 - cos q. */
#include "core/ode/kernel/loops.h"
#include "tests/problems/energy.h"
#include "tests/problems/problems.h"

GM_LOOPS_DECLARE(pendulum)
GM_ENERGY_DECLARE(pendulum)

const struct gm_problem gm_problem_pendulum = {
    .name = "pendulum",
    .n = 2,
    .m = 1,
    .kind = &gm_kind_ode,
    .facets =
        &(const struct gm_ode){
            .components = "q p",
            .split = &(const struct gm_split){.nystrom = true},
            .hamiltonian =
                &(const struct gm_hamiltonian){.energy = gm_energy_pendulum, .formula = gm_formula_pendulum},
            .lagrangian = &(const struct gm_lagrangian){.potential = gm_potential_pendulum},
            .loops = GM_LOOPS(pendulum),
        },
};
