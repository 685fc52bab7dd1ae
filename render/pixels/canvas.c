/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A picture as triangles of a batch, drawn by the program's own rasteriser or by OpenGL. */
#include "render/pixels/canvas.h"

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
#include "render/pixels/rasteriser.h"
#include "render/triangles/triangles.h"

struct gm_canvas {
    struct gm_brush brush;
    struct gm_painter painter;
    struct gm_opengl *opengl; /* NULL: the rasteriser draws */
    struct gm_rasteriser rasteriser;
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

static bool rasteriser_open(struct gm_rasteriser *rasteriser, const struct gm_appearance *look, char *message)
{
    *rasteriser = (struct gm_rasteriser){.width = look->width, .height = look->height, .theme = look->theme};
    return (look->width >= 1 && look->height >= 1 && look->width <= GM_RASTERISER_MOST &&
            look->height <= GM_RASTERISER_MOST) ||
           gm_refuse(message, "A picture of %d x %d pixels cannot be painted; each side is 1 to %d.",
                     look->width, look->height, GM_RASTERISER_MOST);
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
    gm_rasteriser_close(&canvas->rasteriser);
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

const unsigned char *gm_canvas_paint(struct gm_canvas *canvas, struct gm_picture *picture, unsigned char *rgb)
{
    struct gm_batch *batch = &canvas->brush.batch;
    gm_batch_clear(batch);
    if (!gm_page_draw(&canvas->painter, picture)) {
        return NULL;
    }
    const struct gm_atlas atlas = gm_glyphs_atlas(canvas->painter.glyphs);
    const bool drawn = canvas->opengl ? gm_opengl_draw(canvas->opengl, batch, &atlas, canvas->rgba)
                                      : gm_rasteriser_draw(&canvas->rasteriser, batch, &atlas, canvas->rgba);
    rgb = rgb ? rgb : canvas->rgba;
    drop_alpha(canvas->rgba, rgb, (size_t)canvas->painter.look.width * (size_t)canvas->painter.look.height);
    return drawn ? rgb : NULL;
}

const struct gm_panel *gm_canvas_locate(struct gm_canvas *canvas, struct gm_picture *picture, double across,
                                        double down, double *x, double *y)
{
    const struct gm_metrics metrics = gm_painter_metrics(&canvas->painter);
    return gm_layout_locate(gm_layout_make(picture, &metrics), across, down, x, y);
}
