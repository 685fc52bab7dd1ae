/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pen that makes a batch: strokes and discs as triangles whose edges fade over a pixel, letters, fields. */
#include "render/triangles/triangles.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "render/grow.h"

/* ---- the batch: one stream of vertices and a short list of draw calls for a whole frame ---- */

void gm_batch_clear(struct gm_batch *batch)
{
    batch->vertex_count = batch->index_count = batch->call_count = batch->join = 0;
    batch->once = 0;
    batch->short_of_memory = false;
    batch->program = GM_PROGRAM_INK;
    batch->stencil = GM_STENCIL_NONE;
    batch->image = NULL;
}

static void set_state(struct gm_batch *batch, enum gm_program program, enum gm_stencil stencil)
{
    batch->program = program;
    batch->stencil = stencil;
}

static bool room_for(struct gm_batch *batch, void *block, size_t *capacity, size_t wanted, size_t size)
{
    const size_t first = 4096;
    const bool grown = gm_grow(block, capacity, wanted > first ? wanted : first, size);
    batch->short_of_memory = batch->short_of_memory || !grown;
    return grown;
}

/* Returns the call for the current state, a new one if the last differs, or NULL. */
static struct gm_draw_call *call_for(struct gm_batch *batch, bool indexed)
{
    if (batch->call_count > 0 && !indexed) {
        struct gm_draw_call *last = &batch->calls[batch->call_count - 1];
        if (!last->indexed && last->program == batch->program && last->stencil == batch->stencil &&
            (last->stencil != GM_STENCIL_ONCE || last->once == batch->once) && last->image == batch->image &&
            memcmp(last->scissor, batch->scissor, sizeof last->scissor) == 0) {
            return last;
        }
    }
    if (!room_for(batch, &batch->calls, &batch->call_capacity, batch->call_count + 1, sizeof *batch->calls)) {
        return NULL;
    }
    struct gm_draw_call *call = &batch->calls[batch->call_count++];
    *call = (struct gm_draw_call){.program = batch->program,
                                  .stencil = batch->stencil,
                                  .indexed = indexed,
                                  .once = batch->once,
                                  .image = batch->image,
                                  .first = indexed ? batch->index_count : batch->vertex_count};
    memcpy(call->scissor, batch->scissor, sizeof call->scissor);
    return call;
}

/* Returns room for a strip of at most count vertices, not connected to the strip before; NULL when out of
   memory. end_strip ends the strip and drops its last `unused` vertices. */
static struct gm_vertex *add_strip(struct gm_batch *batch, size_t count)
{
    const size_t joint = 2; /* vertices of the degenerate triangles between two strips */
    if (!room_for(batch, &batch->vertices, &batch->vertex_capacity, batch->vertex_count + count + joint,
                  sizeof *batch->vertices)) {
        return NULL;
    }
    struct gm_draw_call *call = call_for(batch, false);
    if (!call) {
        return NULL;
    }
    batch->join = 0;
    if (call->count > 0) {
        batch->vertices[batch->vertex_count] = batch->vertices[batch->vertex_count - 1];
        batch->join = batch->vertex_count + 1;
        batch->vertex_count += joint;
        call->count += joint;
    }
    struct gm_vertex *strip = batch->vertices + batch->vertex_count;
    batch->vertex_count += count;
    call->count += count;
    return strip;
}

static void end_strip(struct gm_batch *batch, size_t unused)
{
    batch->vertex_count -= unused;
    batch->calls[batch->call_count - 1].count -= unused;
    if (batch->join > 0) {
        batch->vertices[batch->join] = batch->vertices[batch->join + 1];
    }
}

/* Adds a strip of four vertices. */
static void add_quad(struct gm_batch *batch, const struct gm_vertex corners[4])
{
    struct gm_vertex *strip = add_strip(batch, 4);
    if (strip) {
        memcpy(strip, corners, 4 * sizeof *strip);
        end_strip(batch, 0);
    }
}

/* Returns room for vertices and the triangles among them (indices count from the first of these); NULL when
   out of memory. */
