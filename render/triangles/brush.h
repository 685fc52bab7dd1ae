/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_TRIANGLES_BRUSH_H
#define GM_RENDER_TRIANGLES_BRUSH_H

#include "render/triangles/batch.h"
#include "render/triangles/strokes.h"

/* The pen that makes a batch of what it draws, with memory that is used again for every frame. */
struct gm_brush {
    struct gm_batch batch;
    struct gm_glyphs *glyphs; /* of the page */
    struct gm_polyline dash;
};

void gm_brush_free(struct gm_brush *brush);

/* Its self is a gm_brush. */
extern const struct gm_pen gm_brush_pen;

#endif
