/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_TESTS_COMMON_MESHES_H
#define GM_TESTS_COMMON_MESHES_H

#include "core/flow/boundary.h"
#include "core/form/gmsh.h"

/* Files of tests/reference/meshes. GM_MESHES, that folder, comes from the build. */

/* The whole text of a file, malloc'ed. */
char *mesh_text(const char *name, size_t *size);

/* The mesh of a file that is known to be good. */
struct gm_triangulation mesh_of(const char *name);

/* The sides of its boundary edges, by the names inlet, outlet and lid; malloc'ed. */
unsigned char *sides_of(const struct gm_triangulation *mesh);

/* Sets a boundary with one side per kind of edge: inlets have this speed, lids move with it; theta is held
   at 0 on walls and lids and at `theta` in inlets. */
enum gm_boundary_fault set_boundary(struct gm_flow *flow, const unsigned char *kinds, double speed,
                                    enum gm_vertex_kind outlet, double theta);

#endif
