/* SPDX-License-Identifier: GPL-3.0-or-later */
/* (q1, q2, p1, p2), H = (1 + |q|^2)^2 |p|^2/8: rays of light where the index of refraction is 2/(1 + |q|^2), which
   are circles. Not separable, and q1 p2 - q2 p1 is kept. M. Born & E. Wolf, Principles of Optics, 4.2.2. */
#include "core/ode/kernel/loops.h"
#include "tests/problems/energy.h"
#include "tests/problems/problems.h"

GM_LOOPS_DECLARE(fish_eye)
GM_ENERGY_DECLARE(fish_eye)

const struct gm_problem gm_problem_fish_eye = {
    .name = "fish-eye",
    .n = 4,
    .m = 1,
    .kind = &gm_kind_ode,
    .facets =
        &(const struct gm_ode){
            .components = "q1 q2 p1 p2",
            .hamiltonian =
                &(const struct gm_hamiltonian){.energy = gm_energy_fish_eye, .formula = gm_formula_fish_eye},
            .loops = GM_LOOPS(fish_eye),
        },
};
