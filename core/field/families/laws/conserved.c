/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Energy and momentum of u_tt - u_xx + V'(u) = 0 on a grid, and fields as schemes represent them. */
#include "core/field/families/laws/laws.h"

#include <complex.h>
#include <math.h>
#include <stdlib.h>

#include "core/field/families/two_step.h"
#include "core/linear/curve.h"

/* Adds a term to a sum and keeps what rounding would lose (Neumaier 1974): invariants are looked at to the
   last digit. */
struct exact_sum {
    double sum, lost;
};

static void add(struct exact_sum *total, double term)
{
    const double sum = total->sum + term;
    total->lost += fabs(total->sum) >= fabs(term) ? (total->sum - sum) + term : (term - sum) + total->sum;
    total->sum = sum;
}

double gm_wave_energy(const struct gm_problem *problem, const double *y)
{
    const struct gm_grid1 *grid = &problem->line;
    const double *u = y, *o = y + grid->points, gap = y[2 * grid->points];
    struct exact_sum total = {0};
    for (size_t i = 0; i < grid->points; i++) {
        const double rate = (u[i] - o[i]) / gap;
        const double slope = (gm_grid1_value(grid, u, i, 1) - u[i]) * (gm_grid1_value(grid, o, i, 1) - o[i]) /
                             (grid->dx * grid->dx);
        add(&total, (rate * rate + slope) / 2 + (gm_field_of(problem)->wave->potential(problem, u[i]) +
                                                 gm_field_of(problem)->wave->potential(problem, o[i])) /
                                                    2);
    }
    return grid->dx * (total.sum + total.lost);
}

double gm_wave_cell_energy(const struct gm_problem *problem, const double *y)
{
    const struct gm_grid1 *grid = &problem->line;
    const double *u = y, *o = y + grid->points, gap = y[2 * grid->points];
    double sum = 0;
    for (size_t i = 0; i < grid->points; i++) {
        const double u_next = gm_grid1_value(grid, u, i, 1), o_next = gm_grid1_value(grid, o, i, 1);
        const double rate = (u[i] + u_next - o[i] - o_next) / (2 * gap);
        const double slope = (u_next - u[i] + o_next - o[i]) / (2 * grid->dx);
        sum += (rate * rate + slope * slope) / 2 +
               gm_field_of(problem)->wave->potential(problem, (u[i] + u_next + o[i] + o_next) / 4);
    }
    return grid->dx * sum;
}

double gm_wave_own_energy(const struct gm_problem *problem, const struct gm_scheme *scheme, const double *y,
                          const double *memory)
{
    if (scheme->family->wave_energy) {
        return memory ? scheme->family->wave_energy(problem, scheme, y, memory) : NAN;
    }
    return scheme->in_cells ? gm_wave_cell_energy(problem, y) : gm_wave_energy(problem, y);
}

double gm_wave_momentum(const struct gm_problem *problem, const double *y)
{
    const struct gm_grid1 *grid = &problem->line;
    const double *u = y, *o = y + grid->points, gap = y[2 * grid->points];
    double sum = 0;
    for (size_t i = 0; i < grid->points; i++) {
        /* gap is the other time minus the current one */
        sum += (o[i] - u[i]) / gap *
               (gm_grid1_value(grid, u, i, 1) - gm_grid1_value(grid, u, i, -1) +
                gm_grid1_value(grid, o, i, 1) - gm_grid1_value(grid, o, i, -1)) /
               4;
    }
    return -sum;
}

double gm_wave_longest_step(const struct gm_problem *problem, const struct gm_scheme *scheme, const double *y)
{
    const struct gm_step_limit *limit = scheme->limit;
    const struct gm_grid1 *grid = &problem->line;
    double most = 0;
    for (size_t i = 0; limit && i < grid->points; i++) {
        most = fmax(most, gm_field_of(problem)->wave->curvature(problem, y[i]));
    }
    if (!limit) {
        return NAN;
    }
    /* beyond the step with the largest V'' the highest mode grows, whichever sign V'' has here */
    const double sum = limit->stiffness / (grid->dx * grid->dx) + (limit->helped ? -most : most);
    return sum > 0 ? sqrt(limit->square / sum) : NAN;
}

bool gm_field_profile(const struct gm_problem *problem, const struct gm_scheme *scheme, const double *u,
                      double *values)
{
    const struct gm_grid1 *grid = &problem->line;
    const size_t points = grid->points;
    double *slopes = values + points;
    for (size_t i = 0; i < points; i++) {
        const double right = u[i + 1 < points ? i + 1 : 0];
        values[i] = scheme->in_cells ? (u[i] + right) / 2 : u[i];
        slopes[i] = (right - u[i]) / grid->dx;
    }
    if (!scheme->in_modes) {
        return true;
    }
    const double unit = 2 * M_PI / (grid->dx * (double)points);
    double complex *along = malloc(points * sizeof *along);
    for (size_t i = 0; along && i < points; i++) {
        along[i] = u[i];
    }
    const bool made = along && gm_curve_differentiate(along, points);
    for (size_t i = 0; made && i < points; i++) {
        slopes[i] = unit * creal(along[i]);
    }
    free(along);
    return made;
}
