/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Drawing the labels of a layout. */
#include <math.h>

#include "render/drawing/pen.h"

/* Returns the width of a label in its font: titles are bold, and the clock, in letters of equal width, is as
   large as the title. */
static double measure(const void *self, enum gm_text_size size, const char *text)
{
    const struct gm_painter *painter = self;
    const int height = painter->letters[size];
    switch (size) {
    case GM_TEXT_TITLE:
        return fmax(gm_glyphs_width(painter->glyphs, GM_FONT_BOLD, height, text),
                    gm_glyphs_width(painter->glyphs, GM_FONT_MONO, height, text));
    case GM_TEXT_PANEL:
        return gm_glyphs_width(painter->glyphs, GM_FONT_BOLD, height, text);
    default:
        return gm_glyphs_width(painter->glyphs, GM_FONT_SANS, height, text);
    }
}

static double line_height(const struct gm_painter *painter, int letters)
{
    return ceil(gm_glyphs_ascent(painter->glyphs, GM_FONT_SANS, letters) +
                gm_glyphs_descent(painter->glyphs, GM_FONT_SANS, letters));
}

struct gm_metrics gm_painter_metrics(const struct gm_painter *painter)
{
    const double roomy = 540.0;
    struct gm_metrics metrics = {
        .width = painter->look.width,
        .height = painter->look.height,
        .measure = measure,
        .self = painter,
        .scale = painter->scale,
        .terse = painter->look.height < roomy * painter->density * painter->enlarged,
    };
    for (int i = 0; i < GM_TEXT_SIZE_COUNT; i++) {
        metrics.line[i] = line_height(painter, painter->letters[i]);
    }
    return metrics;
}

static void draw_label(struct gm_painter *painter, const struct gm_label *label)
{
    struct gm_writing writing = {.font = label->mono   ? GM_FONT_MONO
                                         : label->bold ? GM_FONT_BOLD
                                                       : GM_FONT_SANS,
                                 .letters = painter->letters[label->size],
                                 .anchor = label->vertical ? GM_ANCHOR_CENTRE : label->anchor,
                                 .upwards = label->vertical,
                                 .ink = {gm_theme_colour(painter->look.theme, label->role), 1.0}};
    writing.width = gm_glyphs_width(painter->glyphs, writing.font, writing.letters, label->text);
    const double ascent = gm_glyphs_ascent(painter->glyphs, GM_FONT_SANS, writing.letters);
    if (label->vertical) {
        writing.x = label->x + ascent;
        writing.y = label->y + 0.5 * writing.width;
    } else {
        writing.x = label->x - gm_anchor_share(label->anchor) * writing.width;
        writing.y = label->y + ascent;
    }
    painter->pen->text(painter->self, &writing, label->text);
}

/* Draws translucent paper, so that a text among the marks is legible on anything. */
static void draw_plate(struct gm_painter *painter, const struct gm_label *label)
{
    const int letters = painter->letters[label->size];
    const double width = gm_glyphs_width(painter->glyphs, GM_FONT_SANS, letters, label->text);
    const double line = line_height(painter, letters);
    const float half = (float)(0.5 * line), middle = (float)(label->y + 0.5 * line);
    const struct gm_stroke plate = {.width = (float)line,
                                    .ink = {gm_theme_colour(painter->look.theme, GM_PAPER), 0.6}};
    const float left = (float)label->x + 0.4f * half, right = (float)(label->x + width) - 0.4f * half;
    struct gm_point ends[2] = {{left, middle}, {fmaxf(left + 1.0f, right), middle}};
    const struct gm_polyline axis = {.points = ends, .count = 2};
    painter->pen->line(painter->self, &axis, &plate);
}

void gm_paint_labels(struct gm_painter *painter, const struct gm_layout *layout)
{
    painter->pen->clip(painter->self, 0, 0, painter->look.width, painter->look.height);
    for (size_t i = 0; i < layout->label_count; i++) {
        if (layout->labels[i].among_marks) {
            draw_plate(painter, &layout->labels[i]);
        }
    }
    for (size_t i = 0; i < layout->label_count; i++) {
        draw_label(painter, &layout->labels[i]);
    }
}
