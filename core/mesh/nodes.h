/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_MESH_NODES_H
#define GM_CORE_MESH_NODES_H

#include <stdint.h>

#include "core/linear/banded.h"
#include "core/mesh/element.h"

/* Linear and small non-linear systems on the nodes, and rows assembled from elements. Node k = 1 ... N has
   row k - 1; the ends are fixed and have none. */

/* The contribution of one element to a matrix of `per_node` unknowns at every node. */
struct gm_assembly {
    struct gm_banded *matrix;
    size_t points, per_node, element;
};

/* The numbers of a node's unknowns, or equations, of y and of X; GM_NOWHERE: none. */
struct gm_places {
    size_t y, x;
};
#define GM_NOWHERE SIZE_MAX

/* Adds a block with a row and a column for each of z = (y0, X0, y1, X1). */
void gm_nodes_add(const struct gm_assembly *assembly, struct gm_places row, struct gm_places column,
                  double block[4][4]);
/* Adds factor * values, by z, to the column of a multiplier, of which an element has as its share that of
   node e less that of node e + 1. */
void gm_nodes_add_column(const struct gm_assembly *assembly, struct gm_places row, size_t column,
                         double factor, const double values[4]);
/* Adds the derivative, `values` by z, of an element quantity to the constraint rows: + at node e, - at e +
   1. */
void gm_nodes_add_row(const struct gm_assembly *assembly, size_t row, struct gm_places column,
                      const double values[4]);

/* The share of every element in one of the unknowns of a node, numbered from 0: the unknown of node e less
   the one of e + 1, with 0 at both ends. */
void gm_nodes_spread(const double *unknowns, size_t points, size_t per_node, size_t unknown, double *share);

/* g_k = ell_k - ell_{k-1} */
static inline double gm_jump(const double *elements, size_t k)
{
    return elements[k] - elements[k - 1];
}

/* Moves the nodes' places, in stage->x, until the constraint holds, by Newton's method with backtracking.
   The field at the nodes is given in stage->y if profile is NULL; otherwise it is the profile's value at
   the node, and stage->u and stage->v receive the profile's slope and rate there (at the ends: 0). Uses
   `matrix` (N, band 1) and `change` (N). Returns false if no such mesh was found nearby. */
bool gm_nodes_equidistribute(struct gm_elements *stage, const struct gm_mesh *mesh, gm_mesh_profile *profile,
                             const void *context, struct gm_banded *matrix, double *change);

/* Computes the nodes' velocities, motion[N], that preserve the constraint. Returns false if singular. */
bool gm_nodes_set_in_motion(struct gm_elements *stage, struct gm_banded *matrix, double *motion);

#endif
