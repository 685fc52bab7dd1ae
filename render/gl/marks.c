/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lines, points and polygons in pixels; fields.c does the marks that have values. */
#include <math.h>

#include "render/gl/painter.h"

/* Nobody sees a tenth of a pixel. */
static const float tolerance = 0.1f;

/* Lines are cut this far outside of their panel, so that their ends are not seen. */
static const float cut = 16.0f;

/* Beyond this many dashes a line fills an area, and its dashes could not be told apart. */
static const float most_dashes = 4000.0f;

enum { DASH_PARTS = 6 };

/* Lengths drawn and left out, in widths of the line. Ends are round: half a width reaches out on both sides,
   so that a length of 0 is a dot. */
static const struct {
    size_t parts;
    float lengths[DASH_PARTS];
} dashes[GM_DASH_COUNT] = {
    [GM_SOLID] = {0, {0}},
    [GM_LONG_DASH] = {2, {6.0f, 3.5f}},
    [GM_DOTS] = {2, {0.0f, 2.4f}},
    [GM_DASH_DOT] = {4, {5.0f, 2.6f, 0.0f, 2.6f}},
    [GM_SHORT_DASH] = {2, {1.8f, 2.8f}},
    [GM_DASH_DOT_DOT] = {6, {4.0f, 2.5f, 0.0f, 2.5f, 0.0f, 2.5f}},
};

/* Marks may reach beyond the box by half their width, so that strokes along its edge keep theirs. */
static void clip_to(struct gm_painter *painter, const struct gm_box *box, double margin)
{
    const int left = (int)floor(box->x - margin), top = (int)floor(box->y - margin);
    gm_batch_scissor(&painter->batch, left, top, (int)ceil(box->x + box->width + margin) - left,
                     (int)ceil(box->y + box->height + margin) - top);
}

