/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_GL_STROKES_H
#define GM_RENDER_GL_STROKES_H

#include "render/gl/batch.h"
#include "render/gl/polyline.h"

/* Polylines and discs as triangles whose edges fade over a pixel. */

struct gm_ink {
    uint8_t colour[4];
};

/* A role's colour, so opaque (0 to 1; clamped). */
struct gm_ink gm_ink_of(enum gm_theme theme, enum gm_role role, double alpha);

/* Joints where the line turns gently are mitred, so that its strip covers nothing twice. At the others,
   counted here, it ends and begins again with round ends that overlap. */
size_t gm_stroke_breaks(const struct gm_polyline *line, float half);

/* A line of half width `half` with round joints and ends. */
void gm_stroke_line(struct gm_batch *batch, const struct gm_polyline *line, float half, struct gm_ink ink);

void gm_stroke_disc(struct gm_batch *batch, struct gm_point centre, float radius, struct gm_ink ink);

/* An upright rectangle with sharp edges. */
void gm_stroke_box(struct gm_batch *batch, float left, float top, float right, float bottom,
                   struct gm_ink ink);

/* The inside of a closed line (even-odd). Convex ones fade at the edge by themselves; the others are painted
   through the stencil. */
void gm_fill_polygon(struct gm_batch *batch, const struct gm_polyline *line, struct gm_ink ink);

#endif
