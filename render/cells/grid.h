/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_CELLS_GRID_H
#define GM_RENDER_CELLS_GRID_H

#include "render/layout/appearance.h"
#include "render/layout/panel.h"

/* The cells of a terminal, as plain data, and the glyphs of marks. */

enum gm_blocks { GM_BRAILLE, GM_QUADRANTS, GM_HALF_BLOCKS, GM_ASCII, GM_BLOCKS_COUNT };

struct gm_cell {
    uint32_t glyph; /* Unicode; ' ' in an empty cell, 0 under a picture of pixels */
    struct gm_rgb foreground, background;
    enum gm_role role; /* the meaning of the foreground, for terminals without true colour */
    bool bold;
};

struct gm_cells {
    int columns, rows;
    struct gm_cell *cells; /* row by row */
    bool outlines;         /* too few colours for shades: braille draws only the outlines of areas */
};

/* The raster beneath the character cells, a few sub-pixels per cell. A sub-pixel stores its colour, level and
   role, because a glyph has only two colours: what matters most in a cell decides them. */

enum gm_level {
    GM_LEVEL_PAPER,
    GM_LEVEL_GRID,
    GM_LEVEL_LINE, /* a line or a point on paper */
    GM_LEVEL_FIELD,
    GM_LEVEL_FILL,
    GM_LEVEL_OVER, /* a line or a point on a field or a fill */
    GM_LEVEL_COUNT,
};

struct gm_subpixel {
    struct gm_rgb colour;
    uint8_t level;
    uint8_t role;
};

struct gm_raster {
    int width, height;     /* size in sub-pixels */
    double unit_x, unit_y; /* surface units per sub-pixel */
    double scale;          /* surface units per pixel of a picture 720 high */
    bool sharp;            /* a sub-pixel is on or off (braille, ASCII), otherwise edges are smoothed */
    enum gm_theme theme;
    struct gm_subpixel *at;
    uint8_t *mask; /* the coverage of the mark at work; 0 everywhere between marks */
    int left, top, right,
        bottom; /* the part of the mask that may be non-zero; right and bottom are exclusive */
    int clip_left, clip_top, clip_right, clip_bottom;
};

/* Makes the paper of a raster that has its size, units, scale and theme. Returns false when out of memory. */
bool gm_raster_open(struct gm_raster *raster);
void gm_raster_close(struct gm_raster *raster);

/* The glyphs of sets of quarters; bits: upper left, upper right, lower left, lower right. */
extern const uint16_t gm_quadrants[16];

/* Marks on the raster. */

/* Draws one mark of a panel, texts excepted. An `outline` is a line around the filled polygon before it, and
   counts as a part of that. Returns false when out of memory. */
bool gm_marks_draw(struct gm_raster *raster, const struct gm_axes *axes, const struct gm_mark *mark,
                   bool outline);

/* Draws a straight line of the axes, in surface units: every `gap`-th sub-pixel. */
void gm_marks_rule(struct gm_raster *raster, const double from_to[4], enum gm_role role, int gap);

/* Draws the colour map from bottom to top. */
void gm_marks_bar(struct gm_raster *raster, const struct gm_box *box, enum gm_colour_map map);

/* The terminal painter: pictures to character cells. Text is text; marks are half blocks, quadrants, braille
   or ASCII. It knows no terminal: app/ writes the cells to one. */

/* Paints the picture over all cells (at least 1 x 1). Returns false when out of memory. */
bool gm_cells_paint(struct gm_cells *cells, struct gm_picture *picture, enum gm_theme theme,
                    enum gm_blocks blocks);

/* Returns the spot in the middle of a cell of a painted picture. */
struct gm_spot gm_cells_locate(const struct gm_cells *cells, struct gm_picture *picture,
                               enum gm_blocks blocks, int column, int row);

#endif
