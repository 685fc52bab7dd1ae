/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Assembly from elements to nodes, and the small systems for places, velocities and multipliers on a mesh. */
#include "core/mesh/nodes.h"

#include <math.h>

/* Row or column of entry `entry` of z = (y0, X0, y1, X1), or no such: the ends are fixed. */
static inline bool locate(size_t points, size_t per_node, size_t element, size_t entry,
                          struct gm_places places, size_t *index)
{
    const size_t node = element + entry / 2;
    if (node < 1 || node > points) {
        return false;
    }
    *index = (node - 1) * per_node + (entry % 2 ? places.x : places.y);
    return true;
}

void gm_nodes_add(struct gm_banded *matrix, size_t points, size_t per_node, size_t element,
                  struct gm_places row, struct gm_places column, double factor, double block[4][4])
{
    for (size_t b = 0; b < 4; b++) {
        size_t j;
        if (!locate(points, per_node, element, b, column, &j)) {
            continue;
        }
        for (size_t a = 0; a < 4; a++) {
            size_t i;
            if (locate(points, per_node, element, a, row, &i)) {
                gm_banded_add(matrix, i, j, factor * block[a][b]);
            }
        }
    }
}

void gm_nodes_add_column(struct gm_banded *matrix, size_t points, size_t per_node, size_t element,
                         struct gm_places row, size_t column, double factor, const double values[4])
{
    for (size_t a = 0; a < 4; a++) {
        size_t i;
        if (!locate(points, per_node, element, a, row, &i)) {
            continue;
        }
        if (element >= 1) {
            gm_banded_add(matrix, i, (element - 1) * per_node + column, factor * values[a]);
        }
        if (element < points) {
            gm_banded_add(matrix, i, element * per_node + column, -factor * values[a]);
        }
    }
}

void gm_nodes_add_row(struct gm_banded *matrix, size_t points, size_t per_node, size_t element, size_t row,
                      struct gm_places column, double factor, const double values[4])
{
    for (size_t b = 0; b < 4; b++) {
        size_t j;
        if (!locate(points, per_node, element, b, column, &j)) {
            continue;
        }
        if (element >= 1) {
            gm_banded_add(matrix, (element - 1) * per_node + row, j, factor * values[b]);
        }
        if (element < points) {
            gm_banded_add(matrix, element * per_node + row, j, -factor * values[b]);
        }
    }
}

/* The derivative of the constraint by the nodes' places alone; `slope` is dy/dX at the nodes, NULL: y is
   given. */
static void by_places(const struct gm_elements *stage, const double *slope, struct gm_banded *matrix)
{
    const size_t points = stage->count - 1;
    gm_banded_clear(matrix);
    for (size_t e = 0; e <= points; e++) {
        const double left = (slope ? stage->ell_y0[e] * slope[e] : 0) - stage->ell_d[e];
        const double right = (slope ? stage->ell_y1[e] * slope[e + 1] : 0) + stage->ell_d[e];
        if (e > 0) {
            gm_banded_add(matrix, e - 1, e - 1, left);
        }
        if (e > 0 && e < points) {
            gm_banded_add(matrix, e - 1, e, right);
            gm_banded_add(matrix, e, e - 1, -left);
        }
        if (e < points) {
            gm_banded_add(matrix, e, e, -right);
        }
    }
}

/* The field at the nodes where they are now, if it is a function of the place; true if all widths are
   positive. */
static bool look(struct gm_elements *stage, const struct gm_mesh *mesh, gm_mesh_profile *profile,
                 const void *context)
{
    for (size_t k = 1; profile && k <= mesh->points; k++) {
        profile(context, stage->x[k], &stage->y[k], &stage->u[k], &stage->v[k]);
    }
    return gm_elements_measure(stage, mesh);
}

bool gm_nodes_equidistribute(struct gm_elements *stage, const struct gm_mesh *mesh, gm_mesh_profile *profile,
                             const void *context, struct gm_banded *matrix, double *change)
{
    enum { MOST = 50, HALVINGS = 20 };
    const size_t points = mesh->points;
    const double enough = 4e-15 * mesh->length;
    if (!look(stage, mesh, profile, context)) {
        return false;
    }
    double before = INFINITY;
    for (int iteration = 0; iteration < MOST; iteration++) {
        by_places(stage, profile ? stage->u : NULL, matrix);
        for (size_t k = 1; k <= points; k++) {
            change[k - 1] = gm_jump(stage->ell, k);
        }
        if (!gm_banded_factor(matrix)) {
            return false;
        }
        gm_banded_solve(matrix, change);
        double largest = 0, sum = 0;
        for (size_t i = 0; i < points; i++) {
            largest = fmax(largest, fabs(change[i]));
            sum += change[i];
        }
        if (!isfinite(sum)) {
            return false;
        }
        double share = 1, moved = 0;
        for (int halving = 0;; halving++) {
            for (size_t k = 1; k <= points; k++) {
                stage->x[k] -= (share - moved) * change[k - 1];
            }
            moved = share;
            if (look(stage, mesh, profile, context)) {
                break;
            }
            if (halving == HALVINGS) {
                return false;
            }
            share /= 2;
        }
        /* the last digits of the widths, not of the method, end the iteration where cells are many */
        if (share == 1 && (largest < enough || (largest > before / 2 && largest < 1e-10 * mesh->length))) {
            return true;
        }
        before = largest;
    }
    return false;
}

bool gm_nodes_set_in_motion(struct gm_elements *stage, struct gm_banded *matrix, double *motion)
{
    const size_t points = stage->count - 1;
    by_places(stage, stage->u, matrix);
    for (size_t k = 1; k <= points; k++) {
        const double *rate = stage->v;
        motion[k - 1] = stage->ell_y0[k - 1] * rate[k - 1] + stage->ell_y1[k - 1] * rate[k] -
                        stage->ell_y0[k] * rate[k] - stage->ell_y1[k] * rate[k + 1];
    }
    if (!gm_banded_factor(matrix)) {
        return false;
    }
    gm_banded_solve(matrix, motion);
    return true;
}

bool gm_nodes_project(const struct gm_elements *stage, const struct gm_mesh *mesh, struct gm_banded *matrix,
                      double *solution)
{
    const size_t points = mesh->points, count = points + 1;
    const struct gm_places velocity = {0, 1};
    gm_banded_clear(matrix);
    for (size_t e = 0; e < count; e++) {
        const double d = stage->width[e], r = stage->rise[e], g = stage->slope[e];
        double mass[4][4];
        for (size_t i = 0; i < 2; i++) {
            for (size_t j = 0; j < 2; j++) {
                const double share = i == j ? 1. / 3 : 1. / 6;
                mass[2 * i][2 * j] = d * share;
                mass[2 * i][2 * j + 1] = mass[2 * i + 1][2 * j] = -r * share;
                mass[2 * i + 1][2 * j + 1] = r * g * share;
            }
        }
        const double gradient[4] = {stage->ell_y0[e], -stage->ell_d[e], stage->ell_y1[e], stage->ell_d[e]};
        gm_nodes_add(matrix, points, 3, e, velocity, velocity, 1, mass);
        gm_nodes_add_row(matrix, points, 3, e, 2, velocity, 1, gradient);
        gm_nodes_add_column(matrix, points, 3, e, velocity, 2, 1, gradient);
    }
    for (size_t i = 0; i < points; i++) {
        solution[3 * i + 2] = 0;
    }
    if (!gm_banded_factor(matrix)) {
        return false;
    }
    gm_banded_solve(matrix, solution);
    return true;
}
