/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_GL_STREAM_H
#define GM_RENDER_GL_STREAM_H

#include "render/gl/gl.h"
#include "render/triangles/triangles.h"

/* A batch through OpenGL: its vertices in one buffer, its calls one by one, its images as textures. */
struct gm_stream {
    const struct gm_gl *gl;
    GLuint programs[GM_PROGRAM_COUNT], array, buffer, index_buffer;
    GLuint *images; /* textures of a frame's images, reused in the next frame */
    size_t image_count, images_used;
    float *texels;
    size_t texel_capacity;
};

/* Needs a current context and lives as long as it. Returns false with a sentence if a shader does not
   compile. */
bool gm_stream_open(struct gm_stream *stream, const struct gm_gl *gl, char *message);

/* Draws everything into the bound framebuffer of width x height pixels. Texture unit 0 has the glyph atlas,
   unit 1 the colour maps. Returns false on a GL error or when out of memory. */
bool gm_stream_draw(struct gm_stream *stream, const struct gm_batch *batch, int width, int height);

#endif
