/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One stream of vertices and a short list of draw calls for a whole frame. */
#include "render/triangles/triangles.h"

#include <stdlib.h>
#include <string.h>

#include "render/grow.h"

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

void gm_batch_state(struct gm_batch *batch, enum gm_program program, enum gm_stencil stencil)
{
    batch->program = program;
    batch->stencil = stencil;
}

static bool room_for(struct gm_batch *batch, void *block, size_t *capacity, size_t wanted, size_t size)
{
    const size_t first = 4096;
    const bool grown = gm_grow(block, capacity, wanted > first ? wanted : first, size);
    batch->short_of_memory = batch->short_of_memory || !grown;
    return grown;
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
    if (!room_for(batch, &batch->calls, &batch->call_capacity, batch->call_count + 1, sizeof *batch->calls)) {
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
    if (!room_for(batch, &batch->vertices, &batch->vertex_capacity, batch->vertex_count + count + joint,
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

void gm_batch_quad(struct gm_batch *batch, const struct gm_vertex corners[4])
{
    struct gm_vertex *strip = gm_batch_strip(batch, 4);
    if (strip) {
        memcpy(strip, corners, 4 * sizeof *strip);
        gm_batch_end(batch, 0);
    }
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
    if (!room_for(batch, &batch->vertices, &batch->vertex_capacity, batch->vertex_count + count,
                  sizeof *batch->vertices) ||
        !room_for(batch, &batch->indices, &batch->index_capacity, batch->index_count + index_count,
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
