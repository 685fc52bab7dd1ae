/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Level lines of a linear function on triangles. A level that crosses a triangle gives one segment, from one
   of its edges to another. Segments that share an edge are joined, so that a painter gets whole lines (joined
   smoothly, dashed along their length). "Above" includes the level itself, so that a level through a vertex
   still crosses two edges of a triangle or none. */
#include "render/picture/picture.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

enum { NONE = -1 };

struct crossing { /* a crossing of an edge of the mesh by the level */
    int from, to; /* the edge's vertices, from < to; from = NONE: a free entry */
    int segments[2];
};

struct segment {
    size_t ends[2]; /* indices of crossings in the table */
    bool used;
};

struct level {
    const double *points, *values;
    double value;
    struct crossing *table; /* open addressing; the size is a power of two */
    size_t table_size;
    struct segment *segments;
    size_t segment_count;
};

static bool above(const struct level *level, int vertex)
{
    return level->values[vertex] >= level->value;
}

static bool usable(const double *points, const double *values, size_t count, const int *triangle)
{
    for (int k = 0; k < 3; k++) {
        const int v = triangle[k];
        if (v < 0 || (size_t)v >= count || !isfinite(values[v]) || !isfinite(points[2 * v]) ||
            !isfinite(points[2 * v + 1])) {
            return false;
        }
    }
    return true;
}

static size_t crossing_find(const struct level *level, int from, int to)
{
    if (from > to) {
        const int swap = from;
        from = to;
        to = swap;
    }
    uint64_t hash = ((uint64_t)(uint32_t)from << 32 | (uint32_t)to) * UINT64_C(0x9e3779b97f4a7c15);
    size_t place = (size_t)(hash >> 32) & (level->table_size - 1);
    struct crossing *table = level->table;
    while (table[place].from != NONE && (table[place].from != from || table[place].to != to)) {
        place = (place + 1) & (level->table_size - 1);
    }
    if (table[place].from == NONE) {
        table[place] = (struct crossing){from, to, {NONE, NONE}};
    }
    return place;
}

static void segment_add(struct level *level, const int *triangle)
{
    /* The odd vertex: both edges from it cross the level. */
    const bool sides[3] = {above(level, triangle[0]), above(level, triangle[1]), above(level, triangle[2])};
    const int odd = sides[1] == sides[2] ? 0 : sides[0] == sides[2] ? 1 : 2;
    struct segment *segment = &level->segments[level->segment_count];
    *segment = (struct segment){.used = false};
    for (int k = 0; k < 2; k++) {
        segment->ends[k] = crossing_find(level, triangle[odd], triangle[(odd + 1 + k) % 3]);
        int *slots = level->table[segment->ends[k]].segments;
        if (slots[0] == NONE) {
            slots[0] = (int)level->segment_count;
        } else if (slots[1] == NONE) { /* an edge of more than two triangles: the line ends there */
            slots[1] = (int)level->segment_count;
        }
    }
    level->segment_count++;
}

static void crossing_point(const struct level *level, const struct crossing *crossing, double *point)
{
    const double a = level->values[crossing->from], b = level->values[crossing->to];
    const double share = (level->value - a) / (b - a);
    for (int k = 0; k < 2; k++) {
        const double p = level->points[2 * crossing->from + k], q = level->points[2 * crossing->to + k];
        point[k] = p + share * (q - p);
    }
}

static int next_segment(const struct level *level, size_t place)
{
    const int *slots = level->table[place].segments;
    for (int k = 0; k < 2; k++) {
        if (slots[k] != NONE && !level->segments[slots[k]].used) {
            return slots[k];
        }
    }
    return NONE;
}

/* Follows the line from a crossing on to *last. Returns its number of points; the last one equals the first
   on a closed line. */
