/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lines, points and polygons in pixels; the pen draws marks with values. */
#include <math.h>

#include "render/drawing/pen.h"

/* A tenth of a pixel is not visible. */
static const float tolerance = 0.1f;

/* Lines are cut this far outside of their panel, in pixels, to hide their ends. */
static const float cut = 16.0f;

/* Lengths drawn and left out, in widths of the line. */
static const struct {
    size_t parts;
    float lengths[GM_DASH_PARTS];
} dashes[GM_DASH_COUNT] = {
    [GM_SOLID] = {0, {0}},
    [GM_LONG_DASH] = {2, {6.0f, 3.5f}},
    [GM_DOTS] = {2, {0.0f, 2.4f}},
    [GM_DASH_DOT] = {4, {5.0f, 2.6f, 0.0f, 2.6f}},
    [GM_SHORT_DASH] = {2, {1.8f, 2.8f}},
    [GM_DASH_DOT_DOT] = {6, {4.0f, 2.5f, 0.0f, 2.5f, 0.0f, 2.5f}},
};

/* Clips marks to a box and half a mark's width, so that strokes along the edge stay whole. */
static void clip_to(struct gm_painter *painter, const struct gm_box *box, double margin)
{
    const int left = (int)floor(box->x - margin), top = (int)floor(box->y - margin);
    painter->pen->clip(painter->self, left, top, (int)ceil(box->x + box->width + margin) - left,
                       (int)ceil(box->y + box->height + margin) - top);
}

/* Maps the mark's points to the surface. Returns false when out of memory. */
static bool project(struct gm_painter *painter, const struct gm_axes *axes, const struct gm_mark *mark)
{
    struct gm_polyline *line = &painter->line;
    if (!gm_polyline_reserve(line, mark->count)) {
        return false;
    }
    const bool linear = axes->panel->x.scale != GM_LOG && axes->panel->y.scale != GM_LOG;
    const double far = 1e7; /* floats still resolve pixels here */
    for (size_t i = 0; i < mark->count; i++) {
        const double *p = mark->points + 2 * i;
        const double x = linear ? axes->x_origin + axes->x_factor * p[0] : gm_axes_x(axes, p[0]);
        const double y = linear ? axes->y_origin + axes->y_factor * p[1] : gm_axes_y(axes, p[1]);
        line->points[i] = (struct gm_point){(float)(x > far    ? far
                                                    : x < -far ? -far
                                                               : x),
                                            (float)(y > far    ? far
                                                    : y < -far ? -far
                                                               : y)};
    }
    line->count = mark->count;
    line->closed = mark->closed && mark->count > 2;
    return true;
}

static struct gm_ink ink_of(const struct gm_painter *painter, const struct gm_style *style)
{
    return (struct gm_ink){gm_theme_colour(painter->look.theme, style->role), style->alpha};
}

static float stroke_width(const struct gm_painter *painter, const struct gm_style *style)
{
    return (float)(style->width * painter->scale);
}

static struct gm_bounds bounds_of(const struct gm_axes *axes, float margin)
{
    const struct gm_box *box = &axes->box;
    return (struct gm_bounds){(float)box->x - margin, (float)box->y - margin,
                              (float)(box->x + box->width) + margin, (float)(box->y + box->height) + margin};
}

/* Returns false if the number of dashes is so large that they merge into an area. */
static bool can_be_dashed(const struct gm_polyline *piece, const float *pattern, size_t parts)
{
    const float most_dashes = 4000.0f;
    float period = 0.0f;
    for (size_t i = 0; i < parts; i++) {
        period += pattern[i];
    }
    return gm_polyline_length(piece) * (float)parts < 2.0f * most_dashes * period;
}

static void draw_line(struct gm_painter *painter, const struct gm_axes *axes, const struct gm_mark *mark)
{
    const struct gm_style *style = &mark->style;
    const float width = stroke_width(painter, style);
    if (!(width > 0.0f) || !project(painter, axes, mark)) {
        return;
    }
    struct gm_stroke stroke = {.width = width, .ink = ink_of(painter, style)};
    const size_t parts = dashes[style->dash].parts;
    for (size_t i = 0; i < parts; i++) { /* thin lines need longer dashes to be distinct */
        stroke.pattern[i] =
            dashes[style->dash].lengths[i] * fmaxf(width, 1.2f * (float)fmax(painter->scale, 0.8));
    }
    const struct gm_bounds bounds = bounds_of(axes, cut + 2.0f * width);
    for (size_t from = 0; gm_polyline_clip(&painter->line, bounds, &from, &painter->piece);) {
        gm_polyline_simplify(&painter->piece, tolerance);
        stroke.parts = can_be_dashed(&painter->piece, stroke.pattern, parts) ? parts : 0;
        painter->pen->line(painter->self, &painter->piece, &stroke);
    }
}

