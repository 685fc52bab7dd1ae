/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_FLOW_MARKS_H
#define GM_SCENES_FLOW_MARKS_H

#include "scenes/flow/flows.h"
#include "scenes/flow/sheet.h"

/* Parts of the pictures of flows. `over`: they are drawn on a field of colours. `size`: the longer side of
   the domain. */

/* Returns true if the field that is shown has both signs. */
bool gm_flow_is_signed(int show);

/* Draws level lines of psi: at equal parts of the flow that passes through, and at the same distance in
   closed eddies. */
void gm_flow_draw_streamlines(struct gm_picture *picture, struct gm_panel *panel, const struct gm_lane *lane,
                              const struct gm_flow_sheet *sheet, const struct gm_look *look);
/* Draws the walls, bold; openings are left open. */
void gm_flow_draw_walls(struct gm_picture *picture, struct gm_panel *panel, const struct gm_flow *flow);
/* Draws the edges of the mesh. */
void gm_flow_draw_grid(struct gm_picture *picture, struct gm_panel *panel, const struct gm_complex *complex,
                       bool over);
/* Draws tracers: a dot each, and a tail to its position a short time ago. */
void gm_flow_draw_tracers(struct gm_picture *picture, struct gm_panel *panel, const struct gm_lane *lane,
                          bool over, double size);
/* Draws arrows of velocity on an even grid; one of `speed` is as long as their distance. */
void gm_flow_draw_arrows(struct gm_picture *picture, struct gm_panel *panel, const struct gm_lane *lane,
                         bool over, double speed);
/* Writes the names of openings, or "inlet" and "outlet", outside the walls. */
void gm_flow_name_openings(struct gm_picture *picture, struct gm_panel *panel, const struct gm_flow *flow,
                           const char *const *names, double size);

/* Sets `outward` to the way out through an opening, with its length; returns the boundary edge behind it. */
size_t gm_flow_opening_outward(const struct gm_flow *flow, const struct gm_opening *opening,
                               double outward[2]);

#endif
