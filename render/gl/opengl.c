/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Triangles drawn with OpenGL, the calls of a batch as its calls, and the pixels read back. */
#include "render/gl/opengl.h"

#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "render/address_space.h"
#include "render/grow.h"
#include "render/message.h"

/* The GL functions the painter uses, found at run time through the context: glClear is gl->Clear. */
/* clang-format off */
#define GM_GL_FUNCTIONS(F) \
    F(ActiveTexture) F(AttachShader) F(BindAttribLocation) F(BindBuffer) F(BindFramebuffer) \
    F(BindRenderbuffer) F(BindTexture) F(BindVertexArray) F(BlendFuncSeparate) F(BufferData) \
    F(BufferSubData) F(CheckFramebufferStatus) F(Clear) F(ClearColor) F(ClearStencil) F(ColorMask) \
    F(CompileShader) F(CreateProgram) F(CreateShader) F(DeleteFramebuffers) F(DeleteRenderbuffers) \
    F(DeleteShader) F(DeleteTextures) F(Disable) F(DrawArrays) F(DrawElements) F(Enable) \
    F(EnableVertexAttribArray) F(FramebufferRenderbuffer) F(GenBuffers) F(GenFramebuffers) \
    F(GenRenderbuffers) F(GenTextures) F(GenVertexArrays) F(GetError) F(GetIntegerv) F(GetProgramiv) \
    F(GetString) F(GetUniformLocation) F(LinkProgram) F(PixelStorei) F(ReadPixels) F(RenderbufferStorage) \
    F(Scissor) F(ShaderSource) F(StencilFunc) F(StencilMask) F(StencilOp) F(TexImage2D) F(TexParameteri) \
    F(TexSubImage2D) F(Uniform1i) F(Uniform2f) F(UseProgram) F(VertexAttribPointer) F(Viewport)
struct gl {
#define GM_GL_POINTER(name) __typeof__(gl##name) *name;
    GM_GL_FUNCTIONS(GM_GL_POINTER)
#undef GM_GL_POINTER
};
/* clang-format on */

/* A batch through OpenGL: its vertices in one buffer, its calls one by one, its images as textures. */
struct stream {
    const struct gl *gl;
    GLuint programs[GM_PROGRAM_COUNT], array, buffer, index_buffer;
    GLuint *images; /* textures of a frame's images, reused in the next frame */
    size_t image_count, images_used;
    float *texels;
    size_t texel_capacity;
};

/* ---- shaders (struct gm_vertex defines their vertices) ---- */

/* The first row of pixels in memory is the top of the picture, so y is not inverted. */
static const char vertex_source[] = "#version 330 core\n"
                                    "uniform vec2 scale;\n"
                                    "in vec2 place;\n"
                                    "in vec3 shape;\n"
                                    "in vec4 colour;\n"
                                    "out vec3 edge;\n"
                                    "out vec4 ink;\n"
                                    "void main() {\n"
                                    "    gl_Position = vec4(place * scale - 1.0, 0.0, 1.0);\n"
                                    "    edge = shape;\n"
                                    "    ink = colour;\n"
                                    "}\n";

static const char fragment_head[] =
    "#version 330 core\n"
    "uniform sampler2D glyphs, maps, image;\n"
    "in vec3 edge;\n"
    "in vec4 ink;\n"
    "out vec4 pixel;\n"
    "vec3 mapped(float value) {\n"
    "    int last = textureSize(maps, 0).x - 1;\n"
    "    ivec2 shade = ivec2(clamp(value, 0.0, 1.0) * float(last) + 0.5, ink.r + 0.5);\n"
    "    return texelFetch(maps, shade, 0).rgb;\n"
    "}\n"
    "float covered() { return clamp(edge.z + 0.5 - length(edge.xy), 0.0, 1.0); }\n";

/* All shaders read all of edge and ink, with factors of 1 and terms of 0 if need be: llvmpipe compiles the
   setup of triangles once for each choice of components, 4 ms that no cache on disk saves. */
