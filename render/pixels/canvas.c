/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A picture as triangles of a batch, drawn by the program's own rasteriser or by OpenGL. */
#include "render/pixels/canvas.h"

#include <math.h>
#include <pthread.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#ifdef __x86_64__
#include <immintrin.h>
#endif

#include "render/address_space.h"
#include "render/drawing/pen.h"
#include "render/files/thread.h"
#include "render/gl/opengl.h"
#include "render/layout/panel.h"
#include "render/triangles/triangles.h"

/* ---- the rasteriser: triangles in memory, by OpenGL's rules, without a library, a driver or a lock ---- */

/* A triangle has the pixels whose middles lie in it, its corners are at multiples of 1/256 pixel, and pixels shared by
   two triangles are painted once. Edges of two triangles with the same ends are computed from these in the same order, so
   that no pixel between the two is left out. */

enum {
    MAPS = 2,
    SHADES = 16 * 255 + 1, /* shades of a map */
    RUN = 256,             /* pixels of a run, along which values are in single precision */
    MOST_SIDE = 16384,
};

struct rasteriser {
    int width, height;
    enum gm_theme theme;
    uint32_t *groups;  /* per pixel the last group of GM_STENCIL_ONCE, and a bit for the inside */
    uint32_t *colours; /* shades of both maps; made at the first use */
};

static const uint32_t inside = UINT32_C(1) << 31;

/* The destination and the state of a call's triangles. */
struct target {
    const struct rasteriser *rasteriser;
    const struct gm_draw_call *call;
    const struct gm_atlas *atlas;
    unsigned char *rgba;
    int width;
    int left, top, right, bottom; /* only these pixels may change */
    bool wholly;                  /* ink on wholly covered pixels alone */
    bool is_ink, plain;           /* plain: ink without a stencil */
    bool paired;                  /* triangles of a strip may be put as one polygon */
};

/* ---- four pixels at a time ---- */

enum { LANES = 4 };
typedef uint32_t pixels __attribute__((vector_size(16))); /* four bytes each, in any order */
typedef uint16_t halves __attribute__((vector_size(16)));
typedef int32_t choices __attribute__((vector_size(16))); /* -1: yes; 0: no */
typedef float reals __attribute__((vector_size(16)));

/* These functions are so short, and are called so often, that a call would cost as much as their work. */
#define INLINE static inline __attribute__((always_inline))

INLINE uint32_t pixel_of(const uint8_t bytes[4])
{
    uint32_t pixel;
    memcpy(&pixel, bytes, sizeof pixel);
    return pixel;
}

INLINE pixels load(const void *from)
{
    pixels values;
    memcpy(&values, from, sizeof values);
    return values;
}

/* Mixes two colours by alpha of 255, each byte rounded to the nearest; 0 and 255 keep one of them. */
INLINE pixels mixed(pixels under, pixels over, pixels alpha)
{
    const uint32_t low = 0x00ff00ff;
    const halves part = (halves)(alpha | alpha << 16), rest = 255 - part;
    halves even = (halves)(over & low) * part + (halves)(under & low) * rest + 128;
    halves odd = (halves)(over >> 8 & low) * part + (halves)(under >> 8 & low) * rest + 128;
    even = (even + (even >> 8)) >> 8;
    odd += odd >> 8;
    return (pixels)even | ((pixels)odd & ~low);
}

/* ---- polygons with values at their corners ---- */

struct corner {
    double x, y; /* relative to the middle of the first pixel */
    const struct gm_vertex *vertex;
};

/* A linear function: its value at the middle of the first pixel, and its change per pixel. */
struct ramp {
    double start, right, down;
};

/* A convex polygon: a triangle, or two of a strip that are convex together and whose values are one linear
   function. Most strips are strokes of a few pixels, and half as many polygons cost half as much. */
struct polygon {
    struct corner corner[4]; /* round it */
    int count;
    double area;   /* of the parallelogram of the first, second and last corner, with its sign */
    bool straight; /* along is 0: the body of a stroke, or a box */
};

struct ramps {
    struct ramp across, along, light; /* light of 255; a straight polygon needs only the first */
};

/* Rounds to 1/256: a double this large has no digits below that. */
INLINE double snapped(float place)
{
    const double large = 0x1.8p44;
    return ((double)place + large) - large - 0.5;
}

