/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The cells of a terminal as a picture: braille, blocks and rules are shapes, so that they join without gaps
   in every font; letters are texts, placed word by word. */
#include "render/drawing/pen.h"

#include <math.h>
#include <string.h>

#include "render/cells/text.h"

enum { LETTERS = 15, WORD = 256 }; /* the em of a letter, in pixels; the most bytes of a word */
static const float dot = 3.2f;     /* the width of a braille dot, in pixels; two have a distance of 4.5 */

static bool same(struct gm_rgb a, struct gm_rgb b)
{
    return memcmp(&a, &b, sizeof a) == 0;
}

/* Draws a part of a cell, given as fractions of its sides. */
static void box(struct gm_painter *painter, int column, int row, const double part[4], struct gm_ink ink)
{
    const double x = column * GM_CELL_WIDTH, y = row * GM_CELL_HEIGHT;
    painter->pen->box(painter->self, (float)round(x + part[0] * GM_CELL_WIDTH),
                      (float)round(y + part[1] * GM_CELL_HEIGHT), (float)round(x + part[2] * GM_CELL_WIDTH),
                      (float)round(y + part[3] * GM_CELL_HEIGHT), ink);
}

/* Returns the quarters of a block, or 0 for other glyphs. */
static unsigned quarters_of(uint32_t glyph)
{
    unsigned set = 15;
    while (set > 0 && gm_quadrants[set] != glyph) {
        set--;
    }
    return set;
}

static void draw_dots(struct gm_painter *painter, int column, int row, uint32_t dots, struct gm_ink ink)
{
    static const unsigned char places[8] = {0, 2, 4, 1, 3, 5, 6, 7}; /* of a bit: column + 2 row */
    for (int bit = 0; bit < 8; bit++) {
        if (dots >> bit & 1) {
            const struct gm_point centre = {
                (float)(GM_CELL_WIDTH * (column + 0.25 + 0.5 * (places[bit] % 2))),
                (float)(GM_CELL_HEIGHT * (row + 0.125 + 0.25 * (places[bit] / 2)))};
            painter->pen->disc(painter->self, centre, dot, ink);
        }
    }
}

/* Draws a rule of a cell: along, down, or both above a T turned over. */
static void draw_rule(struct gm_painter *painter, int column, int row, uint32_t glyph, struct gm_ink ink)
{
    const double thin_x = 1.0 / GM_CELL_WIDTH, thin_y = 1.0 / GM_CELL_HEIGHT;
    const double along[4] = {0, 0.5 - (glyph == 0x2501) * thin_y, 1, 0.5 + (1 + (glyph == 0x2501)) * thin_y};
    const double down[4] = {0.45, 0, 0.45 + thin_x, glyph == 0x2502 ? 1 : 0.5};
    if (glyph != 0x2502) {
        box(painter, column, row, along, ink);
    }
    if (glyph == 0x2502 || glyph == 0x2534) {
        box(painter, column, row, down, ink);
    }
}

static bool is_rule(uint32_t glyph)
{
    return glyph == 0x2500 || glyph == 0x2501 || glyph == 0x2502 || glyph == 0x2534;
}

static bool is_letter(uint32_t glyph)
{
    const bool blank = glyph == ' ' || glyph == 0;
    const bool braille = glyph >= 0x2800 && glyph < 0x2900;
    const bool eighths = glyph > 0x2580 && glyph < 0x2588;
    return !blank && !braille && !eighths && quarters_of(glyph) == 0 && !is_rule(glyph);
}

static void draw_shape(struct gm_painter *painter, int column, int row, const struct gm_cell *cell)
{
    const struct gm_ink ink = {cell->foreground, 1.0};
    const uint32_t glyph = cell->glyph;
    const unsigned parts = quarters_of(glyph);
    if (glyph > 0x2800 && glyph < 0x2900) {
        draw_dots(painter, column, row, glyph - 0x2800, ink);
    } else if (parts) {
        for (int i = 0; i < 4; i++) {
            const double x = 0.5 * (i % 2), y = 0.5 * (i / 2);
            if (parts >> i & 1) {
                box(painter, column, row, (const double[]){x, y, x + 0.5, y + 0.5}, ink);
            }
        }
    } else if (glyph > 0x2580 && glyph < 0x2588) {
        box(painter, column, row, (const double[]){0, 1 - (glyph - 0x2580) / 8.0, 1, 1}, ink);
    } else if (is_rule(glyph)) {
        draw_rule(painter, column, row, glyph, ink);
    }
}

/* Draws the word that starts at a letter; returns its number of cells. */
static int draw_word(struct gm_painter *painter, int column, int row, const struct gm_cell *cells, int most)
{
    const double ascent = gm_glyphs_ascent(painter->glyphs, GM_FONT_MONO, LETTERS),
                 descent = gm_glyphs_descent(painter->glyphs, GM_FONT_MONO, LETTERS);
    char text[WORD];
    size_t length = 0;
    int count = 0;
    while (count < most && is_letter(cells[count].glyph) && cells[count].bold == cells->bold &&
           same(cells[count].foreground, cells->foreground) && length + GM_TEXT_BYTES < sizeof text) {
        length += gm_text_put(cells[count++].glyph, text + length);
    }
    text[length] = '\0';
    const struct gm_writing writing = {
        .font = cells->bold ? GM_FONT_MONO_BOLD : GM_FONT_MONO,
        .letters = LETTERS,
        .x = column * GM_CELL_WIDTH,
        .y = round((row + 0.5) * GM_CELL_HEIGHT + 0.5 * (ascent - descent)),
        .width = count * GM_CELL_WIDTH,
        .anchor = GM_ANCHOR_LEFT,
        .ink = {cells->foreground, 1.0},
    };
    painter->pen->text(painter->self, &writing, text);
    return count;
}

/* Draws the grounds of a row that are not paper. */
static void draw_grounds(struct gm_painter *painter, int row, const struct gm_cell *cells, int columns)
{
    const struct gm_rgb paper = gm_theme_colour(painter->look.theme, GM_PAPER);
    for (int i = 0; i < columns; i++) {
        if (!same(cells[i].background, paper)) {
            box(painter, i, row, (const double[]){0, 0, 1, 1}, (struct gm_ink){cells[i].background, 1.0});
        }
    }
}

void gm_paint_cells(struct gm_painter *painter, const struct gm_cells *cells)
{
    painter->pen->clip(painter->self, 0, 0, painter->look.width, painter->look.height);
    for (int row = 0; row < cells->rows; row++) {
        const struct gm_cell *line = &cells->cells[(size_t)row * (size_t)cells->columns];
        draw_grounds(painter, row, line, cells->columns);
        for (int column = 0; column < cells->columns;) {
            if (is_letter(line[column].glyph)) {
                column += draw_word(painter, column, row, &line[column], cells->columns - column);
            } else {
                draw_shape(painter, column, row, &line[column]);
                column++;
            }
        }
    }
}
