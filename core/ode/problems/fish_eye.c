/* SPDX-License-Identifier: GPL-3.0-or-later */
/* (q1, q2, p1, p2), H = (1 + |q|^2)^2 |p|^2/8: rays of light where the index of refraction is 2/(1 + |q|^2), which
   are circles. Not separable, and q1 p2 - q2 p1 is kept. M. Born & E. Wolf, Principles of Optics, 4.2.2. */
#include "core/ode/hamiltonian.h"
#include "core/ode/kernel/loops.h"
#include "core/ode/problems/problems.h"

GM_LOOPS_DECLARE(fish_eye)

static void energy(const struct gm_problem *problem, const double *y, double *value, size_t m)
{
    (void)problem;
    for (size_t i = 0; i < m; i++) {
        const double q1 = y[i], q2 = y[m + i], p1 = y[2 * m + i], p2 = y[3 * m + i];
        const double n = 1 + (q1 * q1 + q2 * q2);
        value[i] = n * n * (p1 * p1 + p2 * p2) / 8;
    }
}

static bool formula(const struct gm_problem *problem, struct gm_formula *graph, gm_node_id *node)
{
    return gm_hamiltonian_read(problem, "(1 + q1^2 + q2^2)^2*(p1^2 + p2^2)/8", graph, node);
}

const struct gm_problem gm_problem_fish_eye = {
    .name = "fish-eye",
    .n = 4,
    .m = 1,
    .kind = &gm_kind_ode,
    .facets =
        &(const struct gm_ode){
            .components = "q1 q2 p1 p2",
            .hamiltonian = &(const struct gm_hamiltonian){.energy = energy, .formula = formula},
            .loops = GM_LOOPS(fish_eye),
        },
};