INLINE struct corner corner_of(const struct gm_vertex *vertex)
{
    return (struct corner){snapped(vertex->x), snapped(vertex->y), vertex};
}

/* The area of a parallelogram, above 0 if the way from a to b turns right, as seen, to c. */
INLINE double area_between(const struct corner *a, const struct corner *b, const struct corner *c)
{
    return (b->x - a->x) * (c->y - a->y) - (c->x - a->x) * (b->y - a->y);
}

/* Returns the ramp of a value that is a, b and c at the first, second and last corner. */
INLINE struct ramp ramp_through(const struct polygon *polygon, float a, float b, float c)
{
    const struct corner *p = &polygon->corner[0], *q = &polygon->corner[1],
                        *r = &polygon->corner[polygon->count - 1];
    const double first = ((double)b - (double)a) / polygon->area,
                 second = ((double)c - (double)a) / polygon->area;
    const double right = first * (r->y - p->y) - second * (q->y - p->y);
    const double down = second * (q->x - p->x) - first * (r->x - p->x);
    return (struct ramp){(double)a - right * p->x - down * p->y, right, down};
}

INLINE struct ramps ramps_of(const struct polygon *polygon)
{
    const struct gm_vertex *a = polygon->corner[0].vertex, *b = polygon->corner[1].vertex,
                           *c = polygon->corner[polygon->count - 1].vertex;
    struct ramps ramps = {.across = ramp_through(polygon, a->across, b->across, c->across)};
    if (!polygon->straight) {
        ramps.along = ramp_through(polygon, a->along, b->along, c->along);
        ramps.light = ramp_through(polygon, a->colour[1], b->colour[1], c->colour[1]);
    }
    return ramps;
}

/* Returns the values of four pixels of row y from x + step on. */
INLINE reals values_of(struct ramp ramp, int x, int y, reals step)
{
    const float start = (float)(ramp.start + ramp.down * y + ramp.right * x);
    return start + step * (float)ramp.right;
}

/* ---- runs of pixels of one row ---- */

/* The colour, the values and the target of a polygon are local copies, so that the compiler knows that stored
   pixels do not change them. */
struct paint {
    struct ramps ramps;
    bool straight;
    float half, alpha;
    uint8_t colour[4];
};

/* Returns alpha times the coverage of pixels by ink. */
INLINE pixels cover_of_ink(const struct paint *paint, bool straight, bool wholly, int x, int y, reals step)
{
    const reals across = values_of(paint->ramps.across, x, y, step);
    reals distance;
    if (straight) {
        distance = (reals)((choices)across & INT32_MAX);
    } else {
        const reals along = values_of(paint->ramps.along, x, y, step);
        distance = across * across + along * along;
        for (int i = 0; i < LANES; i++) {
            distance[i] = sqrtf(distance[i]);
        }
    }
    const reals covered = (paint->half + 0.5f) - distance;
    const reals most = {1.0f, 1.0f, 1.0f, 1.0f};
    const choices partly = covered < most, some = partly & (covered > 0.0f) & (wholly ? 0 : -1);
    const reals part = (reals)(((choices)covered & some) | ((choices)most & ~partly));
    return (pixels) __builtin_convertvector(part * paint->alpha + 0.5f, choices);
}

INLINE pixels cover_of_letters(const struct paint *paint, const struct gm_atlas *atlas, int x, int y,
                               reals step)
{
    const reals across = values_of(paint->ramps.across, x, y, step);
    const reals along = values_of(paint->ramps.along, x, y, step);
    pixels covered = {0};
    for (int i = 0; i < LANES; i++) {
        const int column = (int)across[i], row = (int)along[i];
        const bool within = column >= 0 && column < atlas->width && row >= 0 && row < atlas->height;
        const float part = within ? atlas->pixels[(size_t)row * (size_t)atlas->width + (size_t)column] : 0.0f;
        covered[i] = (uint32_t)(part * paint->alpha / 255.0f + 0.5f);
    }
    return covered;
}

/* Returns a value rounded, from 0 to 255. */
INLINE uint32_t byte_of(float value)
{
    return value > 0.0f ? (value < 255.0f ? (uint32_t)(value + 0.5f) : 255) : 0;
}

