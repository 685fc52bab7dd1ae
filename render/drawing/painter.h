/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_DRAWING_PAINTER_H
#define GM_RENDER_DRAWING_PAINTER_H

#include "render/drawing/pen.h"
#include "render/layout/appearance.h"
#include "render/layout/layout.h"

/* What draws a layout with a pen, alike for all pens: the sizes of letters and strokes, the look, and memory
   that is used again for every frame. Each of its functions has a file of its own. */
struct gm_painter {
    const struct gm_pen *pen;
    void *self; /* of the pen */
    struct gm_appearance look;
    double scale;                    /* pixels for a pixel of a picture 720 high */
    double density;                  /* pixels for one of a screen, which is 1/96 inch */
    double enlarged;                 /* how many times letters are larger than usual; at least 1 */
    int letters[GM_TEXT_SIZE_COUNT]; /* heights of letters (em) */
    struct gm_glyphs *glyphs;
    struct gm_polyline line, piece;
};

/* marks.c: everything of a panel's data but its texts. */
void gm_paint_marks(struct gm_painter *painter, const struct gm_axes *axes);

/* frame.c: grid, marks, axes and colour bar. */
void gm_paint_axes(struct gm_painter *painter, const struct gm_axes *axes);

/* text.c: every label of the layout, those among the marks on plates of paper; and the layout's view of the
   fonts, whose self is the painter. */
void gm_paint_labels(struct gm_painter *painter, const struct gm_layout *layout);
struct gm_metrics gm_painter_metrics(const struct gm_painter *painter);

#endif
