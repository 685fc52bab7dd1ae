/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Ablowitz, Kaup, Newell & Segur, Phys. Rev. Lett. 30 (1973) 1262; Drazin & Johnson, Solitons (1989). */
#include "core/problems/sine_gordon.h"

#include <math.h>

/* sinh a / cosh b, where both may overflow */
static double sinh_over_cosh(double a, double b)
{
    const double size = exp(fabs(a) - fabs(b)) * (-expm1(-2 * fabs(a))) / (1 + exp(-2 * fabs(b)));
    return copysign(size, a);
}

double gm_sine_gordon_jump(const struct gm_sine_gordon *solution)
{
    return solution->initial == GM_KINK ? 2 * M_PI : solution->initial == GM_ANTIKINK ? -2 * M_PI : 0;
}

double gm_sine_gordon_exact(const struct gm_sine_gordon *solution, double half_length, double x, double t)
{
    const double c = solution->velocity, w = solution->frequency;
    if (solution->initial == GM_BREATHER) {
        const double g = sqrt((1 - w) * (1 + w));
        return 4 * atan(g * sin(w * t) / (w * cosh(g * x)));
    }
    const double g = 1 / sqrt((1 - c) * (1 + c));
    if (solution->initial == GM_KINK || solution->initial == GM_ANTIKINK) {
        const double jump = gm_sine_gordon_jump(solution);
        const double away = x - solution->position - c * t;
        const double turns = floor((away + half_length) / (2 * half_length));
        return 4 * atan(exp(copysign(g, jump) * (away - 2 * half_length * turns))) + jump * turns;
    }
    if (c == 0) {
        return 4 * atan((t - (solution->initial == GM_COLLISION ? fabs(solution->position) : 0)) / cosh(x));
    }
    const double since = solution->initial == GM_COLLISION ? t - fabs(solution->position / c) : t;
    return 4 * atan(sinh_over_cosh(c * g * since, g * x) / c);
}

void gm_sine_gordon_levels(const struct gm_problem *problem, double t, double gap, double *y)
{
    const struct gm_line *line = &problem->line;
    const double half_length = line->dx * (double)line->points / 2;
    for (size_t i = 0; i < line->points; i++) {
        const double x = line->first + (double)i * line->dx;
        y[i] = gm_sine_gordon_exact(problem->parameters, half_length, x, t);
        y[line->points + i] = gm_sine_gordon_exact(problem->parameters, half_length, x, t + gap);
    }
    y[2 * line->points] = gap;
}

/* As a run leaves it: the other level is the one before. */
static void solution(const struct gm_problem *problem, double t, const double *y0, double *y, size_t m)
{
    (void)m;
    gm_sine_gordon_levels(problem, t, -fabs(y0[2 * problem->line.points]), y);
}

const struct gm_exact gm_sine_gordon_solution = {solution};