INLINE pixels colours_of_field(const struct target *target, const struct paint *paint, int x, int y,
                               reals step)
{
    const struct gm_mark *image = target->call->image;
    const uint32_t *colours = target->rasteriser->colours + (paint->colour[0] == 0 ? 0 : SHADES);
    const reals across = values_of(paint->ramps.across, x, y, step);
    const reals along = values_of(paint->ramps.along, x, y, step);
    const reals light = values_of(paint->ramps.light, x, y, step);
    pixels colour = {0}, lit = {0};
    for (int i = 0; i < LANES; i++) {
        const double value = image
                                 ? (gm_image_value(image, (double)across[i], (double)along[i]) - image->low) /
                                       (image->high - image->low)
                                 : (double)(across[i] + along[i]);
        const int shade = value > 0.0 ? (value < 1.0 ? (int)(value * (SHADES - 1) + 0.5) : SHADES - 1) : 0;
        colour[i] = colours[shade];
        lit[i] = byte_of(light[i]);
    }
    const uint32_t black = pixel_of((const uint8_t[4]){0, 0, 0, 255});
    return mixed((pixels){black, black, black, black}, colour, lit);
}

/* Returns the coverage that the call's stencil leaves of pixels within the run, and updates the stencil. */
INLINE pixels sifted(const struct gm_draw_call *call, unsigned char *group, pixels within, pixels covered)
{
    const uint32_t own = (uint32_t)call->once;
    const pixels before = load(group), held = (pixels)((before & inside) != 0);
    pixels after = before;
    switch (call->stencil) {
    case GM_STENCIL_ONCE:
        covered &= (pixels)((before & ~inside) != own);
        after ^= (before ^ ((before & inside) | own)) & (pixels)(covered != 0);
        break;
    case GM_STENCIL_OUTSIDE:
        return covered & ~held;
    case GM_STENCIL_INSIDE:
        covered &= held;
        after &= ~(within & inside);
        break;
    case GM_STENCIL_INVERT:
        covered &= 0;
        after ^= within & inside;
        break;
    case GM_STENCIL_NONE:
        break;
    }
    memcpy(group, &after, sizeof after);
    return covered;
}

/* Variants that put_row is compiled for: most pixels are ink without a stencil. */
enum variant { STRAIGHT_INK, ROUND_INK, ANY };

/* Draws at most RUN pixels of a row from x on. */
INLINE void put_row(const struct target *target, const struct paint *paint, enum variant variant, int x,
                    int y, int count)
{
    const int last = target->width - LANES - x; /* the last four of the row */
    const size_t place = (size_t)y * (size_t)target->width + (size_t)x;
    const uint32_t ink = pixel_of(paint->colour);
    for (int i = 0; i < count; i += LANES) {
        const int first = i < last ? i : last;
        const choices number = (choices){0, 1, 2, 3} + first;
        const pixels within = (pixels)((number >= i) & (number < count));
        const reals step = __builtin_convertvector(number, reals);
        pixels colour = {ink, ink, ink, ink}, covered;
        if (variant != ANY || target->is_ink) {
            covered = cover_of_ink(paint, variant == STRAIGHT_INK || (variant == ANY && paint->straight),
                                   target->wholly, x, y, step);
        } else if (target->call->program == GM_PROGRAM_TEXT) {
            covered = cover_of_letters(paint, target->atlas, x, y, step);
        } else {
            const uint32_t alpha = byte_of(255.0f * paint->half);
            covered = (pixels){alpha, alpha, alpha, alpha};
            colour = colours_of_field(target, paint, x, y, step);
        }
        covered &= within;
        const size_t at = 4 * (place + (size_t)first);
        if (variant == ANY && target->call->stencil != GM_STENCIL_NONE) {
            covered = sifted(target->call, (unsigned char *)target->rasteriser->groups + at, within, covered);
        }
        const pixels painted = mixed(load(target->rgba + at), colour, covered);
        memcpy(target->rgba + at, &painted, sizeof painted);
    }
}

/* ---- polygons ---- */

/* Returns the first whole number that is not below a place, clamped to low and high. */
INLINE int first_from(double place, int low, int high)
{
    if (!(place > low)) {
        return low;
    }
    if (!(place < high)) {
        return high;
    }
    const int whole = (int)place;
    return whole + (whole < place);
}

/* One side of a polygon: the edge that crosses a row, while rows go down from corner to corner. */
struct side {
    int end, turn; /* the lower corner; the next is `turn` corners on */
    double x, y, slope;
};

