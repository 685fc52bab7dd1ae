/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_VECTOR_SVG_H
#define GM_RENDER_VECTOR_SVG_H

#include "render/files/png.h"
#include "render/layout/appearance.h"
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

#endif
