/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Two particles of masses 1 and 3 on a line, (q1, q2, p1, p2),
       H = p1^2/2 + p2^2/6 + d^2/2 + d^4/4 + a (q1^4 + q2^4)/4,   d = q1 - q2,
   a = *(const double *)parameters, and a monitor 1 + d^2 of steps that shorten with the distance.
   Masses that differ catch a scheme that takes p for the velocity. */
#include "core/ode/kernel/loops.h"
#include "tests/problems/energy.h"
#include "tests/problems/problems.h"

GM_LOOPS_DECLARE(particles)
GM_ENERGY_DECLARE(particles)

static void density(const struct gm_problem *problem, const double *y, double *value, double *gradient)
{
    (void)problem;
    const double d = y[0] - y[1];
    *value = 1 + d * d;
    for (size_t c = 0; c < 4 && gradient; c++) {
        gradient[c] = c == 0 ? 2 * d : c == 1 ? -2 * d : 0;
    }
}

const struct gm_problem gm_problem_particles = {
    .name = "particles",
    .n = 4,
    .m = 1,
    .kind = &gm_kind_ode,
    .facets =
        &(const struct gm_ode){
            .components = "q1 q2 p1 p2",
            .split = &(const struct gm_split){.nystrom = true},
            .hamiltonian = &(const struct gm_hamiltonian){.energy = gm_energy_particles},
            .monitor = &(const struct gm_monitor){.density = density},
            .loops = GM_LOOPS(particles),
        },
};