static const char *const fragment_sources[GM_PROGRAM_COUNT] = {
    [GM_PROGRAM_INK] = "void main() { pixel = vec4(ink.rgb, ink.a * covered()); }\n",
    [GM_PROGRAM_CORE] = "void main() { if (covered() < 1.0) discard; pixel = ink; }\n",
    [GM_PROGRAM_TEXT] =
        "void main() { pixel = vec4(ink.rgb, edge.z * ink.a * texelFetch(glyphs, ivec2(edge.xy), 0).r); }\n",
    [GM_PROGRAM_FIELD] = "void main() { pixel = vec4(ink.gba * mapped(edge.x + edge.y), edge.z); }\n",
    [GM_PROGRAM_IMAGE] =
        "void main() { pixel = vec4(ink.gba * mapped(texture(image, edge.xy).r), edge.z); }\n",
};

static GLuint compile(const struct gl *gl, GLenum kind, const char *head, const char *body)
{
    const GLuint shader = gl->CreateShader(kind);
    const char *sources[] = {head, body};
    gl->ShaderSource(shader, 2, sources, NULL);
    gl->CompileShader(shader);
    return shader;
}

static bool link_program(const struct gl *gl, GLuint program, const char *fragment_body)
{
    const GLuint vertex = compile(gl, GL_VERTEX_SHADER, vertex_source, "");
    const GLuint fragment = compile(gl, GL_FRAGMENT_SHADER, fragment_head, fragment_body);
    gl->AttachShader(program, vertex);
    gl->AttachShader(program, fragment);
    gl->BindAttribLocation(program, 0, "place");
    gl->BindAttribLocation(program, 1, "shape");
    gl->BindAttribLocation(program, 2, "colour");
    gl->LinkProgram(program);
    gl->DeleteShader(vertex);
    gl->DeleteShader(fragment);
    GLint linked = GL_FALSE;
    gl->GetProgramiv(program, GL_LINK_STATUS, &linked);
    return linked;
}

/* Uses the program for a picture of width x height pixels. The first use compiles it, since most pictures
   need few of the five. Returns false if this OpenGL cannot compile it. */
static bool use_program(const struct gl *gl, GLuint *programs, enum gm_program program, int width, int height)
{
    static const char *const samplers[] = {"glyphs", "maps", "image"}; /* sorted by texture unit */
    const bool is_new = programs[program] == 0;
    const GLuint made = programs[program] = is_new ? gl->CreateProgram() : programs[program];
    const bool linked = !is_new || link_program(gl, made, fragment_sources[program]);
    gl->UseProgram(made); /* a program that is not linked gives a GL error here and in all later uses */
    for (int unit = 0; is_new && linked && unit < 3; unit++) {
        const GLint location = gl->GetUniformLocation(made, samplers[unit]);
        if (location >= 0) {
            gl->Uniform1i(location, unit);
        }
    }
    if (linked) {
        gl->Uniform2f(gl->GetUniformLocation(made, "scale"), 2.0f / (float)width, 2.0f / (float)height);
    }
    return linked;
}

/* ---- calls ---- */

/* Bits of the stencil: the upper one for inside and outside, the others number groups painted once. */
enum { INSIDE_BIT = 0x80, ONCE_BITS = 0x7f };

/* Needs a current context and lives as long as it. Returns false with a sentence if a shader does not
   compile. */
static bool stream_open(struct stream *stream, const struct gl *gl, char *message)
{
    *stream = (struct stream){.gl = gl};
    if (!use_program(gl, stream->programs, GM_PROGRAM_INK, 1, 1)) {
        return gm_refuse(message, "This OpenGL cannot compile the painter's shaders.");
    }
    gl->GenVertexArrays(1, &stream->array);
    gl->BindVertexArray(stream->array);
    gl->GenBuffers(1, &stream->buffer);
    gl->GenBuffers(1, &stream->index_buffer);
    gl->BindBuffer(GL_ARRAY_BUFFER, stream->buffer);
    gl->BindBuffer(GL_ELEMENT_ARRAY_BUFFER, stream->index_buffer);
    const GLsizei stride = sizeof(struct gm_vertex);
    gl->VertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, stride, (const void *)offsetof(struct gm_vertex, x));
    gl->VertexAttribPointer(1, 3, GL_FLOAT, GL_FALSE, stride,
                            (const void *)offsetof(struct gm_vertex, across));
    gl->VertexAttribPointer(2, 4, GL_UNSIGNED_BYTE, GL_TRUE, stride,
                            (const void *)offsetof(struct gm_vertex, colour));
    for (GLuint i = 0; i < 3; i++) {
        gl->EnableVertexAttribArray(i);
    }
    return true;
}

