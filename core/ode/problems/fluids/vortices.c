/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Point vortices of equal strength g = *(const double *)parameters in the plane,
       H = -(1/2 pi) sum_{i<j} g^2 ln r_ij :
   with q_i = g x_i, p_i = y_i these are Hamilton's equations. H. Aref, Annu. Rev. Fluid Mech. 15 (1983) 345;
   Razafindralandy et al. (2018), eq. 30, with corrected factor and sense of rotation. */
#include <math.h>
#include <stdio.h>

#include "core/functions/functions.h"
#include "core/ode/hamiltonian.h"
#include "core/ode/kernel/loops.h"
#include "core/ode/problems/fluids/logarithms.h"
#include "core/ode/problems/problems.h"

GM_LOOPS_DECLARE(vortices)
GM_LOOPS_DECLARE(vortices_multipole)
GM_LOOPS_DECLARE(vortices_four)
GM_LOOPS_DECLARE(vortices_reduced)
GM_LOOPS_DECLARE(vortices_reduced_carrying)

static double strength(const struct gm_problem *problem)
{
    return *(const double *)problem->parameters;
}

static double inverse_strength(const struct gm_problem *problem)
{
    return 1 / strength(problem);
}

/* A vortex that is carried stands for two. */
static double inverse_of_two(const struct gm_problem *problem)
{
    return 1 / (2 * strength(problem));
}

static void energy(const struct gm_problem *problem, const double *state, double *value, size_t m)
{
    const size_t count = (problem->n - 2 * problem->passive) / 2;
    const double factor = strength(problem) * strength(problem) / (4 * M_PI);
    for (size_t k = 0; k < m; k++) {
        const double *x = state + k, *y = state + count * m + k;
        struct gm_logarithms squares = {.product = 1};
        for (size_t i = 0; i < count; i++) {
            for (size_t j = i + 1; j < count; j++) {
                const double dx = x[i * m] - x[j * m], dy = y[i * m] - y[j * m];
                gm_logarithms_add(&squares, dx * dx + dy * dy);
            }
        }
        value[k] = -factor * gm_logarithms_sum(&squares);
    }
}

/* Writes the energy of one member, as loops have it. */
static void energy_of_many(const struct gm_problem *problem, const double *state, double *value, size_t m)
{
    (void)m;
    *value = gm_ode_of(problem)->loops[gm_isa_best()]->energy(problem, state);
}

static void reduced_energy(const struct gm_problem *problem, const double *state, double *value, size_t m)
{
    const double factor = strength(problem) * strength(problem) / (4 * M_PI);
    for (size_t k = 0; k < m; k++) {
        const double x1 = state[k], x2 = state[m + k], y1 = state[2 * m + k], y2 = state[3 * m + k];
        const double dx = x1 - x2, dy = y1 - y2, sx = x1 + x2, sy = y1 + y2;
        value[k] = -factor * (2 * gm_log(dx * dx + dy * dy) + 2 * gm_log(sx * sx + sy * sy) +
                              gm_log(4 * (x1 * x1 + y1 * y1)) + gm_log(4 * (x2 * x2 + y2 * y2)));
    }
}

static bool formula(const struct gm_problem *problem, struct gm_formula *graph, gm_node_id *node)
{
    char text[160];
    const int count = (int)((problem->n - 2 * problem->passive) / 2);
    snprintf(text, sizeof text,
             "-%.17g*sum(i = 1 .. %d, j = i+1 .. %d, log((x[i] - x[j])^2 + (y[i] - y[j])^2))",
             strength(problem) * strength(problem) / (4 * M_PI), count, count);
    return gm_hamiltonian_read(problem, text, graph, node);
}

static bool reduced_formula(const struct gm_problem *problem, struct gm_formula *graph, gm_node_id *node)
{
    char text[256];
    snprintf(text, sizeof text,
             "-%.17g*(2*log((x[1] - x[2])^2 + (y[1] - y[2])^2) + 2*log((x[1] + x[2])^2 + (y[1] + y[2])^2)"
             " + log(4*(x[1]^2 + y[1]^2)) + log(4*(x[2]^2 + y[2]^2)))",
             strength(problem) * strength(problem) / (4 * M_PI));
    return gm_hamiltonian_read(problem, text, graph, node);
}

static const struct gm_hamiltonian full = {.energy = energy, .weight = inverse_strength, .formula = formula};
static const struct gm_hamiltonian of_many = {
    .energy = energy_of_many, .weight = inverse_strength, .formula = formula};
static const struct gm_hamiltonian within_a_tolerance = {.energy = energy_of_many,
                                                         .weight = inverse_strength};
static const struct gm_hamiltonian halved = {
    .energy = reduced_energy, .weight = inverse_of_two, .formula = reduced_formula};

#define VORTICES(numbers, its_hamiltonian, its_loops)                                                        \
    {                                                                                                        \
        .name = "vortices", .kind = &gm_kind_ode, .n = (numbers), .m = 1, .facets = &(const struct gm_ode)   \
        {                                                                                                    \
            .components = "x[] y[]", .hamiltonian = &(its_hamiltonian), .loops = GM_LOOPS(its_loops)         \
        }                                                                                                    \
    }

const struct gm_problem gm_problem_vortices = VORTICES(8, of_many, vortices);
const struct gm_problem gm_problem_vortices_multipole = VORTICES(8, within_a_tolerance, vortices_multipole);
const struct gm_problem gm_problem_vortices_four = VORTICES(8, full, vortices_four);
const struct gm_problem gm_problem_vortices_reduced = VORTICES(4, halved, vortices_reduced);
const struct gm_problem gm_problem_vortices_reduced_carrying = VORTICES(4, halved, vortices_reduced_carrying);
