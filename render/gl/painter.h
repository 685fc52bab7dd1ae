/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_GL_PAINTER_H
#define GM_RENDER_GL_PAINTER_H

#include "render/gl/batch.h"
#include "render/gl/canvas.h"
#include "render/gl/glyphs.h"
#include "render/gl/polyline.h"
#include "render/gl/strokes.h"
#include "render/layout/layout.h"

/* What the files of the canvas share. */
struct gm_canvas {
    int width, height;
    enum gm_theme theme;
    double scale;                    /* pixels for a pixel of a picture 720 high */
    int letters[GM_TEXT_SIZE_COUNT]; /* heights of letters (em) */
    struct gm_context *context;
    struct gm_gl gl;
    struct gm_batch batch;
    struct gm_glyphs *glyphs;
    GLuint framebuffer, colour_buffer, stencil_buffer;
    GLuint atlas, maps;
    int atlas_height; /* of the texture */
    GLuint *images;   /* textures for the images of a frame, used again in the next */
    size_t image_count, images_used;
    float *texels;
    size_t texel_capacity;
    unsigned char *pixels; /* as read back, 4 bytes each */
    struct gm_polyline line, piece, dash;
    char backend[GM_MESSAGE];
};

struct gm_ink gm_canvas_ink(const struct gm_canvas *canvas, enum gm_role role, double alpha);

/* Grid, marks, axes and colour bar of a frame. */
void gm_canvas_frame(struct gm_canvas *canvas, const struct gm_frame *frame);
void gm_canvas_marks(struct gm_canvas *canvas, const struct gm_frame *frame);
void gm_canvas_image(struct gm_canvas *canvas, const struct gm_frame *frame, const struct gm_mark *mark);
void gm_canvas_mesh(struct gm_canvas *canvas, const struct gm_frame *frame, const struct gm_mark *mark);
void gm_canvas_map_bar(struct gm_canvas *canvas, struct gm_box box, enum gm_map map);

/* Every label of the layout, and the texts among the marks. */
void gm_canvas_labels(struct gm_canvas *canvas, const struct gm_layout *layout);
/* The layout's view of the fonts; self is the canvas. */
struct gm_metrics gm_canvas_metrics(struct gm_canvas *canvas);

#endif
