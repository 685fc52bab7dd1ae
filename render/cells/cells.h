/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_CELLS_CELLS_H
#define GM_RENDER_CELLS_CELLS_H

#include "render/layout/theme.h"

/* The terminal painter: pictures to character cells. Text is text; marks are half blocks, quadrants, braille
   or ASCII. It knows no terminal: app/ writes the cells to one. */

enum gm_blocks { GM_BRAILLE, GM_QUADRANTS, GM_HALF_BLOCKS, GM_ASCII, GM_BLOCKS_COUNT };

struct gm_cell {
    uint32_t glyph; /* Unicode; ' ' for an empty cell, 0 where a picture of pixels is */
    struct gm_rgb foreground, background;
    enum gm_role role; /* what the foreground means, for terminals without true colour */
    bool bold;
};

struct gm_cells {
    int columns, rows;
    struct gm_cell *cells; /* row by row */
    bool outlines; /* there are too few colours for shades: braille draws areas by their outline alone */
};

/* Paints the picture over all cells (at least 1 x 1). False when memory is short. */
bool gm_cells_paint(struct gm_cells *cells, struct gm_picture *picture, enum gm_theme theme,
                    enum gm_blocks blocks);

/* The panel of a state that lies under a cell of a painted picture, as the point (x, y) of its axes in the
   middle of the cell; NULL where there is none. */
const struct gm_panel *gm_cells_locate(const struct gm_cells *cells, struct gm_picture *picture,
                                       enum gm_blocks blocks, int column, int row, double *x, double *y);

#endif
