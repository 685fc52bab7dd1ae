/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The spherical pendulum in Cartesian coordinates, with its rod as a constraint; see
   spherical_pendulum.system. */
#include <string.h>

#include "core/ode/hamiltonian.h"
#include "core/ode/kernel/loops.h"
#include "core/ode/problems/problems.h"

GM_LOOPS_DECLARE(spherical_pendulum)
GM_ENERGY_DECLARE(spherical_pendulum)

/* L = |v|^2/2 - z */
static void motion(const struct gm_problem *problem, const double *at, const struct gm_motion *motion)
{
    static const double identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, weight[3] = {0, 0, -1};
    (void)problem;
    memcpy(motion->momenta, at + 3, sizeof weight);
    memcpy(motion->forces, weight, sizeof weight);
    memset(motion->momenta_q, 0, sizeof identity);
    memcpy(motion->momenta_v, identity, sizeof identity);
    memset(motion->forces_q, 0, sizeof identity);
    memset(motion->forces_v, 0, sizeof identity);
}

static void constrain(const struct gm_problem *problem, const double *q, const double *multipliers, double *g,
                      double *slopes, double *curvature)
{
    (void)problem;
    g[0] = (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] - 1) / 2;
    for (int i = 0; i < 3; i++) {
        slopes[i] = q[i];
        for (int j = 0; j < 3; j++) {
            curvature[3 * i + j] = i == j ? multipliers[0] : 0;
        }
    }
}

const struct gm_problem gm_problem_spherical_pendulum = {
    .name = "spherical pendulum",
    .n = 6,
    .m = 1,
    .kind = &gm_kind_ode,
    .facets =
        &(const struct gm_ode){
            .components = "x y z p_x p_y p_z",
            .hamiltonian = &(const struct gm_hamiltonian){.energy = gm_energy_spherical_pendulum},
            .action = &(const struct gm_action){.motion = motion, .constraints = 1, .constrain = constrain},
            .loops = GM_LOOPS(spherical_pendulum),
        },
};
