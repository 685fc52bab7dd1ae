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

/* Uses the program, made when it is first wanted (most pictures need few of the five), for pictures of so many
   pixels, which stay the same. False if this OpenGL cannot compile it. */
bool gm_shaders_use(const struct gm_gl *gl, GLuint *programs, enum gm_program program, int width, int height);
/* Those that were made; others are 0. */
void gm_shaders_close(const struct gm_gl *gl, GLuint *programs);

#endif