static struct gm_vertex *add_mesh(struct gm_batch *batch, size_t count, size_t index_count,
                                  uint32_t **indices)
{
    if (!room_for(batch, &batch->vertices, &batch->vertex_capacity, batch->vertex_count + count,
                  sizeof *batch->vertices) ||
        !room_for(batch, &batch->indices, &batch->index_capacity, batch->index_count + index_count,
                  sizeof *batch->indices)) {
        return NULL;
    }
    struct gm_draw_call *call = call_for(batch, true);
    if (!call) {
        return NULL;
    }
    call->count = index_count;
    *indices = batch->indices + batch->index_count;
    batch->index_count += index_count;
    struct gm_vertex *vertices = batch->vertices + batch->vertex_count;
    batch->vertex_count += count;
    return vertices;
}

void gm_brush_free(struct gm_brush *brush)
{
    free(brush->batch.vertices);
    free(brush->batch.indices);
    free(brush->batch.calls);
    gm_polyline_free(&brush->dash);
}

/* ---- strokes, discs and polygons ---- */

/* Pixels of a stroke's triangles beyond half its width, for the fading edge. */
static const float fringe = 0.75f;

/* Turns with a smaller cosine are not mitred. */
static const float sharpest = 0.35f;

struct rgba {
    uint8_t colour[4];
};

/* Returns the ink with its opacity times `faint`. */
static struct rgba rgba_of(struct gm_ink ink, double faint)
{
    const struct gm_rgb rgb = ink.colour;
    const double alpha = ink.alpha * faint;
    const double clamped = alpha > 0.0 ? (alpha < 1.0 ? alpha : 1.0) : 0.0;
    return (struct rgba){{rgb.r, rgb.g, rgb.b, (uint8_t)(255.0 * clamped + 0.5)}};
}

/* Returns the direction of a segment, and its length. */
static struct gm_point direction(struct gm_point from, struct gm_point to, float *length)
{
    const struct gm_point way = gm_point_minus(to, from);
    *length = sqrtf(gm_point_dot(way, way));
    return *length > 0.0f ? (struct gm_point){way.x / *length, way.y / *length}
                          : (struct gm_point){1.0f, 0.0f};
}

static struct gm_vertex vertex(struct gm_point place, float across, float along, float half, struct rgba ink)
{
    struct gm_vertex made = {place.x, place.y, across, along, half, {0}};
    memcpy(made.colour, ink.colour, sizeof made.colour);
    return made;
}

struct joint {
    struct gm_point before, after; /* directions */
    bool mitred;
};

static struct joint joint_at(const struct gm_polyline *line, size_t i, float reach)
{
    const size_t n = line->count;
    const struct gm_point *p = line->points;
    float length, next;
    struct joint joint;
    joint.before = direction(p[(i + n - 1) % n], p[i], &length);
    joint.after = direction(p[i], p[(i + 1) % n], &next);
    const float cosine = gm_point_dot(joint.before, joint.after);
    /* The inner side of the mitre must not take up half of a neighbouring segment. */
    const float inner = reach * reach * (1.0f - cosine), shorter = 0.5f * fminf(length, next);
    joint.mitred = cosine > sharpest && inner <= shorter * shorter * (1.0f + cosine);
    return joint;
}

/* Returns the number of breaks. Joints at gentle turns are mitred, so that the strip covers nothing twice. At
   the others the strip ends and begins again with round ends that overlap. */
static size_t count_breaks(const struct gm_polyline *line, float half)
{
    size_t breaks = 0;
    const size_t ends = line->closed ? 0 : 1;
    for (size_t i = ends; i + ends < line->count; i++) {
        breaks += !joint_at(line, i, half + fringe).mitred;
    }
    return breaks;
}

/* Writes the two sides of the strip at a point; `slant` is along the normal of one direction or between
   two. */
static void put_sides(struct gm_vertex *strip, struct gm_point p, struct gm_point slant, float along,
                      float half, struct rgba ink)
{
    const float reach = half + fringe;
    const struct gm_point left = {p.x + reach * slant.x, p.y + reach * slant.y};
    const struct gm_point right = {p.x - reach * slant.x, p.y - reach * slant.y};
    strip[0] = vertex(left, reach, along, half, ink);
    strip[1] = vertex(right, -reach, along, half, ink);
}

static struct gm_point normal(struct gm_point way)
{
    return (struct gm_point){-way.y, way.x};
}

