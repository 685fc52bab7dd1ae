/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The calls of a batch as calls of OpenGL, and the shaders of a frame. */
#include "render/gl/stream.h"

#include <stdlib.h>

#include "render/grow.h"
#include "render/message.h"

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

static GLuint compile(const struct gm_gl *gl, GLenum kind, const char *head, const char *body)
{
    const GLuint shader = gl->CreateShader(kind);
    const char *sources[] = {head, body};
    gl->ShaderSource(shader, 2, sources, NULL);
    gl->CompileShader(shader);
    return shader;
}

static bool link_program(const struct gm_gl *gl, GLuint program, const char *fragment_body)
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
static bool use_program(const struct gm_gl *gl, GLuint *programs, enum gm_program program, int width,
                        int height)
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

bool gm_stream_open(struct gm_stream *stream, const struct gm_gl *gl, char *message)
{
    *stream = (struct gm_stream){.gl = gl};
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

/* Returns a texture that no image of this frame uses yet; 0 when out of memory. */
static GLuint next_texture(struct gm_stream *stream)
{
    const struct gm_gl *gl = stream->gl;
    if (stream->images_used == stream->image_count) {
        GLuint *images = realloc(stream->images, (stream->image_count + 1) * sizeof *images);
        if (!images) {
            return 0;
        }
        stream->images = images;
        gl->GenTextures(1, &images[stream->image_count]);
        gl->BindTexture(GL_TEXTURE_2D, images[stream->image_count++]);
        gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
        gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
        gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
        gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    }
    const GLuint texture = stream->images[stream->images_used++];
    gl->BindTexture(GL_TEXTURE_2D, texture);
    return texture;
}

/* Binds the values of an image to the current texture unit. Returns false when out of memory. */
static bool bind_image(struct gm_stream *stream, const struct gm_mark *mark)
{
    const struct gm_gl *gl = stream->gl;
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

static void set_stencil(const struct gm_gl *gl, const struct gm_draw_call *call)
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
static void forget_groups(const struct gm_gl *gl)
{
    gl->Disable(GL_SCISSOR_TEST);
    gl->StencilMask(ONCE_BITS);
    gl->Clear(GL_STENCIL_BUFFER_BIT);
    gl->Enable(GL_SCISSOR_TEST);
}

bool gm_stream_draw(struct gm_stream *stream, const struct gm_batch *batch, int width, int height)
{
    const struct gm_gl *gl = stream->gl;
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