/* Returns where a side crosses row y, which is above the lowest corner. */
INLINE double crossing(struct side *side, const struct polygon *polygon, int y)
{
    const struct corner *to = &polygon->corner[side->end];
    if (!(y < to->y)) {
        const struct corner *from;
        do {
            from = to;
            side->end = (side->end + side->turn) % polygon->count;
            to = &polygon->corner[side->end];
        } while (!(y < to->y));
        side->x = from->x;
        side->y = from->y;
        side->slope = (to->x - from->x) / (to->y - from->y);
    }
    return side->x + side->slope * (y - side->y);
}

INLINE void paint_rows(const struct target *shared, const struct polygon *given, enum variant variant)
{
    const struct target target = *shared;
    const struct polygon polygon = *given;
    int top = 0;
    double bottom = polygon.corner[0].y;
    for (int i = 1; i < polygon.count; i++) {
        top = polygon.corner[i].y < polygon.corner[top].y ? i : top;
        bottom = polygon.corner[i].y > bottom ? polygon.corner[i].y : bottom;
    }
    int y = first_from(polygon.corner[top].y, target.top, target.bottom);
    const int last = first_from(bottom, target.top, target.bottom);
    if (y == last) {
        return;
    }
    const struct gm_vertex *vertex = polygon.corner[0].vertex;
    struct paint paint = {
        ramps_of(&polygon), polygon.straight, vertex->half, vertex->colour[3], {0, 0, 0, 255}};
    memcpy(paint.colour, vertex->colour, 3);
    const bool is_clockwise = polygon.area > 0.0;
    struct side left = {.end = top, .turn = is_clockwise ? polygon.count - 1 : 1};
    struct side right = {.end = top, .turn = is_clockwise ? 1 : polygon.count - 1};
    for (; y < last; y++) {
        const int end = first_from(crossing(&right, &polygon, y), target.left, target.right);
        for (int x = first_from(crossing(&left, &polygon, y), target.left, target.right); x < end; x += RUN) {
            put_row(&target, &paint, variant, x, y, end - x < RUN ? end - x : RUN);
        }
    }
}

static void paint_polygon(const struct target *target, const struct polygon *polygon)
{
    if (!target->plain) {
        paint_rows(target, polygon, ANY);
    } else if (polygon->straight) {
        paint_rows(target, polygon, STRAIGHT_INK);
    } else {
        paint_rows(target, polygon, ROUND_INK);
    }
}

static void put_triangle(const struct target *target, const struct corner *a, const struct corner *b,
                         const struct corner *c)
{
    const struct polygon polygon = {.corner = {*a, *b, *c}, .count = 3, .area = area_between(a, b, c)};
    if (fabs(polygon.area) > 0.0) {
        paint_polygon(target, &polygon);
    }
}

/* Puts the first two triangles of a strip as one polygon if they make one. Their colours are the same, as they share an
   edge. */
static bool put_pair(const struct target *target, const struct corner p[4])
{
    const double area = area_between(&p[0], &p[1], &p[2]);
    if (area == 0.0) {
        return false;
    }
    /* barycentric coordinates of the last corner */
    const double w[3] = {area_between(&p[3], &p[1], &p[2]) / area, area_between(&p[0], &p[3], &p[2]) / area,
                         area_between(&p[0], &p[1], &p[3]) / area};
    if (!(w[0] < 0.0 && w[1] > 0.0 && w[2] > 0.0)) {
        return false;
    }
    const struct gm_vertex *a = p[0].vertex, *b = p[1].vertex, *c = p[2].vertex, *d = p[3].vertex;
    const double near = 1.0 / 64.0; /* corners are rounded to a quarter of it */
    const double across = w[0] * (double)a->across + w[1] * (double)b->across + w[2] * (double)c->across;
    const double along = w[0] * (double)a->along + w[1] * (double)b->along + w[2] * (double)c->along;
    if (!(fabs(across - (double)d->across) < near && fabs(along - (double)d->along) < near)) {
        return false;
    }
    const struct polygon polygon = {
        .corner = {p[0], p[1], p[3], p[2]},
        .count = 4,
        .area = area,
        .straight = a->along == 0.0f && b->along == 0.0f && c->along == 0.0f && d->along == 0.0f,
    };
    paint_polygon(target, &polygon);
    return true;
}