/* Returns the vector whose projection on both normals of a mitred joint is 1. */
static struct gm_point mitre(struct joint joint)
{
    const struct gm_point a = normal(joint.before), b = normal(joint.after);
    const float scale = 1.0f / (1.0f + gm_point_dot(a, b));
    return (struct gm_point){scale * (a.x + b.x), scale * (a.y + b.y)};
}

static struct gm_point beyond(struct gm_point p, struct gm_point way, float distance)
{
    return (struct gm_point){p.x + distance * way.x, p.y + distance * way.y};
}

/* Draws `segments` mitred segments from point `first` on, round at both ends. */
static void put_run(struct gm_batch *batch, const struct gm_polyline *line, size_t first, size_t segments,
                    float half, struct rgba ink)
{
    const float reach = half + fringe;
    const size_t n = line->count;
    struct gm_vertex *strip = add_strip(batch, 2 * (segments + 3));
    if (!strip) {
        return;
    }
    const struct gm_point *p = line->points, start = p[first % n], end = p[(first + segments) % n];
    float length;
    struct gm_point way = direction(start, p[(first + 1) % n], &length);
    put_sides(strip, beyond(start, way, -reach), normal(way), reach, half, ink);
    put_sides(strip + 2, start, normal(way), 0.0f, half, ink);
    strip += 4;
    for (size_t i = 1; i < segments; i++, strip += 2) {
        put_sides(strip, p[(first + i) % n], mitre(joint_at(line, (first + i) % n, reach)), 0.0f, half, ink);
    }
    way = direction(p[(first + segments - 1) % n], end, &length);
    put_sides(strip, end, normal(way), 0.0f, half, ink);
    put_sides(strip + 2, beyond(end, way, reach), normal(way), reach, half, ink);
    end_strip(batch, 0);
}

/* Draws a closed line with mitred joints only. */
static void put_loop(struct gm_batch *batch, const struct gm_polyline *line, float half, struct rgba ink)
{
    const float reach = half + fringe;
    struct gm_vertex *strip = add_strip(batch, 2 * (line->count + 1));
    if (!strip) {
        return;
    }
    for (size_t i = 0; i <= line->count; i++) {
        const size_t k = i % line->count;
        put_sides(strip + 2 * i, line->points[k], mitre(joint_at(line, k, reach)), 0.0f, half, ink);
    }
    end_strip(batch, 0);
}

static void put_disc(struct gm_batch *batch, struct gm_point centre, float radius, struct rgba ink)
{
    struct gm_vertex corners[4];
    const float reach = radius + fringe;
    for (int i = 0; i < 4; i++) {
        const float x = i % 2 == 0 ? -reach : reach, y = i < 2 ? -reach : reach;
        corners[i] = vertex((struct gm_point){centre.x + x, centre.y + y}, x, y, radius, ink);
    }
    add_quad(batch, corners);
}

/* Draws a line of half width `half` with round joints and ends. */
static void put_line(struct gm_batch *batch, const struct gm_polyline *line, float half, struct rgba ink)
{
    const float reach = half + fringe;
    const size_t n = line->count;
    if (n == 0) {
        return;
    }
    if (n == 1) {
        put_disc(batch, line->points[0], half, ink);
        return;
    }
    size_t first = 0, segments = n - 1;
    if (line->closed) {
        while (first < n && joint_at(line, first, reach).mitred) {
            first++;
        }
        if (first == n && n > 2) {
            put_loop(batch, line, half, ink);
            return;
        }
        segments = n;
    }
    size_t begin = 0;
    for (size_t i = 1; i <= segments; i++) {
        if (i == segments || !joint_at(line, (first + i) % n, reach).mitred) {
            put_run(batch, line, first + begin, i - begin, half, ink);
            begin = i;
        }
    }
}

/* Draws an upright rectangle with sharp edges. */
static void put_box(struct gm_batch *batch, float left, float top, float right, float bottom, struct rgba ink)
{
    struct gm_vertex corners[4];
    for (int i = 0; i < 4; i++) {
        corners[i] =
            vertex((struct gm_point){i % 2 == 0 ? left : right, i < 2 ? top : bottom}, 0.0f, 0.0f, 1.0f, ink);
    }
    add_quad(batch, corners);
}

