/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_CELLS_TEXT_H
#define GM_RENDER_CELLS_TEXT_H

#include "render/cells.h"

/* Text in character cells: one cell a code point. */

/* The next code point of UTF-8; moves *text on. Malformed bytes become U+FFFD, the end is 0. */
uint32_t gm_text_next(const char **text);

/* The letters that stand for a code point where only ASCII can be shown ("pi" for U+03C0). */
const char *gm_text_ascii(uint32_t code);

/* The cells a text takes; with `ascii` as it is spelled there. */
int gm_text_width(const char *text, bool ascii);

/* Writes text into one row from `column` on, at most `limit` cells of it (negative: as many as there are);
   what lies outside the cells is cut. Returns the cells it took. */
int gm_cells_text(struct gm_cells *cells, int column, int row, int limit, const char *text, bool ascii,
                  enum gm_theme theme, enum gm_role role, bool bold);

#endif
