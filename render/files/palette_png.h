/* SPDX-License-Identifier: GPL-3.0-or-later */
/* PNG of numbered colours in memory, the shortest that terminals are sent. */
#ifndef GM_RENDER_FILES_PALETTE_PNG_H
#define GM_RENDER_FILES_PALETTE_PNG_H

#include <stddef.h>
#include <stdint.h>

enum { GM_PALETTE = 256 };

/* A PNG in memory of pixels that are numbers of colours (rows of `columns` bytes, top first), of which
   palette[] has red, green, blue and opacity; malloc'ed, its bytes in *size. NULL when memory is short. */
unsigned char *gm_palette_png(const uint8_t *pixels, int columns, int rows,
                              const uint8_t palette[GM_PALETTE][4], size_t *size);

#endif
