/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Polylines in pixels: cut to the frame, simplified, dashed. */
#include "render/drawing/pen.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "render/grow.h"

bool gm_polyline_reserve(struct gm_polyline *line, size_t count)
{
    line->count = 0;
    return gm_grow(&line->points, &line->capacity, count, sizeof *line->points);
}

void gm_polyline_free(struct gm_polyline *line)
{
    free(line->points);
    *line = (struct gm_polyline){0};
}

static bool inside(struct gm_bounds bounds, struct gm_point p)
{
    return p.x >= bounds.left && p.x <= bounds.right && p.y >= bounds.top && p.y <= bounds.bottom;
}

/* Narrows the part [*enter, *leave] of a segment to those t with start + t * step in [low, high]. */
static bool narrow(float start, float step, float low, float high, float *enter, float *leave)
{
    if (step == 0.0f) {
        return start >= low && start <= high;
    }
    const float a = (low - start) / step, b = (high - start) / step;
    *enter = fmaxf(*enter, fminf(a, b));
    *leave = fminf(*leave, fmaxf(a, b));
    return *enter <= *leave;
}

static struct gm_point along(struct gm_point p, struct gm_point q, float t)
{
    return t <= 0.0f ? p : t >= 1.0f ? q : (struct gm_point){p.x + t * (q.x - p.x), p.y + t * (q.y - p.y)};
}

bool gm_polyline_clip(const struct gm_polyline *line, struct gm_bounds bounds, size_t *from,
                      struct gm_polyline *piece)
{
    const size_t segments = line->count == 0 ? 0 : line->closed ? line->count : line->count - 1;
    if (*from > segments || line->count == 0 || !gm_polyline_reserve(piece, line->count + 1)) {
        return false;
    }
    piece->closed = false;
    if (*from == 0) {
        bool whole = true;
        for (size_t i = 0; i < line->count && whole; i++) {
            whole = inside(bounds, line->points[i]);
        }
        if (whole) {
            memcpy(piece->points, line->points, line->count * sizeof *line->points);
            piece->count = line->count;
            piece->closed = line->closed;
            *from = segments + 1;
            return true;
        }
    }
    size_t i = *from;
    for (; i < segments; i++) {
        const struct gm_point p = line->points[i], q = line->points[(i + 1) % line->count];
        float enter = 0.0f, leave = 1.0f;
        const bool seen = narrow(p.x, q.x - p.x, bounds.left, bounds.right, &enter, &leave) &&
                          narrow(p.y, q.y - p.y, bounds.top, bounds.bottom, &enter, &leave);
        if (!seen && piece->count > 0) {
            break;
        }
        if (!seen) {
            continue;
        }
        if (piece->count == 0) {
            piece->points[piece->count++] = along(p, q, enter);
        }
        piece->points[piece->count++] = along(p, q, leave);
        if (leave < 1.0f) {
            break;
        }
    }
    *from = i < segments ? i + 1 : segments + 1;
    return piece->count > 0;
}

static float cross(struct gm_point a, struct gm_point b)
{
    return a.x * b.y - a.y * b.x;
}

/* All lines from a kept point to later points must pass the points between within the tolerance: they lie in
   a wedge that every point narrows. A point outside the wedge, or nearer than the one before, ends it. */
void gm_polyline_simplify(struct gm_polyline *line, float tolerance)
{
    struct gm_point *points = line->points;
    if (line->count < 3) {
        return;
    }
    size_t kept = 1;
    struct gm_point anchor = points[0], last = points[0];
    struct gm_point left = {0}, right = {0}; /* the wedge's sides, once it exists */
    float reach = 0.0f;                      /* square of the distance from the anchor to `last` */
    bool wedge = false;
    for (size_t i = 1; i < line->count; i++) {
        const struct gm_point point = points[i];
        struct gm_point way = gm_point_minus(point, anchor);
        float square = gm_point_dot(way, way);
        const bool outside = wedge && (cross(left, way) > 0.0f || cross(right, way) < 0.0f || square < reach);
        if (outside) {
            points[kept++] = anchor = last;
            way = gm_point_minus(point, anchor);
            square = gm_point_dot(way, way);
            wedge = false;
        }
        if (square > tolerance * tolerance) {
            /* The tangents from the anchor to the circle of the tolerance round the point. */
            const float near = sqrtf(square - tolerance * tolerance);
            const struct gm_point l = {way.x * near - way.y * tolerance, way.y * near + way.x * tolerance};
            const struct gm_point r = {way.x * near + way.y * tolerance, way.y * near - way.x * tolerance};
            if (!wedge || cross(left, l) < 0.0f) {
                left = l;
            }
            if (!wedge || cross(right, r) > 0.0f) {
                right = r;
            }
            wedge = true;
        }
        last = point;
        reach = square;
    }
    points[kept++] = last;
    line->count = kept;
}

static float distance(struct gm_point a, struct gm_point b)
{
    return sqrtf(gm_point_dot(gm_point_minus(a, b), gm_point_minus(a, b)));
}

static size_t segments_of(const struct gm_polyline *line)
{
    return line->count < 2 ? 0 : line->closed ? line->count : line->count - 1;
}

float gm_polyline_length(const struct gm_polyline *line)
{
    float length = 0.0f;
    for (size_t i = 0; i < segments_of(line); i++) {
        length += distance(line->points[i], line->points[(i + 1) % line->count]);
    }
    return length;
}

bool gm_polyline_dash(const struct gm_polyline *line, const float *pattern, size_t parts,
                      struct gm_dashing *state, struct gm_polyline *dash)
{
    const size_t segments = segments_of(line);
    if (!gm_polyline_reserve(dash, line->count + 2)) {
        return false;
    }
    dash->closed = false;
    while (state->segment < segments) {
        const bool drawn = state->part % 2 == 0;
        float left = pattern[state->part];
        dash->count = 0;
        for (; state->segment < segments; state->segment++, state->within = 0.0f) {
            const struct gm_point p = line->points[state->segment];
            const struct gm_point q = line->points[(state->segment + 1) % line->count];
            const float length = distance(p, q);
            if (length == 0.0f) {
                continue;
            }
            if (drawn && dash->count == 0) {
                dash->points[dash->count++] = along(p, q, state->within / length);
            }
            const float rest = length - state->within;
            const bool ends = rest > left;
            state->within = ends ? state->within + left : length;
            left -= ends ? left : rest;
            if (drawn) {
                dash->points[dash->count++] = along(p, q, state->within / length);
            }
            if (ends) {
                break;
            }
        }
        state->part = (state->part + 1) % parts;
        if (drawn && dash->count > 0) {
            return true;
        }
    }
    return false;
}
