/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The GL painter: what is painted in which order, and the pixels read back. */
#include "render/gl/canvas.h"

#include <pthread.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#ifdef __x86_64__
#include <immintrin.h>
#endif

#include "render/address_space.h"
#include "render/drawing/page.h"
#include "render/gl/brush.h"

enum { MAP_STEPS = 256, MAP_ROWS = 2, BAND = 64 /* rows that are read back at a time, and stay in cache */ };

struct gm_canvas {
    struct gm_context *context;
    struct gm_gl gl;
    struct gm_brush brush;
    struct gm_painter painter;
    GLuint framebuffer, colour_buffer, stencil_buffer;
    GLuint atlas, maps;
    int atlas_height;    /* of the texture */
    unsigned char *band; /* rows as they are read back, 4 bytes a pixel */
    char backend[GM_MESSAGE];
};

static bool framebuffer_open(struct gm_canvas *canvas, char *message)
{
    const struct gm_gl *gl = &canvas->gl;
    GLint most = 0, viewport[2] = {0, 0};
    gl->GetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &most);
    gl->GetIntegerv(GL_MAX_VIEWPORT_DIMS, viewport);
    most = most < viewport[0] ? most : viewport[0];
    if (canvas->painter.look.width < 1 || canvas->painter.look.height < 1 ||
        canvas->painter.look.width > most || canvas->painter.look.height > most) {
        snprintf(message, GM_MESSAGE, "A picture of %d x %d pixels cannot be painted; each side is 1 to %d.",
                 canvas->painter.look.width, canvas->painter.look.height, most);
        return false;
    }
    gl->GenFramebuffers(1, &canvas->framebuffer);
    gl->BindFramebuffer(GL_FRAMEBUFFER, canvas->framebuffer);
    gl->GenRenderbuffers(1, &canvas->colour_buffer);
    gl->BindRenderbuffer(GL_RENDERBUFFER, canvas->colour_buffer);
    gl->RenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, canvas->painter.look.width,
                            canvas->painter.look.height);
    gl->FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, canvas->colour_buffer);
    gl->GenRenderbuffers(1, &canvas->stencil_buffer);
    gl->BindRenderbuffer(GL_RENDERBUFFER, canvas->stencil_buffer);
    static const struct {
        GLenum format, attachment;
    } stencils[] = {{GL_STENCIL_INDEX8, GL_STENCIL_ATTACHMENT},
                    {GL_DEPTH24_STENCIL8, GL_DEPTH_STENCIL_ATTACHMENT}};
    for (int i = 0; i < 2; i++) {
        gl->RenderbufferStorage(GL_RENDERBUFFER, stencils[i].format, canvas->painter.look.width,
                                canvas->painter.look.height);
        gl->FramebufferRenderbuffer(GL_FRAMEBUFFER, stencils[i].attachment, GL_RENDERBUFFER,
                                    canvas->stencil_buffer);
        if (gl->CheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE &&
            gl->GetError() == GL_NO_ERROR) {
            return true;
        }
    }
    snprintf(message, GM_MESSAGE, "This OpenGL gives no framebuffer of %d x %d pixels.",
             canvas->painter.look.width, canvas->painter.look.height);
    return false;
}

static void texture_parameters(const struct gm_gl *gl, GLint filter)
{
    gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
    gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
    gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

static void textures_open(struct gm_canvas *canvas)
{
    const struct gm_gl *gl = &canvas->gl;
    unsigned char texels[MAP_ROWS][MAP_STEPS][4];
    for (int map = 0; map < MAP_ROWS; map++) {
        for (int i = 0; i < MAP_STEPS; i++) {
            const struct gm_rgb rgb = gm_colour_map_at((enum gm_colour_map)map, canvas->painter.look.theme,
                                                       (double)i / (MAP_STEPS - 1));
            memcpy(texels[map][i], (const unsigned char[]){rgb.r, rgb.g, rgb.b, 255}, 4);
        }
    }
    gl->PixelStorei(GL_UNPACK_ALIGNMENT, 1);
    gl->GenTextures(1, &canvas->atlas);
    gl->ActiveTexture(GL_TEXTURE0);
    gl->BindTexture(GL_TEXTURE_2D, canvas->atlas);
    texture_parameters(gl, GL_NEAREST);
    gl->GenTextures(1, &canvas->maps);
    gl->ActiveTexture(GL_TEXTURE1);
    gl->BindTexture(GL_TEXTURE_2D, canvas->maps);
    texture_parameters(gl, GL_LINEAR);
    gl->TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, MAP_STEPS, MAP_ROWS, 0, GL_RGBA, GL_UNSIGNED_BYTE, texels);
}