/* Returns true if all turns have one sign and add up to one round, so that x rises and falls once. */
static bool convex(const struct gm_polyline *line)
{
    const size_t n = line->count;
    const struct gm_point *p = line->points;
    bool left = false, right = false;
    int reversals = 0;
    struct gm_point before = gm_point_minus(p[0], p[n - 1]);
    for (size_t i = 0; i < n; i++) {
        const struct gm_point after = gm_point_minus(p[(i + 1) % n], p[i]);
        const float turn = before.x * after.y - before.y * after.x;
        left |= turn > 0.0f;
        right |= turn < 0.0f;
        reversals += (before.x < 0.0f) != (after.x < 0.0f);
        if ((left && right) || reversals > 2) {
            return false;
        }
        before = after;
    }
    return left || right;
}

static float area_of(const struct gm_polyline *line)
{
    float area = 0.0f;
    for (size_t i = 0; i < line->count; i++) {
        const struct gm_point p = gm_point_minus(line->points[i], line->points[0]);
        const struct gm_point q = gm_point_minus(line->points[(i + 1) % line->count], line->points[0]);
        area += 0.5f * (p.x * q.y - p.y * q.x);
    }
    return area;
}

static float perimeter_of(const struct gm_polyline *line)
{
    struct gm_polyline closed = *line;
    closed.closed = true;
    return gm_polyline_length(&closed);
}

/* Returns corner i in the order 0, 1, n-1, 2, n-2, ...: as a strip they cover a convex polygon once, and the
   inside of any polygon an odd number of times. */
static size_t zigzag(size_t i, size_t n)
{
    return i == 0 ? 0 : i % 2 == 1 ? (i + 1) / 2 : n - i / 2;
}

/* Returns a corner moved along the bisector by `distance` from both of its sides. */
static struct gm_point shifted(const struct gm_polyline *line, size_t i, float distance)
{
    const struct joint joint = joint_at(line, i, 0.0f);
    const struct gm_point a = normal(joint.before), b = normal(joint.after);
    const float scale = distance / fmaxf(0.25f, 1.0f + gm_point_dot(a, b));
    return (struct gm_point){line->points[i].x + scale * (a.x + b.x),
                             line->points[i].y + scale * (a.y + b.y)};
}

/* The inside of a polygon whose corners are moved inwards. */
static void put_polygon(struct gm_batch *batch, const struct gm_polyline *line, float inwards, float half,
                        struct rgba ink)
{
    const size_t n = line->count;
    struct gm_vertex *strip = add_strip(batch, n);
    if (!strip) {
        return;
    }
    for (size_t i = 0; i < n; i++) {
        const size_t k = zigzag(i, n);
        strip[i] =
            vertex(inwards == 0.0f ? line->points[k] : shifted(line, k, inwards), 0.0f, 0.0f, half, ink);
    }
    end_strip(batch, 0);
}

static void fill_convex(struct gm_batch *batch, const struct gm_polyline *line, float outwards,
                        struct rgba ink)
{
    /* The fading rim comes first, a ring of corners half a pixel inside and outside; then the inside. */
    const size_t n = line->count;
    struct gm_vertex *ring = add_strip(batch, 2 * (n + 1));
    if (!ring) {
        return;
    }
    for (size_t i = 0; i <= n; i++) {
        const size_t k = i % n;
        ring[2 * i] = vertex(shifted(line, k, -0.5f * outwards), 0.0f, 0.0f, 0.5f, ink);
        ring[2 * i + 1] = vertex(shifted(line, k, 0.5f * outwards), 1.0f, 0.0f, 0.5f, ink);
    }
    end_strip(batch, 0);
    put_polygon(batch, line, -0.5f * outwards, 0.5f, ink);
}

