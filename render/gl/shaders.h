/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_GL_SHADERS_H
#define GM_RENDER_GL_SHADERS_H

#include "render/gl/gl.h"
#include "render/triangles/triangles.h"

/* The programs of a batch (struct gm_vertex defines its vertices). */

/* Uses the program for a picture of width x height pixels. The first use compiles it, since most pictures
   need few of the five. Returns false if this OpenGL cannot compile it. */
bool gm_shaders_use(const struct gm_gl *gl, GLuint *programs, enum gm_program program, int width, int height);

#endif
