/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_TRIANGLES_TRIANGLES_H
#define GM_RENDER_TRIANGLES_TRIANGLES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "render/drawing/pen.h"
#include "render/picture/picture.h"

/* A frame as one stream of vertices and a short list of calls. Marks are appended in painting order, and
   neighbours of equal state share a call. A painter draws the whole batch at the end. Buffers grow and
   stay. */

/* The colour of a triangle's pixels from the values interpolated between its vertices. */
enum gm_program {
    GM_PROGRAM_INK,
    GM_PROGRAM_CORE, /* ink, only on wholly covered pixels */
    GM_PROGRAM_TEXT,
    GM_PROGRAM_FIELD,
    GM_PROGRAM_IMAGE,
    GM_PROGRAM_COUNT,
};

/* Ink covers a pixel by clamp(half + 1/2 - |(across, along)|), in pixels: a stroke's body has along = 0, a
   round cap counts along from the end, a disc has both from the centre. Text: (across, along) is a place in
   the glyph atlas, in texels; half is 1. Fields: across is the value from 0 to 1, along 0, half the alpha.
   Images: (across, along) is the place in the image, from 0 to 1; half is the alpha. Half and colour are
   the same at all corners of a triangle, except the light of fields and images. */
struct gm_vertex {
    float x, y; /* place in pixels, y downwards */
    float across, along, half;
    /* a strip's colour; in fields and images the row of the colour map, 0 or 255, and three times the light,
       255 without one */
    uint8_t colour[4];
};

enum gm_stencil {
    GM_STENCIL_NONE,
    GM_STENCIL_ONCE,    /* a pixel is painted once in each group */
    GM_STENCIL_INVERT,  /* no colour: each triangle turns inside to outside and back */
    GM_STENCIL_OUTSIDE, /* paints where the inversions left the outside */
    GM_STENCIL_INSIDE,  /* paints the inside and clears it */
};

/* Triangles of one state: a strip of vertices, or three indices each. */
struct gm_draw_call {
    enum gm_program program;
    enum gm_stencil stencil;
    bool indexed;
    int once;                    /* number of the group of GM_STENCIL_ONCE, from 1 */
    int scissor[4];              /* left, top, width, height */
    const struct gm_mark *image; /* the image of GM_PROGRAM_IMAGE */
    size_t first, count;         /* range of vertices, or of indices */
};

struct gm_batch {
    struct gm_vertex *vertices;
    size_t vertex_count, vertex_capacity;
    uint32_t *indices;
    size_t index_count, index_capacity;
    struct gm_draw_call *calls;
    size_t call_count, call_capacity;
    size_t join; /* index where a strip's first vertex must be doubled; 0: none */
    /* the state of later triangles */
    int scissor[4];
    int once; /* number of the current group of GM_STENCIL_ONCE */
    enum gm_program program;
    enum gm_stencil stencil;
    const struct gm_mark *image; /* lives until the batch is drawn */
    bool short_of_memory;
};

/* Empties a batch, which begins zeroed, for a frame. */
void gm_batch_clear(struct gm_batch *batch);

/* The pen that makes a batch, with buffers reused for every frame. */
struct gm_brush {
    struct gm_batch batch;
    struct gm_glyphs *glyphs; /* the letters of the page */
    struct gm_polyline dash;
};

void gm_brush_free(struct gm_brush *brush);

/* The pen's self is a gm_brush. */
extern const struct gm_pen gm_brush_pen;

#endif
