/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_DRAWING_PAGE_H
#define GM_RENDER_DRAWING_PAGE_H

#include "render/drawing/painter.h"
#include "render/message.h"

/* A page that is drawn with one pen in one look, as often as its picture changes. */

/* False on failure, with one sentence in message (GM_MESSAGE bytes) and errno (gm_glyphs_open). To be closed in both
   cases. */
bool gm_page_open(struct gm_painter *painter, const struct gm_pen *pen, void *self,
                  const struct gm_appearance *look, char *message);
void gm_page_close(struct gm_painter *painter);

/* Lays the picture out and draws it. False when memory is short. */
bool gm_page_draw(struct gm_painter *painter, struct gm_picture *picture);

#endif
