/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "app/explorer/screen.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "render/cells_text.h"

/* ---- cells and sheets ---- */

static bool resize(struct gm_cells *cells, int columns, int rows)
{
    struct gm_cell *more = realloc(cells->cells, sizeof *more * (size_t)columns * (size_t)rows);
    if (!more) {
        return false;
    }
    *cells = (struct gm_cells){.columns = columns, .rows = rows, .cells = more};
    return true;
}

static void clear(struct gm_cells *cells, enum gm_theme theme)
{
    const struct gm_cell blank = {.glyph = ' ',
                                  .foreground = gm_theme_colour(theme, GM_INK),
                                  .background = gm_theme_colour(theme, GM_PAPER),
                                  .role = GM_INK};
    for (size_t i = 0; i < (size_t)cells->columns * (size_t)cells->rows; i++) {
        cells->cells[i] = blank;
    }
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
    cell->bold = bold;
}

bool gm_screen_resize(struct gm_screen *screen, int columns, int rows)
{
    screen->fresh = false;
    return resize(&screen->cells, columns, rows);
}

void gm_screen_close(struct gm_screen *screen)
{
    free(screen->cells.cells);
    free(screen->picture.cells);
    *screen = (struct gm_screen){0};
}

/* ---- the parts of the screen ---- */

enum { SIDE_FROM_COLUMNS = 60, SIDE_FROM_ROWS = 12, SIDE_LEAST = 31, SIDE_MOST = 58 };

static int side_columns(const struct gm_cells *cells)
{
    if (cells->columns < SIDE_FROM_COLUMNS || cells->rows < SIDE_FROM_ROWS) {
        return 0;
    }
    int columns = cells->columns * 2 / 5;
    return columns < SIDE_LEAST ? SIDE_LEAST : columns > SIDE_MOST ? SIDE_MOST : columns;
}

static int status_rows(const struct gm_cells *cells)
{
    return cells->rows >= SIDE_FROM_ROWS ? 2 : cells->rows >= 4 ? 1 : 0;
}

static void leave_for_pixels(struct gm_screen *screen, int columns, int rows)
{
    screen->pixel_columns = columns;
    screen->pixel_rows = rows;
    for (int row = 0; row < rows; row++) {
        for (int column = 0; column < columns; column++) {
            screen->cells.cells[(size_t)row * (size_t)screen->cells.columns + (size_t)column].glyph = 0;
        }
    }
}

static void draw_picture(struct gm_screen *screen, const struct gm_face *face, const struct gm_shot *shot,
                         int columns, int rows)
{
    if (face->pixels &&
        rows < screen->cells.rows) { /* in the last row a picture could make the screen scroll */
        leave_for_pixels(screen, columns, rows);
        return;
    }
    if (!screen->fresh || screen->blocks != face->blocks || screen->picture.columns != columns ||
        screen->picture.rows != rows) {
        if (!resize(&screen->picture, columns, rows)) {
            return;
        }
        clear(&screen->picture, face->theme);
        screen->picture.outlines = face->few_colours;
        gm_cells_paint(&screen->picture, shot->picture, face->theme, face->blocks);
        screen->blocks = face->blocks;
        screen->fresh = true;
    }
    for (int row = 0; row < rows; row++) {
        memcpy(&screen->cells.cells[(size_t)row * (size_t)screen->cells.columns],
               &screen->picture.cells[(size_t)row * (size_t)columns],
               sizeof(struct gm_cell) * (size_t)columns);
    }
}

struct hint {
    const char *key, *word;
};

/* As many hints as fit at the right; returns the column where they begin. */
static int draw_hints(const struct gm_sheet *sheet, int from, const struct hint *hints)
{
    int widths = 0, count = 0;
    for (; hints[count].key; count++) {
        int width =
            gm_sheet_width(sheet, hints[count].key) + 1 + gm_sheet_width(sheet, hints[count].word) + 3;
        if (from + widths + width > sheet->width) {
            break;
        }
        widths += width;
    }
    int begin = sheet->width - widths + 2, column = begin;
    for (int i = 0; i < count; i++) {
        column += gm_sheet_text(sheet, column, 0, hints[i].key, GM_INK, true) + 1;
        column += gm_sheet_text(sheet, column, 0, hints[i].word, GM_SECONDARY, false) + 3;
    }
    return begin;
}

