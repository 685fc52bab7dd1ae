/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The discrete multisymplectic laws that core/field/multisymplectic.h states, summed over cells and nodes. */
#include "core/field/multisymplectic.h"

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

bool gm_faces_open(struct gm_faces *faces, const struct gm_form *field, const struct gm_lattice *cells)
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

double gm_lattice_law(const struct gm_form *field, const struct gm_lattice *cells, const struct gm_faces *a,
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
        largest = fabs(residual) > largest || isnan(residual) ? fabs(residual) : largest;
    }
    return largest;
}

double gm_nodes_law(const struct gm_form *field, bool centred, size_t points, double dx, double dt,
                    gm_complete_node *complete, const void *a, const void *b)
{
    const size_t d = field->dimension;
    const double over_t = 1 / (centred ? 2 * dt : dt), over_x = 1 / (centred ? 2 * dx : dx);
    /* both tangents at a node and the next; the flux in space behind a node is that before the next */
    double sides[2][2][3 * GM_LARGEST_FORM] = {{{0}}};
    double largest = 0, before = 0;
    complete(a, points - 1, sides[0][0]);
    complete(b, points - 1, sides[0][1]);
    for (size_t i = 0; i <= points; i++) {
        double(*const left)[3 * GM_LARGEST_FORM] = sides[i % 2];
        double(*const here)[3 * GM_LARGEST_FORM] = sides[(i + 1) % 2];
        complete(a, i < points ? i : 0, here[0]);
        complete(b, i < points ? i : 0, here[1]);
        const double behind = form(d, field->k, centred, left[0] + d, here[0] + d, left[1] + d, here[1] + d);
        if (i > 0) {
            const double earlier = form(d, field->m, centred, left[0], left[0] + d, left[1], left[1] + d);
            const double later =
                form(d, field->m, centred, left[0] + d, left[0] + 2 * d, left[1] + d, left[1] + 2 * d);
            const double residual = fabs(over_t * (later - earlier) + over_x * (behind - before));
            largest = residual > largest || isnan(residual) ? residual : largest;
        }
        before = behind;
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
