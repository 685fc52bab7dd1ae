/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_MESH_NODES_H
#define GM_CORE_MESH_NODES_H

#include "core/linear/banded.h"
#include "core/mesh/element.h"

/* Linear and small non-linear systems on the nodes, and rows assembled from elements. Node k = 1 ... N has
   row k - 1; the ends are fixed and have none. */

/* Adds a 4 x 4 block of one element, rows of `row` and columns of `column` (0 to per_node - 1) for y and
   X. */
struct gm_places {
    size_t y, x; /* offset among the unknowns, or the equations, of a node */
};
void gm_nodes_add(struct gm_banded *matrix, size_t points, size_t per_node, size_t element,
                  struct gm_places row, struct gm_places column, double factor, double block[4][4]);
/* Adds column: d(all four rows) / d(element's share of a multiplier), which is + at node e and - at node e +
   1. */
void gm_nodes_add_column(struct gm_banded *matrix, size_t points, size_t per_node, size_t element,
                         struct gm_places row, size_t column, double factor, const double values[4]);
/* Adds the derivative, `values` by z, of an element quantity to the constraint rows: + at node e, - at e +
   1. */
void gm_nodes_add_row(struct gm_banded *matrix, size_t points, size_t per_node, size_t element, size_t row,
                      struct gm_places column, double factor, const double values[4]);

/* g_k = ell_k - ell_{k-1} */
static inline double gm_jump(const double *elements, size_t k)
{
    return elements[k] - elements[k - 1];
}

/* Moves the nodes' places, in stage->x, until the constraint holds, by Newton's method with backtracking. The
   field at the nodes is given in stage->y where profile is NULL; otherwise it is the profile's value at the
   node, and stage->u and stage->v receive the profile's slope and rate there (at the ends: 0). Uses `matrix`
   (N, band 1) and `change` (N). False: no such mesh was found nearby. */
bool gm_nodes_equidistribute(struct gm_elements *stage, const struct gm_mesh *mesh, gm_mesh_profile *profile,
                             const void *context, struct gm_banded *matrix, double *change);

/* Then the nodes' velocities, into `motion` (N), with which the constraint goes on to hold. False:
   singular. */
bool gm_nodes_set_in_motion(struct gm_elements *stage, struct gm_banded *matrix, double *motion);

/* The velocity and multiplier with M qdot + Dg^T lambda = p, Dg qdot = 0: `solution` holds p by node (u, V,
   and a third, ignored) and receives (u, V, lambda). `stage` has been evaluated and constrained; matrix N *
   3, band 5. False: singular. */
bool gm_nodes_project(const struct gm_elements *stage, const struct gm_mesh *mesh, struct gm_banded *matrix,
                      double *solution);

#endif
