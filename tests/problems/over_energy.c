/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The energy of a problem, from the file GM_ENERGIES that write_energy writes; GM_PROBLEM as for over_kernels.c. The build
   compiles this file once for each; without an energy it is empty. */
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#include "core/ode/families/runge_kutta/explicit.h"
#include "core/ode/families/runge_kutta/implicit.h"
#include "core/ode/families/splitting/splitting.h"
#include "core/ode/hamiltonian.h"
#include "core/ode/kernel/loops.h"
#include "core/scheme.h"
#include "tests/problems/energy.h"

#define GM_PASS_SCALAR
#include "core/functions/lanes.h"

#include GM_ENERGIES

#define NAME(what) NAME_(what, GM_PROBLEM)
#define NAME_(what, problem) NAME__(what, problem)
#define NAME__(what, problem) gm_##what##_##problem

GM_ENERGY_DECLARE(GM_PROBLEM)

#ifdef GM_WITH_ENERGY
void NAME(energy)(const struct gm_problem *problem, const double *y, double *energy, size_t m)
{
    for (size_t i = 0; i < m; i++) {
        double state[GM_COMPONENTS];
        for (size_t c = 0; c < GM_COMPONENTS; c++) {
            state[c] = y[c * m + i];
        }
        K(energy)(state, &energy[i], problem->parameters);
    }
}
#endif

#ifdef GM_ENERGY_TEXT
bool NAME(formula)(const struct gm_problem *problem, struct gm_formula *graph, gm_node_id *energy)
{
    return gm_hamiltonian_read(problem, GM_ENERGY_TEXT, graph, energy);
}
#endif

#ifdef GM_WITH_POTENTIAL
void NAME(potential)(const struct gm_problem *problem, double q, double values[3])
{
    K(potential)(&q, values, problem->parameters);
}
#endif
