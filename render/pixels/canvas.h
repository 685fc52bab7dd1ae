/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_PIXELS_CANVAS_H
#define GM_RENDER_PIXELS_CANVAS_H

#include "render/layout/appearance.h"
#include "render/message.h"
#include "render/picture/picture.h"

/* The GL painter: pictures to pixels, without a screen. One canvas has one look, whose title outlives it, and
   is used by one thread at a time; canvases of several threads take turns. The context comes from OSMesa or
   from EGL without a surface (render/gl/context.h). */

struct gm_canvas;

/* Loads the libraries that the first canvas needs: beside other work, in a thread of its own, that canvas opens
   in half the time. */
void gm_canvas_load(void);
/* NULL on failure, with one sentence in message (GM_MESSAGE bytes). */
struct gm_canvas *gm_canvas_open(const struct gm_appearance *look, char *message);
void gm_canvas_close(struct gm_canvas *canvas);

/* Paints the picture into rgb: height rows of width * 3 bytes, top row first. False when memory is short. */
bool gm_canvas_paint(struct gm_canvas *canvas, struct gm_picture *picture, unsigned char *rgb);

/* The panel of a state that a pixel is in, as gm_layout_locate. */
const struct gm_panel *gm_canvas_locate(struct gm_canvas *canvas, struct gm_picture *picture, double across,
                                        double down, double *x, double *y);

/* What paints: "OSMesa, OpenGL 4.5, llvmpipe (LLVM 15.0.6, 256 bits), Mesa 22.3.6". */
const char *gm_canvas_backend(const struct gm_canvas *canvas);

#endif
