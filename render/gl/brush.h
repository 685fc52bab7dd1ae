/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_GL_BRUSH_H
#define GM_RENDER_GL_BRUSH_H

#include "render/gl/batch.h"
#include "render/gl/strokes.h"

/* The pen that makes a batch of what it draws, with memory that is used again for every frame. */
struct gm_brush {
    const struct gm_gl *gl;
    struct gm_batch batch;
    struct gm_glyphs *glyphs; /* of the page */
    GLuint *images;           /* textures for the images of a frame, used again in the next */
    size_t image_count, images_used;
    float *texels;
    size_t texel_capacity;
    struct gm_polyline dash;
};

/* Its self is a gm_brush. */
extern const struct gm_pen gm_brush_pen;

#endif