static bool gl_open(struct gm_canvas *canvas, char *message)
{
    canvas->context = gm_context_open(message, GM_MESSAGE);
    if (!canvas->context) {
        return false;
    }
    const char *missing = gm_gl_load(&canvas->gl, canvas->context);
    if (missing) {
        return gm_refuse(message, "This OpenGL lacks the function %s.", missing);
    }
    const char *version = (const char *)canvas->gl.GetString(GL_VERSION);
    const char *renderer = (const char *)canvas->gl.GetString(GL_RENDERER);
    const char *mesa = strstr(version, "Mesa");
    snprintf(canvas->backend, sizeof canvas->backend, "%s, OpenGL %.3s, %s%s%s",
             gm_context_name(canvas->context), version, renderer, mesa ? ", " : "", mesa ? mesa : "");
    return framebuffer_open(canvas, message) &&
           gm_batch_open(&canvas->brush.batch, &canvas->gl, canvas->painter.look.width,
                         canvas->painter.look.height, message);
}

static void close_alone(struct gm_canvas *canvas)
{
    if (!canvas) {
        return;
    }
    if (canvas->context && canvas->gl.Viewport && gm_context_use(canvas->context)) {
        const struct gm_gl *gl = &canvas->gl;
        gm_batch_close(&canvas->brush.batch);
        gl->DeleteTextures(1, &canvas->atlas);
        gl->DeleteTextures(1, &canvas->maps);
        gl->DeleteTextures((GLsizei)canvas->brush.image_count, canvas->brush.images);
        gl->DeleteFramebuffers(1, &canvas->framebuffer);
        gl->DeleteRenderbuffers(1, &canvas->colour_buffer);
        gl->DeleteRenderbuffers(1, &canvas->stencil_buffer);
    }
    gm_page_close(&canvas->painter);
    gm_polyline_free(&canvas->brush.dash);
    free(canvas->brush.images);
    free(canvas->brush.texels);
    free(canvas->band);
    gm_context_close(canvas->context);
    free(canvas);
}

/* The page, for which the fonts are found, and the memory: what needs no GL. */
static bool page_open(struct gm_canvas *canvas, const struct gm_appearance *look, char *message)
{
    if (!gm_page_open(&canvas->painter, &gm_brush_pen, &canvas->brush, look, message)) {
        return false;
    }
    canvas->brush.glyphs = canvas->painter.glyphs;
    const size_t rows = look->height < BAND ? (size_t)look->height : BAND;
    canvas->band = malloc((size_t)look->width * rows * 4);
    return canvas->band || gm_refuse(message, "There is not enough memory for a picture of %d x %d pixels.",
                                     look->width, look->height);
}

static bool gl_page_open(struct gm_canvas *canvas, char *message)
{
    if (!gl_open(canvas, message)) {
        return false;
    }
    textures_open(canvas);
    canvas->brush.gl = &canvas->gl;
    return true;
}

const char *gm_canvas_backend(const struct gm_canvas *canvas)
{
    return canvas->backend;
}

static void update_atlas(struct gm_canvas *canvas)
{
    const struct gm_gl *gl = &canvas->gl;
    const struct gm_atlas atlas = gm_glyphs_atlas(canvas->painter.glyphs);
    gl->ActiveTexture(GL_TEXTURE0);
    gl->BindTexture(GL_TEXTURE_2D, canvas->atlas);
    if (atlas.height != canvas->atlas_height) {
        gl->TexImage2D(GL_TEXTURE_2D, 0, GL_R8, atlas.width, atlas.height, 0, GL_RED, GL_UNSIGNED_BYTE,
                       atlas.pixels);
    } else if (atlas.changed < atlas.used) {
        gl->TexSubImage2D(GL_TEXTURE_2D, 0, 0, atlas.changed, atlas.width, atlas.used - atlas.changed, GL_RED,
                          GL_UNSIGNED_BYTE, atlas.pixels + (size_t)atlas.changed * (size_t)atlas.width);
    }
    canvas->atlas_height = atlas.height;
}

