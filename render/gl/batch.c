/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One stream of vertices and a short list of draw calls for a whole frame. */
#include "render/gl/batch.h"

#include <stdlib.h>
#include <string.h>

#include "render/message.h"

struct gm_draw_call {
    enum gm_program program;
    enum gm_stencil stencil;
    bool indexed;
    int once;
    int scissor[4];
    GLuint texture;
    size_t first, count; /* vertices, or indices */
};

/* Bits of the stencil: the upper one for inside and outside, the others number groups painted once. */
enum { INSIDE_BIT = 0x80, ONCE_BITS = 0x7f };

bool gm_batch_open(struct gm_batch *batch, const struct gm_gl *gl, int width, int height, char *message)
{
    *batch = (struct gm_batch){.gl = gl};
    if (!gm_shaders_use(gl, batch->programs, GM_PROGRAM_INK, width, height)) {
        return gm_refuse(message, "This OpenGL cannot compile the painter's shaders.");
    }
    gl->GenVertexArrays(1, &batch->array);
    gl->BindVertexArray(batch->array);
    gl->GenBuffers(1, &batch->buffer);
    gl->GenBuffers(1, &batch->index_buffer);
    gl->BindBuffer(GL_ARRAY_BUFFER, batch->buffer);
    gl->BindBuffer(GL_ELEMENT_ARRAY_BUFFER, batch->index_buffer);
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

void gm_batch_close(struct gm_batch *batch)
{
    const struct gm_gl *gl = batch->gl;
    if (gl) {
        gm_shaders_close(gl, batch->programs);
        gl->DeleteBuffers(1, &batch->buffer);
        gl->DeleteBuffers(1, &batch->index_buffer);
        gl->DeleteVertexArrays(1, &batch->array);
    }
    free(batch->vertices);
    free(batch->indices);
    free(batch->calls);
}

void gm_batch_clear(struct gm_batch *batch)
{
    batch->vertex_count = batch->index_count = batch->call_count = batch->join = 0;
    batch->once = 0;
    batch->short_of_memory = false;
    batch->program = GM_PROGRAM_INK;
    batch->stencil = GM_STENCIL_NONE;
    batch->texture = 0;
}

void gm_batch_scissor(struct gm_batch *batch, int x, int y, int width, int height)
{
    const int scissor[4] = {x, y, width, height};
    memcpy(batch->scissor, scissor, sizeof scissor);
}

void gm_batch_state(struct gm_batch *batch, enum gm_program program, enum gm_stencil stencil)
{
    batch->program = program;
    batch->stencil = stencil;
}

void gm_batch_texture(struct gm_batch *batch, GLuint texture)
{
    batch->texture = texture;
}

void gm_batch_once(struct gm_batch *batch)
{
    batch->once++;
}

/* Room for `more` further elements. The block stays where it is when memory is short. */
static bool grow(struct gm_batch *batch, void **block, size_t *capacity, size_t count, size_t more,
                 size_t size)
{
    if (more <= *capacity - count) {
        return true;
    }
    size_t wanted = *capacity > 0 ? 2 * *capacity : 4096;
    while (wanted - count < more && wanted < SIZE_MAX / 4 / size) {
        wanted *= 2;
    }
    void *bigger = wanted - count < more ? NULL : realloc(*block, wanted * size);
    if (!bigger) {
        batch->short_of_memory = true;
        return false;
    }
    *block = bigger;
    *capacity = wanted;
    return true;
}

/* The call for the present state, a new one if the last differs. */
static struct gm_draw_call *call_for(struct gm_batch *batch, bool indexed)
{
    if (batch->call_count > 0 && !indexed) {
        struct gm_draw_call *last = &batch->calls[batch->call_count - 1];
        if (!last->indexed && last->program == batch->program && last->stencil == batch->stencil &&
            (last->stencil != GM_STENCIL_ONCE || last->once == batch->once) &&
            last->texture == batch->texture &&
            memcmp(last->scissor, batch->scissor, sizeof last->scissor) == 0) {
            return last;
        }
    }
    if (!grow(batch, (void **)&batch->calls, &batch->call_capacity, batch->call_count, 1,
              sizeof *batch->calls)) {
        return NULL;
    }
    struct gm_draw_call *call = &batch->calls[batch->call_count++];
    *call = (struct gm_draw_call){.program = batch->program,
                                  .stencil = batch->stencil,
                                  .indexed = indexed,
                                  .once = batch->once,
                                  .texture = batch->texture,
                                  .first = indexed ? batch->index_count : batch->vertex_count};
    memcpy(call->scissor, batch->scissor, sizeof call->scissor);
    return call;
}

struct gm_vertex *gm_batch_strip(struct gm_batch *batch, size_t count)
{
    const size_t joint = 2; /* vertices of the degenerate triangles between two strips */
    if (!grow(batch, (void **)&batch->vertices, &batch->vertex_capacity, batch->vertex_count, count + joint,
              sizeof *batch->vertices)) {
        return NULL;
    }
    struct gm_draw_call *call = call_for(batch, false);
    if (!call) {
        return NULL;
    }
    batch->join = 0;
    if (call->count > 0) {
        batch->vertices[batch->vertex_count] = batch->vertices[batch->vertex_count - 1];
        batch->join = batch->vertex_count + 1;
        batch->vertex_count += joint;
        call->count += joint;
    }
    struct gm_vertex *strip = batch->vertices + batch->vertex_count;
    batch->vertex_count += count;
    call->count += count;
    return strip;
}

void gm_batch_end(struct gm_batch *batch, size_t unused)
{
    batch->vertex_count -= unused;
    batch->calls[batch->call_count - 1].count -= unused;
    if (batch->join > 0) {
        batch->vertices[batch->join] = batch->vertices[batch->join + 1];
    }
}

struct gm_vertex *gm_batch_mesh(struct gm_batch *batch, size_t count, size_t index_count, uint32_t **indices)
{
    if (!grow(batch, (void **)&batch->vertices, &batch->vertex_capacity, batch->vertex_count, count,
              sizeof *batch->vertices) ||
        !grow(batch, (void **)&batch->indices, &batch->index_capacity, batch->index_count, index_count,
              sizeof *batch->indices)) {
        return NULL;
    }
    struct gm_draw_call *call = call_for(batch, true);
    if (!call) {
        return NULL;
    }
    call->count = index_count;
    *indices = batch->indices + batch->index_count;
    batch->index_count += index_count;
    struct gm_vertex *vertices = batch->vertices + batch->vertex_count;
    batch->vertex_count += count;
    return vertices;
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

/* Numbers of groups come round after ONCE_BITS of them: old marks in the stencil must go first. */
static void forget_groups(const struct gm_gl *gl)
{
    gl->Disable(GL_SCISSOR_TEST);
    gl->StencilMask(ONCE_BITS);
    gl->Clear(GL_STENCIL_BUFFER_BIT);
    gl->Enable(GL_SCISSOR_TEST);
}

bool gm_batch_draw(struct gm_batch *batch, int width, int height)
{
    const struct gm_gl *gl = batch->gl;
    gl->BindVertexArray(batch->array);
    gl->BindBuffer(GL_ARRAY_BUFFER, batch->buffer);
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
        gm_shaders_use(gl, batch->programs, call->program, width, height); /* or GL has an error to tell */
        gl->Scissor(call->scissor[0], call->scissor[1], call->scissor[2], call->scissor[3]);
        set_stencil(gl, call);
        const bool colour = call->stencil != GM_STENCIL_INVERT;
        gl->ColorMask(colour, colour, colour, colour);
        if (call->program == GM_PROGRAM_IMAGE) {
            gl->BindTexture(GL_TEXTURE_2D, call->texture);
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
    return !batch->short_of_memory && gl->GetError() == GL_NO_ERROR;
}