static const struct hint running_hints[] = {
    {"?", "help"},    {"space", "pause"}, {"q", "quit"},   {"s", "scheme"},  {"c", "compare"},
    {"←→", "change"}, {"r", "restart"},   {". ,", "step"}, {"[ ]", "speed"}, {"p", "save"},
    {"tab", "lane"},  {"b", "blocks"},    {NULL, NULL},
};
static const struct hint paused_hints[] = {
    {"?", "help"},    {"space", "go on"}, {"q", "quit"}, {". ,", "step"}, {"s", "scheme"}, {"c", "compare"},
    {"←→", "change"}, {"r", "restart"},   {"p", "save"}, {"tab", "lane"}, {"b", "blocks"}, {NULL, NULL},
};
static const struct hint chooser_hints[] = {
    {"enter", "switch"}, {"↑↓", "choose"}, {"esc", "back"}, {NULL, NULL}};
static const struct hint help_hints[] = {{"?", "back"}, {"↑↓", "scroll"}, {"q", "quit"}, {NULL, NULL}};
static const struct hint start_hints[] = {{"enter", "open"}, {"↑↓", "choose"}, {"q", "quit"}, {NULL, NULL}};

static void draw_rule(struct gm_screen *screen, const struct gm_face *face, int side)
{
    int row = screen->cells.rows - 2, foot = screen->cells.columns - side;
    const struct gm_sheet sheet = {&screen->cells, face, 0, 0, screen->cells.columns, screen->cells.rows};
    for (int i = 0; i < screen->cells.columns; i++) {
        gm_sheet_glyph(&sheet, i, row, side && i == foot ? 0x2534 : 0x2500, GM_GRID, false);
    }
    for (int i = 0; side && i < row; i++) {
        gm_sheet_glyph(&sheet, foot, i, 0x2502, GM_GRID, false);
    }
}

static void speed_text(const struct gm_shot *shot, char *text, size_t size)
{
    snprintf(text, size, "%s %g×%s", shot->paused ? "‖" : "▸", shot->speed,
             shot->paused   ? " paused"
             : shot->behind ? " late"
                            : "");
}

/* The last row: what there is to say or to watch at the left, keys at the right. */
static void draw_status(struct gm_screen *screen, const struct gm_face *face, const struct gm_shot *shot,
                        int side)
{
    int rows = status_rows(&screen->cells), column = 1;
    if (rows == 0) {
        return;
    }
    const struct gm_sheet sheet = {&screen->cells, face, 0, screen->cells.rows - 1, screen->cells.columns, 1};
    char text[GM_MESSAGE];
    if (!side) { /* the side panel has it otherwise */
        speed_text(shot, text, sizeof text);
        column += gm_sheet_text(&sheet, column, 0, text, GM_INK, true) + 2;
    }
    bool news = shot->message[0] && shot->message_number != face->read;
    if (face->choosing) {
        snprintf(text, sizeof text, "Another scheme for %s, from its present state on",
                 shot->lanes[shot->selected].scheme->title);
    } else if (news) {
        snprintf(text, sizeof text, "%s", shot->message);
    } else if (face->explaining && face->parameter < shot->parameter_count) {
        const struct gm_shot_parameter *parameter = &shot->parameters[face->parameter];
        snprintf(text, sizeof text, "%s: %s; %s", parameter->row->key, parameter->row->help,
                 parameter->row->live && !parameter->of_scheme ? "acts at once" : "starts again");
    } else {
        snprintf(text, sizeof text, "%s", shot->scene->watch ? shot->scene->watch : "");
    }
    int width = gm_sheet_width(&sheet, text);
    const struct hint *hints = face->choosing ? chooser_hints : shot->paused ? paused_hints : running_hints;
    /* the first hint, help, is always there if it fits at all */
    int from = column + width + 3, most = sheet.width - 10;
    int begin = draw_hints(&sheet, from < most ? from : most > column ? most : column, hints);
    if (begin > column) {
        const struct gm_sheet left = {&screen->cells, face, 0, screen->cells.rows - 1, begin - 2, 1};
        gm_sheet_text(&left, column, 0, text, news ? GM_INK : GM_SECONDARY, news);
    }
}

