/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_TRIANGLES_STROKES_H
#define GM_RENDER_TRIANGLES_STROKES_H

#include "render/drawing/pen.h"
#include "render/triangles/batch.h"

/* Polylines and discs as triangles whose edges fade over a pixel. */

struct gm_rgba {
    uint8_t colour[4];
};

/* The ink, `faint` times as opaque. */
struct gm_rgba gm_rgba_of(struct gm_ink ink, double faint);

/* Joints where the line turns gently are mitred, so that its strip covers nothing twice. At the others,
   counted here, it ends and begins again with round ends that overlap. */
size_t gm_stroke_breaks(const struct gm_polyline *line, float half);

/* A line of half width `half` with round joints and ends. */
void gm_stroke_line(struct gm_batch *batch, const struct gm_polyline *line, float half, struct gm_rgba ink);

void gm_stroke_disc(struct gm_batch *batch, struct gm_point centre, float radius, struct gm_rgba ink);

/* An upright rectangle with sharp edges. */
void gm_stroke_box(struct gm_batch *batch, float left, float top, float right, float bottom,
                   struct gm_rgba ink);

/* The inside of a closed line (even-odd). Convex ones fade at the edge by themselves; the others are painted
   through the stencil. */
void gm_fill_polygon(struct gm_batch *batch, const struct gm_polyline *line, struct gm_rgba ink);

#endif
