/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_PIXELS_CANVAS_H
#define GM_RENDER_PIXELS_CANVAS_H

#include "render/layout/appearance.h"
#include "render/message.h"
#include "render/picture/picture.h"

/* The painter of pixels: pictures to rows of bytes, without a screen. One canvas has one look, whose title outlives
   it, and is used by one thread at a time. The program's own rasteriser draws (render/pixels/rasteriser.h), with the
   same bits everywhere where the fonts are the same, or OpenGL (render/gl/opengl.h). */

struct gm_canvas;

/* Chooses what paints on canvases that are opened from now on: "osmesa", "egl", "own", or "auto", which is OSMesa for
   files, where it can be loaded, and else the rasteriser. NULL: as the environment variable GEOMINT_PAINTER says, and
   auto where it says nothing. False with a sentence (GM_MESSAGE bytes) where there is no such painter, or it cannot be
   loaded. No other thread is to open a canvas meanwhile. */
bool gm_canvas_choose(const char *painter, char *message);

/* Begins, in a thread of its own, what takes long of opening the first canvas for a file; and waits for its end, which
   comes before that of the process. */
void gm_canvas_expect(void);
void gm_canvas_settle(void);

/* NULL on failure, with one sentence in message (GM_MESSAGE bytes). */
struct gm_canvas *gm_canvas_open(const struct gm_appearance *look, char *message);
void gm_canvas_close(struct gm_canvas *canvas);

/* Paints the picture into rgb: height rows of width * 3 bytes, top row first. False when memory is short. */
bool gm_canvas_paint(struct gm_canvas *canvas, struct gm_picture *picture, unsigned char *rgb);

/* The panel of a state that a pixel is in, as gm_layout_locate. */
const struct gm_panel *gm_canvas_locate(struct gm_canvas *canvas, struct gm_picture *picture, double across,
                                        double down, double *x, double *y);

/* What paints, as gm_canvas_choose takes it up to a comma: "own", or "osmesa, OpenGL 4.5, llvmpipe (LLVM 15.0.6, 256
   bits), Mesa 22.3.6". */
const char *gm_canvas_backend(const struct gm_canvas *canvas);

#endif