/* Draws a glyph other than a disc, with paper inside. The line of the mark is in use, the piece is not. */
static void draw_glyph(struct gm_painter *painter, const struct gm_mark *mark, struct gm_point centre,
                       float width)
{
    enum { SIDES = 32 };
    const float pi = 3.14159265f, radius = 0.5f * width;
    const struct gm_ink ink = ink_of(painter, &mark->style);
    const struct gm_ink paper = {gm_theme_colour(painter->look.theme, GM_PAPER), 1};
    struct gm_polyline *line = &painter->piece;
    struct gm_stroke stroke = {.width = 0.2f * width, .ink = ink};
    if (!gm_polyline_reserve(line, SIDES)) {
        return;
    }
    if (mark->glyph == GM_CROSS) {
        for (float side = -1.0f; side < 2.0f; side += 2.0f) {
            line->points[0] = (struct gm_point){centre.x - radius, centre.y - side * radius};
            line->points[1] = (struct gm_point){centre.x + radius, centre.y + side * radius};
            line->count = 2;
            line->closed = false;
            painter->pen->line(painter->self, line, &stroke);
        }
        return;
    }
    for (int i = 0; i < SIDES; i++) {
        const float angle = 2.0f * pi * (float)i / SIDES + 0.5f * pi;
        line->points[i] = (struct gm_point){centre.x + radius * cosf(angle), centre.y + radius * sinf(angle)};
    }
    line->count = SIDES;
    line->closed = true;
    painter->pen->disc(painter->self, centre, width, paper);
    if (mark->glyph == GM_DOTTED_RING) { /* eight dots */
        stroke.parts = 2;
        stroke.pattern[1] = 0.125f * pi * width;
    }
    painter->pen->line(painter->self, line, &stroke);
    if (mark->glyph == GM_HALF_DISC) {
        line->count = SIDES / 2 + 1;
        painter->pen->fill(painter->self, line, ink);
    }
}

static void draw_points(struct gm_painter *painter, const struct gm_axes *axes, const struct gm_mark *mark)
{
    const struct gm_style *style = &mark->style;
    const float width = stroke_width(painter, style);
    if (!(width > 0.0f) || !project(painter, axes, mark)) {
        return;
    }
    const float radius = 0.5f * fmaxf(width, 1.0f);
    const struct gm_ink ink = ink_of(painter, style);
    const struct gm_bounds bounds = bounds_of(axes, 0.5f);
    clip_to(painter, &axes->box, radius + 1.0f);
    for (size_t i = 0; i < painter->line.count; i++) {
        const struct gm_point p = painter->line.points[i];
        if (p.x >= bounds.left && p.x <= bounds.right && p.y >= bounds.top && p.y <= bounds.bottom) {
            if (mark->glyph == GM_DISC) {
                painter->pen->disc(painter->self, p, width, ink);
            } else {
                draw_glyph(painter, mark, p, width);
            }
        }
    }
}

static void draw_polygon(struct gm_painter *painter, const struct gm_axes *axes, const struct gm_mark *mark)
{
    if (!project(painter, axes, mark)) {
        return;
    }
    struct gm_polyline *line = &painter->line;
    gm_polyline_simplify(line, tolerance);
    const struct gm_point first = line->points[0], last = line->points[line->count - 1];
    if (line->count > 1 && hypotf(first.x - last.x, first.y - last.y) < tolerance) {
        line->count--; /* the last corner repeats the first */
    }
    line->closed = true;
    painter->pen->fill(painter->self, line, ink_of(painter, &mark->style));
}

void gm_paint_marks(struct gm_painter *painter, const struct gm_axes *axes)
{
    for (const struct gm_mark *mark = axes->panel->first; mark; mark = mark->next) {
        if (!gm_mark_is_shown(mark, axes->box.width, axes->box.height)) {
            continue;
        }
        clip_to(painter, &axes->box, 2.5 * painter->scale);
        switch (mark->kind) {
        case GM_MARK_LINE:
            draw_line(painter, axes, mark);
            break;
        case GM_MARK_POINTS:
            draw_points(painter, axes, mark);
            break;
        case GM_MARK_POLYGON:
            draw_polygon(painter, axes, mark);
            break;
        case GM_MARK_MESH:
        case GM_MARK_IMAGE:
            painter->pen->field(painter->self, axes, mark);
            break;
        case GM_MARK_TEXT: /* drawn last, by gm_paint_labels */
            break;
        }
    }
}
