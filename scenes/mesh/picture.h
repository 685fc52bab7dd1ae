/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_MESH_PICTURE_H
#define GM_SCENES_MESH_PICTURE_H

#include "scenes/common/lane.h"

/* The pictures of fields on moving meshes: the field with its nodes over the exact solution, the paths of the nodes,
   the energy; or the error over the number of nodes. */

enum gm_mesh_view {
    GM_MESH_ALL,
    GM_MESH_FIELD,
    GM_MESH_PATHS,
    GM_MESH_ENERGY,
    GM_MESH_CONVERGENCE,
    GM_MESH_ENERGY_ORDER,
    GM_MESH_INERTIA,
};

/* The names of enum gm_mesh_view, NULL-terminated, and of those that nodes alone have. */
extern const char *const gm_mesh_views[], *const gm_node_views[];

/* The differences between scenes; the picture has the title. The first track of such a scene holds the paths
   (scenes/mesh/observed.h). */
struct gm_mesh_look {
    enum gm_mesh_view show;
    const char *front, *name; /* the beginning of the subtitle; the name of the field */
    enum gm_scale scale;
    double low, high; /* the range of the field */
};

void gm_mesh_draw(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture,
                  const struct gm_mesh_look *look);

#endif
