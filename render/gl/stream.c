/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The calls of a batch as calls of OpenGL. */
#include "render/gl/stream.h"

#include <stdlib.h>

#include "render/grow.h"
#include "render/message.h"

/* Bits of the stencil: the upper one for inside and outside, the others number groups painted once. */
enum { INSIDE_BIT = 0x80, ONCE_BITS = 0x7f };

bool gm_stream_open(struct gm_stream *stream, const struct gm_gl *gl, char *message)
{
    *stream = (struct gm_stream){.gl = gl};
    if (!gm_shaders_use(gl, stream->programs, GM_PROGRAM_INK, 1, 1)) {
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
            gm_shaders_use(gl, stream->programs, call->program, width,
                           height); /* a failure leaves a GL error */
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
