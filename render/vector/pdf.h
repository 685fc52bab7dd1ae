/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_VECTOR_PDF_H
#define GM_RENDER_VECTOR_PDF_H

#include "render/files/png.h"
#include "render/layout/appearance.h"
#include "render/picture/picture.h"

/* Draws the picture as a page of PDF, by Cairo: as gm_svg_write, with the fonts in it. Its date is always the
   same, so that the same picture has the same bytes. */
bool gm_pdf_write(const char *path, const struct gm_appearance *look, struct gm_picture *picture,
                  const struct gm_png_text *texts, size_t count, size_t *fields, char *message);

/* What writes it: "Cairo 1.16.0". */
const char *gm_pdf_backend(void);

#endif
