/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_PIXELS_RASTERISER_H
#define GM_RENDER_PIXELS_RASTERISER_H

#include "render/drawing/glyphs.h"
#include "render/layout/appearance.h"
#include "render/triangles/triangles.h"

/* The triangles of a batch, drawn into memory by the program itself as OpenGL draws them: a triangle has the pixels
   whose middles lie in it, its corners at multiples of 1/256 pixel, and what two triangles share is painted once. A
   picture needs no library, no driver and no turn for it. */
struct gm_rasteriser {
    int width, height;
    enum gm_theme theme;
    uint32_t *groups;  /* which group of GM_STENCIL_ONCE painted a pixel last, and whether it is inside */
    uint32_t *colours; /* of both maps, finely; made when one is first wanted */
};

/* Sides are 1 to GM_RASTERISER_MOST. It begins zeroed but for its sides and its theme. */
enum { GM_RASTERISER_MOST = 16384 };
void gm_rasteriser_close(struct gm_rasteriser *rasteriser);

/* Draws on paper: height rows of width pixels of four bytes, top row first. False when memory is short. */
bool gm_rasteriser_draw(struct gm_rasteriser *rasteriser, const struct gm_batch *batch,
                        const struct gm_atlas *atlas, unsigned char *rgba);

#endif
