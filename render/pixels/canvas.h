/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_PIXELS_CANVAS_H
#define GM_RENDER_PIXELS_CANVAS_H

#include "render/layout/appearance.h"
#include "render/message.h"
#include "render/picture/picture.h"

/* The painter of pixels: pictures to rows of bytes, without a screen. A canvas has one look, whose title
   outlives it, and is used by one thread at a time. Its own rasteriser draws the
   same bits on every machine with the same fonts. The alternative is OpenGL (render/gl/opengl.h). */

struct gm_canvas;

/* Chooses the painter of canvases opened from now on: "osmesa", "egl", "own", or "auto": OSMesa for files, if
   it can be loaded, otherwise the rasteriser. NULL: the environment variable GEOMINT_PAINTER, or auto.
   Returns false with a sentence (GM_MESSAGE bytes) if the painter does not exist or cannot be loaded. No
   other thread may open a canvas meanwhile. */
bool gm_canvas_choose(const char *painter, char *message);

/* The first starts a thread with the slow part of opening the first canvas for a file. The second waits for
   it, before the process ends. */
void gm_canvas_expect(void);
void gm_canvas_settle(void);

/* Returns NULL on failure, with one sentence in message (GM_MESSAGE bytes). */
struct gm_canvas *gm_canvas_open(const struct gm_appearance *look, char *message);
void gm_canvas_close(struct gm_canvas *canvas);

/* Paints the picture into rgb, or if that is NULL into pixels of the canvas, which the next picture overwrites: height
   rows of width * 3 bytes, top row first. Returns them; NULL when out of memory. */
const unsigned char *gm_canvas_paint(struct gm_canvas *canvas, struct gm_picture *picture,
                                     unsigned char *rgb);
/* Paints the picture into rgba: the same pixels, each with a fourth byte of 255. Returns false when out of memory. */
bool gm_canvas_paint_opaque(struct gm_canvas *canvas, struct gm_picture *picture, unsigned char *rgba);

/* Returns the spot at a pixel. */
struct gm_spot gm_canvas_locate(struct gm_canvas *canvas, struct gm_picture *picture, double across,
                                double down);

/* The name of the painter, up to a comma a word for gm_canvas_choose: "own", or "osmesa, OpenGL 4.5, llvmpipe
   (LLVM 15.0.6, 256 bits), Mesa 22.3.6". */
const char *gm_canvas_backend(const struct gm_canvas *canvas);

#endif
