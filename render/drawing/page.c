/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A page: sizes of letters and strokes, and the order of drawing. */
#include "render/drawing/pen.h"

#include <math.h>

/* Letters and strokes scale with the height, on narrow pages with the width. */
static void set_sizes(struct gm_painter *painter)
{
    static const double shares[GM_TEXT_SIZE_COUNT] = {0.036, 0.025, 0.022, 0.021};
    const double smallest = 9.0, screen_dpi = 96.0;
    const struct gm_appearance *look = &painter->look;
    const double larger = look->scale > 0.0 ? look->scale : 1.0;
    const double by_width = look->width / 960.0, by_height = look->height / 720.0;
    painter->density = look->dpi > 0.0 ? look->dpi / screen_dpi : 1.0;
    painter->scale = larger * (by_height < by_width ? by_height : by_width);
    painter->enlarged = fmax(larger, 1.0);
    const int least = (int)(smallest * painter->density * painter->enlarged + 0.5);
    for (int i = 0; i < GM_TEXT_SIZE_COUNT; i++) {
        const int letters = (int)(720.0 * painter->scale * shares[i] + 0.5);
        painter->letters[i] = letters > least ? letters : least;
    }
}

bool gm_page_open(struct gm_painter *painter, const struct gm_pen *pen, void *self,
                  const struct gm_appearance *look, char *message)
{
    *painter = (struct gm_painter){.pen = pen, .self = self, .look = *look};
    set_sizes(painter);
    painter->glyphs = gm_glyphs_open(message, GM_MESSAGE);
    return painter->glyphs != NULL;
}

void gm_page_close(struct gm_painter *painter)
{
    gm_glyphs_close(painter->glyphs);
    gm_polyline_free(&painter->line);
    gm_polyline_free(&painter->piece);
}

bool gm_page_draw(struct gm_painter *painter, struct gm_picture *picture)
{
    const struct gm_metrics metrics = gm_painter_metrics(painter);
    if (painter->look.screen) {
        gm_paint_cells(painter, painter->look.screen);
        return true;
    }
    if (painter->look.title) {
        picture->title = painter->look.title;
    }
    const struct gm_layout *layout = gm_layout_make(picture, &metrics);
    if (!layout) {
        return false;
    }
    for (size_t i = 0; i < layout->frame_count; i++) {
        gm_paint_axes(painter, &layout->frames[i]);
    }
    gm_paint_labels(painter, layout);
    return true;
}