static void put_call(const struct target *target, const struct gm_batch *batch)
{
    const struct gm_draw_call *call = target->call;
    struct corner corner[4];
    if (call->indexed) {
        const uint32_t *indices = batch->indices + call->first;
        for (size_t i = 0; i + 3 <= call->count; i += 3) {
            for (int k = 0; k < 3; k++) {
                corner[k] = corner_of(batch->vertices + indices[i + (size_t)k]);
            }
            put_triangle(target, &corner[0], &corner[1], &corner[2]);
        }
        return;
    }
    const struct gm_vertex *vertices = batch->vertices + call->first;
    for (size_t i = 0; i + 3 <= call->count; i++) {
        for (size_t k = 0; k < 4 && i + k < call->count; k++) {
            corner[k] = corner_of(&vertices[i + k]);
        }
        if (target->paired && i + 4 <= call->count && put_pair(target, corner)) {
            i++;
        } else {
            put_triangle(target, &corner[0], &corner[1], &corner[2]);
        }
    }
}

/* ---- a frame ---- */

static bool make_colours(struct rasteriser *rasteriser)
{
    rasteriser->colours = malloc(sizeof *rasteriser->colours * MAPS * SHADES);
    for (int i = 0; rasteriser->colours && i < MAPS * SHADES; i++) {
        const struct gm_rgb rgb = gm_colour_map_at((enum gm_colour_map)(i / SHADES), rasteriser->theme,
                                                   (double)(i % SHADES) / (SHADES - 1));
        rasteriser->colours[i] = pixel_of((const uint8_t[4]){rgb.r, rgb.g, rgb.b, 255});
    }
    return rasteriser->colours != NULL;
}

/* Makes the groups and colours for the batch; false when out of memory. */
static bool prepare(struct rasteriser *rasteriser, const struct gm_batch *batch)
{
    const size_t size = sizeof *rasteriser->groups * (size_t)rasteriser->width * (size_t)rasteriser->height;
    bool groups = false, colours = false;
    for (size_t i = 0; i < batch->call_count; i++) {
        const struct gm_draw_call *call = &batch->calls[i];
        groups |= call->stencil != GM_STENCIL_NONE;
        colours |= call->program == GM_PROGRAM_FIELD || call->program == GM_PROGRAM_IMAGE;
    }
    if (groups && !rasteriser->groups) {
        rasteriser->groups = malloc(size);
    }
    if (groups && rasteriser->groups) {
        memset(rasteriser->groups, 0, size);
    }
    return (!groups || rasteriser->groups) && (!colours || rasteriser->colours || make_colours(rasteriser));
}

static int within(int value, int high)
{
    return value < 0 ? 0 : value < high ? value : high;
}

/* Draws on paper: height rows of width pixels of four bytes, top row first. Returns false when out of
   memory. */
static bool rasterise(struct rasteriser *rasteriser, const struct gm_batch *batch,
                      const struct gm_atlas *atlas, unsigned char *rgba)
{
    if (!prepare(rasteriser, batch)) {
        return false;
    }
    const struct gm_rgb paper = gm_theme_colour(rasteriser->theme, GM_PAPER);
    const uint32_t blank = pixel_of((const uint8_t[4]){paper.r, paper.g, paper.b, 255});
    const size_t total = (size_t)rasteriser->width * (size_t)rasteriser->height;
    for (size_t i = 0; i < total; i++) {
        memcpy(rgba + 4 * i, &blank, sizeof blank);
    }
    for (size_t i = 0; i < batch->call_count; i++) {
        const struct gm_draw_call *call = &batch->calls[i];
        const int *scissor = call->scissor;
        const bool is_ink = call->program == GM_PROGRAM_INK || call->program == GM_PROGRAM_CORE;
        const struct target target = {
            .rasteriser = rasteriser,
            .call = call,
            .atlas = atlas,
            .rgba = rgba,
            .width = rasteriser->width,
            .wholly = call->program == GM_PROGRAM_CORE,
            .is_ink = is_ink,
            .plain = is_ink && call->stencil == GM_STENCIL_NONE,
            /* A rounding of values decides which pixels are covered wholly, and which a group has painted. Values of
               fields are not in pixels. */
            .paired = call->stencil == GM_STENCIL_NONE &&
                      (call->program == GM_PROGRAM_INK || call->program == GM_PROGRAM_TEXT),
            .left = within(scissor[0], rasteriser->width),
            .top = within(scissor[1], rasteriser->height),
            .right = within(scissor[0] + scissor[2], rasteriser->width),
            .bottom = within(scissor[1] + scissor[3], rasteriser->height),
        };
        put_call(&target, batch);
    }
    return !batch->short_of_memory;
}

