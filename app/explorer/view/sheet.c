/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Text into a rectangle of the screen, cut to it, with what a click on it means. */
#include "app/explorer/view/sheet.h"

#include <stdio.h>
#include <string.h>

#include "render/cells/text.h"

struct gm_sheet gm_sheet_part(const struct gm_sheet *sheet, int column, int row, int width, int height)
{
    struct gm_sheet part = *sheet;
    part.column += column;
    part.row += row;
    part.width = width;
    part.height = height;
    return part;
}

int gm_sheet_text(const struct gm_sheet *sheet, int column, int row, const char *text, enum gm_role role,
                  bool bold)
{
    if (row < 0 || row >= sheet->height || column >= sheet->width) {
        return 0;
    }
    return gm_cells_text(sheet->cells, sheet->column + column, sheet->row + row, sheet->width - column, text,
                         sheet->face->blocks == GM_ASCII, sheet->face->theme, role, bold);
}

int gm_sheet_width(const struct gm_sheet *sheet, const char *text)
{
    return gm_text_width(text, sheet->face->blocks == GM_ASCII);
}

void gm_sheet_cut(const struct gm_sheet *sheet, int column, int row, const char *text, enum gm_role role,
                  bool bold)
{
    const int room = sheet->width - column;
    gm_sheet_text(sheet, column, row, text, role, bold);
    if (room > 1 && gm_sheet_width(sheet, text) > room) {
        const char *end = sheet->face->blocks == GM_ASCII ? "." : "…";
        gm_sheet_text(sheet, sheet->width - 1, row, end, role, bold);
    }
}

void gm_sheet_right(const struct gm_sheet *sheet, int column, int row, const char *text, enum gm_role role,
                    bool bold)
{
    gm_sheet_text(sheet, column - gm_sheet_width(sheet, text), row, text, role, bold);
}

void gm_sheet_glyph(const struct gm_sheet *sheet, int column, int row, uint32_t glyph, enum gm_role role,
                    bool bold)
{
    if (column < 0 || row < 0 || column >= sheet->width || row >= sheet->height) {
        return;
    }
    if (sheet->face->blocks == GM_ASCII && glyph >= 0x7F) {
        glyph = (unsigned char)gm_text_ascii(glyph)[0];
    }
    size_t at = (size_t)(sheet->row + row) * (size_t)sheet->cells->columns + (size_t)(sheet->column + column);
    struct gm_cell *cell = &sheet->cells->cells[at];
    cell->glyph = glyph;
    cell->role = role;
    cell->foreground = gm_theme_colour(sheet->face->theme, role);
    cell->background = gm_theme_colour(sheet->face->theme, GM_PAPER);
    cell->bold = bold;
}

void gm_sheet_slider(const struct gm_sheet *sheet, int from, int to, int row, double position, bool chosen)
{
    int at = from + (int)(position * (to - from - 1) + 0.5);
    for (int i = from; i < to; i++) {
        gm_sheet_glyph(sheet, i, row,
                       i == at  ? 0x25CF
                       : i < at ? 0x2501
                                : 0x2500,
                       chosen && i <= at ? GM_INK
                       : i <= at         ? GM_SECONDARY
                                         : GM_GRID,
                       false);
    }
}

static bool is_wide(const struct gm_sheet *sheet, const char *text, size_t length, int room)
{
    char line[512];
    snprintf(line, sizeof line, "%.*s", (int)length, text);
    return gm_sheet_width(sheet, line) > room;
}

/* How many bytes of a line fit: all, or, as it is one long word, those up to a comma in its second half, or
   to any letter. */
static size_t broken(const struct gm_sheet *sheet, const char *word, size_t length, int room)
{
    size_t fits = length;
    while (fits > 1 && is_wide(sheet, word, fits, room)) {
        do {
            fits--;
        } while (fits > 1 && ((unsigned char)word[fits] & 0xC0) == 0x80);
    }
    for (size_t at = fits; fits < length && at > fits / 2; at--) {
        if (word[at - 1] == ',') {
            return at;
        }
    }
    return fits;
}

int gm_sheet_wrapped(const struct gm_sheet *sheet, int column, int row, int rows, const char *text,
                     enum gm_role role)
{
    int room = sheet->width - column, taken = 0;
    while (*text && room > 0 && taken < rows) {
        char line[512];
        size_t fits = 0;
        for (size_t i = 1; i < sizeof line; i++) {
            bool end = text[i] == '\0' || text[i] == '\n', blank = end || text[i] == ' ';
            if (blank) {
                if (fits > 0 && is_wide(sheet, text, i, room)) {
                    break;
                }
                fits = i;
            }
            if (end) {
                break;
            }
        }
        if (fits == 0) {
            fits = strlen(text) < sizeof line ? strlen(text) : sizeof line - 1;
        }
        fits = broken(sheet, text, fits, room);
        snprintf(line, sizeof line, "%.*s", (int)fits, text);
        gm_sheet_text(sheet, column, row + taken, line, role, false);
        taken++;
        text += fits;
        while (*text == ' ' || *text == '\n') {
            text++;
        }
    }
    return taken;
}

void gm_sheet_hit(const struct gm_sheet *sheet, int column, int row, int width, struct gm_hit hit)
{
    if (!sheet->hits || sheet->hits->count == GM_MOST_HITS || row < 0 || row >= sheet->height) {
        return;
    }
    hit.column = sheet->column + column;
    hit.row = sheet->row + row;
    hit.width = width;
    hit.height = 1;
    sheet->hits->hits[sheet->hits->count++] = hit;
}

const struct gm_hit *gm_hits_at(const struct gm_hits *hits, int column, int row)
{
    for (size_t i = hits->count; i-- > 0;) {
        const struct gm_hit *hit = &hits->hits[i];
        if (column >= hit->column && column < hit->column + hit->width && row >= hit->row &&
            row < hit->row + hit->height) {
            return hit;
        }
    }
    return NULL;
}
