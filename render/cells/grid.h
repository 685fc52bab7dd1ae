/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_CELLS_GRID_H
#define GM_RENDER_CELLS_GRID_H

#include "render/layout/theme.h"

/* The cells of a terminal, as plain data, and what marks may be made of in them. */

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

#endif