/* ---- a canvas ---- */

struct gm_canvas {
    struct gm_brush brush;
    struct gm_painter painter;
    struct gm_opengl *opengl; /* NULL: the rasteriser draws */
    struct rasteriser rasteriser;
    unsigned char *rgba;
    char backend[GM_MESSAGE];
};

enum choice { OSMESA = GM_CONTEXT_OSMESA, EGL = GM_CONTEXT_EGL, OWN, AUTO, CHOICES };
static const char *const names[CHOICES] = {"osmesa", "egl", "own", "auto"};
static enum choice chosen = AUTO;

bool gm_canvas_choose(const char *painter, char *message)
{
    static const char rule[] = "--painter and GEOMINT_PAINTER take auto, osmesa, egl or own";
    char reason[GM_MESSAGE / 2];
    const char *word = painter ? painter : getenv("GEOMINT_PAINTER");
    word = word && *word ? word : names[AUTO];
    int found = 0;
    while (found < CHOICES && strcmp(names[found], word) != 0) {
        found++;
    }
    if (found == CHOICES) {
        return gm_refuse(message, "\"%.40s\" is not a painter: %s", word, rule);
    }
    if (found < OWN && !gm_opengl_load((enum gm_context_kind)found, reason, sizeof reason)) {
        return gm_refuse(message, "%s cannot be loaded (%s): %s", word, reason, rule);
    }
    chosen = (enum choice)found;
    return true;
}

/* Returns the painter of a live picture, or of a file. If the address space is limited, Mesa, which takes
   hundreds of MB of it, can wait without end for a thread that it is refused. */
static enum choice painter_of(bool live)
{
    char reason[GM_MESSAGE];
    if (chosen != AUTO) {
        return chosen;
    }
    return live || gm_address_space_is_limited() || !gm_opengl_load(GM_CONTEXT_OSMESA, reason, sizeof reason)
               ? OWN
               : OSMESA;
}

static pthread_t setting_up;
static bool expected;

static void *set_up(void *nothing)
{
    const enum choice painter = painter_of(false);
    if (painter != OWN) {
        gm_opengl_set_up((enum gm_context_kind)painter);
    }
    return nothing;
}

void gm_canvas_expect(void)
{
    /* a thread's stack and its share of the heap would leave Mesa too little of a limited address space */
    expected = expected || (chosen != OWN && !gm_address_space_is_limited() &&
                            gm_thread_start(&setting_up, set_up, NULL) == 0);
}

void gm_canvas_settle(void)
{
    if (expected) {
        pthread_join(setting_up, NULL);
        expected = false;
    }
}

static bool rasteriser_open(struct rasteriser *rasteriser, const struct gm_appearance *look, char *message)
{
    *rasteriser = (struct rasteriser){.width = look->width, .height = look->height, .theme = look->theme};
    return (look->width >= LANES && look->height >= 1 && look->width <= MOST_SIDE &&
            look->height <= MOST_SIDE) ||
           gm_refuse(
               message,
               "A picture of %d x %d pixels cannot be painted; each side is at most %d, and the width at least %d.",
               look->width, look->height, MOST_SIDE, LANES);
}

static bool open_all(struct gm_canvas *canvas, const struct gm_appearance *look, char *message)
{
    if (!gm_page_open(&canvas->painter, &gm_brush_pen, &canvas->brush, look, message)) {
        return false;
    }
    canvas->brush.glyphs = canvas->painter.glyphs;
    const enum choice painter = painter_of(look->live);
    if (painter != OWN) {
        canvas->opengl =
            gm_opengl_open((enum gm_context_kind)painter, look->width, look->height, look->theme, message);
    }
    const bool is_user = painter == OWN || (!canvas->opengl && chosen == AUTO);
    if (is_user ? !rasteriser_open(&canvas->rasteriser, look, message) : !canvas->opengl) {
        return false;
    }
    snprintf(canvas->backend, sizeof canvas->backend, "%s%s%s", names[is_user ? OWN : painter],
             is_user ? "" : ", ", is_user ? "" : gm_opengl_name(canvas->opengl));
    canvas->rgba = malloc((size_t)look->width * (size_t)look->height * 4);
    return canvas->rgba || gm_refuse(message, "There is not enough memory for a picture of %d x %d pixels.",
                                     look->width, look->height);
}

