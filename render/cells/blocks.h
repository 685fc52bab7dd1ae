/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sub-pixels as characters. */
#ifndef GM_RENDER_CELLS_BLOCKS_H
#define GM_RENDER_CELLS_BLOCKS_H

#include "render/cells/grid.h"
#include "render/cells/raster.h"

/* How many sub-pixels a cell has, and whether they are merely on or off. */
void gm_blocks_grid(enum gm_blocks blocks, int *columns, int *rows, bool *sharp);

/* Turns the raster, which has that many sub-pixels a cell, into glyphs with two colours each. Braille draws
   lines well and areas badly, so it takes these from a second raster, that of GM_QUADRANTS; NULL for other
   blocks. */
void gm_blocks_glyphs(struct gm_cells *cells, const struct gm_raster *raster, const struct gm_raster *areas,
                      enum gm_blocks blocks);

#endif
