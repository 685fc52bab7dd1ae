/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_FLOW_MARKS_H
#define GM_SCENES_FLOW_MARKS_H

#include "scenes/flow/flows.h"
#include "scenes/flow/sheet.h"

/* Parts of the pictures of flows. `over`: what is drawn lies over a field of colours. `size`: the longer side
   of the domain. */

/* Whether what is shown has colours of both signs. */
bool gm_flow_is_signed(int show);

/* Level lines of psi: equal parts of the flow that passes through; the same distance in what turns on its
   own. */
void gm_flow_draw_streamlines(struct gm_picture *picture, struct gm_panel *panel, const struct gm_lane *lane,
                              const struct gm_flow_sheet *sheet, const struct gm_look *look);
/* Walls, bold; openings are left open. */
void gm_flow_draw_walls(struct gm_picture *picture, struct gm_panel *panel, const struct gm_flow *flow);
/* The edges of the mesh. */
void gm_flow_draw_grid(struct gm_picture *picture, struct gm_panel *panel, const struct gm_complex *complex,
                       bool over);
/* Tracers: a dot each, and a tail where it was a short time ago. */
void gm_flow_draw_tracers(struct gm_picture *picture, struct gm_panel *panel, const struct gm_lane *lane,
                          bool over, double size);
/* Arrows of velocity; one of `speed` is as long as their distance. */
void gm_flow_draw_arrows(struct gm_picture *picture, struct gm_panel *panel, const struct gm_lane *lane,
                         bool over, double speed);
/* The names of openings, or "inlet" and "outlet", outside the walls. */
void gm_flow_name_openings(struct gm_picture *picture, struct gm_panel *panel, const struct gm_flow *flow,
                           const char *const *names, double size);

/* The way out through an opening, as long as it; returns the boundary edge behind it. */
size_t gm_flow_opening_outward(const struct gm_flow *flow, const struct gm_opening *opening,
                               double outward[2]);

#endif
