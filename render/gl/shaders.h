/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_GL_SHADERS_H
#define GM_RENDER_GL_SHADERS_H

#include "render/gl/gl.h"

/* The programs (struct gm_vertex in render/gl/batch.h says what their vertices mean). */

enum gm_program {
    GM_PROGRAM_INK,
    GM_PROGRAM_CORE, /* ink where it covers pixels wholly */
    GM_PROGRAM_TEXT,
    GM_PROGRAM_FIELD,
    GM_PROGRAM_IMAGE,
    GM_PROGRAM_COUNT,
};

/* Makes all of them. False, with a sentence in message, when one does not compile. */
bool gm_shaders_open(const struct gm_gl *gl, GLuint *programs, char *message, size_t size);
void gm_shaders_close(const struct gm_gl *gl, GLuint *programs);
/* For pictures of so many pixels. */
void gm_shaders_resize(const struct gm_gl *gl, const GLuint *programs, int width, int height);

#endif
