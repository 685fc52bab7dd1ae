/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A picture's memory, and its panels and marks. */
#include "render/picture/picture.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { FIRST_CHUNK = 1 << 16, ALIGNMENT = 32 };

struct chunk {
    struct chunk *next;
    size_t size, used;
    unsigned char *bytes;
};

struct gm_picture_store {
    struct chunk *chunk;       /* the newest chunk; the others are full */
    size_t total;              /* bytes of all chunks */
    jmp_buf *leave;            /* the end of the body that draws; NULL outside of one */
    struct gm_mark spare_mark; /* the result if nothing is drawn; it is never read */
};

enum gm_role gm_lane_role(size_t lane)
{
    return (enum gm_role)(GM_LANE + (int)(lane % GM_LANE_COLOURS));
}

enum gm_dash gm_lane_dash(size_t lane)
{
    return (enum gm_dash)(lane % GM_DASH_COUNT);
}

static struct chunk *chunk_open(size_t size, struct chunk *next)
{
    struct chunk *chunk = malloc(sizeof *chunk);
    if (!chunk) {
        return NULL;
    }
    *chunk = (struct chunk){.next = next, .size = size, .bytes = aligned_alloc(ALIGNMENT, size)};
    if (!chunk->bytes) {
        free(chunk);
        return NULL;
    }
    return chunk;
}

static void chunks_close(struct chunk *chunk)
{
    while (chunk) {
        struct chunk *next = chunk->next;
        free(chunk->bytes);
        free(chunk);
        chunk = next;
    }
}

static void picture_reset(struct gm_picture *picture)
{
    struct gm_picture_store *arena = picture->arena;
    *picture = (struct gm_picture){.title = "", .subtitle = "", .clock = "", .caption = "", .arena = arena};
}

struct gm_picture *gm_picture_open(void)
{
    struct gm_picture *picture = malloc(sizeof *picture);
    struct gm_picture_store *arena = calloc(1, sizeof *arena);
    if (!picture || !arena) {
        free(picture);
        free(arena);
        return NULL;
    }
    picture->arena = arena;
    picture_reset(picture);
    return picture;
}

void gm_picture_close(struct gm_picture *picture)
{
    if (!picture) {
        return;
    }
    chunks_close(picture->arena->chunk);
    free(picture->arena);
    free(picture);
}

void gm_picture_clear(struct gm_picture *picture)
{
    struct gm_picture_store *arena = picture->arena;
    /* Several chunks become one, so that frames of one kind soon allocate nothing. */
    if (arena->chunk && arena->chunk->next) {
        chunks_close(arena->chunk);
        arena->chunk = chunk_open(arena->total, NULL);
        if (!arena->chunk) {
            arena->total = 0;
        }
    }
    if (arena->chunk) {
        arena->chunk->used = 0;
    }
    picture_reset(picture);
}

bool gm_picture_draw(struct gm_picture *picture, void (*draw)(const void *data, struct gm_picture *picture),
                     const void *data)
{
    struct gm_picture_store *arena = picture->arena;
    jmp_buf *const outer = arena->leave, leave;
    const bool drawn = setjmp(leave) == 0;
    if (drawn) {
        arena->leave = &leave;
        draw(data, picture);
    }
    arena->leave = outer;
    return drawn;
}

/* Leaves the body that draws. */
static void *short_of_memory(struct gm_picture_store *arena)
{
    if (arena->leave) {
        longjmp(*arena->leave, 1);
    }
    return NULL;
}