static void clear(const struct gm_canvas *canvas)
{
    const struct gm_gl *gl = &canvas->gl;
    const struct gm_rgb paper = gm_theme_colour(canvas->painter.look.theme, GM_PAPER);
    gl->BindFramebuffer(GL_FRAMEBUFFER, canvas->framebuffer);
    gl->Viewport(0, 0, canvas->painter.look.width, canvas->painter.look.height);
    gl->ClearColor(paper.r / 255.0f, paper.g / 255.0f, paper.b / 255.0f, 1.0f);
    gl->ClearStencil(0);
    gl->Clear(GL_COLOR_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
}

#ifdef __x86_64__
/* Four pixels at a time by one shuffle, which also writes four bytes that the next ones overwrite; how many
   pixels are done. */
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

/* Elsewhere as three words; the shifts are those of processors whose low byte comes first. */
static void drop_alpha(const unsigned char *rgba, unsigned char *rgb, size_t count)
{
    size_t i = 0;
#ifdef __x86_64__
    i = __builtin_cpu_supports("ssse3") ? shuffle_alpha(rgba, rgb, count) : 0;
#endif
#if __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__
    for (; i + 4 <= count; i += 4) {
        uint32_t in[4], out[3];
        memcpy(in, rgba + 4 * i, sizeof in);
        out[0] = (in[0] & 0xffffff) | in[1] << 24;
        out[1] = (in[1] >> 8 & 0xffff) | in[2] << 16;
        out[2] = (in[2] >> 16 & 0xff) | in[3] << 8;
        memcpy(rgb + 3 * i, out, sizeof out);
    }
#endif
    for (; i < count; i++) {
        memcpy(rgb + 3 * i, rgba + 4 * i, 3);
    }
}

/* Reading 4 bytes a pixel is a plain copy for GL; reading 3 is not. */
static void read_back(const struct gm_canvas *canvas, unsigned char *rgb)
{
    const struct gm_gl *gl = &canvas->gl;
    const int width = canvas->painter.look.width, height = canvas->painter.look.height;
    gl->PixelStorei(GL_PACK_ALIGNMENT, 1);
    for (int row = 0; row < height; row += BAND) {
        const int rows = height - row < BAND ? height - row : BAND;
        gl->ReadPixels(0, row, width, rows, GL_RGBA, GL_UNSIGNED_BYTE, canvas->band);
        drop_alpha(canvas->band, rgb + (size_t)row * (size_t)width * 3, (size_t)rows * (size_t)width);
    }
}

static bool paint_alone(struct gm_canvas *canvas, struct gm_picture *picture, unsigned char *rgb)
{
    if (!gm_context_use(canvas->context)) {
        return false;
    }
    gm_batch_clear(&canvas->brush.batch);
    canvas->brush.images_used = 0;
    if (!gm_page_draw(&canvas->painter, picture)) {
        return false;
    }
    update_atlas(canvas);
    clear(canvas);
    const bool drawn =
        gm_batch_draw(&canvas->brush.batch, canvas->painter.look.width, canvas->painter.look.height);
    read_back(canvas, rgb);
    return drawn;
}

/* Mesa's software contexts of one process are not safe from each other: two threads that paint at once crash
   in libOSMesa 22.3. So all canvases take turns. */
static pthread_mutex_t turn = PTHREAD_MUTEX_INITIALIZER;

static void take_turn(void)
{
    pthread_mutex_lock(&turn);
    gm_context_guard();
}

static void end_turn(void)
{
    gm_context_unguard();
    pthread_mutex_unlock(&turn);
}

void gm_canvas_load(void)
{
    take_turn();
    gm_context_load();
    end_turn();
}

enum { TAKEN = 512 << 20 /* bytes of the address space, by Mesa and what it loads */ };

/* Fonts are found before the turn is taken: Mesa may still be loaded meanwhile. */
struct gm_canvas *gm_canvas_open(const struct gm_appearance *look, char *message)
{
    struct gm_canvas *canvas = calloc(1, sizeof *canvas);
    if (!canvas) {
        gm_refuse(message, "There is not enough memory for a picture.");
        return NULL;
    }
    bool good = page_open(canvas, look, message);
    take_turn();
    good = good && gl_page_open(canvas, message);
    if (!good) {
        close_alone(canvas);
        if (!gm_address_space_has(TAKEN)) {
            gm_refuse(message, "There is not enough memory to paint pictures.");
        }
    }
    end_turn();
    return good ? canvas : NULL;
}

void gm_canvas_close(struct gm_canvas *canvas)
{
    take_turn();
    close_alone(canvas);
    end_turn();
}

bool gm_canvas_paint(struct gm_canvas *canvas, struct gm_picture *picture, unsigned char *rgb)
{
    take_turn();
    const bool painted = paint_alone(canvas, picture, rgb);
    if (!painted) {
        gm_address_space_has(TAKEN); /* notes a refusal that was Mesa's */
    }
    end_turn();
    return painted;
}

const struct gm_panel *gm_canvas_locate(struct gm_canvas *canvas, struct gm_picture *picture, double across,
                                        double down, double *x, double *y)
{
    const struct gm_metrics metrics = gm_painter_metrics(&canvas->painter);
    return gm_layout_locate(gm_layout_make(picture, &metrics), across, down, x, y);
}
