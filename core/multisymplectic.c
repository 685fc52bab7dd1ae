/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/multisymplectic.h"

#include <math.h>
#include <stdlib.h>

/* a0' G b1 - b0' G a1 with the upper triangle of a skew matrix or the whole of it for G. With the triangle
   and both at one place this is a' matrix b. */
static double form(size_t d, const double *matrix, bool whole, const double *a0, const double *a1,
                   const double *b0, const double *b1)
{
    double sum = 0;
    for (size_t i = 0; i < d; i++) {
        for (size_t k = whole ? 0 : i + 1; k < d; k++) {
            const double entry = matrix[i * d + k];
            if (entry != 0) {
                sum += entry * (a0[i] * b1[k] - b0[i] * a1[k]);
            }
        }
    }
    return sum;
}

static double form_at(size_t d, const double *matrix, const double *a, const double *b)
{
    return form(d, matrix, false, a, a, b, b);
}

bool gm_faces_open(struct gm_faces *faces, const struct gm_field *field, const struct gm_cells *cells)
{
    const size_t face = cells->points * cells->r * field->dimension;
    const size_t sides = (cells->points + 1) * cells->s * field->dimension;
    faces->lower = calloc(2 * face + sides + cells->points, sizeof(double));
    faces->upper = faces->lower + face;
    faces->sides = faces->upper + face;
    faces->scratch = faces->sides + sides;
    return faces->lower != NULL;
}

void gm_faces_close(struct gm_faces *faces)
{
    free(faces->lower);
}

double gm_cells_law(const struct gm_field *field, const struct gm_cells *cells, const struct gm_faces *a,
                    const struct gm_faces *b)
{
    const size_t d = field->dimension;
    double largest = 0;
    for (size_t i = 0; i < cells->points; i++) {
        double residual = 0;
        for (size_t m = 0; m < cells->r; m++) {
            const size_t at = (i * cells->r + m) * d;
            residual += cells->space[m] / cells->dt *
                        (form_at(d, field->m, a->upper + at, b->upper + at) -
                         form_at(d, field->m, a->lower + at, b->lower + at));
        }
        for (size_t j = 0; j < cells->s; j++) {
            const size_t left = (i * cells->s + j) * d, right = left + cells->s * d;
            residual += cells->time[j] / cells->dx *
                        (form_at(d, field->k, a->sides + right, b->sides + right) -
                         form_at(d, field->k, a->sides + left, b->sides + left));
        }
        largest = residual == residual ? fmax(largest, fabs(residual)) : NAN;
    }
    return largest;
}

double gm_nodes_law(const struct gm_field *field, bool centred, size_t points, double dx, double dt,
                    const double *const a[3], const double *const b[3])
{
    const size_t d = field->dimension;
    const double over_t = 1 / (centred ? 2 * dt : dt), over_x = 1 / (centred ? 2 * dx : dx);
    double largest = 0;
    for (size_t i = 0; i < points; i++) {
        const size_t here = i * d, right = (i + 1 < points ? i + 1 : 0) * d,
                     left = (i ? i - 1 : points - 1) * d;
        const double earlier = form(d, field->m, centred, a[0] + here, a[1] + here, b[0] + here, b[1] + here);
        const double later = form(d, field->m, centred, a[1] + here, a[2] + here, b[1] + here, b[2] + here);
        const double before = form(d, field->k, centred, a[1] + left, a[1] + here, b[1] + left, b[1] + here);
        const double behind =
            form(d, field->k, centred, a[1] + here, a[1] + right, b[1] + here, b[1] + right);
        largest = fmax(largest, fabs(over_t * (later - earlier) + over_x * (behind - before)));
    }
    return largest;
}

double gm_form_residual(const struct gm_problem *problem, const struct gm_scheme *scheme, double dt,
                        const double *y, const double *memory)
{
    return scheme->family->form ? scheme->family->form(problem, scheme, dt, y, memory, false) : NAN;
}

double gm_form_defect(const struct gm_problem *problem, const struct gm_scheme *scheme, double dt,
                      const double *y, const double *memory)
{
    return scheme->family->form ? scheme->family->form(problem, scheme, dt, y, memory, true) : NAN;
}

void gm_tangent_start(double *tangent, size_t points, double waves, double phase)
{
    for (size_t i = 0; i < points; i++) {
        tangent[i] = cos(2 * M_PI * waves * (double)i / (double)points + phase);
    }
}
