/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Triangles drawn with OpenGL, and the pixels read back. */
#include "render/gl/opengl.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "render/address_space.h"
#include "render/gl/stream.h"
#include "render/message.h"

enum { MAP_STEPS = 16 * 255 + 1 /* as in the rasteriser */, MAP_ROWS = 2 };

/* The state that all pictures of a kind share: setting it up takes longer than drawing one. */
struct engine {
    const struct gm_backend *backend; /* NULL: it has no context */
    struct gm_gl gl;
    struct gm_stream stream;
    char name[GM_MESSAGE];
};
static struct engine engines[GM_CONTEXT_KINDS];

struct gm_opengl {
    struct engine *engine;
    int width, height;
    enum gm_theme theme;
    GLuint framebuffer, colour_buffer, stencil_buffer;
    GLuint atlas, maps;
    int atlas_height; /* rows of the atlas texture */
};

static bool framebuffer_open(struct gm_opengl *opengl, char *message)
{
    const struct gm_gl *gl = &opengl->engine->gl;
    GLint most = 0, viewport[2] = {0, 0};
    gl->GetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &most);
    gl->GetIntegerv(GL_MAX_VIEWPORT_DIMS, viewport);
    most = most < viewport[0] ? most : viewport[0];
    if (opengl->width < 1 || opengl->height < 1 || opengl->width > most || opengl->height > most) {
        snprintf(message, GM_MESSAGE, "A picture of %d x %d pixels cannot be painted; each side is 1 to %d.",
                 opengl->width, opengl->height, most);
        return false;
    }
    gl->GenFramebuffers(1, &opengl->framebuffer);
    gl->BindFramebuffer(GL_FRAMEBUFFER, opengl->framebuffer);
    gl->GenRenderbuffers(1, &opengl->colour_buffer);
    gl->BindRenderbuffer(GL_RENDERBUFFER, opengl->colour_buffer);
    gl->RenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, opengl->width, opengl->height);
    gl->FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, opengl->colour_buffer);
    gl->GenRenderbuffers(1, &opengl->stencil_buffer);
    gl->BindRenderbuffer(GL_RENDERBUFFER, opengl->stencil_buffer);
    static const struct {
        GLenum format, attachment;
    } stencils[] = {{GL_STENCIL_INDEX8, GL_STENCIL_ATTACHMENT},
                    {GL_DEPTH24_STENCIL8, GL_DEPTH_STENCIL_ATTACHMENT}};
    for (int i = 0; i < 2; i++) {
        gl->RenderbufferStorage(GL_RENDERBUFFER, stencils[i].format, opengl->width, opengl->height);
        gl->FramebufferRenderbuffer(GL_FRAMEBUFFER, stencils[i].attachment, GL_RENDERBUFFER,
                                    opengl->stencil_buffer);
        if (gl->GetError() == GL_NO_ERROR &&
            gl->CheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE) {
            return true;
        }
    }
    snprintf(message, GM_MESSAGE, "This OpenGL gives no framebuffer of %d x %d pixels.", opengl->width,
             opengl->height);
    return false;
}

static void texture_parameters(const struct gm_gl *gl)
{
    gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

static void textures_open(struct gm_opengl *opengl)
{
    const struct gm_gl *gl = &opengl->engine->gl;
    unsigned char texels[MAP_ROWS][MAP_STEPS][4];
    for (int map = 0; map < MAP_ROWS; map++) {
        for (int i = 0; i < MAP_STEPS; i++) {
            const struct gm_rgb rgb =
                gm_colour_map_at((enum gm_colour_map)map, opengl->theme, (double)i / (MAP_STEPS - 1));
            memcpy(texels[map][i], (const unsigned char[]){rgb.r, rgb.g, rgb.b, 255}, 4);
        }
    }
    gl->PixelStorei(GL_UNPACK_ALIGNMENT, 1);
    gl->GenTextures(1, &opengl->atlas);
    gl->ActiveTexture(GL_TEXTURE0);
    gl->BindTexture(GL_TEXTURE_2D, opengl->atlas);
    texture_parameters(gl);
    gl->GenTextures(1, &opengl->maps);
    gl->ActiveTexture(GL_TEXTURE1);
    gl->BindTexture(GL_TEXTURE_2D, opengl->maps);
    texture_parameters(gl);
    gl->TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, MAP_STEPS, MAP_ROWS, 0, GL_RGBA, GL_UNSIGNED_BYTE, texels);
}

