/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The chain of Fermi, Pasta & Ulam with three stiff springs; see fpu.kernel.h. */
#include "core/kernel/loops.h"
#include "core/problems/problems.h"

GM_LOOPS_DECLARE(fpu)

enum { SPRINGS = 3 };

static double frequency(const struct gm_problem *problem, size_t i)
{
    return i < SPRINGS ? 0 : *(const double *)problem->parameters;
}

/* The four lengths whose fourth powers make the slow potential, of member i. */
static void lengths(const double *q, size_t i, size_t m, double d[SPRINGS + 1])
{
    const double *x = q + i, *y = q + SPRINGS * m + i;
    d[0] = x[0] - y[0];
    for (size_t k = 1; k < SPRINGS; k++) {
        d[k] = x[k * m] - y[k * m] - x[(k - 1) * m] - y[(k - 1) * m];
    }
    d[SPRINGS] = x[(SPRINGS - 1) * m] + y[(SPRINGS - 1) * m];
}

static void slow_force(const struct gm_problem *problem, const double *q, double *force, size_t m)
{
    (void)problem;
    for (size_t i = 0; i < m; i++) {
        double d[SPRINGS + 1];
        lengths(q, i, m, d);
        for (size_t k = 0; k <= SPRINGS; k++) {
            d[k] = d[k] * d[k] * d[k];
        }
        for (size_t k = 0; k < SPRINGS; k++) {
            const double right = k + 1 < SPRINGS ? -d[k + 1] : d[k + 1]; /* the last wall pushes back */
            force[k * m + i] = -(right + d[k]);
            force[(SPRINGS + k) * m + i] = d[k] - right;
        }
    }
}

static void energy(const struct gm_problem *problem, const double *y, double *value, size_t m)
{
    for (size_t i = 0; i < m; i++) {
        double d[SPRINGS + 1], sum = 0;
        for (size_t c = 0; c < 2 * SPRINGS; c++) {
            const double omega = frequency(problem, c), q = omega * y[c * m + i],
                         p = y[(2 * SPRINGS + c) * m + i];
            sum += (p * p + q * q) / 2;
        }
        lengths(y, i, m, d);
        for (size_t k = 0; k <= SPRINGS; k++) {
            sum += d[k] * d[k] * d[k] * d[k] / 4;
        }
        value[i] = sum;
    }
}

const struct gm_problem gm_problem_fpu = {
    .name = "fpu",
    .n = 4 * SPRINGS,
    .m = 1,
    .ode = &(const struct gm_ode){.stiff = true},
    .split = &(const struct gm_split){.nystrom = true},
    .hamiltonian = &(const struct gm_hamiltonian){.energy = energy},
    .fast_linear = &(const struct gm_fast_linear){.frequency = frequency, .slow_force = slow_force},
    .loops = GM_LOOPS(fpu),
};
