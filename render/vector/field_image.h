/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_VECTOR_FIELD_IMAGE_H
#define GM_RENDER_VECTOR_FIELD_IMAGE_H

#include <stdbool.h>
#include <stdint.h>

#include "render/layout/surface.h"
#include "render/layout/theme.h"

/* A field of colours as pixels: between the values that are given the picture has others, and each pixel the
   colour of its own, which no few shapes of a drawing can tell. */

/* The colours of a map, and none. */
enum { GM_FIELD_COLOURS = 255, GM_FIELD_NONE = GM_FIELD_COLOURS };

struct gm_field_image {
    int left, top, width, height; /* on the surface, in its pixels */
    int columns, rows;            /* of the pixels here: a multiple of these */
    uint8_t *pixels;              /* numbers of colours, top row first; malloc'ed */
};

/* Paints a mesh or an image, as far as it lies in a rectangle {left, top, width, height} of the surface, with
   two pixels for one of the surface, as drawings are looked at from near, or one where it is large. An empty
   field (width 0) where nothing of it does. False when memory is short. */
bool gm_field_image_paint(struct gm_field_image *field, const struct gm_axes *axes,
                          const struct gm_mark *mark, const int clip[4]);
void gm_field_image_close(struct gm_field_image *field);

/* Colour `index` of a map. */
struct gm_rgb gm_field_image_colour(enum gm_colour_map map, enum gm_theme theme, int index);

#endif
