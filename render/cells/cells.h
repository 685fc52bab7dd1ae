/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_CELLS_CELLS_H
#define GM_RENDER_CELLS_CELLS_H

#include "render/cells/grid.h"
#include "render/picture/picture.h"

/* The terminal painter: pictures to character cells. Text is text; marks are half blocks, quadrants, braille
   or ASCII. It knows no terminal: app/ writes the cells to one. */

/* Paints the picture over all cells (at least 1 x 1). Returns false when out of memory. */
bool gm_cells_paint(struct gm_cells *cells, struct gm_picture *picture, enum gm_theme theme,
                    enum gm_blocks blocks);

/* Returns the state's panel under a cell of a painted picture, with the middle of the cell as (x, y) on its
   axes; NULL if the cell shows no state. */
const struct gm_panel *gm_cells_locate(const struct gm_cells *cells, struct gm_picture *picture,
                                       enum gm_blocks blocks, int column, int row, double *x, double *y);

#endif
