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
    RUN = 256,             /* pixels of a run, along which values are summed in single precision */
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
    int left, top, right, bottom; /* only these pixels may change */
};

/* These functions are so short, and are called so often, that a call would cost as much as their work. */
#define INLINE static inline __attribute__((always_inline))

/* ---- pixels: four bytes, in any order ---- */

INLINE uint32_t pixel_of(const uint8_t bytes[4])
{
    uint32_t pixel;
    memcpy(&pixel, bytes, sizeof pixel);
    return pixel;
}

/* Mixes two colours by alpha of 255, each byte rounded to the nearest. */
INLINE uint32_t mixed(uint32_t under, uint32_t over, uint32_t alpha)
{
    const uint32_t pairs = 0x00ff00ff, half = 0x00800080;
    uint32_t even = (over & pairs) * alpha + (under & pairs) * (255 - alpha) + half;
    uint32_t odd = (over >> 8 & pairs) * alpha + (under >> 8 & pairs) * (255 - alpha) + half;
    even = (even + (even >> 8 & pairs)) >> 8 & pairs;
    odd = (odd + (odd >> 8 & pairs)) & ~pairs;
    return even | odd;
}

/* ---- a triangle's values as planes over the pixels ---- */

struct corner {
    double x, y; /* relative to the middle of the first pixel */
    const struct gm_vertex *vertex;
};

struct slope {
    double right, down; /* the change of a value per pixel */
};

struct plane {
    float start, right; /* the value at the first pixel of a run, and its change per pixel */
};

struct planes {
    struct plane across, along, half, light; /* the light of 255 */
};

struct triangle {
    struct corner corner[3];
    double area; /* twice the area, with its sign */
    bool sloped; /* the slopes are known: many a triangle has no pixel and needs none */
    struct slope across, along, half, light;
};

/* Rounds to 1/256: a double this large has no digits below that. */
static double snapped(float place)
{
    const double large = 0x1.8p44;
    return ((double)place + large) - large - 0.5;
}

static struct corner corner_of(const struct gm_vertex *vertex)
{
    return (struct corner){snapped(vertex->x), snapped(vertex->y), vertex};
}

/* The slope of a value that is a, b and c at the corners. */
static struct slope slope_across(const struct triangle *triangle, float a, float b, float c)
{
    const struct corner *p = triangle->corner;
    const double first = (double)b - (double)a, second = (double)c - (double)a;
    return (struct slope){
        .right = (first * (p[2].y - p[0].y) - second * (p[1].y - p[0].y)) / triangle->area,
        .down = (second * (p[1].x - p[0].x) - first * (p[2].x - p[0].x)) / triangle->area,
    };
}

static void find_slopes(struct triangle *triangle)
{
    const struct gm_vertex *a = triangle->corner[0].vertex, *b = triangle->corner[1].vertex,
                           *c = triangle->corner[2].vertex;
    triangle->sloped = true;
    triangle->across = slope_across(triangle, a->across, b->across, c->across);
    triangle->along = slope_across(triangle, a->along, b->along, c->along);
    triangle->half = slope_across(triangle, a->half, b->half, c->half);
    triangle->light = slope_across(triangle, a->colour[1], b->colour[1], c->colour[1]);
}

INLINE struct plane plane_of(const struct triangle *triangle, struct slope slope, float a, int x, int y)
{
    const struct corner *p = triangle->corner;
    return (struct plane){(float)((double)a + slope.right * (x - p->x) + slope.down * (y - p->y)),
                          (float)slope.right};
}

INLINE struct planes planes_of(const struct triangle *triangle, int x, int y)
{
    const struct gm_vertex *a = triangle->corner->vertex;
    return (struct planes){
        plane_of(triangle, triangle->across, a->across, x, y),
        plane_of(triangle, triangle->along, a->along, x, y),
        plane_of(triangle, triangle->half, a->half, x, y),
        plane_of(triangle, triangle->light, a->colour[1], x, y),
    };
}

/* ---- runs of pixels of one row ---- */

/* Returns alpha times the ink's coverage of a pixel of a run. */
INLINE uint8_t cover(const struct planes *planes, int i, bool wholly, float alpha)
{
    const float step = (float)i;
    const float across = planes->across.start + step * planes->across.right;
    const float along = planes->along.start + step * planes->along.right;
    const float half = planes->half.start + step * planes->half.right;
    const float covered = half + 0.5f - sqrtf(across * across + along * along);
    const float part = covered < 1.0f ? (wholly || !(covered > 0.0f) ? 0.0f : covered) : 1.0f;
    return (uint8_t)(part * alpha + 0.5f);
}