struct gm_canvas *gm_canvas_open(const struct gm_appearance *look, char *message)
{
    struct gm_canvas *canvas = calloc(1, sizeof *canvas);
    if (!canvas) {
        gm_refuse(message, "There is not enough memory for a picture.");
        return NULL;
    }
    if (!open_all(canvas, look, message)) {
        gm_canvas_close(canvas);
        return NULL;
    }
    return canvas;
}

void gm_canvas_close(struct gm_canvas *canvas)
{
    if (!canvas) {
        return;
    }
    gm_page_close(&canvas->painter);
    gm_brush_free(&canvas->brush);
    gm_opengl_close(canvas->opengl);
    free(canvas->rasteriser.groups);
    free(canvas->rasteriser.colours);
    free(canvas->rgba);
    free(canvas);
}

const char *gm_canvas_backend(const struct gm_canvas *canvas)
{
    return canvas->backend;
}

#ifdef __x86_64__
/* Packs four pixels at a time with one shuffle, which also writes four bytes that the next ones overwrite.
   Returns how many. */
__attribute__((target("ssse3"))) static size_t shuffle_alpha(const unsigned char *rgba, unsigned char *rgb,
                                                             size_t count)
{
    const __m128i kept = _mm_setr_epi8(0, 1, 2, 4, 5, 6, 8, 9, 10, 12, 13, 14, -1, -1, -1, -1);
    size_t i = 0;
    for (; i + 6 <= count; i += 4) {
        const __m128i four = _mm_loadu_si128((const __m128i *)(rgba + 4 * i));
        _mm_storeu_si128((__m128i *)(rgb + 3 * i), _mm_shuffle_epi8(four, kept));
    }
    return i;
}
#endif

/* Both may be one array. */
static void drop_alpha(const unsigned char *rgba, unsigned char *rgb, size_t count)
{
    size_t i = 0;
#ifdef __x86_64__
    i = __builtin_cpu_supports("ssse3") ? shuffle_alpha(rgba, rgb, count) : 0;
#endif
    for (; i < count; i++) {
        memmove(rgb + 3 * i, rgba + 4 * i, 3);
    }
}

/* Draws with fourth bytes of any value. */
static bool draw(struct gm_canvas *canvas, struct gm_picture *picture, unsigned char *rgba)
{
    struct gm_batch *batch = &canvas->brush.batch;
    gm_batch_clear(batch);
    if (!gm_page_draw(&canvas->painter, picture)) {
        return false;
    }
    const struct gm_atlas atlas = gm_glyphs_atlas(canvas->painter.glyphs);
    return canvas->opengl ? gm_opengl_draw(canvas->opengl, batch, &atlas, rgba)
                          : rasterise(&canvas->rasteriser, batch, &atlas, rgba);
}

const unsigned char *gm_canvas_paint(struct gm_canvas *canvas, struct gm_picture *picture, unsigned char *rgb)
{
    const struct gm_appearance *look = &canvas->painter.look;
    if (!draw(canvas, picture, canvas->rgba)) {
        return NULL;
    }
    rgb = rgb ? rgb : canvas->rgba;
    drop_alpha(canvas->rgba, rgb, (size_t)look->width * (size_t)look->height);
    return rgb;
}

bool gm_canvas_paint_opaque(struct gm_canvas *canvas, struct gm_picture *picture, unsigned char *rgba)
{
    const struct gm_appearance *look = &canvas->painter.look;
    const size_t bytes = (size_t)look->width * (size_t)look->height * 4;
    const bool drawn = draw(canvas, picture, rgba);
    for (size_t i = 3; drawn && canvas->opengl && i < bytes; i += 4) { /* the rasteriser's are 255 */
        rgba[i] = 255;
    }
    return drawn;
}

struct gm_spot gm_canvas_locate(struct gm_canvas *canvas, struct gm_picture *picture, double across,
                                double down)
{
    const struct gm_metrics metrics = gm_painter_metrics(&canvas->painter);
    return gm_layout_locate(gm_layout_make(picture, &metrics), across, down);
}
