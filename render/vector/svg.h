/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_VECTOR_SVG_H
#define GM_RENDER_VECTOR_SVG_H

#include "render/files/png.h"
#include "render/layout/look.h"
#include "render/picture/picture.h"

/* Draws the picture as SVG 1.1: lines, shapes and texts, and fields of colours as images of pixels, whose
   number is set. The texts stand in its metadata. By way of a temporary name, so that a killed program leaves
   no half file. False on failure, with one sentence in message (GM_MESSAGE bytes). */
bool gm_svg_write(const char *path, const struct gm_look *look, struct gm_picture *picture,
                  const struct gm_png_text *texts, size_t count, size_t *fields, char *message);

#endif
