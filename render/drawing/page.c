/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A page: its grids, axes and colour bars, whose rules begin and end on whole pixels, its labels, the sizes of letters
   and strokes, and the order of drawing. */
#include "render/drawing/pen.h"

#include <math.h>

/* ---- grid, axes and colour bar ---- */

static double hairline(const struct gm_painter *painter)
{
    return floor(fmax(fmax(1.0, 0.5 * painter->density), painter->scale) + 0.5);
}

static void horizontal_rule(struct gm_painter *painter, double left, double right, double y,
                            struct gm_ink ink)
{
    const double thickness = hairline(painter), top = floor(y - 0.5 * thickness + 0.5);
    painter->pen->box(painter->self, (float)floor(left + 0.5), (float)top, (float)floor(right + 0.5),
                      (float)(top + thickness), ink);
}

static void vertical_rule(struct gm_painter *painter, double x, double top, double bottom, struct gm_ink ink)
{
    const double thickness = hairline(painter), left = floor(x - 0.5 * thickness + 0.5);
    painter->pen->box(painter->self, (float)left, (float)floor(top + 0.5), (float)(left + thickness),
                      (float)floor(bottom + 0.5), ink);
}

static void draw_grid(struct gm_painter *painter, const struct gm_axes *axes)
{
    const struct gm_box box = axes->box;
    const struct gm_ink ink = {gm_theme_colour(painter->look.theme, GM_GRID), 1.0};
    for (size_t i = 0; i < axes->x_tick_count; i++) {
        vertical_rule(painter, axes->x_ticks[i].position, box.y, box.y + box.height, ink);
    }
    for (size_t i = 0; i < axes->y_tick_count; i++) {
        horizontal_rule(painter, box.x, box.x + box.width, axes->y_ticks[i].position, ink);
    }
}

static void draw_axes(struct gm_painter *painter, const struct gm_axes *axes)
{
    const struct gm_box box = axes->box;
    const struct gm_ink ink = {gm_theme_colour(painter->look.theme, GM_SECONDARY), 1.0};
    const double tick = 4.0 * painter->scale, right = box.x + box.width, bottom = box.y + box.height;
    const double half = 0.5 * hairline(painter);
    vertical_rule(painter, box.x, box.y, bottom + half, ink);
    horizontal_rule(painter, box.x - half, right, bottom, ink);
    for (size_t i = 0; i < axes->x_tick_count; i++) {
        vertical_rule(painter, axes->x_ticks[i].position, bottom, bottom + tick, ink);
    }
    for (size_t i = 0; i < axes->y_tick_count; i++) {
        horizontal_rule(painter, box.x - tick, box.x, axes->y_ticks[i].position, ink);
    }
}

/* Draws tips at the ends of the bar beyond which there are values, in the colours of the ends. */
static void draw_tips(struct gm_painter *painter, const struct gm_axes *axes, enum gm_colour_map map)
{
    const struct gm_box bar = axes->colour_bar;
    for (int end = 0; end < 2; end++) {
        const double base = end == 0 ? bar.y + bar.height : bar.y;
        const double tip = end == 0 ? base + axes->bar_tip[0] : base - axes->bar_tip[1];
        const struct gm_rgb colour = gm_colour_map_at(map, painter->look.theme, end);
        struct gm_point corners[3] = {{(float)bar.x, (float)base},
                                      {(float)(bar.x + bar.width), (float)base},
                                      {(float)(bar.x + 0.5 * bar.width), (float)tip}};
        const struct gm_polyline line = {.points = corners, .count = 3, .closed = true};
        if (axes->bar_tip[end] > 0.0) {
            painter->pen->fill(painter->self, &line, (struct gm_ink){colour, 1.0});
        }
    }
}

static void draw_colour_bar(struct gm_painter *painter, const struct gm_axes *axes)
{
    const struct gm_box bar = axes->colour_bar;
    const struct gm_ink ink = {gm_theme_colour(painter->look.theme, GM_SECONDARY), 1.0};
    const double tick = 4.0 * painter->scale, right = bar.x + bar.width;
    const struct gm_mark *field = gm_panel_field(axes->panel);
    if (field) {
        painter->pen->ramp(painter->self, bar, field->map);
        draw_tips(painter, axes, field->map);
    }
    for (size_t i = 0; i < axes->bar_tick_count; i++) {
        horizontal_rule(painter, right, right + tick, axes->bar_ticks[i].position, ink);
    }
}

/* Draws grid, marks, axes and colour bar. */
static void paint_axes(struct gm_painter *painter, const struct gm_axes *axes)
{
    const struct gm_box box = axes->box;
    if (!(box.width >= 1.0 && box.height >= 1.0)) {
        return;
    }
    painter->pen->clip(painter->self, 0, 0, painter->look.width, painter->look.height);
    if (axes->panel->axes) {
        draw_grid(painter, axes);
        draw_axes(painter, axes);
    }
    gm_paint_marks(painter, axes);
    painter->pen->clip(painter->self, 0, 0, painter->look.width, painter->look.height);
    if (axes->colour_bar.width > 0.0) {
        draw_colour_bar(painter, axes);
    }
}

/* ---- labels ---- */

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

/* Draws every label of the layout, labels among the marks on plates of paper. */
static void paint_labels(struct gm_painter *painter, const struct gm_layout *layout)
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

/* ---- the page ---- */

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
        paint_axes(painter, &layout->frames[i]);
    }
    paint_labels(painter, layout);
    return true;
}