static void draw_head(const struct gm_sheet *sheet, const struct gm_shot *shot)
{
    char text[64];
    speed_text(shot, text, sizeof text);
    gm_sheet_text(sheet, 0, 0, "geomint", GM_INK, true);
    gm_sheet_right(sheet, sheet->width, 0, text, GM_INK, shot->paused);
}

void gm_screen_draw(struct gm_screen *screen, struct gm_face *face, const struct gm_shot *shot, bool fresh)
{
    struct gm_cells *cells = &screen->cells;
    int below = status_rows(cells), rows = cells->rows - below;
    clear(cells, face->theme);
    screen->pixel_columns = screen->pixel_rows = 0;
    if (fresh) {
        screen->fresh = false;
    }
    if (face->help) {
        gm_help_draw(&(const struct gm_sheet){cells, face, 1, 0, cells->columns - 2, rows}, face, shot);
        if (below == 2) {
            draw_rule(screen, face, 0);
        }
        if (below > 0) {
            draw_hints(&(const struct gm_sheet){cells, face, 0, cells->rows - 1, cells->columns, 1}, 1,
                       help_hints);
        }
        return;
    }
    int side = side_columns(cells);
    draw_picture(screen, face, shot, cells->columns - side, rows);
    if (below == 2) {
        draw_rule(screen, face, side);
    }
    if (side) {
        const struct gm_sheet sheet = {cells, face, cells->columns - side + 2, 0, side - 3, rows};
        const struct gm_sheet body = {cells, face, sheet.column, 1, sheet.width, rows - 1};
        draw_head(&sheet, shot);
        if (face->choosing) {
            gm_chooser_draw(&body, shot);
        } else {
            gm_side_draw(&body, shot);
        }
    }
    draw_status(screen, face, shot, side);
}

/* ---- the start screen ---- */

void gm_screen_draw_start(struct gm_screen *screen, const struct gm_face *face, size_t choice)
{
    struct gm_cells *cells = &screen->cells;
    clear(cells, face->theme);
    screen->pixel_columns = screen->pixel_rows = 0;
    int below = status_rows(cells), rows = cells->rows - below;
    const struct gm_sheet sheet = {cells, face, cells->columns > 60 ? 4 : 1, 0, cells->columns - 5, rows};
    int at = 1;
    if (rows > 6) {
        gm_sheet_text(&sheet, 0, at, "geomint", GM_INK, true);
        gm_sheet_text(&sheet, 9, at, "what a geometric integrator keeps, and an ordinary one loses",
                      GM_SECONDARY, false);
        at += 2;
    } else {
        at = 0;
    }
    int each = rows - at >= 3 * (int)gm_scene_count() ? 3 : 1;
    int visible = (rows - at) / each, first = 0;
    if (visible < 1) {
        visible = 1;
    }
    if ((int)choice >= visible) {
        first = (int)choice - visible + 1;
    }
    for (size_t i = (size_t)first; i < gm_scene_count() && at < rows; i++, at += each) {
        const struct gm_scene *scene = gm_scene_at(i);
        bool chosen = i == choice;
        gm_sheet_text(&sheet, 0, at, chosen ? "▸" : " ", GM_LANE, true);
        gm_sheet_text(&sheet, 2, at, scene->name, chosen ? GM_LANE : GM_INK, chosen);
        gm_sheet_text(&sheet, 18, at, scene->title, GM_INK, chosen);
        if (each > 1 && scene->watch) {
            gm_sheet_text(&sheet, 18, at + 1, scene->watch, GM_SECONDARY, false);
        }
    }
    if (below == 2) {
        draw_rule(screen, face, 0);
    }
    if (below > 0) {
        draw_hints(&(const struct gm_sheet){cells, face, 0, cells->rows - 1, cells->columns, 1}, 1,
                   start_hints);
    }
}
