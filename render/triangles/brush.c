/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A pen that draws strokes and triangles of a batch. */
#include "render/triangles/triangles.h"

#include <math.h>
#include <string.h>

void gm_brush_free(struct gm_brush *brush)
{
    gm_batch_free(&brush->batch);
    gm_polyline_free(&brush->dash);
}

static void clip(void *self, int left, int top, int width, int height)
{
    memcpy(((struct gm_brush *)self)->batch.scissor, (const int[]){left, top, width, height}, sizeof(int[4]));
}

static void box(void *self, float left, float top, float right, float bottom, struct gm_ink ink)
{
    gm_batch_state(&((struct gm_brush *)self)->batch, GM_PROGRAM_INK, GM_STENCIL_NONE);
    gm_stroke_box(&((struct gm_brush *)self)->batch, left, top, right, bottom, gm_rgba_of(ink, 1.0));
}

static void draw_line(struct gm_brush *brush, const struct gm_polyline *line, const struct gm_stroke *stroke,
                      float half, struct gm_rgba ink)
{
    struct gm_dashing state = {0};
    if (stroke->parts == 0) {
        gm_stroke_line(&brush->batch, line, half, ink);
        return;
    }
    while (gm_polyline_dash(line, stroke->pattern, stroke->parts, &state, &brush->dash)) {
        gm_stroke_line(&brush->batch, &brush->dash, half, ink);
    }
}

/* Strokes thinner than a pixel are a pixel wide and fainter. A translucent stroke that would overlap itself
   at joints is painted in two passes, each pixel once: whole pixels first, then the fading edges on pixels
   not painted yet. A stroke without whole pixels is not: the first and faintest edge would keep its pixel,
   and a close zigzag would vanish. */
static void line(void *self, const struct gm_polyline *line, const struct gm_stroke *stroke)
{
    struct gm_brush *brush = self;
    const float half = 0.5f * fmaxf(stroke->width, 1.0f);
    const struct gm_rgba ink = gm_rgba_of(stroke->ink, fminf(stroke->width, 1.0f));
    const bool has_whole_pixels = half > 0.75f;
    if (ink.colour[3] < 255 && has_whole_pixels && gm_stroke_breaks(line, half) > 0) {
        brush->batch.once++;
        gm_batch_state(&brush->batch, GM_PROGRAM_CORE, GM_STENCIL_ONCE);
        draw_line(brush, line, stroke, half, ink);
        gm_batch_state(&brush->batch, GM_PROGRAM_INK, GM_STENCIL_ONCE);
        draw_line(brush, line, stroke, half, ink);
    } else {
        gm_batch_state(&brush->batch, GM_PROGRAM_INK, GM_STENCIL_NONE);
        draw_line(brush, line, stroke, half, ink);
    }
}

static void disc(void *self, struct gm_point centre, float width, struct gm_ink ink)
{
    gm_batch_state(&((struct gm_brush *)self)->batch, GM_PROGRAM_INK, GM_STENCIL_NONE);
    gm_stroke_disc(&((struct gm_brush *)self)->batch, centre, 0.5f * fmaxf(width, 1.0f),
                   gm_rgba_of(ink, fminf(width * width, 1.0f)));
}

static void fill(void *self, const struct gm_polyline *line, struct gm_ink ink)
{
    gm_batch_state(&((struct gm_brush *)self)->batch, GM_PROGRAM_INK, GM_STENCIL_NONE);
    gm_fill_polygon(&((struct gm_brush *)self)->batch, line, gm_rgba_of(ink, 1.0));
}

static void put_letter(struct gm_batch *batch, bool upwards, double x, double y,
                       const struct gm_letter *letter, struct gm_rgba ink)
{
    struct gm_vertex corners[4];
    for (int i = 0; i < 4; i++) {
        const int u = i % 2 == 0 ? 0 : letter->width, v = i < 2 ? 0 : letter->height;
        const double along = letter->x + u, down = letter->y + v;
        corners[i] = (struct gm_vertex){
            .x = (float)(upwards ? x + down : x + along),
            .y = (float)(upwards ? y - along : y + down),
            .across = (float)(letter->atlas_x + u),
            .along = (float)(letter->atlas_y + v),
            .half = 1,
        };
        memcpy(corners[i].colour, ink.colour, sizeof corners[i].colour);
    }
    gm_batch_quad(batch, corners);
}

