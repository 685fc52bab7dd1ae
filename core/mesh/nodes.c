/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Assembly from elements to nodes, and the small systems for places, velocities and multipliers on a mesh. */
#include "core/mesh/nodes.h"

#include <math.h>

/* The rows or columns of z = (y0, X0, y1, X1) that there are, and how many: the ends are fixed and have
   none. */
static inline size_t locate(const struct gm_assembly *assembly, struct gm_places places, size_t entries[4],
                            size_t indices[4])
{
    const size_t node = assembly->element, before = (node - 1) * assembly->per_node;
    size_t count = 0;
    for (size_t side = node == 0; side <= (node < assembly->points); side++) {
        const size_t first = before + side * assembly->per_node;
        if (places.y != GM_NOWHERE) {
            entries[count] = 2 * side;
            indices[count++] = first + places.y;
        }
        if (places.x != GM_NOWHERE) {
            entries[count] = 2 * side + 1;
            indices[count++] = first + places.x;
        }
    }
    return count;
}

void gm_nodes_add(const struct gm_assembly *assembly, struct gm_places row, struct gm_places column,
                  double block[4][4])
{
    size_t a[4], i[4], b[4], j[4];
    const size_t rows = locate(assembly, row, a, i), columns = locate(assembly, column, b, j);
    for (size_t c = 0; c < columns; c++) {
        for (size_t r = 0; r < rows; r++) {
            gm_banded_add(assembly->matrix, i[r], j[c], block[a[r]][b[c]]);
        }
    }
}

void gm_nodes_add_column(const struct gm_assembly *assembly, struct gm_places row, size_t column,
                         double factor, const double values[4])
{
    double block[4][4];
    for (size_t a = 0; a < 4; a++) {
        block[a][1] = factor * values[a];
        block[a][3] = -factor * values[a];
    }
    gm_nodes_add(assembly, row, (struct gm_places){GM_NOWHERE, column}, block);
}

void gm_nodes_add_row(const struct gm_assembly *assembly, size_t row, struct gm_places column,
                      const double values[4])
{
    double block[4][4];
    for (size_t b = 0; b < 4; b++) {
        block[1][b] = values[b];
        block[3][b] = -values[b];
    }
    gm_nodes_add(assembly, (struct gm_places){GM_NOWHERE, row}, column, block);
}

void gm_nodes_spread(const double *unknowns, size_t points, size_t per_node, size_t unknown, double *share)
{
    double left = 0;
    for (size_t e = 0; e < points; e++) {
        const double right = unknowns[e * per_node + unknown];
        share[e] = left - right;
        left = right;
    }
    share[points] = left;
}

/* The derivative of the constraint by the nodes' places alone; `slope` is dy/dX at the nodes, NULL: y is
   given. */
static void by_places(const struct gm_elements *stage, const double *slope, struct gm_banded *matrix)
{
    const size_t points = stage->count - 1;
    gm_banded_clear(matrix);
    for (size_t e = 0; e <= points; e++) {
        const double left = (slope ? stage->gradient[0][e] * slope[e] : 0) + stage->gradient[1][e];
        const double right = (slope ? stage->gradient[2][e] * slope[e + 1] : 0) + stage->gradient[3][e];
        const struct gm_assembly assembly = {matrix, points, 1, e};
        gm_nodes_add_row(&assembly, 0, (struct gm_places){GM_NOWHERE, 0}, (double[]){0, left, 0, right});
    }
}

/* The field at the nodes in their current places, if it is a function of the place; true if all widths are
   positive. */
static bool look(struct gm_elements *stage, const struct gm_mesh *mesh, gm_mesh_profile *profile,
                 const void *context)
{
    if (profile) {
        profile(context, stage->x + 1, mesh->points, stage->y + 1, stage->u + 1, stage->v + 1);
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
        const double *rate = stage->v, *left = stage->gradient[0], *right = stage->gradient[2];
        motion[k - 1] =
            left[k - 1] * rate[k - 1] + right[k - 1] * rate[k] - left[k] * rate[k] - right[k] * rate[k + 1];
    }
    if (!gm_banded_factor(matrix)) {
        return false;
    }
    gm_banded_solve(matrix, motion);
    return true;
}
