/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_VECTOR_VECTOR_H
#define GM_RENDER_VECTOR_VECTOR_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "render/drawing/pen.h"
#include "render/files/images.h"
#include "render/layout/appearance.h"
#include "render/layout/panel.h"
#include "render/picture/picture.h"

/* A picture to draw, with the texts of its metadata. */
struct gm_drawing {
    const struct gm_appearance *look;
    struct gm_picture *picture;
    const struct gm_png_text *texts;
    size_t count;
    size_t fields; /* set: the fields of colours, which are images of pixels */
};

/* Draws the picture as SVG 1.1: lines, shapes and texts, and fields of colours as images of pixels. A killed
   program leaves no half file. Returns false on failure, with one sentence in message (GM_MESSAGE bytes) and
   errno: ENOMEM also when a library was refused memory. */
bool gm_svg_write(const char *path, struct gm_drawing *drawing, char *message);

/* Reads the texts of these keys from the metadata of an SVG. The caller frees texts[i], which is NULL for a
   missing key. Returns false with a sentence if the file cannot be read. */
bool gm_svg_read_texts(const char *path, const char *const *keys, char **texts, size_t count, char *message);

/* Draws the picture as a page of PDF, with Cairo: as gm_svg_write, with embedded fonts. The date is fixed, so
   that the same picture has the same bytes. */
bool gm_pdf_write(const char *path, struct gm_drawing *drawing, char *message);

/* Returns the library: "Cairo 1.16.0". */
const char *gm_pdf_backend(void);

/* Opens the page of a pen and lets `draw` write the file; draw returns false when out of memory. */
struct gm_drawer {
    const struct gm_pen *pen;
    bool (*draw)(void *self, struct gm_drawing *drawing, FILE *out);
    void *self;
    struct gm_painter *painter; /* of self */
};
bool gm_drawing_write(const char *path, struct gm_drawing *drawing, const struct gm_drawer *drawer,
                      char *message);

/* A field of colours as pixels: each pixel has the colour of its interpolated value, which a few shapes of a
   drawing cannot show. */

/* The colours of a map, and one number for none. */
enum { GM_FIELD_COLOURS = 255, GM_FIELD_NONE = GM_FIELD_COLOURS };

struct gm_field_image {
    int left, top, width, height; /* place on the surface, in its pixels */
    int columns, rows;            /* size of the field, a multiple of width and height */
    uint8_t *pixels;              /* numbers of colours, top row first */
    bool shade;                   /* it is the shade over a field with light, in black */
};

/* Paints the part of a mesh or an image in a rectangle {left, top, width, height} of the surface, and calls `put` with
   its colours and, if it has a light, with the shade over them; with nothing if there is no such part. Returns false
   when out of memory. */
typedef void gm_field_put(void *self, const struct gm_field_image *image, const struct gm_mark *mark);
bool gm_field_image_draw(const struct gm_axes *axes, const struct gm_mark *mark, const int clip[4],
                         gm_field_put *put, void *self);

/* Sets the colours of the image's numbers: red, green, blue and opacity. */
void gm_field_image_palette(const struct gm_field_image *field, enum gm_colour_map map, enum gm_theme theme,
                            uint8_t palette[GM_PALETTE][4]);

#endif
