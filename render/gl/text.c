/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The labels of a layout, painted. */
#include <math.h>
#include <string.h>

#include "render/gl/painter.h"

/* The font of a label, and what the layout measures it with: titles are bold, and the clock, in letters of
   equal width, is as large as the title. */
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
    const int roomy = 540;
    struct gm_metrics metrics = {
        .width = painter->width,
        .height = painter->height,
        .measure = measure,
        .self = painter,
        .scale = painter->scale,
        .terse = painter->height < roomy,
    };
    for (int i = 0; i < GM_TEXT_SIZE_COUNT; i++) {
        metrics.line[i] = line_height(painter, painter->letters[i]);
    }
    return metrics;
}

struct writing {
    enum gm_font font;
    int letters;
    double x, y; /* of the baseline's start */
    bool upwards;
    struct gm_ink ink;
};

static void put_letter(struct gm_batch *batch, const struct writing *writing, double x, double y,
                       const struct gm_letter *letter)
{
    struct gm_vertex *strip = gm_batch_strip(batch, 4);
    if (strip == NULL) {
        return;
    }
    for (int i = 0; i < 4; i++) {
        const int u = i % 2 == 0 ? 0 : letter->width, v = i < 2 ? 0 : letter->height;
        const double along = letter->x + u, down = letter->y + v;
        strip[i] = (struct gm_vertex){
            .x = (float)(writing->upwards ? x + down : x + along),
            .y = (float)(writing->upwards ? y - along : y + down),
            .across = (float)(letter->atlas_x + u),
            .along = (float)(letter->atlas_y + v),
        };
        memcpy(strip[i].colour, writing->ink.colour, sizeof strip[i].colour);
    }
    gm_batch_end(batch, 0);
}

static void write_text(struct gm_painter *painter, const struct writing *writing, const char *text)
{
    /* Baselines stand on whole pixels; letters find their place along them to a quarter. */
    const double x = writing->upwards ? floor(writing->x + 0.5) : floor(writing->x);
    const double y = writing->upwards ? ceil(writing->y) : floor(writing->y + 0.5);
    double pen = writing->upwards ? y - writing->y : writing->x - x;
    struct gm_letter letter;
    while (gm_glyphs_next(painter->glyphs, writing->font, writing->letters, &text, &pen, &letter)) {
        if (letter.width > 0) {
            put_letter(&painter->batch, writing, x, y, &letter);
        }
    }
}

static void draw_label(struct gm_painter *painter, const struct gm_label *label)
{
    struct writing writing = {.font = label->mono   ? GM_FONT_MONO
                                      : label->bold ? GM_FONT_BOLD
                                                    : GM_FONT_SANS,
                              .letters = painter->letters[label->size],
                              .upwards = label->vertical,
                              .ink = gm_ink_of(painter->theme, label->role, 1.0)};
    const double width = gm_glyphs_width(painter->glyphs, writing.font, writing.letters, label->text);
    const double ascent = gm_glyphs_ascent(painter->glyphs, GM_FONT_SANS, writing.letters);
    if (label->vertical) {
        writing.x = label->x + ascent;
        writing.y = label->y + 0.5 * width;
    } else {
        writing.x = label->x - gm_anchor_share(label->anchor) * width;
        writing.y = label->y + ascent;
    }
    write_text(painter, &writing, label->text);
}

/* A plate of translucent paper, so that a text among the marks can be read on anything. */
static void draw_plate(struct gm_painter *painter, const struct gm_label *label)
{
    const int letters = painter->letters[label->size];
    const double width = gm_glyphs_width(painter->glyphs, GM_FONT_SANS, letters, label->text);
    const double line = line_height(painter, letters);
    const float half = (float)(0.5 * line), middle = (float)(label->y + 0.5 * line);
    const float left = (float)label->x + 0.25f * half, right = (float)(label->x + width) - 0.25f * half;
    struct gm_point ends[2] = {{left, middle}, {fmaxf(left + 1.0f, right), middle}};
    const struct gm_polyline axis = {.points = ends, .count = 2};
    gm_stroke_line(&painter->batch, &axis, half, gm_ink_of(painter->theme, GM_PAPER, 0.6));
}

void gm_paint_labels(struct gm_painter *painter, const struct gm_layout *layout)
{
    gm_batch_scissor(&painter->batch, 0, 0, painter->width, painter->height);
    gm_batch_state(&painter->batch, GM_PROGRAM_INK, GM_STENCIL_NONE);
    for (size_t i = 0; i < layout->label_count; i++) {
        if (layout->labels[i].among_marks) {
            draw_plate(painter, &layout->labels[i]);
        }
    }
    gm_batch_state(&painter->batch, GM_PROGRAM_TEXT, GM_STENCIL_NONE);
    for (size_t i = 0; i < layout->label_count; i++) {
        draw_label(painter, &layout->labels[i]);
    }
}
