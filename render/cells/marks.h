/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_CELLS_MARKS_H
#define GM_RENDER_CELLS_MARKS_H

#include "render/cells/raster.h"

/* What is drawn on the raster. */

/* One mark of a panel, texts excepted; `outline` says that it is a line around the filled polygon before it,
   and counts as a part of that. False when memory is short. */
bool gm_marks_draw(struct gm_raster *raster, const struct gm_axes *axes, const struct gm_mark *mark,
                   bool outline);

/* A straight line in surface units that belongs to the axes: every `gap`-th sub-pixel. */
void gm_marks_rule(struct gm_raster *raster, const double from_to[4], enum gm_role role, int gap);

/* The colour map from bottom to top. */
void gm_marks_bar(struct gm_raster *raster, const struct gm_box *box, enum gm_colour_map map);

#endif
