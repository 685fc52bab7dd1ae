/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Henon & Heiles, (q1, q2, p1, p2), H = (|p|^2 + |q|^2)/2 + q1^2 q2 - q2^3/3. Astron. J. 69 (1964) 73. */
#include "core/ode/kernel/loops.h"
#include "tests/problems/energy.h"
#include "tests/problems/problems.h"

GM_LOOPS_DECLARE(henon_heiles)
GM_ENERGY_DECLARE(henon_heiles)

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
            .hamiltonian = &(const struct gm_hamiltonian){.energy = gm_energy_henon_heiles,
                                                          .formula = gm_formula_henon_heiles},
            .loops = GM_LOOPS(henon_heiles),
        },
};
