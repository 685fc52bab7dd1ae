/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_TRIANGLES_TRIANGLES_H
#define GM_RENDER_TRIANGLES_TRIANGLES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "render/drawing/pen.h"
#include "render/picture/picture.h"

/* A frame as one stream of vertices and a short list of calls: marks are appended in painting order,
   neighbours of equal state share a call, and what draws triangles takes everything at the end. Buffers grow and
   stay. */

/* How a triangle's pixels get their colour from what is interpolated between its vertices. */
enum gm_program {
    GM_PROGRAM_INK,
    GM_PROGRAM_CORE, /* ink where it covers pixels wholly */
    GM_PROGRAM_TEXT,
    GM_PROGRAM_FIELD,
    GM_PROGRAM_IMAGE,
    GM_PROGRAM_COUNT,
};

/* Ink covers a pixel by clamp(half + 1/2 - |(across, along)|), the distances in pixels: a stroke's body has
   along = 0, its round cap counts along from its end, a disc has both from its centre. Text: (across,
   along) is a place in the glyph atlas, in texels, half is 1. Fields: across is the value from 0 to 1, along 0,
   half the alpha. Images: (across, along) is the place in the image, from 0 to 1, half the alpha. */
struct gm_vertex {
    float x, y; /* in pixels, downwards */
    float across, along, half;
    uint8_t colour[4]; /* of a whole strip; of fields and images: the row of the colour map, 0 or 255, and
                          three of 255 */
};

enum gm_stencil {
    GM_STENCIL_NONE,
    GM_STENCIL_ONCE,    /* a pixel is painted once since gm_batch_once */
    GM_STENCIL_INVERT,  /* no colour: each triangle turns inside to outside and back */
    GM_STENCIL_OUTSIDE, /* paints where the inversions left the outside */
    GM_STENCIL_INSIDE,  /* paints the inside and forgets it */
};

/* Triangles of one state: a strip of vertices, or three indices each. */
struct gm_draw_call {
    enum gm_program program;
    enum gm_stencil stencil;
    bool indexed;
    int once;                    /* number of the group of GM_STENCIL_ONCE, from 1 */
    int scissor[4];              /* left, top, width, height */
    const struct gm_mark *image; /* of GM_PROGRAM_IMAGE */
    size_t first, count;         /* vertices, or indices */
};

struct gm_batch {
    struct gm_vertex *vertices;
    size_t vertex_count, vertex_capacity;
    uint32_t *indices;
    size_t index_count, index_capacity;
    struct gm_draw_call *calls;
    size_t call_count, call_capacity;
    size_t join; /* where a strip's first vertex is to be doubled; 0: nowhere */
    int scissor[4];
    int once; /* number of the present group of GM_STENCIL_ONCE */
    enum gm_program program;
    enum gm_stencil stencil;
    const struct gm_mark *image;
    bool short_of_memory;
};

/* A batch begins zeroed. */
void gm_batch_free(struct gm_batch *batch);

void gm_batch_clear(struct gm_batch *batch);
/* The state of what follows. An image lives until the batch is drawn. */
void gm_batch_scissor(struct gm_batch *batch, int x, int y, int width, int height);
void gm_batch_state(struct gm_batch *batch, enum gm_program program, enum gm_stencil stencil);
void gm_batch_image(struct gm_batch *batch, const struct gm_mark *image);
void gm_batch_once(struct gm_batch *batch);

/* Room for a strip of at most count vertices, not connected to the strip before; NULL when memory is short.
   The strip ends with gm_batch_end, which says how many there are. */
struct gm_vertex *gm_batch_strip(struct gm_batch *batch, size_t count);
void gm_batch_end(struct gm_batch *batch, size_t unused);

/* Room for vertices and the triangles among them (numbers count from the first of these vertices). */
struct gm_vertex *gm_batch_mesh(struct gm_batch *batch, size_t count, size_t index_count, uint32_t **indices);

/* Polylines and discs as triangles whose edges fade over a pixel. */

struct gm_rgba {
    uint8_t colour[4];
};

/* The ink, `faint` times as opaque. */
struct gm_rgba gm_rgba_of(struct gm_ink ink, double faint);

/* Joints where the line turns gently are mitred, so that its strip covers nothing twice. At the others,
   counted here, it ends and begins again with round ends that overlap. */
size_t gm_stroke_breaks(const struct gm_polyline *line, float half);

/* A line of half width `half` with round joints and ends. */
void gm_stroke_line(struct gm_batch *batch, const struct gm_polyline *line, float half, struct gm_rgba ink);

void gm_stroke_disc(struct gm_batch *batch, struct gm_point centre, float radius, struct gm_rgba ink);

/* An upright rectangle with sharp edges. */
void gm_stroke_box(struct gm_batch *batch, float left, float top, float right, float bottom,
                   struct gm_rgba ink);

/* The inside of a closed line (even-odd). Convex ones fade at the edge by themselves; the others are painted
   through the stencil. */
void gm_fill_polygon(struct gm_batch *batch, const struct gm_polyline *line, struct gm_rgba ink);

/* The pen that makes a batch of what it draws, with memory that is used again for every frame. */
struct gm_brush {
    struct gm_batch batch;
    struct gm_glyphs *glyphs; /* of the page */
    struct gm_polyline dash;
};

void gm_brush_free(struct gm_brush *brush);

/* Its self is a gm_brush. */
extern const struct gm_pen gm_brush_pen;

#endif