INLINE uint8_t cover_of_letter(const struct gm_atlas *atlas, const struct planes *planes, int i, float alpha)
{
    const int column = (int)(planes->across.start + (float)i * planes->across.right);
    const int row = (int)(planes->along.start + (float)i * planes->along.right);
    const bool within = column >= 0 && column < atlas->width && row >= 0 && row < atlas->height;
    const float part = within ? atlas->pixels[(size_t)row * (size_t)atlas->width + (size_t)column] : 0.0f;
    return (uint8_t)(part * alpha / 255.0f + 0.5f);
}

/* Returns the coverage that the call's stencil leaves of a pixel, and updates the stencil. */
INLINE uint8_t sifted(const struct gm_draw_call *call, uint32_t *group, uint8_t covered)
{
    const uint32_t own = (uint32_t)call->once, before = *group;
    switch (call->stencil) {
    case GM_STENCIL_ONCE:
        covered = (before & ~inside) == own ? 0 : covered;
        *group = covered > 0 ? (before & inside) | own : before;
        return covered;
    case GM_STENCIL_OUTSIDE:
        return before & inside ? 0 : covered;
    case GM_STENCIL_INSIDE:
        *group = before & ~inside;
        return before & inside ? covered : 0;
    case GM_STENCIL_INVERT:
    case GM_STENCIL_NONE:
        break;
    }
    return covered;
}

INLINE void put_ink(unsigned char *rgba, uint32_t colour, uint8_t covered)
{
    if (covered > 0) {
        const uint32_t pixel = covered == 255 ? colour : mixed(pixel_of(rgba), colour, covered);
        memcpy(rgba, &pixel, sizeof pixel);
    }
}

static void put_field(const struct target *target, const struct planes *planes,
                      const struct gm_vertex *vertex, unsigned char *rgba, int count)
{
    const struct gm_mark *image = target->call->image;
    const uint32_t *colours = target->rasteriser->colours + (vertex->colour[0] == 0 ? 0 : SHADES);
    const float half = planes->half.start;
    const uint32_t alpha = half > 0.0f ? (half < 1.0f ? (uint32_t)(255.0f * half + 0.5f) : 255) : 0;
    for (int i = 0; i < count; i++) {
        const float across = planes->across.start + (float)i * planes->across.right;
        const float along = planes->along.start + (float)i * planes->along.right;
        const double value = image ? (gm_image_value(image, (double)across, (double)along) - image->low) /
                                         (image->high - image->low)
                                   : (double)(across + along);
        const int shade = value > 0.0 ? (value < 1.0 ? (int)(value * (SHADES - 1) + 0.5) : SHADES - 1) : 0;
        const float light = planes->light.start + (float)i * planes->light.right;
        const uint32_t black = pixel_of((const uint8_t[4]){0, 0, 0, 255});
        const uint32_t colour = light < 254.5f
                                    ? mixed(black, colours[shade], light > 0 ? (uint32_t)(light + 0.5f) : 0)
                                    : colours[shade];
        const uint32_t pixel = mixed(pixel_of(rgba + 4 * i), colour, alpha);
        memcpy(rgba + 4 * i, &pixel, sizeof pixel);
    }
}

/* Draws at most RUN pixels of a row from x on. */
INLINE void put_pixels(const struct target *target, struct triangle *triangle, int x, int y, int count)
{
    const struct gm_draw_call *call = target->call;
    const struct gm_vertex *vertex = triangle->corner[0].vertex;
    const size_t place = (size_t)y * (size_t)target->rasteriser->width + (size_t)x;
    uint32_t *groups = target->rasteriser->groups ? target->rasteriser->groups + place : NULL;
    if (call->stencil == GM_STENCIL_INVERT) {
        for (int i = 0; i < count; i++) {
            groups[i] ^= inside;
        }
        return;
    }
    unsigned char *rgba = target->rgba + 4 * place;
    const float alpha = vertex->colour[3];
    const uint8_t bytes[4] = {vertex->colour[0], vertex->colour[1], vertex->colour[2], 255};
    const uint32_t colour = pixel_of(bytes);
    if (!triangle->sloped) {
        find_slopes(triangle);
    }
    const struct planes planes = planes_of(triangle, x, y);
    const bool is_ink = call->program == GM_PROGRAM_INK || call->program == GM_PROGRAM_CORE;
    if (is_ink && call->stencil == GM_STENCIL_NONE) {
        for (int i = 0; i < count; i++) {
            put_ink(rgba + 4 * i, colour, cover(&planes, i, call->program == GM_PROGRAM_CORE, alpha));
        }
    } else if (is_ink) {
        for (int i = 0; i < count; i++) {
            put_ink(rgba + 4 * i, colour,
                    sifted(call, &groups[i], cover(&planes, i, call->program == GM_PROGRAM_CORE, alpha)));
        }
    } else if (call->program == GM_PROGRAM_TEXT) {
        for (int i = 0; i < count; i++) {
            const uint8_t covered = cover_of_letter(target->atlas, &planes, i, alpha);
            put_ink(rgba + 4 * i, colour,
                    call->stencil == GM_STENCIL_NONE ? covered : sifted(call, &groups[i], covered));
        }
    } else {
        put_field(target, &planes, vertex, rgba, count);
    }
}

