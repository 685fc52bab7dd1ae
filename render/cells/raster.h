/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_CELLS_RASTER_H
#define GM_RENDER_CELLS_RASTER_H

#include "render/layout/layout.h"
#include "render/layout/theme.h"

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

/* One mark of a panel, texts excepted; `outline` says that it is a line around the filled polygon before it,
   and counts as a part of that. False when memory is short. */
bool gm_raster_mark(struct gm_raster *raster, const struct gm_frame *frame, const struct gm_mark *mark,
                    bool outline);

/* A straight line in surface units that belongs to the axes: every `gap`-th sub-pixel. */
void gm_raster_rule(struct gm_raster *raster, double x0, double y0, double x1, double y1, enum gm_role role,
                    int gap);

/* The colour map from bottom to top. */
void gm_raster_bar(struct gm_raster *raster, const struct gm_box *box, enum gm_map map);

#endif
