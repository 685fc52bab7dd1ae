/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_GL_PAINTER_H
#define GM_RENDER_GL_PAINTER_H

#include "render/gl/batch.h"
#include "render/gl/glyphs.h"
#include "render/gl/polyline.h"
#include "render/gl/strokes.h"
#include "render/layout/layout.h"

/* What turns a layout into a batch: the sizes of letters and strokes, the look, and memory that is used again
   for every frame. Each of its functions has a file of its own. */
struct gm_painter {
    const struct gm_gl *gl;
    int width, height; /* of the picture, in pixels */
    enum gm_theme theme;
    double scale;                    /* pixels for a pixel of a picture 720 high */
    int letters[GM_TEXT_SIZE_COUNT]; /* heights of letters (em) */
    struct gm_batch batch;
    struct gm_glyphs *glyphs;
    GLuint *images; /* textures for the images of a frame, used again in the next */
    size_t image_count, images_used;
    float *texels;
    size_t texel_capacity;
    struct gm_polyline line, piece, dash;
};

/* fields.c: meshes, images and colour bars. */
void gm_paint_image(struct gm_painter *painter, const struct gm_frame *frame, const struct gm_mark *mark);
void gm_paint_mesh(struct gm_painter *painter, const struct gm_frame *frame, const struct gm_mark *mark);
void gm_paint_colours(struct gm_painter *painter, struct gm_box box, enum gm_map map);

/* marks.c: everything of a panel's data but its texts. */
void gm_paint_marks(struct gm_painter *painter, const struct gm_frame *frame);

/* frame.c: grid, marks, axes and colour bar. */
void gm_paint_frame(struct gm_painter *painter, const struct gm_frame *frame);

/* text.c: every label of the layout, those among the marks on plates of paper; and the layout's view of the
   fonts, whose self is the painter. */
void gm_paint_labels(struct gm_painter *painter, const struct gm_layout *layout);
struct gm_metrics gm_painter_metrics(const struct gm_painter *painter);

#endif
