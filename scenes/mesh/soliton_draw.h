/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_MESH_SOLITON_DRAW_H
#define GM_SCENES_MESH_SOLITON_DRAW_H

#include "core/mesh/soliton.h"
#include "scenes/frame/lane.h"

/* The pictures of scenes/mesh/soliton.c, and the parameters that they tell of. */

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

/* Observables by their place; and the only track, the places of all nodes or of every so many. */
enum { GM_SOLITON_ERROR };
enum { GM_SOLITON_PATHS };

struct gm_mesh gm_soliton_mesh(const struct gm_view *view);

void gm_soliton_draw(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture);

#endif
