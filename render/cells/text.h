/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_CELLS_TEXT_H
#define GM_RENDER_CELLS_TEXT_H

#include <stddef.h>

#include "render/cells/grid.h"

/* Text in character cells, one code point per cell. */

/* Returns the next code point of UTF-8 and moves *text past it. Malformed bytes become U+FFFD, the end is
   0. */
uint32_t gm_text_next(const char **text);

/* Writes a code point as UTF-8; returns the number of bytes. */
enum { GM_TEXT_BYTES = 4 };
size_t gm_text_put(uint32_t code, char bytes[GM_TEXT_BYTES]);

/* Returns true if a terminal shows a code point. It obeys control characters (C0, C1); marks of direction and
   letters without a width make a text look like another one; U+FFFD is malformed UTF-8. */
bool gm_text_is_shown(uint32_t code);

/* Returns true if all of a text is shown. */
bool gm_text_is_plain(const char *text);

/* Replaces, in place, every code point that is not shown, and every malformed byte, by "?". Words of files
   and arguments pass through it before a terminal shows them. Returns text. */
char *gm_text_tame(char *text);

/* Returns the ASCII letters for a code point ("pi" for U+03C0). */
const char *gm_text_ascii(uint32_t code);

/* Returns the cells that a text takes; `ascii` spells it in ASCII. */
int gm_text_width(const char *text, bool ascii);

/* The look of a text in cells; `ascii` spells it in ASCII. */
struct gm_text_look {
    enum gm_theme theme;
    enum gm_role role;
    bool bold, ascii;
};

/* Writes text into one row from `column` on, at most `limit` cells of it (negative: all). Text outside the
   cells is cut. Returns the cells it took. */
int gm_cells_text(struct gm_cells *cells, int column, int row, int limit, const char *text,
                  const struct gm_text_look *look);

#endif