static size_t follow(struct level *level, size_t place, double *line, size_t *last)
{
    size_t count = 0;
    for (;;) {
        double point[2];
        crossing_point(level, &level->table[place], point);
        if (count == 0 || point[0] != line[2 * count - 2] || point[1] != line[2 * count - 1]) {
            line[2 * count] = point[0];
            line[2 * count + 1] = point[1];
            count++;
        }
        const int next = next_segment(level, place);
        if (next == NONE) {
            break;
        }
        struct segment *segment = &level->segments[next];
        segment->used = true;
        place = segment->ends[segment->ends[0] == place ? 1 : 0];
    }
    *last = place;
    return count;
}

static void emit(struct gm_picture *picture, struct gm_panel *panel, struct gm_style style,
                 const double *line, size_t count, bool closed)
{
    if (closed && count > 1) {
        count--; /* the last point repeats the first */
    }
    if (count > 1) {
        gm_mark_line(picture, panel, style, line, count, closed && count > 2);
    }
}

static void level_draw(struct gm_picture *picture, struct gm_panel *panel, struct gm_style style,
                       struct level *level, double *line)
{
    size_t last;
    /* Lines with ends come first, so that the rest is closed. */
    for (size_t i = 0; i < level->table_size; i++) {
        const struct crossing *crossing = &level->table[i];
        if (crossing->from != NONE && crossing->segments[1] == NONE && next_segment(level, i) != NONE) {
            emit(picture, panel, style, line, follow(level, i, line, &last), false);
        }
    }
    for (size_t i = 0; i < level->segment_count; i++) {
        if (level->segments[i].used) {
            continue;
        }
        const size_t start = level->segments[i].ends[0];
        const size_t count = follow(level, start, line, &last);
        emit(picture, panel, style, line, count, last == start);
    }
}

/* The values on a triangle: a level with low < level <= high crosses it. */
struct span {
    double low, high;
};

static struct span span_of(const double *points, const double *values, size_t count, const int *triangle)
{
    if (!usable(points, values, count, triangle)) {
        return (struct span){INFINITY, -INFINITY};
    }
    const double a = values[triangle[0]], b = values[triangle[1]], c = values[triangle[2]];
    const double low = a < b ? a : b, high = a < b ? b : a;
    return (struct span){c < low ? c : low, c > high ? c : high};
}

static bool crosses(struct span span, double value)
{
    return (span.low < value) & (value <= span.high);
}

void gm_mark_level_lines(struct gm_picture *picture, struct gm_panel *panel, struct gm_style style,
                         const double *points, const double *values, size_t count, const int *triangles,
                         size_t triangle_count, const double *levels, size_t level_count)
{
    /* Vertices are far apart in memory, so they are visited once, not for every level. */
    struct span *spans = gm_picture_memory(picture, triangle_count * sizeof *spans);
    for (size_t t = 0; t < triangle_count; t++) {
        spans[t] = span_of(points, values, count, triangles + 3 * t);
    }
    /* Scratch memory for the level with most segments. */
    size_t most = 0;
    for (size_t l = 0; l < level_count; l++) {
        size_t crossed = 0;
        for (size_t t = 0; t < triangle_count; t++) {
            crossed += crosses(spans[t], levels[l]);
        }
        most = crossed > most ? crossed : most;
    }
    if (most == 0 || most > INT32_MAX / 8) {
        return;
    }
    size_t table_size = 16;
    while (table_size < 4 * most) {
        table_size *= 2;
    }
    struct crossing *table = gm_picture_memory(picture, table_size * sizeof *table);
    struct segment *segments = gm_picture_memory(picture, most * sizeof *segments);
    double *line = gm_picture_memory(picture, (most + 1) * 2 * sizeof *line);
    for (size_t l = 0; l < level_count; l++) {
        struct level level = {points, values, levels[l], table, table_size, segments, 0};
        for (size_t i = 0; i < table_size; i++) {
            table[i].from = NONE;
        }
        for (size_t t = 0; t < triangle_count; t++) {
            if (crosses(spans[t], levels[l])) {
                segment_add(&level, triangles + 3 * t);
            }
        }
        level_draw(picture, panel, style, &level, line);
    }
}
