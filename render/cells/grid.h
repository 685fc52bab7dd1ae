/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_CELLS_GRID_H
#define GM_RENDER_CELLS_GRID_H

#include "render/layout/appearance.h"
#include "render/layout/panel.h"

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

/* The raster beneath the character cells: a few sub-pixels a cell. A sub-pixel keeps its colour and what it
   belongs to, because a glyph has room for two colours only: what matters most in a cell decides them. */

enum gm_level {
    GM_LEVEL_PAPER,
    GM_LEVEL_GRID,
    GM_LEVEL_LINE, /* or a point, on paper */
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
    int width, height;     /* in sub-pixels */
    double unit_x, unit_y; /* surface units a sub-pixel */
    double scale;          /* surface units a pixel of a picture 720 high */
    bool sharp;            /* a sub-pixel is on or off (braille, ASCII), otherwise edges are smoothed */
    enum gm_theme theme;
    struct gm_subpixel *at;
    uint8_t *mask;                /* the coverage of the mark at work; 0 everywhere between marks */
    int left, top, right, bottom; /* where the mask may be non-zero; right and bottom are exclusive */
    int clip_left, clip_top, clip_right, clip_bottom;
};

bool gm_raster_open(struct gm_raster *raster, int width, int height, enum gm_theme theme);
void gm_raster_close(struct gm_raster *raster);

/* Marks stay within this box of the surface. */
void gm_raster_clip(struct gm_raster *raster, const struct gm_box *box);

/* Towards zero, and within the bounds; NaN is the lower one. */
int gm_raster_clamp(double value, int low, int high);

/* A place on the raster, in sub-pixels. */
struct gm_raster_place {
    double x, y;
};
/* Where a point (x, y) of the panel lies. */
struct gm_raster_place gm_raster_place(const struct gm_raster *raster, const struct gm_axes *axes,
                                       const double *point);
/* Whether it is finite. */
bool gm_raster_is_place(struct gm_raster_place place);

/* Marks a sub-pixel in the mask as covered by at least so much (0 to 1), if it is within the clip box. */
void gm_raster_cover(struct gm_raster *raster, int x, int y, double coverage);
/* Lays the mask over the raster in one colour, so that a mark that meets itself is not counted twice, and
   empties it. */
void gm_raster_settle(struct gm_raster *raster, struct gm_rgb colour, double alpha, enum gm_level level,
                      enum gm_role role);

/* Sub-pixels as characters. */

/* How many sub-pixels a cell has, and whether they are merely on or off. */
void gm_blocks_grid(enum gm_blocks blocks, int *columns, int *rows, bool *sharp);

/* Turns the raster, which has that many sub-pixels a cell, into glyphs with two colours each. Braille draws
   lines well and areas badly, so it takes these from a second raster, that of GM_QUADRANTS; NULL for other
   blocks. */
void gm_blocks_glyphs(struct gm_cells *cells, const struct gm_raster *raster, const struct gm_raster *areas,
                      enum gm_blocks blocks);

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
