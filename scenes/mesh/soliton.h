/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_MESH_SOLITON_H
#define GM_SCENES_MESH_SOLITON_H

#include "core/mesh/soliton.h"
#include "scenes/frame/lane.h"

/* What scenes/mesh/soliton.c and its pictures, scenes/mesh/soliton_draw.c, share. */

enum gm_soliton_view {
    GM_SOLITON_ALL,
    GM_SOLITON_FIELD,
    GM_SOLITON_MESH,
    GM_SOLITON_ENERGY,
    GM_SOLITON_CONVERGENCE,
};

struct gm_soliton_scene {
    struct gm_timing timing;
    struct gm_soliton own;
    int show; /* enum gm_soliton_view */
};

struct gm_mesh gm_soliton_mesh(const struct gm_view *view);

/* The largest difference from the exact solution at the nodes; NaN where none is known. */
double gm_soliton_error(const struct gm_view *view);

/* The only track holds the places of all nodes, or of every so many of `points`. */
size_t gm_soliton_path_stride(size_t points);

void gm_soliton_draw(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture);

#endif