void *gm_picture_memory(struct gm_picture *picture, size_t size)
{
    struct gm_picture_store *arena = picture->arena;
    if (size > SIZE_MAX / 4) {
        return short_of_memory(arena);
    }
    size = (size + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT;
    struct chunk *chunk = arena->chunk;
    if (!chunk || chunk->size - chunk->used < size) {
        size_t wanted = arena->total > FIRST_CHUNK ? arena->total : FIRST_CHUNK;
        chunk = chunk_open(wanted > size ? wanted : size, arena->chunk);
        if (!chunk) {
            return short_of_memory(arena);
        }
        arena->chunk = chunk;
        arena->total += chunk->size;
    }
    void *memory = chunk->bytes + chunk->used;
    chunk->used += size;
    return memory;
}

static void *memory_of(struct gm_picture *picture, size_t count, size_t size)
{
    return gm_picture_memory(picture, count > SIZE_MAX / 4 / size ? SIZE_MAX : count * size);
}

const char *gm_picture_text(struct gm_picture *picture, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    const int length = vsnprintf(NULL, 0, format, arguments);
    va_end(arguments);
    char *text = length < 0 ? NULL : gm_picture_memory(picture, (size_t)length + 1);
    if (!text) {
        return "";
    }
    va_start(arguments, format);
    vsnprintf(text, (size_t)length + 1, format, arguments);
    va_end(arguments);
    return text;
}

static const char *text_copy(struct gm_picture *picture, const char *text)
{
    return text ? gm_picture_text(picture, "%s", text) : "";
}

struct gm_panel *gm_panel_add(struct gm_picture *picture, enum gm_place place, const char *title)
{
    struct gm_panel *panel = gm_picture_memory(picture, sizeof *panel);
    *panel = (struct gm_panel){
        .place = place,
        .title = text_copy(picture, title),
        .note = "",
        .title_role = GM_INK,
        .x = {.label = "", .low = 0.0, .high = 1.0},
        .y = {.label = "", .low = 0.0, .high = 1.0},
        .axes = place == GM_PLACE_GRAPH,
        .colour_bar_label = "",
    };
    if (picture->last) {
        picture->last->next = panel;
    } else {
        picture->first = panel;
    }
    picture->last = panel;
    return panel;
}

static struct gm_mark *spare(struct gm_picture *picture)
{
    picture->arena->spare_mark = (struct gm_mark){.text = ""};
    return &picture->arena->spare_mark;
}

static struct gm_mark *mark_add(struct gm_picture *picture, struct gm_panel *panel, enum gm_mark_kind kind,
                                struct gm_style style)
{
    struct gm_mark *mark = gm_picture_memory(picture, sizeof *mark);
    *mark = (struct gm_mark){.kind = kind, .style = style, .text = ""};
    if (panel->last) {
        panel->last->next = mark;
    } else {
        panel->first = mark;
    }
    panel->last = mark;
    return mark;
}

void gm_marks_repeat(struct gm_picture *picture, struct gm_panel *panel, const struct gm_mark *first,
                     const struct gm_mark *last)
{
    for (const struct gm_mark *mark = first; mark; mark = mark == last ? NULL : mark->next) {
        struct gm_mark *copy = mark_add(picture, panel, mark->kind, mark->style);
        *copy = *mark;
        copy->next = NULL;
    }
}

bool gm_mark_is_shown(const struct gm_mark *mark, double width, double height)
{
    const double side = width < height ? width : height;
    return side >= mark->least && (mark->most == 0 || side < mark->most);
}

static bool drawable(const struct gm_axis *axis, double value)
{
    return isfinite(value) && (axis->scale != GM_LOG || value > 0.0);
}

static bool point_drawable(const struct gm_panel *panel, const double *point)
{
    return drawable(&panel->x, point[0]) && drawable(&panel->y, point[1]);
}

/* Copies the points that can be drawn. Returns their number. */
static size_t points_copy(const struct gm_panel *panel, double *to, const double *points, size_t count)
{
    size_t kept = 0;
    for (size_t i = 0; i < count; i++) {
        if (!point_drawable(panel, points + 2 * i)) {
            continue;
        }
        to[2 * kept] = points[2 * i];
        to[2 * kept + 1] = points[2 * i + 1];
        kept++;
    }
    return kept;
}

void gm_panel_key(struct gm_picture *picture, struct gm_panel *panel, struct gm_style style, const char *name)
{
    struct gm_key *key = gm_picture_memory(picture, sizeof *key);
    *key = (struct gm_key){.name = gm_picture_text(picture, "%s", name), .style = style};
    if (panel->last_key) {
        panel->last_key->next = key;
    } else {
        panel->first_key = key;
    }
    panel->last_key = key;
}

struct gm_mark *gm_mark_line(struct gm_picture *picture, struct gm_panel *panel, struct gm_style style,
                             const double *points, size_t count, bool closed)
{
    double *copy = memory_of(picture, count, 2 * sizeof *copy);
    if (count == 0) {
        return spare(picture);
    }

    /* A closed line with a gap becomes an open one that starts after the gap. */
    size_t start = 0;
    for (size_t i = 0; closed && i < count; i++) {
        if (!point_drawable(panel, points + 2 * i)) {
            start = i + 1;
            closed = false;
        }
    }
    struct gm_mark *first = NULL;
    size_t kept = 0, piece = 0; /* start of the current piece in the copy */
    for (size_t k = 0; k <= count; k++) {
        const double *point = points + 2 * ((start + k) % count);
        const bool good = k < count && point_drawable(panel, point);
        if (good) {
            copy[2 * kept] = point[0];
            copy[2 * kept + 1] = point[1];
            kept++;
        } else if (kept > piece) {
            struct gm_mark *mark = mark_add(picture, panel, GM_MARK_LINE, style);
            mark->points = copy + 2 * piece;
            mark->count = kept - piece;
            mark->closed = closed;
            first = first ? first : mark;
            piece = kept;
        }
    }
    return first ? first : spare(picture);
}

static struct gm_mark *mark_of_points(struct gm_picture *picture, struct gm_panel *panel,
                                      enum gm_mark_kind kind, struct gm_style style, const double *points,
                                      size_t count)
{
    double *copy = memory_of(picture, count, 2 * sizeof *copy);
    const size_t kept = points_copy(panel, copy, points, count);
    if (kept == 0) {
        return spare(picture);
    }
    struct gm_mark *mark = mark_add(picture, panel, kind, style);
    mark->points = copy;
    mark->count = kept;
    return mark;
}

struct gm_mark *gm_mark_points(struct gm_picture *picture, struct gm_panel *panel, struct gm_style style,
                               const double *points, size_t count)
{
    return mark_of_points(picture, panel, GM_MARK_POINTS, style, points, count);
}

struct gm_mark *gm_mark_polygon(struct gm_picture *picture, struct gm_panel *panel, struct gm_style style,
                                const double *points, size_t count)
{
    struct gm_mark *mark = mark_of_points(picture, panel, GM_MARK_POLYGON, style, points, count);
    mark->closed = true;
    return mark;
}

struct gm_mark *gm_mark_text(struct gm_picture *picture, struct gm_panel *panel, struct gm_style style,
                             double x, double y, enum gm_anchor anchor, const char *text)
{
    struct gm_mark *mark = mark_of_points(picture, panel, GM_MARK_TEXT, style, (const double[]){x, y}, 1);
    mark->anchor = anchor;
    mark->text = text_copy(picture, text);
    return mark;
}

static void mark_set_map(struct gm_mark *mark, enum gm_colour_map map, double low, double high)
{
    mark->map = map;
    mark->low = isfinite(low) ? low : 0.0;
    mark->high = isfinite(high) && high > mark->low ? high : mark->low + fmax(1.0, fabs(mark->low));
}

static const struct gm_style opaque = {.role = GM_INK, .alpha = 1.0, .width = 1.0};

/* Notes if a value lies beyond the range of the colours. */
static void mark_reach(struct gm_mark *mark, double value)
{
    const double slack = 0.01 * (mark->high - mark->low);
    mark->below = mark->below || value < mark->low - slack;
    mark->above = mark->above || value > mark->high + slack;
}

struct gm_mark *gm_mark_mesh(struct gm_picture *picture, struct gm_panel *panel, enum gm_colour_map map,
                             double low, double high, const double *points, const double *values,
                             size_t count, const int *triangles, size_t triangle_count)
{
    double *places = memory_of(picture, count, 2 * sizeof *places);
    double *heights = memory_of(picture, count, sizeof *heights);
    int *corners = memory_of(picture, triangle_count, 3 * sizeof *corners);
    struct gm_mark *mark = mark_add(picture, panel, GM_MARK_MESH, opaque);
    mark_set_map(mark, map, low, high);

    size_t kept = 0;
    for (size_t t = 0; t < triangle_count; t++) {
        const int *triangle = triangles + 3 * t;
        bool good = true;
        for (int k = 0; k < 3 && good; k++) {
            const int v = triangle[k];
            good =
                v >= 0 && (size_t)v < count && point_drawable(panel, points + 2 * v) && isfinite(values[v]);
        }
        if (good) {
            memcpy(corners + 3 * kept++, triangle, 3 * sizeof *corners);
        }
    }
    for (size_t i = 0; i < count; i++) {
        const bool good = point_drawable(panel, points + 2 * i);
        places[2 * i] = good ? points[2 * i] : panel->x.low;
        places[2 * i + 1] = good ? points[2 * i + 1] : panel->y.low;
        heights[i] = isfinite(values[i]) ? values[i] : mark->low;
        mark_reach(mark, heights[i]);
    }
    mark->points = places;
    mark->values = heights;
    mark->count = count;
    mark->triangles = corners;
    mark->triangle_count = kept;
    return mark;
}

struct gm_mark *gm_mark_image(struct gm_picture *picture, struct gm_panel *panel, enum gm_colour_map map,
                              double low, double high, const double corners[4], const double *values,
                              size_t rows, size_t columns)
{
    const size_t count = columns > 0 && rows > SIZE_MAX / columns ? SIZE_MAX : rows * columns;
    double *copy = memory_of(picture, count, sizeof *copy);
    double *places = gm_picture_memory(picture, 4 * sizeof *places);
    if (count == 0 || points_copy(panel, places, corners, 2) != 2) {
        return spare(picture);
    }
    struct gm_mark *mark = mark_add(picture, panel, GM_MARK_IMAGE, opaque);
    mark_set_map(mark, map, low, high);
    for (size_t i = 0; i < count; i++) {
        copy[i] = isfinite(values[i]) ? values[i] : mark->low;
        mark_reach(mark, copy[i]);
    }
    mark->points = places;
    mark->count = 2;
    mark->values = copy;
    mark->rows = rows;
    mark->columns = columns;
    return mark;
}

/* ---- ranges of axes: widened by values, then rounded ---- */

#define PI 3.14159265358979323846

void gm_range_add(double *low, double *high, double value)
{
    if (!isfinite(value)) {
        return;
    }
    if (*low > *high) {
        *low = *high = value;
        return;
    }
    *low = fmin(*low, value);
    *high = fmax(*high, value);
}

/* Returns the smallest of 1, 2, 5 times a power of ten that is not below value > 0. */
static double round_up(double value)
{
    const double power = pow(10.0, floor(log10(value)));
    const double mantissa = value / power;
    const double rounding = 1.0 + 1e-9;
    return power * (mantissa <= rounding         ? 1.0
                    : mantissa <= 2.0 * rounding ? 2.0
                    : mantissa <= 5.0 * rounding ? 5.0
                                                 : 10.0);
}

/* Widens to multiples of a round step of about a quarter of the range. If the wider range has the next larger
   step, this is repeated, so that rounding twice changes nothing. */
static void round_linear(double *low, double *high, double unit)
{
    if (*low == *high) {
        const double around = *low != 0.0 ? 0.1 * fabs(*low) : 1.0;
        *low -= around;
        *high += around;
    }
    const double from = *low / unit, to = *high / unit;
    double a = from, b = to;
    for (int pass = 0; pass < 4; pass++) {
        const double step = round_up((b - a) / 4.0);
        const double next_a = step * floor(from / step + 1e-9), next_b = step * ceil(to / step - 1e-9);
        if (!isfinite(next_a) || !isfinite(next_b) || (next_a == a && next_b == b)) {
            break;
        }
        a = next_a;
        b = next_b;
    }
    *low = fmin(*low, a * unit);
    *high = fmax(*high, b * unit);
}

/* Widens to 1, 2, 5 times powers of ten up to two decades, to whole decades beyond. */
static void round_log(double *low, double *high)
{
    if (!(*low > 0.0)) {
        *low = *high > 0.0 ? *high / 10.0 : 0.1;
        *high = *high > 0.0 ? *high : 1.0;
    }
    if (*low == *high) {
        *low /= 2.0;
        *high *= 2.0;
    }
    if (log10(*high / *low) <= 2.0) {
        *high = fmax(*high, round_up(*high));
        /* The largest round value not above low is the inverse of the smallest not below its inverse. */
        *low = fmin(*low, 1.0 / round_up(1.0 / *low));
    } else {
        *low = fmin(*low, pow(10.0, floor(log10(*low) + 1e-9)));
        *high = fmax(*high, pow(10.0, ceil(log10(*high) - 1e-9)));
    }
}

void gm_range_round(double *low, double *high, enum gm_scale scale)
{
    if (!(*low <= *high) || !isfinite(*low) || !isfinite(*high)) {
        *low = scale == GM_LOG ? 0.1 : 0.0;
        *high = 1.0;
        return;
    }
    if (scale == GM_LOG) {
        round_log(low, high);
    } else {
        round_linear(low, high, scale == GM_PI ? PI : 1.0);
    }
}