static bool use(const struct engine *engine)
{
    return engine->backend && engine->backend->use();
}

static bool complete(struct engine *engine, char *message)
{
#define FIND(name)                                                                                           \
    engine->gl.name = (__typeof__(engine->gl.name))engine->backend->find("gl" #name);                        \
    if (!engine->gl.name) {                                                                                  \
        return gm_refuse(message, "This OpenGL lacks the function gl%s.", #name);                            \
    }
    GM_GL_FUNCTIONS(FIND)
#undef FIND
    const char *version = (const char *)engine->gl.GetString(GL_VERSION);
    const char *renderer = (const char *)engine->gl.GetString(GL_RENDERER);
    const char *mesa = strstr(version, "Mesa");
    snprintf(engine->name, sizeof engine->name, "OpenGL %.3s, %s%s%s", version, renderer, mesa ? ", " : "",
             mesa ? mesa : "");
    return gm_stream_open(&engine->stream, &engine->gl, message);
}

static bool engine_open(struct engine *engine, char *message)
{
    char reason[GM_MESSAGE / 2];
    engine->backend = gm_context_open((enum gm_context_kind)(engine - engines), reason, sizeof reason);
    if (!engine->backend) {
        return gm_refuse(message, "No OpenGL context could be opened: %s.", reason);
    }
    if (!complete(engine, message)) {
        engine->backend->close();
        engine->backend = NULL;
    }
    return engine->backend != NULL;
}

static void close_alone(struct gm_opengl *opengl)
{
    const struct engine *engine = opengl->engine;
    if (use(engine)) {
        const struct gm_gl *gl = &engine->gl;
        gl->DeleteTextures(1, &opengl->atlas);
        gl->DeleteTextures(1, &opengl->maps);
        gl->DeleteFramebuffers(1, &opengl->framebuffer);
        gl->DeleteRenderbuffers(1, &opengl->colour_buffer);
        gl->DeleteRenderbuffers(1, &opengl->stencil_buffer);
    }
    free(opengl);
}

const char *gm_opengl_name(const struct gm_opengl *opengl)
{
    return opengl->engine->name;
}

static void bind_textures(struct gm_opengl *opengl, const struct gm_atlas *atlas)
{
    const struct gm_gl *gl = &opengl->engine->gl;
    gl->ActiveTexture(GL_TEXTURE1);
    gl->BindTexture(GL_TEXTURE_2D, opengl->maps);
    gl->ActiveTexture(GL_TEXTURE0);
    gl->BindTexture(GL_TEXTURE_2D, opengl->atlas);
    if (atlas->height != opengl->atlas_height) {
        gl->TexImage2D(GL_TEXTURE_2D, 0, GL_R8, atlas->width, atlas->height, 0, GL_RED, GL_UNSIGNED_BYTE,
                       atlas->pixels);
    } else if (atlas->changed < atlas->used) {
        gl->TexSubImage2D(GL_TEXTURE_2D, 0, 0, atlas->changed, atlas->width, atlas->used - atlas->changed,
                          GL_RED, GL_UNSIGNED_BYTE,
                          atlas->pixels + (size_t)atlas->changed * (size_t)atlas->width);
    }
    opengl->atlas_height = atlas->height;
}

static void clear(const struct gm_opengl *opengl)
{
    const struct gm_gl *gl = &opengl->engine->gl;
    const struct gm_rgb paper = gm_theme_colour(opengl->theme, GM_PAPER);
    gl->BindFramebuffer(GL_FRAMEBUFFER, opengl->framebuffer);
    gl->Viewport(0, 0, opengl->width, opengl->height);
    gl->ClearColor(paper.r / 255.0f, paper.g / 255.0f, paper.b / 255.0f, 1.0f);
    gl->ClearStencil(0);
    gl->Clear(GL_COLOR_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
}

static bool draw_alone(struct gm_opengl *opengl, const struct gm_batch *batch, const struct gm_atlas *atlas,
                       unsigned char *rgba)
{
    struct engine *engine = opengl->engine;
    if (!use(engine)) {
        return false;
    }
    bind_textures(opengl, atlas);
    clear(opengl);
    const bool drawn = gm_stream_draw(&engine->stream, batch, opengl->width, opengl->height);
    engine->gl.PixelStorei(GL_PACK_ALIGNMENT, 1);
    engine->gl.ReadPixels(0, 0, opengl->width, opengl->height, GL_RGBA, GL_UNSIGNED_BYTE, rgba);
    return drawn;
}

/* Mesa's software contexts of one process are not thread-safe: two threads that paint at once crash in
   libOSMesa 22.3. So all canvases take turns. */
static pthread_mutex_t turn = PTHREAD_MUTEX_INITIALIZER;

static void take_turn(void)
{
    pthread_mutex_lock(&turn);
    gm_context_guard();
}

static void end_turn(const struct engine *engine)
{
    if (engine->backend) {
        engine->backend->release();
    }
    gm_context_unguard();
    pthread_mutex_unlock(&turn);
}

/* Returns true in the process that has set OpenGL up. A process forked from it has none of its threads and
   would hang; returns false with a sentence there. */
static bool is_here(char *message)
{
    static pid_t set_up_in;
    set_up_in = set_up_in ? set_up_in : getpid();
    return set_up_in == getpid() ||
           gm_refuse(message,
                     "A process that was forked from one that had painted by OpenGL cannot paint by it.");
}

/* Makes the engine current; the first call opens it. */
static bool use_alone(struct engine *engine, char *message)
{
    return is_here(message) && (engine->backend ? use(engine) : engine_open(engine, message));
}

bool gm_opengl_load(enum gm_context_kind kind, char *message, size_t size)
{
    take_turn();
    const bool loaded = gm_context_load(kind, message, size);
    end_turn(&engines[kind]);
    return loaded;
}

void gm_opengl_set_up(enum gm_context_kind kind)
{
    char message[GM_MESSAGE]; /* not reported: the first picture fails for the same reason */
    take_turn();
    use_alone(&engines[kind], message);
    end_turn(&engines[kind]);
}

struct gm_opengl *gm_opengl_open(enum gm_context_kind kind, int width, int height, enum gm_theme theme,
                                 char *message)
{
    struct gm_opengl *opengl = calloc(1, sizeof *opengl);
    if (!opengl) {
        gm_refuse(message, "There is not enough memory for a picture.");
        return NULL;
    }
    struct engine *engine = &engines[kind];
    *opengl = (struct gm_opengl){.engine = engine, .width = width, .height = height, .theme = theme};
    take_turn();
    const bool here = is_here(message);
    const bool good = use_alone(engine, message) && framebuffer_open(opengl, message);
    if (good) {
        textures_open(opengl);
    } else {
        close_alone(opengl);
        if (here && !gm_address_space_has(GM_CONTEXT_TAKES)) {
            gm_refuse(message, "There is not enough memory to paint pictures.");
        }
    }
    end_turn(engine);
    return good ? opengl : NULL;
}

void gm_opengl_close(struct gm_opengl *opengl)
{
    if (!opengl) {
        return;
    }
    const struct engine *engine = opengl->engine;
    take_turn();
    close_alone(opengl);
    end_turn(engine);
}

bool gm_opengl_draw(struct gm_opengl *opengl, const struct gm_batch *batch, const struct gm_atlas *atlas,
                    unsigned char *rgba)
{
    take_turn();
    const bool drawn = draw_alone(opengl, batch, atlas, rgba);
    if (!drawn) {
        gm_address_space_has(GM_CONTEXT_TAKES); /* notes Mesa's refusal of memory */
    }
    end_turn(opengl->engine);
    return drawn;
}