static void fill_any(struct gm_batch *batch, const struct gm_polyline *line, struct rgba ink)
{
    struct gm_polyline rim = *line;
    struct gm_bounds bounds = {line->points[0].x, line->points[0].y, line->points[0].x, line->points[0].y};
    for (size_t i = 1; i < line->count; i++) {
        bounds.left = fminf(bounds.left, line->points[i].x);
        bounds.right = fmaxf(bounds.right, line->points[i].x);
        bounds.top = fminf(bounds.top, line->points[i].y);
        bounds.bottom = fmaxf(bounds.bottom, line->points[i].y);
    }
    set_state(batch, GM_PROGRAM_INK, GM_STENCIL_INVERT);
    put_polygon(batch, line, 0.0f, 1.0f, ink);
    set_state(batch, GM_PROGRAM_INK, GM_STENCIL_OUTSIDE);
    rim.closed = true;
    put_line(batch, &rim, 0.0f, ink);
    set_state(batch, GM_PROGRAM_INK, GM_STENCIL_INSIDE);
    put_box(batch, bounds.left - 1.0f, bounds.top - 1.0f, bounds.right + 1.0f, bounds.bottom + 1.0f, ink);
    set_state(batch, GM_PROGRAM_INK, GM_STENCIL_NONE);
}

/* Fills the inside of a closed line (even-odd). Convex polygons have fading edges; the others are painted
   through the stencil. */
static void fill_polygon(struct gm_batch *batch, const struct gm_polyline *line, struct rgba ink)
{
    if (line->count < 3) {
        return;
    }
    const float area = area_of(line);
    /* Half a pixel inwards is beyond the middle of a thin polygon. */
    const bool thick = fabsf(area) > 2.0f * perimeter_of(line);
    if (convex(line) && thick) {
        fill_convex(batch, line, area > 0.0f ? -1.0f : 1.0f, ink);
    } else if (convex(line)) {
        put_polygon(batch, line, 0.0f, 1.0f, ink);
    } else {
        fill_any(batch, line, ink);
    }
}

/* ---- the pen ---- */

static void clip(void *self, int left, int top, int width, int height)
{
    memcpy(((struct gm_brush *)self)->batch.scissor, (const int[]){left, top, width, height}, sizeof(int[4]));
}

static void box(void *self, float left, float top, float right, float bottom, struct gm_ink ink)
{
    set_state(&((struct gm_brush *)self)->batch, GM_PROGRAM_INK, GM_STENCIL_NONE);
    put_box(&((struct gm_brush *)self)->batch, left, top, right, bottom, rgba_of(ink, 1.0));
}

static void draw_line(struct gm_brush *brush, const struct gm_polyline *line, const struct gm_stroke *stroke,
                      float half, struct rgba ink)
{
    struct gm_dashing state = {0};
    if (stroke->parts == 0) {
        put_line(&brush->batch, line, half, ink);
        return;
    }
    while (gm_polyline_dash(line, stroke->pattern, stroke->parts, &state, &brush->dash)) {
        put_line(&brush->batch, &brush->dash, half, ink);
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
    const struct rgba ink = rgba_of(stroke->ink, fminf(stroke->width, 1.0f));
    const bool has_whole_pixels = half > 0.75f;
    if (ink.colour[3] < 255 && has_whole_pixels && count_breaks(line, half) > 0) {
        brush->batch.once++;
        set_state(&brush->batch, GM_PROGRAM_CORE, GM_STENCIL_ONCE);
        draw_line(brush, line, stroke, half, ink);
        set_state(&brush->batch, GM_PROGRAM_INK, GM_STENCIL_ONCE);
        draw_line(brush, line, stroke, half, ink);
    } else {
        set_state(&brush->batch, GM_PROGRAM_INK, GM_STENCIL_NONE);
        draw_line(brush, line, stroke, half, ink);
    }
}

static void disc(void *self, struct gm_point centre, float width, struct gm_ink ink)
{
    set_state(&((struct gm_brush *)self)->batch, GM_PROGRAM_INK, GM_STENCIL_NONE);
    put_disc(&((struct gm_brush *)self)->batch, centre, 0.5f * fmaxf(width, 1.0f),
             rgba_of(ink, fminf(width * width, 1.0f)));
}

static void fill(void *self, const struct gm_polyline *line, struct gm_ink ink)
{
    set_state(&((struct gm_brush *)self)->batch, GM_PROGRAM_INK, GM_STENCIL_NONE);
    fill_polygon(&((struct gm_brush *)self)->batch, line, rgba_of(ink, 1.0));
}

static void put_letter(struct gm_batch *batch, bool upwards, double x, double y,
                       const struct gm_letter *letter, struct rgba ink)
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
    add_quad(batch, corners);
}