/* Sets how the bound texture is read: by that filter, and beyond its edges like the edges. */
static void set_texture(const struct gl *gl, GLint filter)
{
    gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
    gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
    gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

/* Returns a texture that no image of this frame uses yet; 0 when out of memory. */
static GLuint next_texture(struct stream *stream)
{
    const struct gl *gl = stream->gl;
    if (stream->images_used == stream->image_count) {
        GLuint *images = realloc(stream->images, (stream->image_count + 1) * sizeof *images);
        if (!images) {
            return 0;
        }
        stream->images = images;
        gl->GenTextures(1, &images[stream->image_count]);
        gl->BindTexture(GL_TEXTURE_2D, images[stream->image_count++]);
        set_texture(gl, GL_LINEAR);
    }
    const GLuint texture = stream->images[stream->images_used++];
    gl->BindTexture(GL_TEXTURE_2D, texture);
    return texture;
}

/* Binds the values of an image to the current texture unit. Returns false when out of memory. */
static bool bind_image(struct stream *stream, const struct gm_mark *mark)
{
    const struct gl *gl = stream->gl;
    GLint most = 1;
    gl->GetIntegerv(GL_MAX_TEXTURE_SIZE, &most);
    /* An image larger than the largest texture is reduced to every stride-th value. */
    const size_t limit = (size_t)most, row_stride = (mark->rows - 1) / limit + 1,
                 column_stride = (mark->columns - 1) / limit + 1;
    const size_t rows = (mark->rows - 1) / row_stride + 1, columns = (mark->columns - 1) / column_stride + 1;
    if (!gm_grow(&stream->texels, &stream->texel_capacity, rows * columns, sizeof *stream->texels)) {
        return false;
    }
    const double factor = 1.0 / (mark->high - mark->low);
    for (size_t row = 0; row < rows; row++) {
        const double *values = mark->values + row * row_stride * mark->columns;
        for (size_t column = 0; column < columns; column++) {
            stream->texels[row * columns + column] =
                (float)(factor * (values[column * column_stride] - mark->low));
        }
    }
    if (next_texture(stream) == 0) {
        return false;
    }
    gl->TexImage2D(GL_TEXTURE_2D, 0, GL_R32F, (GLsizei)columns, (GLsizei)rows, 0, GL_RED, GL_FLOAT,
                   stream->texels);
    return true;
}

static void set_stencil(const struct gl *gl, const struct gm_draw_call *call)
{
    if (call->stencil == GM_STENCIL_NONE) {
        gl->Disable(GL_STENCIL_TEST);
        return;
    }
    gl->Enable(GL_STENCIL_TEST);
    switch (call->stencil) {
    case GM_STENCIL_ONCE:
        gl->StencilMask(ONCE_BITS);
        gl->StencilFunc(GL_NOTEQUAL, call->once % ONCE_BITS + 1, ONCE_BITS);
        gl->StencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
        break;
    case GM_STENCIL_INVERT:
        gl->StencilMask(INSIDE_BIT);
        gl->StencilFunc(GL_ALWAYS, 0, INSIDE_BIT);
        gl->StencilOp(GL_KEEP, GL_KEEP, GL_INVERT);
        break;
    case GM_STENCIL_OUTSIDE:
        gl->StencilFunc(GL_NOTEQUAL, INSIDE_BIT, INSIDE_BIT);
        gl->StencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
        break;
    case GM_STENCIL_INSIDE:
        gl->StencilMask(INSIDE_BIT);
        gl->StencilFunc(GL_EQUAL, INSIDE_BIT, INSIDE_BIT);
        gl->StencilOp(GL_KEEP, GL_KEEP, GL_ZERO);
        break;
    case GM_STENCIL_NONE:
        break;
    }
}

/* Numbers of groups repeat after ONCE_BITS of them: old marks in the stencil must go first. */
static void forget_groups(const struct gl *gl)
{
    gl->Disable(GL_SCISSOR_TEST);
    gl->StencilMask(ONCE_BITS);
    gl->Clear(GL_STENCIL_BUFFER_BIT);
    gl->Enable(GL_SCISSOR_TEST);
}

/* Draws everything into the bound framebuffer of width x height pixels. Texture unit 0 has the glyph atlas,
   unit 1 the colour maps. Returns false on a GL error or when out of memory. */
static bool stream_draw(struct stream *stream, const struct gm_batch *batch, int width, int height)
{
    const struct gl *gl = stream->gl;
    bool has_images = true;
    stream->images_used = 0;
    gl->BindVertexArray(stream->array);
    gl->BindBuffer(GL_ARRAY_BUFFER, stream->buffer);
    gl->BufferData(GL_ARRAY_BUFFER, (GLsizeiptr)(batch->vertex_count * sizeof *batch->vertices),
                   batch->vertices, GL_STREAM_DRAW);
    if (batch->index_count > 0) {
        gl->BufferData(GL_ELEMENT_ARRAY_BUFFER, (GLsizeiptr)(batch->index_count * sizeof *batch->indices),
                       batch->indices, GL_STREAM_DRAW);
    }
    gl->Enable(GL_BLEND);
    gl->BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    gl->Enable(GL_SCISSOR_TEST);
    gl->ActiveTexture(GL_TEXTURE2);

    int rounds = 0;
    for (size_t i = 0; i < batch->call_count; i++) {
        const struct gm_draw_call *call = &batch->calls[i];
        if (call->stencil == GM_STENCIL_ONCE && call->once / ONCE_BITS != rounds) {
            rounds = call->once / ONCE_BITS;
            forget_groups(gl);
        }
        if (i == 0 || call[-1].program != call->program) {
            use_program(gl, stream->programs, call->program, width, height); /* a failure leaves a GL error */
        }
        gl->Scissor(call->scissor[0], call->scissor[1], call->scissor[2], call->scissor[3]);
        set_stencil(gl, call);
        const bool colour = call->stencil != GM_STENCIL_INVERT;
        gl->ColorMask(colour, colour, colour, colour);
        if (call->program == GM_PROGRAM_IMAGE) {
            has_images = bind_image(stream, call->image) && has_images;
        }
        if (call->indexed) {
            gl->DrawElements(GL_TRIANGLES, (GLsizei)call->count, GL_UNSIGNED_INT,
                             (const void *)(call->first * sizeof *batch->indices));
        } else {
            gl->DrawArrays(GL_TRIANGLE_STRIP, (GLint)call->first, (GLsizei)call->count);
        }
    }
    gl->ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    gl->StencilMask(0xff);
    gl->Disable(GL_SCISSOR_TEST);
    return has_images && !batch->short_of_memory && gl->GetError() == GL_NO_ERROR;
}

/* ---- pictures ---- */

enum { MAP_STEPS = 16 * 255 + 1 /* as in the rasteriser */, MAP_ROWS = 2 };

/* The state that all pictures of a kind share: setting it up takes longer than drawing one. */
struct engine {
    const struct gm_backend *backend; /* NULL: it has no context */
    struct gl gl;
    struct stream stream;
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
    const struct gl *gl = &opengl->engine->gl;
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

static void textures_open(struct gm_opengl *opengl)
{
    const struct gl *gl = &opengl->engine->gl;
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
    set_texture(gl, GL_NEAREST);
    gl->GenTextures(1, &opengl->maps);
    gl->ActiveTexture(GL_TEXTURE1);
    gl->BindTexture(GL_TEXTURE_2D, opengl->maps);
    set_texture(gl, GL_NEAREST);
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
    return stream_open(&engine->stream, &engine->gl, message);
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
        const struct gl *gl = &engine->gl;
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
    const struct gl *gl = &opengl->engine->gl;
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
    const struct gl *gl = &opengl->engine->gl;
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
    const bool drawn = stream_draw(&engine->stream, batch, opengl->width, opengl->height);
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
    const bool opened = use_alone(engine, message) && framebuffer_open(opengl, message);
    if (opened) {
        textures_open(opengl);
    } else {
        close_alone(opengl);
        if (here && !gm_address_space_has(GM_CONTEXT_TAKES)) {
            gm_refuse(message, "There is not enough memory to paint pictures.");
        }
    }
    end_turn(engine);
    return opened ? opengl : NULL;
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
