/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_GL_OPENGL_H
#define GM_RENDER_GL_OPENGL_H

#include "render/drawing/glyphs.h"
#include "render/gl/context.h"
#include "render/layout/appearance.h"
#include "render/triangles/triangles.h"

/* OpenGL without a screen draws the triangles of a batch. The context comes from OSMesa or from EGL without a
   surface (render/gl/context.h): one of a kind in a process, kept to its end, in which several threads take turns. */

struct gm_opengl;

/* Loads the library of a kind, which stays. False with the reason: "libEGL.so.1 is not installed". */
bool gm_opengl_load(enum gm_context_kind kind, char *message, size_t size);

/* Sets up what all pictures of a kind share, which the first of them does else: beside a run, for instance. */
void gm_opengl_set_up(enum gm_context_kind kind);

/* For pictures of width x height pixels. NULL on failure, with one sentence in message (GM_MESSAGE bytes). */
struct gm_opengl *gm_opengl_open(enum gm_context_kind kind, int width, int height, enum gm_theme theme,
                                 char *message);
void gm_opengl_close(struct gm_opengl *opengl);

/* Draws on paper: height rows of width * 4 bytes, top row first. False when memory is short. */
bool gm_opengl_draw(struct gm_opengl *opengl, const struct gm_batch *batch, const struct gm_atlas *atlas,
                    unsigned char *rgba);

/* "OpenGL 4.5, llvmpipe (LLVM 15.0.6, 256 bits), Mesa 22.3.6". */
const char *gm_opengl_name(const struct gm_opengl *opengl);

#endif
