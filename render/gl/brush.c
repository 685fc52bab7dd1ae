/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a pen draws, as strokes of a batch; fields.c does what has values. */
#include "render/gl/brush.h"

#include <math.h>
#include <string.h>

static void set_state(struct gm_brush *brush, enum gm_program program, enum gm_stencil stencil)
{
    gm_batch_state(&brush->batch, program, stencil);
}

static void clip(void *self, int left, int top, int width, int height)
{
    gm_batch_scissor(&((struct gm_brush *)self)->batch, left, top, width, height);
}

static void box(void *self, float left, float top, float right, float bottom, struct gm_ink ink)
{
    set_state(self, GM_PROGRAM_INK, GM_STENCIL_NONE);
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

/* Strokes thinner than a pixel are a pixel wide and fainter. What is translucent and would overlap itself at
   joints is painted in two passes, each pixel once: whole pixels first, then the fading edges where nothing
   was painted. */
static void line(void *self, const struct gm_polyline *line, const struct gm_stroke *stroke)
{
    struct gm_brush *brush = self;
    const float half = 0.5f * fmaxf(stroke->width, 1.0f);
    const struct gm_rgba ink = gm_rgba_of(stroke->ink, fminf(stroke->width, 1.0f));
    if (ink.colour[3] < 255 && gm_stroke_breaks(line, half) > 0) {
        gm_batch_once(&brush->batch);
        set_state(brush, GM_PROGRAM_CORE, GM_STENCIL_ONCE);
        draw_line(brush, line, stroke, half, ink);
        set_state(brush, GM_PROGRAM_INK, GM_STENCIL_ONCE);
        draw_line(brush, line, stroke, half, ink);
    } else {
        set_state(brush, GM_PROGRAM_INK, GM_STENCIL_NONE);
        draw_line(brush, line, stroke, half, ink);
    }
}

static void disc(void *self, struct gm_point centre, float width, struct gm_ink ink)
{
    set_state(self, GM_PROGRAM_INK, GM_STENCIL_NONE);
    gm_stroke_disc(&((struct gm_brush *)self)->batch, centre, 0.5f * fmaxf(width, 1.0f),
                   gm_rgba_of(ink, fminf(width * width, 1.0f)));
}

static void fill(void *self, const struct gm_polyline *line, struct gm_ink ink)
{
    set_state(self, GM_PROGRAM_INK, GM_STENCIL_NONE);
    gm_fill_polygon(&((struct gm_brush *)self)->batch, line, gm_rgba_of(ink, 1.0));
}

static void put_letter(struct gm_batch *batch, bool upwards, double x, double y,
                       const struct gm_letter *letter, struct gm_rgba ink)
{
    struct gm_vertex *strip = gm_batch_strip(batch, 4);
    if (strip == NULL) {
        return;
    }
    for (int i = 0; i < 4; i++) {
        const int u = i % 2 == 0 ? 0 : letter->width, v = i < 2 ? 0 : letter->height;
        const double along = letter->x + u, down = letter->y + v;
        strip[i] = (struct gm_vertex){
            .x = (float)(upwards ? x + down : x + along),
            .y = (float)(upwards ? y - along : y + down),
            .across = (float)(letter->atlas_x + u),
            .along = (float)(letter->atlas_y + v),
        };
        memcpy(strip[i].colour, ink.colour, sizeof strip[i].colour);
    }
    gm_batch_end(batch, 0);
}

/* Baselines stand on whole pixels; letters find their place along them to a quarter. */
static void text(void *self, const struct gm_writing *writing, const char *text)
{
    struct gm_brush *brush = self;
    const double x = writing->upwards ? floor(writing->x + 0.5) : floor(writing->x);
    const double y = writing->upwards ? ceil(writing->y) : floor(writing->y + 0.5);
    double pen = writing->upwards ? y - writing->y : writing->x - x;
    struct gm_letter letter;
    set_state(brush, GM_PROGRAM_TEXT, GM_STENCIL_NONE);
    while (gm_glyphs_next(brush->glyphs, writing->font, writing->letters, &text, &pen, &letter)) {
        if (letter.width > 0) {
            put_letter(&brush->batch, writing->upwards, x, y, &letter, gm_rgba_of(writing->ink, 1.0));
        }
    }
}

const struct gm_pen gm_brush_pen = {.clip = clip,
                                    .box = box,
                                    .line = line,
                                    .disc = disc,
                                    .fill = fill,
                                    .field = gm_brush_field,
                                    .ramp = gm_brush_ramp,
                                    .text = text};
