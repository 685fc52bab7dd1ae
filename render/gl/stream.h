/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_GL_STREAM_H
#define GM_RENDER_GL_STREAM_H

#include "render/gl/shaders.h"

/* A batch through OpenGL: its vertices in one buffer, its calls one by one, its images as textures. */
struct gm_stream {
    const struct gm_gl *gl;
    GLuint programs[GM_PROGRAM_COUNT], array, buffer, index_buffer;
    GLuint *images; /* textures for the images of a frame, used again in the next */
    size_t image_count, images_used;
    float *texels;
    size_t texel_capacity;
};

/* Needs a current context, with which it ends. False, with a sentence in message, when shaders do not compile. */
bool gm_stream_open(struct gm_stream *stream, const struct gm_gl *gl, char *message);

/* Draws everything into the bound framebuffer of width x height pixels. The glyph atlas is bound to texture
   unit 0, the colour maps to unit 1. */
bool gm_stream_draw(struct gm_stream *stream, const struct gm_batch *batch, int width, int height);

#endif
