/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_PIXELS_RASTERISER_H
#define GM_RENDER_PIXELS_RASTERISER_H

#include "render/drawing/glyphs.h"
#include "render/layout/appearance.h"
#include "render/triangles/triangles.h"

/* The triangles of a batch, drawn into memory by OpenGL's rules: a triangle has the pixels whose middles lie
   in it, its corners are at multiples of 1/256 pixel, and pixels shared by two triangles are painted once. It
   needs no library, no driver and no lock. */
struct gm_rasteriser {
    int width, height;
    enum gm_theme theme;
    uint32_t *groups;  /* per pixel the last group of GM_STENCIL_ONCE, and a bit for the inside */
    uint32_t *colours; /* shades of both maps; made at the first use */
};

/* A rasteriser begins zeroed, except its theme and its sides, 1 to GM_RASTERISER_MOST. */
enum { GM_RASTERISER_MOST = 16384 };
void gm_rasteriser_close(struct gm_rasteriser *rasteriser);

/* Draws on paper: height rows of width pixels of four bytes, top row first. Returns false when out of
   memory. */
bool gm_rasteriser_draw(struct gm_rasteriser *rasteriser, const struct gm_batch *batch,
                        const struct gm_atlas *atlas, unsigned char *rgba);

#endif