/* Baselines are on whole pixels, letters along them at quarters of a pixel. */
static void text(void *self, const struct gm_writing *writing, const char *text)
{
    struct gm_brush *brush = self;
    const double x = writing->upwards ? floor(writing->x + 0.5) : floor(writing->x);
    const double y = writing->upwards ? ceil(writing->y) : floor(writing->y + 0.5);
    double pen = writing->upwards ? y - writing->y : writing->x - x;
    struct gm_letter letter;
    gm_batch_state(&brush->batch, GM_PROGRAM_TEXT, GM_STENCIL_NONE);
    while (gm_glyphs_next(brush->glyphs, writing->font, writing->letters, &text, &pen, &letter)) {
        if (letter.width > 0) {
            put_letter(&brush->batch, writing->upwards, x, y, &letter, gm_rgba_of(writing->ink, 1.0));
        }
    }
}

/* ---- meshes, images and colour bars: values are interpolated before they become colours ---- */

static struct gm_vertex vertex(double x, double y, double across, double along, double alpha,
                               enum gm_colour_map map)
{
    const uint8_t row = map == GM_MAP_SEQUENTIAL ? 0 : 255;
    return (struct gm_vertex){(float)x,     (float)y,     (float)across,
                              (float)along, (float)alpha, {row, 255, 255, 255}};
}

static void paint_mesh(struct gm_brush *brush, const struct gm_axes *axes, const struct gm_mark *mark)
{
    uint32_t *indices;
    gm_batch_state(&brush->batch, GM_PROGRAM_FIELD, GM_STENCIL_NONE);
    struct gm_vertex *vertices =
        gm_batch_mesh(&brush->batch, mark->count, 3 * mark->triangle_count, &indices);
    if (!vertices) {
        return;
    }
    const size_t first = (size_t)(vertices - brush->batch.vertices);
    const double factor = 1.0 / (mark->high - mark->low);
    for (size_t i = 0; i < mark->count; i++) {
        vertices[i] = vertex(gm_axes_x(axes, mark->points[2 * i]), gm_axes_y(axes, mark->points[2 * i + 1]),
                             factor * (mark->values[i] - mark->low), 0.0, mark->style.alpha, mark->map);
    }
    for (size_t i = 0; i < 3 * mark->triangle_count; i++) {
        indices[i] = (uint32_t)(first + (size_t)mark->triangles[i]);
    }
}

static void ramp(void *self, struct gm_box box, enum gm_colour_map map)
{
    struct gm_brush *brush = self;
    gm_batch_state(&brush->batch, GM_PROGRAM_FIELD, GM_STENCIL_NONE);
    const double right = box.x + box.width, bottom = box.y + box.height;
    gm_batch_quad(&brush->batch, (struct gm_vertex[4]){vertex(box.x, box.y, 1.0, 0.0, 1.0, map),
                                                       vertex(right, box.y, 1.0, 0.0, 1.0, map),
                                                       vertex(box.x, bottom, 0.0, 0.0, 1.0, map),
                                                       vertex(right, bottom, 0.0, 0.0, 1.0, map)});
    gm_batch_state(&brush->batch, GM_PROGRAM_INK, GM_STENCIL_NONE);
}

static void paint_image(struct gm_brush *brush, const struct gm_axes *axes, const struct gm_mark *mark)
{
    const double left = gm_axes_x(axes, mark->points[0]), right = gm_axes_x(axes, mark->points[2]);
    const double bottom = gm_axes_y(axes, mark->points[1]), top = gm_axes_y(axes, mark->points[3]);
    const double alpha = mark->style.alpha;
    gm_batch_state(&brush->batch, GM_PROGRAM_IMAGE, GM_STENCIL_NONE);
    brush->batch.image = mark;
    gm_batch_quad(&brush->batch, (struct gm_vertex[4]){vertex(left, bottom, 0.0, 0.0, alpha, mark->map),
                                                       vertex(right, bottom, 1.0, 0.0, alpha, mark->map),
                                                       vertex(left, top, 0.0, 1.0, alpha, mark->map),
                                                       vertex(right, top, 1.0, 1.0, alpha, mark->map)});
    brush->batch.image = NULL;
    gm_batch_state(&brush->batch, GM_PROGRAM_INK, GM_STENCIL_NONE);
}

static void field(void *self, const struct gm_axes *axes, const struct gm_mark *mark)
{
    if (mark->kind == GM_MARK_MESH) {
        paint_mesh(self, axes, mark);
    } else {
        paint_image(self, axes, mark);
    }
}

const struct gm_pen gm_brush_pen = {.clip = clip,
                                    .box = box,
                                    .line = line,
                                    .disc = disc,
                                    .fill = fill,
                                    .field = field,
                                    .ramp = ramp,
                                    .text = text};
