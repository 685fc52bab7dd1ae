/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The plane Kepler problem, H = |p|^2/2 - 1/|q|, and its perturbation by -e/|q|^2. The exact solution is that
   of Lagrange's f and g functions in the difference of the eccentric anomalies (H. Curtis, Orbital Mechanics
   for Engineering Students, sections 2.11, 3.7; R. Battin, An Introduction to the Mathematics and Methods of
   Astrodynamics, section 4.3). */
#include <math.h>
#include <stdio.h>

#include "core/ode/hamiltonian.h"
#include "core/ode/kernel/loops.h"
#include "tests/problems/problems.h"

GM_LOOPS_DECLARE(kepler)
GM_LOOPS_DECLARE(kepler_perturbed)

static double strength(const struct gm_problem *problem)
{
    return problem->parameters ? *(const double *)problem->parameters : 0;
}

static void potential(const struct gm_problem *problem, const double *q, double *value, size_t m)
{
    for (size_t i = 0; i < m; i++) {
        const double square = q[i] * q[i] + q[m + i] * q[m + i];
        value[i] = -1 / sqrt(square) - strength(problem) / square;
    }
}

static void perturbing_force(const struct gm_problem *problem, const double *q, double *force, size_t m)
{
    for (size_t i = 0; i < m; i++) {
        const double square = q[i] * q[i] + q[m + i] * q[m + i];
        const double pull = 2 * strength(problem) / (square * square);
        force[i] = -(pull * q[i]);
        force[m + i] = -(pull * q[m + i]);
    }
}

static void energy(const struct gm_problem *problem, const double *y, double *value, size_t m)
{
    potential(problem, y, value, m);
    for (size_t i = 0; i < m; i++) {
        value[i] += (y[2 * m + i] * y[2 * m + i] + y[3 * m + i] * y[3 * m + i]) / 2;
    }
}

static bool formula(const struct gm_problem *problem, struct gm_formula *graph, gm_node_id *node)
{
    char text[128];
    snprintf(text, sizeof text, "(p1^2 + p2^2)/2 - 1/sqrt(q1^2 + q2^2) - (%.17g)/(q1^2 + q2^2)",
             strength(problem));
    return gm_hamiltonian_read(problem, text, graph, node);
}

/* r^(-3/2), so that a revolution has equally many steps whatever its size */
static void density(const struct gm_problem *problem, const double *y, double *value, double *gradient)
{
    (void)problem;
    const double square = y[0] * y[0] + y[1] * y[1], root = sqrt(square);
    *value = 1 / (root * sqrt(root));
    for (size_t c = 0; c < 4 && gradient; c++) {
        gradient[c] = c < 2 ? -1.5 * *value / square * y[c] : 0;
    }
}

/* The root E of E - c sin E + s (1 - cos E) = anomaly in [-pi, pi]; its left side grows, for c^2 + s^2 <
   1. */
static double solve_kepler(double c, double s, double anomaly)
{
    double low = anomaly - 3, high = anomaly + 3, E = anomaly;
    for (int i = 0; i < 100; i++) {
        const double value = E - c * sin(E) + s * (1 - cos(E)) - anomaly;
        if (value > 0) {
            high = E;
        } else {
            low = E;
        }
        double next = E - value / (1 - c * cos(E) + s * sin(E));
        if (!(next > low && next < high)) {
            next = (low + high) / 2;
        }
        if (next == E || fabs(next - E) < 1e-16) {
            break;
        }
        E = next;
    }
    return E;
}

static void solution(const struct gm_problem *problem, double t, const double *y0, double *y, size_t m)
{
    (void)problem;
    for (size_t i = 0; i < m; i++) {
        const double q1 = y0[i], q2 = y0[m + i], p1 = y0[2 * m + i], p2 = y0[3 * m + i];
        const double r0 = hypot(q1, q2), a = 1 / (2 / r0 - (p1 * p1 + p2 * p2));
        if (!(a > 0)) {
            for (size_t c = 0; c < 4; c++) {
                y[c * m + i] = NAN; /* no ellipse */
            }
            continue;
        }
        const double motion = 1 / (a * sqrt(a)), c = 1 - r0 / a, s = (q1 * p1 + q2 * p2) / sqrt(a);
        const double anomaly = remainder(motion * t, 2 * M_PI);
        const double E = solve_kepler(c, s, anomaly), one_less_cos = 2 * sin(E / 2) * sin(E / 2);
        const double r = a * (1 - c * cos(E) + s * sin(E));
        const double f = 1 - a / r0 * one_less_cos, g = (anomaly - (E - sin(E))) / motion;
        const double df = -(sqrt(a) / (r * r0) * sin(E)), dg = 1 - a / r * one_less_cos;
        y[i] = f * q1 + g * p1;
        y[m + i] = f * q2 + g * p2;
        y[2 * m + i] = df * q1 + dg * p1;
        y[3 * m + i] = df * q2 + dg * p2;
    }
}

#define KEPLER(its_loops)                                                                                    \
    .kind = &gm_kind_ode, .n = 4, .m = 1, .facets = &(const struct gm_ode)                                   \
    {                                                                                                        \
        .components = "q1 q2 p1 p2", .split = &(const struct gm_split){.nystrom = true, .unit_mass = true},  \
        .hamiltonian = &(const struct gm_hamiltonian){.energy = energy, .formula = formula},                 \
        .kepler_split =                                                                                      \
            &(const struct gm_kepler_split){.potential = potential, .perturbing_force = perturbing_force},   \
        .monitor = &(const struct gm_monitor){.density = density, .of_places = true},                        \
        .loops = GM_LOOPS(its_loops)                                                                         \
    }

const struct gm_problem gm_problem_kepler = {
    .name = "kepler",
    KEPLER(kepler),
    .exact = &(const struct gm_exact){.solution = solution},
};

const struct gm_problem gm_problem_kepler_perturbed = {
    .name = "kepler-perturbed",
    KEPLER(kepler_perturbed),
};
