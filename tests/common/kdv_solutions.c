/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Solitons of Korteweg and de Vries' equation. R. Hirota, Phys. Rev. Lett. 27 (1971) 1192; N.J. Zabusky & M.D.
   Kruskal, Phys. Rev. Lett. 15 (1965) 240. */
#include "tests/common/kdv_solutions.h"

#include <math.h>

/* The distance from a place on the ring. */
static double around(const struct gm_grid1 *grid, double distance)
{
    const double period = grid->dx * (double)grid->points;
    return distance - period * floor(distance / period + 0.5);
}

/* The k of the two solitons, whose heights are 3 mu k^2 / eta and velocities mu k^2, and their places at
   the start. */
static const double fast = 1.2, slow = 0.8, fast_start = -30, slow_start = -15;

/* (ln F)_xx with F = 1 + e^a + e^b + A e^(a + b), everything divided by the largest exponential; a is fast
   times the way from the faster soliton before they meet, b likewise from the slower one after it. */
static double two_solitons(double a, double b, double log_a)
{
    const double exponents[4] = {0, a, b, a + b + log_a}, rates[4] = {0, fast, slow, fast + slow};
    double largest = 0, sum = 0, first = 0, second = 0;
    for (int i = 0; i < 4; i++) {
        largest = fmax(largest, exponents[i]);
    }
    for (int i = 0; i < 4; i++) {
        const double e = exp(exponents[i] - largest);
        sum += e;
        first += rates[i] * e;
        second += rates[i] * rates[i] * e;
    }
    return second / sum - first / sum * (first / sum);
}

/* On the covering line of the ring the faster soliton meets one image of the slower one after another. A
   meeting moves it forwards by shift / fast and the other one back by shift / slow, so that the m-th is
   the first one with other starts. What counts is the nearest meeting; its own images, a period apart, are
   added. */
static double two_solitons_around(const struct kdv_solution *solution, const struct gm_grid1 *grid, double x,
                                  double t)
{
    const double period = grid->dx * (double)grid->points;
    const double shift = 2 * log((fast + slow) / (fast - slow));
    const double overtakes = solution->kdv.mu * (fast * fast - slow * slow) * t;
    const double first = slow_start + shift / (2 * slow) - (fast_start + shift / (2 * fast));
    const double between = period - shift / fast - shift / slow;
    const double passed = between > 0 ? floor((overtakes - first) / between + 0.5) : 0;
    const double fast_at = fast_start + passed * shift / fast + solution->kdv.mu * fast * fast * t;
    const double slow_at = slow_start + passed * (period - shift / slow) + solution->kdv.mu * slow * slow * t;
    const double middle = (fast_at + slow_at) / 2, place = middle + around(grid, x - middle);
    double sum = 0;
    for (int image = -1; image <= 1; image++) {
        const double there = place + image * period;
        sum += two_solitons(fast * (there - fast_at), slow * (there - slow_at), -shift);
    }
    return sum;
}

/* lambda = 0 */
static double unboosted(const struct kdv_solution *solution, const struct gm_grid1 *grid, double x, double t)
{
    if (solution->initial == KDV_COSINE) {
        return t == 0 ? cos(M_PI * x) : NAN;
    }
    if (solution->initial == KDV_TWO) {
        return 12 * solution->kdv.mu / solution->kdv.eta * two_solitons_around(solution, grid, x, t);
    }
    const double c = solution->velocity, away = around(grid, x - solution->position - c * t);
    const double sech = 1 / cosh(sqrt(c / solution->kdv.mu) / 2 * away);
    return 3 * c / solution->kdv.eta * sech * sech;
}

double kdv_exact(const struct kdv_solution *solution, const struct gm_grid1 *grid, double x, double t)
{
    return unboosted(solution, grid, x - solution->kdv.framed.lambda * t, t) +
           solution->kdv.framed.lambda / solution->kdv.eta;
}

bool kdv_is_known(const struct kdv_solution *solution, const struct gm_grid1 *grid, double t)
{
    const double half = grid->dx * (double)grid->points / 2;
    const double rate = solution->initial == KDV_TWO ? slow : sqrt(solution->velocity / solution->kdv.mu);
    return t == 0 || (solution->initial != KDV_COSINE && 4 * exp(-rate * half) <= 1e-3);
}

void kdv_levels(const struct gm_problem *problem, double dt, double *y)
{
    const struct kdv_solution *solution = problem->parameters;
    const struct gm_grid1 *grid = &problem->line;
    for (size_t i = 0; i < grid->points; i++) {
        const double x = gm_grid1_node(grid, i);
        y[i] = kdv_exact(solution, grid, x, 0);
        if (solution->initial == KDV_COSINE) {
            const double slope = -M_PI * sin(M_PI * x), third = M_PI * M_PI * M_PI * sin(M_PI * x);
            y[grid->points + i] = y[i] - dt * (solution->kdv.eta * y[i] * slope + solution->kdv.mu * third);
        } else {
            y[grid->points + i] = kdv_exact(solution, grid, x, dt);
        }
    }
    y[2 * grid->points] = dt;
}

/* The value of u = 0 in the original frame. */
static double level_of(const struct gm_problem *problem)
{
    return gm_kdv_of(problem)->framed.lambda / gm_kdv_of(problem)->eta;
}

double kdv_mass(const struct gm_problem *problem, const double *y)
{
    const double level = level_of(problem);
    double sum = 0;
    for (size_t i = 0; i < problem->line.points; i++) {
        sum += y[i] - level;
    }
    return problem->line.dx * sum;
}

double kdv_square(const struct gm_problem *problem, const double *profile)
{
    const double level = level_of(problem);
    double sum = 0;
    for (size_t i = 0; i < problem->line.points; i++) {
        sum += (profile[i] - level) * (profile[i] - level);
    }
    return problem->line.dx * sum;
}
