/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_TESTS_COMMON_DISPERSIVE_SOLITONS_H
#define GM_TESTS_COMMON_DISPERSIVE_SOLITONS_H

#include <math.h>

#include "core/field/problems/problems.h"
#include "tests/common/kdv_solutions.h"

/* One soliton of Korteweg-de Vries and one of nonlinear Schroedinger, with velocity 1 from x = -5, on a ring
   of length 40. */

static const struct kdv_solution soliton = {
    .initial = KDV_SOLITON, .kdv.eta = 1, .kdv.mu = 1, .velocity = 1, .position = -5};

/* psi = sqrt(2) a sech(a (x - x0 - c t)) exp i[c (x - x0)/2 + (a^2 - c^2/4) t] on the ring, where its phase follows
   it, and the sum of this and of its mirror image at t = 0. */
struct bright {
    double amplitude, velocity, position;
    bool collides;
};
static const struct bright bright = {.amplitude = 1, .velocity = 1, .position = -5};

static inline void bright_add(double a, double c, double x0, const struct gm_grid1 *grid, double x, double t,
                              double psi[2])
{
    const double period = grid->dx * (double)grid->points;
    double away = x - x0 - c * t;
    away -= period * floor(away / period + 0.5);
    const double size = sqrt(2) * a / cosh(a * away), phase = c * away / 2 + (a * a + c * c / 4) * t;
    psi[0] += size * cos(phase);
    psi[1] += size * sin(phase);
}

/* The state of the nonlinear Schroedinger equation at time t. */
static inline void bright_state(const struct bright *one, const struct gm_grid1 *grid, double t, double *y)
{
    for (size_t i = 0; i < grid->points; i++) {
        double psi[2] = {0};
        bright_add(one->amplitude, one->velocity, one->position, grid, gm_grid1_node(grid, i), t, psi);
        if (one->collides) {
            bright_add(one->amplitude, -one->velocity, -one->position, grid, gm_grid1_node(grid, i), t, psi);
        }
        y[i] = psi[0];
        y[grid->points + i] = psi[1];
    }
}

/* dx sum |A psi|^2 */
static inline double nls_charge(const struct gm_problem *problem, const double *y)
{
    const size_t points = problem->line.points;
    double sum = 0;
    for (size_t i = 0; i < points; i++) {
        const size_t right = (i + 1) % points;
        const double re = (y[i] + y[right]) / 2, im = (y[points + i] + y[points + right]) / 2;
        sum += re * re + im * im;
    }
    return problem->line.dx * sum;
}

static inline struct gm_problem kdv_problem(size_t points)
{
    struct gm_problem problem = gm_problem_kdv;
    problem.parameters = &soliton;
    problem.line = (struct gm_grid1){points, 40.0 / (double)points, -20, 0, false};
    problem.n = gm_wave_size(points);
    return problem;
}

static inline struct gm_problem nls_problem(size_t points)
{
    struct gm_problem problem = gm_problem_nls;
    problem.line = (struct gm_grid1){points, 40.0 / (double)points, -20, 0, false};
    problem.n = 2 * points;
    return problem;
}

#endif
