/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Breathers, kinks and their meetings, exact on the line; on a ring their images are added. M.J. Ablowitz,
   D.J. Kaup, A.C. Newell & H. Segur, Phys. Rev. Lett. 30 (1973) 1262; P.G. Drazin & R.S. Johnson, Solitons
   (1989). */
#include "tests/common/sine_gordon.h"

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

/* When the two meet at x = 0. */
static double met_at(const struct gm_sine_gordon *solution)
{
    const double x0 = fabs(solution->position), c = fabs(solution->velocity);
    return solution->initial != GM_KINK_COLLISION ? 0 : c == 0 ? x0 : x0 / c;
}

/* The solution of one meeting, at x = 0 and t = 0, on the line. */
static double pair(double c, double x, double t)
{
    const double g = 1 / sqrt((1 - c) * (1 + c));
    return 4 * atan(c == 0 ? t / cosh(x) : sinh_over_cosh(c * g * t, g * x) / c);
}

/* Two that part meet again on the other side of the ring, 2 pi higher, and so on in turn. A meeting moves
   both forwards by -ln c / g on either side. What counts is the nearest meeting; its images, a period apart,
   are added. */
static double pair_around(const struct gm_sine_gordon *solution, double half_length, double x, double t)
{
    const double c = fabs(solution->velocity), since = t - met_at(solution);
    const double way = half_length + 2 * log(c) * sqrt((1 - c) * (1 + c)); /* from a meeting to the next */
    const double m = c > 0 && way > 0 ? floor(since * c / way + 0.5) : 0;
    const double place = x - m * half_length, period = 2 * half_length;
    const double near = place - period * floor(place / period + 0.5);
    double sum = 2 * M_PI * m;
    for (int image = -1; image <= 1; image++) {
        sum += pair(c, near + image * period, m == 0 ? since : since - m * way / c);
    }
    return sum;
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
    return pair_around(solution, half_length, x, t);
}

bool gm_sine_gordon_is_known(const struct gm_sine_gordon *solution, double half_length, double t)
{
    const double c = fabs(solution->velocity), w = solution->frequency;
    const double g = solution->initial == GM_BREATHER ? sqrt((1 - w) * (1 + w)) : 1 / sqrt((1 - c) * (1 + c));
    if (solution->initial != GM_KINK_ANTIKINK && solution->initial != GM_KINK_COLLISION) {
        return t == 0 || 4 * exp(-g * half_length) <= 1e-3;
    }
    /* the images' pull goes with exp(-g half_length) and is compared with what moves the kinks */
    const double since = fabs(t - met_at(solution));
    const double ratio = c == 0 ? since : sinh(fmin(c * g * since, 700)) / c;
    const bool far_from_images = acosh(fmax(ratio, 1)) <= g * half_length / 2 - 4;
    return t == 0 || far_from_images || exp(-g * half_length) <= 1e-4 * c * c;
}

void gm_sine_gordon_levels(const struct gm_problem *problem, double t, double gap, double *y)
{
    const struct gm_grid1 *grid = &problem->line;
    const double half_length = grid->dx * (double)grid->points / 2;
    for (size_t i = 0; i < grid->points; i++) {
        const double x = grid->first + (double)i * grid->dx;
        y[i] = gm_sine_gordon_exact(problem->parameters, half_length, x, t);
        y[grid->points + i] = gm_sine_gordon_exact(problem->parameters, half_length, x, t + gap);
    }
    y[2 * grid->points] = gap;
}
