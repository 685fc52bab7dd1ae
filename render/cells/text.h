/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_CELLS_TEXT_H
#define GM_RENDER_CELLS_TEXT_H

#include "render/cells/grid.h"

/* Text in character cells: one cell a code point. */

/* The next code point of UTF-8; moves *text on. Malformed bytes become U+FFFD, the end is 0. */
uint32_t gm_text_next(const char **text);

/* Whether a terminal shows a code point: it obeys control characters (C0, C1), and marks of direction and
   letters without a width make a text look like another one; U+FFFD stands for what is no UTF-8. */
bool gm_text_is_shown(uint32_t code);

/* Whether all of a text is shown. */
bool gm_text_is_plain(const char *text);

/* Replaces, in place, every code point that is not shown, and every byte that is no UTF-8, by "?": what words
   of files and arguments go through on their way to a terminal. Returns text. */
char *gm_text_tame(char *text);

/* The letters that stand for a code point where only ASCII can be shown ("pi" for U+03C0). */
const char *gm_text_ascii(uint32_t code);

/* The cells a text takes; with `ascii` as it is spelled there. */
int gm_text_width(const char *text, bool ascii);

/* How a text looks in cells; with `ascii` it is spelled in ASCII. */
struct gm_text_look {
    enum gm_theme theme;
    enum gm_role role;
    bool bold, ascii;
};

/* Writes text into one row from `column` on, at most `limit` cells of it (negative: as many as there are);
   what lies outside the cells is cut. Returns the cells it took. */
int gm_cells_text(struct gm_cells *cells, int column, int row, int limit, const char *text,
                  const struct gm_text_look *look);

#endif
