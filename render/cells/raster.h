/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_CELLS_RASTER_H
#define GM_RENDER_CELLS_RASTER_H

#include "render/layout/surface.h"
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

#endif
