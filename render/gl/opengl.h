/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_GL_OPENGL_H
#define GM_RENDER_GL_OPENGL_H

#include "render/drawing/glyphs.h"
#include "render/gl/context.h"
#include "render/layout/appearance.h"
#include "render/triangles/triangles.h"

/* OpenGL without a screen draws the triangles of a batch. The context comes from OSMesa or from EGL without a
   surface (render/gl/context.h). A process has one of each kind until it ends; threads take turns. */

struct gm_opengl;

/* Loads the library of a kind for good. Returns false with the reason: "libEGL.so.1 is not installed". */
bool gm_opengl_load(enum gm_context_kind kind, char *message, size_t size);

/* Sets up the state that all pictures of a kind share, before the first of them needs it. */
void gm_opengl_set_up(enum gm_context_kind kind);

/* Opens a canvas of width x height pixels. Returns NULL with a sentence in message (GM_MESSAGE bytes) on
   failure. */
struct gm_opengl *gm_opengl_open(enum gm_context_kind kind, int width, int height, enum gm_theme theme,
                                 char *message);
void gm_opengl_close(struct gm_opengl *opengl);

/* Draws on paper: height rows of width * 4 bytes, top row first. Returns false when out of memory. */
bool gm_opengl_draw(struct gm_opengl *opengl, const struct gm_batch *batch, const struct gm_atlas *atlas,
                    unsigned char *rgba);

/* The painter: "OpenGL 4.5, llvmpipe (LLVM 15.0.6, 256 bits), Mesa 22.3.6". */
const char *gm_opengl_name(const struct gm_opengl *opengl);

#endif
