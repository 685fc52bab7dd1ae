/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_CELLS_CELLS_H
#define GM_RENDER_CELLS_CELLS_H

#include "render/cells/grid.h"
#include "render/picture/picture.h"

/* The terminal painter: pictures to character cells. Text is text; marks are half blocks, quadrants, braille
   or ASCII. It knows no terminal: app/ writes the cells to one. */

/* Paints the picture over all cells (at least 1 x 1). False when memory is short. */
bool gm_cells_paint(struct gm_cells *cells, struct gm_picture *picture, enum gm_theme theme,
                    enum gm_blocks blocks);

/* The panel of a state that lies under a cell of a painted picture, as the point (x, y) of its axes in the
   middle of the cell; NULL where there is none. */
const struct gm_panel *gm_cells_locate(const struct gm_cells *cells, struct gm_picture *picture,
                                       enum gm_blocks blocks, int column, int row, double *x, double *y);

#endif
