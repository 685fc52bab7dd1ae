/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_VECTOR_VECTOR_H
#define GM_RENDER_VECTOR_VECTOR_H

#include <stdbool.h>
#include <stdint.h>

#include "render/files/images.h"
#include "render/layout/appearance.h"
#include "render/layout/panel.h"
#include "render/picture/picture.h"

/* Draws the picture as SVG 1.1: lines, shapes and texts, and fields of colours as images of pixels, whose
   number is set. The texts stand in its metadata. By way of a temporary name, so that a killed program leaves
   no half file. False on failure, with one sentence in message (GM_MESSAGE bytes) and
   errno: ENOMEM also where a library was refused memory. */
bool gm_svg_write(const char *path, const struct gm_appearance *look, struct gm_picture *picture,
                  const struct gm_png_text *texts, size_t count, size_t *fields, char *message);

/* Reads the texts of these keys from the metadata of such a file: texts[i] is malloc'ed, NULL where there is
   none. False with a sentence if it is no file, or cannot be read. */
bool gm_svg_read_texts(const char *path, const char *const *keys, char **texts, size_t count, char *message);

/* Draws the picture as a page of PDF, by Cairo: as gm_svg_write, with the fonts in it. Its date is always the
   same, so that the same picture has the same bytes. */
bool gm_pdf_write(const char *path, const struct gm_appearance *look, struct gm_picture *picture,
                  const struct gm_png_text *texts, size_t count, size_t *fields, char *message);

/* What writes it: "Cairo 1.16.0". */
const char *gm_pdf_backend(void);

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
