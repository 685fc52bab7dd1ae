/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/field/families/laws/profile.h"

#include <complex.h>
#include <math.h>
#include <stdlib.h>

#include "core/linear/curve.h"

/* False: out of memory. */
static bool differentiate(const struct gm_grid1 *grid, const double *u, double *slopes)
{
    const size_t points = grid->points;
    const double unit = 2 * M_PI / (grid->dx * (double)points);
    double complex *along = malloc(points * sizeof *along);
    for (size_t i = 0; along && i < points; i++) {
        along[i] = u[i];
    }
    const bool good = along && gm_curve_differentiate(along, points);
    for (size_t i = 0; good && i < points; i++) {
        slopes[i] = unit * creal(along[i]);
    }
    free(along);
    return good;
}

double *gm_field_profile(const struct gm_problem *problem, const struct gm_scheme *scheme, const double *u)
{
    const struct gm_grid1 *grid = &problem->line;
    const size_t points = grid->points;
    double *values = malloc(2 * points * sizeof *values);
    for (size_t i = 0; values && i < points; i++) {
        const double right = u[i + 1 < points ? i + 1 : 0];
        values[i] = scheme->in_cells ? (u[i] + right) / 2 : u[i];
        values[points + i] = (right - u[i]) / grid->dx;
    }
    if (values && scheme->in_modes && !differentiate(grid, u, values + points)) {
        free(values);
        return NULL;
    }
    return values;
}
