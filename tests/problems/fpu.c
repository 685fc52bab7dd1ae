/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The chain of Fermi, Pasta & Ulam with stiff springs; see fpu.kernel.h. */
#include <stdio.h>

#include "core/ode/hamiltonian.h"
#include "core/ode/kernel/loops.h"
#include "tests/problems/problems.h"

GM_LOOPS_DECLARE(fpu)
GM_LOOPS_DECLARE(fpu_1)

enum { MOST = 3 };

static size_t springs_of(const struct gm_problem *problem)
{
    return problem->n / 4;
}

static double frequency(const struct gm_problem *problem, size_t i)
{
    return i < springs_of(problem) ? 0 : *(const double *)problem->parameters;
}

/* The lengths whose fourth powers make the slow potential, of member i: one more than there are springs. */
static void lengths(const double *q, size_t springs, size_t i, size_t m, double d[MOST + 1])
{
    const double *x = q + i, *y = q + springs * m + i;
    d[0] = x[0] - y[0];
    for (size_t k = 1; k < springs; k++) {
        d[k] = x[k * m] - y[k * m] - x[(k - 1) * m] - y[(k - 1) * m];
    }
    d[springs] = x[(springs - 1) * m] + y[(springs - 1) * m];
}

static void slow_force(const struct gm_problem *problem, const double *q, double *force, size_t m)
{
    const size_t springs = springs_of(problem);
    for (size_t i = 0; i < m; i++) {
        double d[MOST + 1];
        lengths(q, springs, i, m, d);
        for (size_t k = 0; k <= springs; k++) {
            d[k] = d[k] * d[k] * d[k];
        }
        for (size_t k = 0; k < springs; k++) {
            const double right = k + 1 < springs ? -d[k + 1] : d[k + 1]; /* the last wall pushes back */
            force[k * m + i] = -(right + d[k]);
            force[(springs + k) * m + i] = d[k] - right;
        }
    }
}

static void energy(const struct gm_problem *problem, const double *y, double *value, size_t m)
{
    const size_t springs = springs_of(problem);
    for (size_t i = 0; i < m; i++) {
        double d[MOST + 1], sum = 0;
        for (size_t c = 0; c < 2 * springs; c++) {
            const double omega = frequency(problem, c), q = omega * y[c * m + i],
                         p = y[(2 * springs + c) * m + i];
            sum += (p * p + q * q) / 2;
        }
        lengths(y, springs, i, m, d);
        for (size_t k = 0; k <= springs; k++) {
            sum += d[k] * d[k] * d[k] * d[k] / 4;
        }
        value[i] = sum;
    }
}

static bool formula(const struct gm_problem *problem, struct gm_formula *graph, gm_node_id *node)
{
    char text[320];
    const int springs = (int)springs_of(problem);
    snprintf(
        text, sizeof text,
        "sum(i = 1 .. %d, p_x[i]^2 + p_y[i]^2 + %.17g*y[i]^2)/2"
        " + ((x[1] - y[1])^4 + sum(i = 2 .. %d, (x[i] - y[i] - x[i-1] - y[i-1])^4) + (x[%d] + y[%d])^4)/4",
        springs, frequency(problem, (size_t)springs) * frequency(problem, (size_t)springs), springs, springs,
        springs);
    return gm_hamiltonian_read(problem, text, graph, node);
}

#define CHAIN(springs, its_loops)                                                                            \
    .name = "fpu", .kind = &gm_kind_ode, .n = 4 * (springs), .m = 1, .facets = &(const struct gm_ode)        \
    {                                                                                                        \
        .components = "x[] y[] p_x[] p_y[]", .stiff = true,                                                  \
        .split = &(const struct gm_split){.nystrom = true},                                                  \
        .hamiltonian = &(const struct gm_hamiltonian){.energy = energy, .formula = formula},                 \
        .fast_linear = &(const struct gm_fast_linear){.frequency = frequency, .slow_force = slow_force},     \
        .loops = GM_LOOPS(its_loops)                                                                         \
    }

const struct gm_problem gm_problem_fpu = {CHAIN(3, fpu)};

const struct gm_problem gm_problem_fpu_1 = {CHAIN(1, fpu_1)};