/* ---- triangles ---- */

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

INLINE double edge_at(const struct corner *from, double slope, int y)
{
    return from->x + slope * (y - from->y);
}

static double slope_of(const struct corner *from, const struct corner *to)
{
    return (to->x - from->x) / (to->y - from->y);
}

/* Draws a triangle. Corners by height: one edge goes from the first to the last, the others meet between. */
static void put_triangle(const struct target *target, struct corner a, struct corner b, struct corner c)
{
    struct triangle triangle = {.corner = {a, b, c},
                                .area = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y)};
    const double area = triangle.area;
    if (!(fabs(area) > 0.0)) {
        return;
    }
    const struct corner *top = &triangle.corner[0], *middle = &triangle.corner[1],
                        *bottom = &triangle.corner[2];
    bool turned = false;
#define ORDER(first, second)                                                                                 \
    if (second->y < first->y) {                                                                              \
        const struct corner *other = first;                                                                  \
        first = second;                                                                                      \
        second = other;                                                                                      \
        turned = !turned;                                                                                    \
    }
    ORDER(top, middle)
    ORDER(middle, bottom)
    ORDER(top, middle)
#undef ORDER
    const bool long_is_left = (area < 0.0) == turned;
    const double whole = slope_of(top, bottom), upper = slope_of(top, middle),
                 lower = slope_of(middle, bottom);
    const int last = first_from(bottom->y, target->top, target->bottom);
    for (int y = first_from(top->y, target->top, target->bottom); y < last; y++) {
        const double along = edge_at(top, whole, y);
        const double other = y < middle->y ? edge_at(top, upper, y) : edge_at(middle, lower, y);
        const int end = first_from(long_is_left ? other : along, target->left, target->right);
        for (int x = first_from(long_is_left ? along : other, target->left, target->right); x < end;
             x += RUN) {
            put_pixels(target, &triangle, x, y, end - x < RUN ? end - x : RUN);
        }
    }
}

static void put_call(const struct target *target, const struct gm_batch *batch)
{
    const struct gm_draw_call *call = target->call;
    if (call->indexed) {
        const uint32_t *indices = batch->indices + call->first;
        for (size_t i = 0; i + 3 <= call->count; i += 3) {
            put_triangle(target, corner_of(batch->vertices + indices[i]),
                         corner_of(batch->vertices + indices[i + 1]),
                         corner_of(batch->vertices + indices[i + 2]));
        }
        return;
    }
    const struct gm_vertex *vertices = batch->vertices + call->first;
    struct corner corner[3];
    for (size_t i = 0; i < call->count; i++) {
        corner[i % 3] = corner_of(&vertices[i]);
        if (i >= 2) {
            put_triangle(target, corner[0], corner[1], corner[2]);
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
    const size_t pixels = (size_t)rasteriser->width * (size_t)rasteriser->height;
    for (size_t i = 0; i < pixels; i++) {
        memcpy(rgba + 4 * i, &blank, sizeof blank);
    }
    for (size_t i = 0; i < batch->call_count; i++) {
        const struct gm_draw_call *call = &batch->calls[i];
        const int *scissor = call->scissor;
        const struct target target = {
            .rasteriser = rasteriser,
            .call = call,
            .atlas = atlas,
            .rgba = rgba,
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
    return (look->width >= 1 && look->height >= 1 && look->width <= MOST_SIDE && look->height <= MOST_SIDE) ||
           gm_refuse(message, "A picture of %d x %d pixels cannot be painted; each side is 1 to %d.",
                     look->width, look->height, MOST_SIDE);
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
        const __m128i pixels = _mm_loadu_si128((const __m128i *)(rgba + 4 * i));
        _mm_storeu_si128((__m128i *)(rgb + 3 * i), _mm_shuffle_epi8(pixels, kept));
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
