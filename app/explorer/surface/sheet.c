/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The screen as cells, and writing into a rectangle of it: text, sliders, hints, pictures. */
#include "app/explorer/surface/surface.h"

#include <stdio.h>
#include <stdlib.h>
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
    const struct gm_text_look look = {sheet->face->theme, role, bold, sheet->face->blocks == GM_ASCII};
    return gm_cells_text(sheet->cells, sheet->column + column, sheet->row + row, sheet->width - column, text,
                         &look);
}

int gm_sheet_width(const struct gm_sheet *sheet, const char *text)
{
    return gm_text_width(text, sheet->face->blocks == GM_ASCII);
}

void gm_sheet_cut(const struct gm_sheet *sheet, int column, int row, const char *text, enum gm_role role,
                  bool bold)
{
    const int available = sheet->width - column;
    gm_sheet_text(sheet, column, row, text, role, bold);
    if (available > 1 && gm_sheet_width(sheet, text) > available) {
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

static bool is_wide(const struct gm_sheet *sheet, const char *text, size_t length, int available)
{
    char line[512];
    snprintf(line, sizeof line, "%.*s", (int)length, text);
    return gm_sheet_width(sheet, line) > available;
}

/* Returns how many bytes of a line fit. A long word breaks after a comma in its second half, or at any
   letter. */
static size_t broken(const struct gm_sheet *sheet, const char *word, size_t length, int available)
{
    size_t fits = length;
    while (fits > 1 && is_wide(sheet, word, fits, available)) {
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
    int available = sheet->width - column, taken = 0;
    while (*text && available > 0 && taken < rows) {
        char line[512];
        size_t fits = 0;
        if (taken + 1 == rows && available > 1 && is_wide(sheet, text, strlen(text), available)) {
            available--; /* for the ellipsis */
        }
        for (size_t i = 1; i < sizeof line; i++) {
            bool end = text[i] == '\0' || text[i] == '\n', blank = end || text[i] == ' ';
            if (blank) {
                if (fits > 0 && is_wide(sheet, text, i, available)) {
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
        fits = broken(sheet, text, fits, available);
        snprintf(line, sizeof line, "%.*s", (int)fits, text);
        gm_sheet_text(sheet, column, row + taken, line, role, false);
        taken++;
        text += fits;
        while (*text == ' ' || *text == '\n') {
            text++;
        }
        if (*text && taken == rows) { /* some words did not fit */
            gm_sheet_text(sheet, column + gm_sheet_width(sheet, line), row + taken - 1,
                          sheet->face->blocks == GM_ASCII ? "." : "…", role, false);
        }
    }
    return taken;
}

enum { HINT = 40 };

/* Reads a hint "keys:word" and moves to the next one; returns false at the end. */
static bool read_hint(const char **at, char keys[HINT], char word[HINT])
{
    const size_t size = strcspn(*at, "|"), length = strcspn(*at, ":");
    if (size == 0) {
        return false;
    }
    snprintf(keys, HINT, "%.*s", (int)length, *at);
    snprintf(word, HINT, "%.*s", (int)(size - length - 1), *at + length + 1);
    *at += size + ((*at)[size] == '|');
    return true;
}

int gm_sheet_hints(const struct gm_sheet *sheet, int from, const char *hints)
{
    const int gap = sheet->width < GM_SCREEN_COLUMNS ? 2 : 3;
    char keys[HINT], word[HINT];
    int widths = 0, count = 0;
    for (const char *at = hints; read_hint(&at, keys, word); count++) {
        const int width = gm_sheet_width(sheet, keys) + 1 + gm_sheet_width(sheet, word) + gap;
        if (from + widths + width > sheet->width) {
            break;
        }
        widths += width;
    }
    const int begin = sheet->width - widths + gap - 1;
    for (int column = begin; count > 0 && read_hint(&hints, keys, word); count--) {
        const int first = column, code = gm_key_named(keys, strcspn(keys, " "));
        column += gm_sheet_text(sheet, column, 0, keys, GM_INK, true) + 1;
        column += gm_sheet_text(sheet, column, 0, word, GM_SECONDARY, false) + gap;
        if (code) {
            gm_sheet_hit(sheet, first, 0, column - first - gap + 1,
                         (struct gm_hit){.kind = GM_HIT_KEY, .index = (size_t)code});
        }
    }
    return begin;
}

/* ---- pictures ---- */

bool gm_cells_resize(struct gm_cells *cells, int columns, int rows)
{
    struct gm_cell *more = realloc(cells->cells, sizeof *more * (size_t)columns * (size_t)rows);
    if (!more) {
        return false;
    }
    *cells = (struct gm_cells){.columns = columns, .rows = rows, .cells = more};
    return true;
}

static void clear_cells(struct gm_cells *cells, enum gm_theme theme)
{
    const struct gm_cell blank = {.glyph = ' ',
                                  .foreground = gm_theme_colour(theme, GM_INK),
                                  .background = gm_theme_colour(theme, GM_PAPER),
                                  .role = GM_INK};
    for (size_t i = 0; i < (size_t)cells->columns * (size_t)cells->rows; i++) {
        cells->cells[i] = blank;
    }
}

void gm_sheet_paint(const struct gm_sheet *sheet, struct gm_painting *painting, struct gm_picture *picture)
{
    struct gm_cells *cells = &painting->cells;
    const struct gm_face *face = sheet->face;
    if (!painting->fresh || painting->blocks != face->blocks || painting->theme != face->theme ||
        cells->columns != sheet->width || cells->rows != sheet->height) {
        if (!gm_cells_resize(cells, sheet->width, sheet->height)) {
            return;
        }
        clear_cells(cells, face->theme);
        cells->outlines = face->few_colours || face->monochrome;
        gm_cells_paint(cells, picture, face->theme, face->blocks);
        painting->blocks = face->blocks;
        painting->theme = face->theme;
        painting->fresh = true;
    }
    for (int i = 0; i < sheet->height; i++) {
        const size_t at = (size_t)(sheet->row + i) * (size_t)sheet->cells->columns + (size_t)sheet->column;
        memcpy(&sheet->cells->cells[at], &cells->cells[(size_t)i * (size_t)sheet->width],
               sizeof(struct gm_cell) * (size_t)sheet->width);
    }
}

/* ---- clicks ---- */

void gm_sheet_hit(const struct gm_sheet *sheet, int column, int row, int width, struct gm_hit hit)
{
    if (!sheet->hits || sheet->hits->count == GM_MOST_HITS || row < 0 || row >= sheet->height) {
        return;
    }
    hit.column = sheet->column + column;
    hit.row = sheet->row + row;
    hit.width = width;
    hit.height = hit.height > 0 ? hit.height : 1;
    sheet->hits->hits[sheet->hits->count++] = hit;
}

/* ---- the whole screen ---- */

static struct gm_sheet whole_of(struct gm_screen *screen, const struct gm_face *face)
{
    return (struct gm_sheet){
        .cells = &screen->cells,
        .face = face,
        .width = screen->cells.columns,
        .height = screen->cells.rows,
        .hits = &screen->hits,
    };
}

struct gm_sheet gm_screen_clear(struct gm_screen *screen, const struct gm_face *face)
{
    clear_cells(&screen->cells, face->theme);
    screen->hits.count = 0;
    screen->pixels = (struct gm_inline_place){0};
    return whole_of(screen, face);
}

bool gm_screen_resize(struct gm_screen *screen, int columns, int rows)
{
    screen->picture.fresh = false;
    return gm_cells_resize(&screen->cells, columns, rows);
}

void gm_screen_close(struct gm_screen *screen)
{
    free(screen->cells.cells);
    free(screen->picture.cells.cells);
    *screen = (struct gm_screen){0};
}

int gm_screen_rows_below(const struct gm_cells *cells)
{
    return cells->rows >= GM_SCREEN_ROWS ? 2 : cells->rows >= 4 ? 1 : 0;
}

void gm_screen_rule(const struct gm_sheet *whole, int below, int side)
{
    int row = whole->height - below, foot = whole->width - side;
    for (int i = 0; i < whole->width; i++) {
        gm_sheet_glyph(whole, i, row, side && i == foot ? 0x2534 : 0x2500, GM_GRID, false);
    }
    for (int i = 0; side && i < row; i++) {
        gm_sheet_glyph(whole, foot, i, 0x2502, GM_GRID, false);
    }
}

struct gm_sheet gm_screen_foot(const struct gm_sheet *whole)
{
    if (gm_screen_rows_below(whole->cells) == 2) {
        gm_screen_rule(whole, 2, 0);
    }
    return gm_sheet_part(whole, 0, whole->height - 1, whole->width, 1);
}

void gm_screen_say_above(const struct gm_sheet *whole, const char *text)
{
    const struct gm_sheet nothing = gm_sheet_part(whole, 1, 0, whole->width - 2, 0);
    const int rows = gm_sheet_wrapped(&nothing, 0, 0, whole->height / 3, text, GM_INK),
              first = whole->height - 1 - rows;
    for (int row = first; row < first + rows; row++) {
        for (int column = 0; column < whole->width; column++) {
            gm_sheet_glyph(whole, column, row, ' ', GM_INK, false);
        }
    }
    const struct gm_sheet above = gm_sheet_part(whole, 1, first, whole->width - 2, rows);
    gm_sheet_wrapped(&above, 0, 0, rows, text, GM_INK);
}

void gm_screen_ask(struct gm_screen *screen, const struct gm_face *face)
{
    char text[160];
    const struct gm_sheet whole = whole_of(screen, face);
    const struct gm_sheet last = gm_sheet_part(&whole, 0, whole.height - 1, whole.width, 1);
    snprintf(text, sizeof text, "Quit? %s. q again quits, any other key stays", face->loss);
    gm_screen_say_above(&whole, text);
    for (int column = 0; column < last.width; column++) {
        gm_sheet_glyph(&last, column, 0, ' ', GM_INK, false);
    }
    gm_sheet_hints(&last, 1, "q:quit|any other key:stay");
}

void gm_screen_picture(struct gm_screen *screen, const struct gm_sheet *sheet, const struct gm_shot *shot)
{
    const struct gm_face *face = sheet->face;
    if (sheet->width < 1 || sheet->height < 1) {
        return;
    }
    screen->picture_column = sheet->column;
    screen->picture_row = sheet->row;
    /* in the last row a picture of pixels could make the screen scroll */
    if (face->pixels && !face->monochrome && sheet->row + sheet->height < screen->cells.rows) {
        screen->pixels = (struct gm_inline_place){
            .column = sheet->column, .row = sheet->row, .columns = sheet->width, .rows = sheet->height};
        for (int i = 0; i < sheet->width * sheet->height; i++) {
            const int row = sheet->row + i / sheet->width, column = sheet->column + i % sheet->width;
            screen->cells.cells[row * screen->cells.columns + column].glyph = 0;
        }
        return;
    }
    if (face->guide) {
        shot->picture->caption = ""; /* a tour has its own texts, and may ask for a prediction */
    }
    gm_sheet_paint(sheet, &screen->picture, shot->picture);
}
