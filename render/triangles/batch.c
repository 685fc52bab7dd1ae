/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One stream of vertices and a short list of draw calls for a whole frame. */
#include "render/triangles/triangles.h"

#include <stdlib.h>
#include <string.h>

void gm_batch_free(struct gm_batch *batch)
{
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
    batch->image = NULL;
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

void gm_batch_image(struct gm_batch *batch, const struct gm_mark *image)
{
    batch->image = image;
}

void gm_batch_once(struct gm_batch *batch)
{
    batch->once++;
}

/* Makes room for `more` elements. When out of memory it returns false, and the block stays valid. */
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

/* Returns the call for the current state, a new one if the last differs, or NULL. */
static struct gm_draw_call *call_for(struct gm_batch *batch, bool indexed)
{
    if (batch->call_count > 0 && !indexed) {
        struct gm_draw_call *last = &batch->calls[batch->call_count - 1];
        if (!last->indexed && last->program == batch->program && last->stencil == batch->stencil &&
            (last->stencil != GM_STENCIL_ONCE || last->once == batch->once) && last->image == batch->image &&
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
                                  .image = batch->image,
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