/* Baselines are on whole pixels, letters along them at quarters of a pixel. */
static void text(void *self, const struct gm_writing *writing, const char *text)
{
    struct gm_brush *brush = self;
    const double x = writing->upwards ? floor(writing->x + 0.5) : floor(writing->x);
    const double y = writing->upwards ? ceil(writing->y) : floor(writing->y + 0.5);
    double pen = writing->upwards ? y - writing->y : writing->x - x;
    struct gm_letter letter;
    set_state(&brush->batch, GM_PROGRAM_TEXT, GM_STENCIL_NONE);
    while (gm_glyphs_next(brush->glyphs, writing->font, writing->letters, &text, &pen, &letter)) {
        if (letter.width > 0) {
            put_letter(&brush->batch, writing->upwards, x, y, &letter, rgba_of(writing->ink, 1.0));
        }
    }
}

/* ---- meshes, images and colour bars: values are interpolated before they become colours ---- */

static struct gm_vertex field_vertex(double x, double y, double across, double along, double alpha,
                                     enum gm_colour_map map)
{
    const uint8_t row = map == GM_MAP_SEQUENTIAL ? 0 : 255;
    return (struct gm_vertex){(float)x,     (float)y,     (float)across,
                              (float)along, (float)alpha, {row, 255, 255, 255}};
}

static void paint_mesh(struct gm_brush *brush, const struct gm_axes *axes, const struct gm_mark *mark)
{
    uint32_t *indices;
    set_state(&brush->batch, GM_PROGRAM_FIELD, GM_STENCIL_NONE);
    struct gm_vertex *vertices = add_mesh(&brush->batch, mark->count, 3 * mark->triangle_count, &indices);
    if (!vertices) {
        return;
    }
    const size_t first = (size_t)(vertices - brush->batch.vertices);
    const double factor = 1.0 / (mark->high - mark->low);
    for (size_t i = 0; i < mark->count; i++) {
        vertices[i] =
            field_vertex(gm_axes_x(axes, mark->points[2 * i]), gm_axes_y(axes, mark->points[2 * i + 1]),
                         factor * (mark->values[i] - mark->low), 0.0, mark->style.alpha, mark->map);
        if (mark->light) {
            memset(vertices[i].colour + 1, (int)(255 * mark->light[i] + 0.5), 3);
        }
    }
    for (size_t i = 0; i < 3 * mark->triangle_count; i++) {
        indices[i] = (uint32_t)(first + (size_t)mark->triangles[i]);
    }
}

static void ramp(void *self, struct gm_box box, enum gm_colour_map map)
{
    struct gm_brush *brush = self;
    set_state(&brush->batch, GM_PROGRAM_FIELD, GM_STENCIL_NONE);
    const double right = box.x + box.width, bottom = box.y + box.height;
    add_quad(&brush->batch, (struct gm_vertex[4]){field_vertex(box.x, box.y, 1.0, 0.0, 1.0, map),
                                                  field_vertex(right, box.y, 1.0, 0.0, 1.0, map),
                                                  field_vertex(box.x, bottom, 0.0, 0.0, 1.0, map),
                                                  field_vertex(right, bottom, 0.0, 0.0, 1.0, map)});
    set_state(&brush->batch, GM_PROGRAM_INK, GM_STENCIL_NONE);
}

static void paint_image(struct gm_brush *brush, const struct gm_axes *axes, const struct gm_mark *mark)
{
    const double left = gm_axes_x(axes, mark->points[0]), right = gm_axes_x(axes, mark->points[2]);
    const double bottom = gm_axes_y(axes, mark->points[1]), top = gm_axes_y(axes, mark->points[3]);
    const double alpha = mark->style.alpha;
    set_state(&brush->batch, GM_PROGRAM_IMAGE, GM_STENCIL_NONE);
    brush->batch.image = mark;
    add_quad(&brush->batch, (struct gm_vertex[4]){field_vertex(left, bottom, 0.0, 0.0, alpha, mark->map),
                                                  field_vertex(right, bottom, 1.0, 0.0, alpha, mark->map),
                                                  field_vertex(left, top, 0.0, 1.0, alpha, mark->map),
                                                  field_vertex(right, top, 1.0, 1.0, alpha, mark->map)});
    brush->batch.image = NULL;
    set_state(&brush->batch, GM_PROGRAM_INK, GM_STENCIL_NONE);
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
