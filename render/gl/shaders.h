/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_GL_SHADERS_H
#define GM_RENDER_GL_SHADERS_H

#include "render/gl/gl.h"

/* The programs of enum gm_program (render/gl/batch.h says what their vertices mean). */
bool gm_shaders_open(const struct gm_gl *gl, GLuint *programs, char *message, size_t size);
void gm_shaders_close(const struct gm_gl *gl, GLuint *programs);
void gm_shaders_resize(const struct gm_gl *gl, const GLuint *programs, int width, int height);

#endif