/* The mark's points on the surface. False when memory is short. */
static bool project(struct gm_painter *painter, const struct gm_frame *frame, const struct gm_mark *mark)
{
    struct gm_polyline *line = &painter->line;
    if (!gm_polyline_reserve(line, mark->count)) {
        return false;
    }
    const bool linear = frame->panel->x.scale != GM_LOG && frame->panel->y.scale != GM_LOG;
    const double far = 1e7; /* where floats still have whole pixels */
    for (size_t i = 0; i < mark->count; i++) {
        const double *p = mark->points + 2 * i;
        const double x = linear ? frame->x_origin + frame->x_factor * p[0] : gm_frame_x(frame, p[0]);
        const double y = linear ? frame->y_origin + frame->y_factor * p[1] : gm_frame_y(frame, p[1]);
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

/* Strokes thinner than a pixel are a pixel wide and fainter. */
struct pen {
    float half;
    struct gm_ink ink;
    const float *pattern;
    size_t parts;
};

static float stroke_width(const struct gm_painter *painter, const struct gm_style *style)
{
    return (float)(style->width * painter->scale);
}

static void draw_dashes(struct gm_painter *painter, const struct gm_polyline *piece, const struct pen *pen)
{
    struct gm_dashing state = {0};
    while (gm_polyline_dash(piece, pen->pattern, pen->parts, &state, &painter->dash)) {
        gm_stroke_line(&painter->batch, &painter->dash, pen->half, pen->ink);
    }
}

static void draw_piece(struct gm_painter *painter, const struct gm_polyline *piece, const struct pen *pen)
{
    float period = 0.0f;
    for (size_t i = 0; i < pen->parts; i++) {
        period += pen->pattern[i];
    }
    if (pen->parts > 0 && gm_polyline_length(piece) * (float)pen->parts < 2.0f * most_dashes * period) {
        draw_dashes(painter, piece, pen);
    } else {
        gm_stroke_line(&painter->batch, piece, pen->half, pen->ink);
    }
}

/* What is translucent and would overlap itself at joints is painted in two passes, each pixel once: whole
   pixels first, then the fading edges where nothing was painted. */
static void draw_translucent(struct gm_painter *painter, const struct gm_polyline *piece,
                             const struct pen *pen)
{
    gm_batch_once(&painter->batch);
    gm_batch_state(&painter->batch, GM_PROGRAM_CORE, GM_STENCIL_ONCE);
    draw_piece(painter, piece, pen);
    gm_batch_state(&painter->batch, GM_PROGRAM_INK, GM_STENCIL_ONCE);
    draw_piece(painter, piece, pen);
    gm_batch_state(&painter->batch, GM_PROGRAM_INK, GM_STENCIL_NONE);
}

static struct gm_bounds bounds_of(const struct gm_frame *frame, float margin)
{
    const struct gm_box *box = &frame->box;
    return (struct gm_bounds){(float)box->x - margin, (float)box->y - margin,
                              (float)(box->x + box->width) + margin, (float)(box->y + box->height) + margin};
}

static void draw_line(struct gm_painter *painter, const struct gm_frame *frame, const struct gm_mark *mark)
{
    const struct gm_style *style = &mark->style;
    const float width = stroke_width(painter, style);
    if (!(width > 0.0f) || !project(painter, frame, mark)) {
        return;
    }
    float pattern[DASH_PARTS];
    struct pen pen = {.half = 0.5f * fmaxf(width, 1.0f),
                      .ink = gm_ink_of(painter->theme, style->role, style->alpha * fminf(width, 1.0f)),
                      .pattern = pattern,
                      .parts = dashes[style->dash].parts};
    for (size_t i = 0; i < pen.parts; i++) { /* thin lines need longer dashes to be told apart */
        pattern[i] = dashes[style->dash].lengths[i] * fmaxf(width, 1.2f * (float)fmax(painter->scale, 0.8));
    }
    const struct gm_bounds bounds = bounds_of(frame, cut + 2.0f * width);
    for (size_t from = 0; gm_polyline_clip(&painter->line, bounds, &from, &painter->piece);) {
        gm_polyline_simplify(&painter->piece, tolerance);
        if (pen.ink.colour[3] < 255 && gm_stroke_breaks(&painter->piece, pen.half) > 0) {
            draw_translucent(painter, &painter->piece, &pen);
        } else {
            draw_piece(painter, &painter->piece, &pen);
        }
    }
}

static void draw_points(struct gm_painter *painter, const struct gm_frame *frame, const struct gm_mark *mark)
{
    const struct gm_style *style = &mark->style;
    const float width = stroke_width(painter, style);
    if (!(width > 0.0f) || !project(painter, frame, mark)) {
        return;
    }
    const float radius = 0.5f * fmaxf(width, 1.0f);
    const struct gm_ink ink =
        gm_ink_of(painter->theme, style->role, style->alpha * fminf(width * width, 1.0f));
    const struct gm_bounds bounds = bounds_of(frame, 0.5f);
    clip_to(painter, &frame->box, radius + 1.0f);
    for (size_t i = 0; i < painter->line.count; i++) {
        const struct gm_point p = painter->line.points[i];
        if (p.x >= bounds.left && p.x <= bounds.right && p.y >= bounds.top && p.y <= bounds.bottom) {
            gm_stroke_disc(&painter->batch, p, radius, ink);
        }
    }
}

static void draw_polygon(struct gm_painter *painter, const struct gm_frame *frame, const struct gm_mark *mark)
{
    if (!project(painter, frame, mark)) {
        return;
    }
    struct gm_polyline *line = &painter->line;
    gm_polyline_simplify(line, tolerance);
    const struct gm_point first = line->points[0], last = line->points[line->count - 1];
    if (line->count > 1 && hypotf(first.x - last.x, first.y - last.y) < tolerance) {
        line->count--; /* closed by repeating the first corner */
    }
    line->closed = true;
    gm_fill_polygon(&painter->batch, line, gm_ink_of(painter->theme, mark->style.role, mark->style.alpha));
}

void gm_paint_marks(struct gm_painter *painter, const struct gm_frame *frame)
{
    for (const struct gm_mark *mark = frame->panel->first; mark != NULL; mark = mark->next) {
        gm_batch_state(&painter->batch, GM_PROGRAM_INK, GM_STENCIL_NONE);
        clip_to(painter, &frame->box, 2.5 * painter->scale);
        switch (mark->kind) {
        case GM_MARK_LINE:
            draw_line(painter, frame, mark);
            break;
        case GM_MARK_POINTS:
            draw_points(painter, frame, mark);
            break;
        case GM_MARK_POLYGON:
            draw_polygon(painter, frame, mark);
            break;
        case GM_MARK_MESH:
            gm_paint_mesh(painter, frame, mark);
            break;
        case GM_MARK_IMAGE:
            gm_paint_image(painter, frame, mark);
            break;
        case GM_MARK_TEXT: /* after everything else: gm_paint_labels */
            break;
        }
    }
    gm_batch_state(&painter->batch, GM_PROGRAM_INK, GM_STENCIL_NONE);
}
