/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_CELLS_COVER_H
#define GM_RENDER_CELLS_COVER_H

#include "render/cells/raster.h"

/* What the files of the raster share with one another, and with nobody else. */

/* fmin and fmax are calls, because of what they do with NaN; no NaN comes here. */
static inline double gm_smaller(double a, double b)
{
    return a < b ? a : b;
}
static inline double gm_larger(double a, double b)
{
    return a > b ? a : b;
}

/* Towards zero, and within the bounds; NaN is the lower one. */
static inline int gm_clamp(double value, int low, int high)
{
    if (!(value > low)) {
        return low;
    }
    return value < high ? (int)value : high;
}

/* A place on the raster, in sub-pixels. */
struct gm_raster_place {
    double x, y;
};
/* Where a point (x, y) of the panel lies. */
struct gm_raster_place gm_raster_place(const struct gm_raster *raster, const struct gm_frame *frame,
                                       const double *point);
/* Whether it is finite. */
bool gm_raster_is_place(struct gm_raster_place place);

/* Marks a sub-pixel in the mask as covered by at least so much (0 to 1), if it is within the clip box. */
void gm_raster_cover(struct gm_raster *raster, int x, int y, double coverage);
/* Lays the mask over the raster in one colour, so that a mark that meets itself is not counted twice, and
   empties it. */
void gm_raster_settle(struct gm_raster *raster, struct gm_rgb colour, double alpha, enum gm_level level,
                      enum gm_role role);

/* Lines, points and polygons go to the mask, fields to the raster itself. */
void gm_raster_line(struct gm_raster *raster, const struct gm_frame *frame, const struct gm_mark *mark);
void gm_raster_points(struct gm_raster *raster, const struct gm_frame *frame, const struct gm_mark *mark);
/* False when memory is short. */
bool gm_raster_polygon(struct gm_raster *raster, const struct gm_frame *frame, const struct gm_mark *mark);
void gm_raster_mesh(struct gm_raster *raster, const struct gm_frame *frame, const struct gm_mark *mark);
void gm_raster_image(struct gm_raster *raster, const struct gm_frame *frame, const struct gm_mark *mark);

#endif
