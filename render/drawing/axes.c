/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The grid, axes and colour bar of a panel. Rules are upright and sharp: they begin and end on whole
   pixels. */
#include <math.h>

#include "render/drawing/pen.h"

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

void gm_paint_axes(struct gm_painter *painter, const struct gm_axes *axes)
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
