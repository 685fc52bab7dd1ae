/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_PIXELS_CANVAS_H
#define GM_RENDER_PIXELS_CANVAS_H

#include "render/layout/appearance.h"
#include "render/message.h"
#include "render/picture/picture.h"

/* The painter of pixels: pictures to rows of bytes, without a screen. One canvas has one look, whose title outlives
   it, and is used by one thread at a time. The program's own rasteriser draws (render/pixels/rasteriser.h), with the
   same bits everywhere where the fonts are the same, or OpenGL (render/gl/opengl.h) where the environment variable
   GEOMINT_GL names one. */

struct gm_canvas;

/* NULL on failure, with one sentence in message (GM_MESSAGE bytes). */
struct gm_canvas *gm_canvas_open(const struct gm_appearance *look, char *message);
void gm_canvas_close(struct gm_canvas *canvas);

/* Paints the picture into rgb: height rows of width * 3 bytes, top row first. False when memory is short. */
bool gm_canvas_paint(struct gm_canvas *canvas, struct gm_picture *picture, unsigned char *rgb);

/* The panel of a state that a pixel is in, as gm_layout_locate. */
const struct gm_panel *gm_canvas_locate(struct gm_canvas *canvas, struct gm_picture *picture, double across,
                                        double down, double *x, double *y);

/* What paints: "geomint's own rasteriser", or "OSMesa, OpenGL 4.5, llvmpipe (LLVM 15.0.6, 256 bits), Mesa 22.3.6". */
const char *gm_canvas_backend(const struct gm_canvas *canvas);

#endif
