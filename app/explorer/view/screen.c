/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The composed screen: picture, side panel, status line, or a page of help. */
#include "app/explorer/view/screen.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/explorer/view/guide.h"
#include "app/explorer/view/studies.h"

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

bool gm_cells_resize(struct gm_cells *cells, int columns, int rows, enum gm_theme theme)
{
    if (!resize(cells, columns, rows)) {
        return false;
    }
    clear(cells, theme);
    return true;
}

struct gm_sheet gm_screen_clear(struct gm_screen *screen, const struct gm_face *face)
{
    clear(&screen->cells, face->theme);
    screen->hits.count = 0;
    screen->pixels = (struct gm_inline_place){0};
    return (struct gm_sheet){
        .cells = &screen->cells,
        .face = face,
        .width = screen->cells.columns,
        .height = screen->cells.rows,
        .hits = &screen->hits,
    };
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

/* Where there is no room for picture and panel, the panel comes when it is asked for, and alone. */
static int side_columns(const struct gm_cells *cells, const struct gm_face *face)
{
    const bool choosing = face->choosing != GM_CHOOSE_NOTHING;
    if (cells->columns < SIDE_FROM_COLUMNS || cells->rows < SIDE_FROM_ROWS) {
        const bool asked = choosing || (face->side != GM_SIDE_ALL && face->side != GM_SIDE_NONE);
        return asked ? cells->columns : 0;
    }
    if (face->side == GM_SIDE_NONE && !choosing) {
        return 0;
    }
    int columns = cells->columns * 2 / 5;
    return columns < SIDE_LEAST ? SIDE_LEAST : columns > SIDE_MOST ? SIDE_MOST : columns;
}

int gm_screen_status_rows(const struct gm_cells *cells)
{
    return cells->rows >= SIDE_FROM_ROWS ? 2 : cells->rows >= 4 ? 1 : 0;
}

static void leave_for_pixels(struct gm_screen *screen, int column, int row, int columns, int rows)
{
    screen->pixels = (struct gm_inline_place){.column = column, .row = row, .columns = columns, .rows = rows};
    for (int i = 0; i < rows; i++) {
        struct gm_cell *line = &screen->cells.cells[(size_t)(row + i) * (size_t)screen->cells.columns];
        for (int k = column; k < column + columns; k++) {
            line[k].glyph = 0;
        }
    }
}

void gm_screen_picture(struct gm_screen *screen, const struct gm_face *face, const struct gm_shot *shot,
                       int column, int row, int columns, int rows)
{
    if (columns < 1 || rows < 1) {
        return;
    }
    screen->picture_column = column;
    screen->picture_row = row;
    /* in the last row a picture of pixels could make the screen scroll */
    if (face->pixels && !face->monochrome && row + rows < screen->cells.rows) {
        leave_for_pixels(screen, column, row, columns, rows);
        return;
    }
    if (!screen->fresh || screen->blocks != face->blocks || screen->theme != face->theme ||
        screen->picture.columns != columns || screen->picture.rows != rows) {
        if (!gm_cells_resize(&screen->picture, columns, rows, face->theme)) {
            return;
        }
        screen->picture.outlines = face->few_colours || face->monochrome;
        if (face->guide) {
            shot->picture->caption = ""; /* a tour has words of its own, and may ask for a prediction */
        }
        gm_cells_paint(&screen->picture, shot->picture, face->theme, face->blocks);
        screen->blocks = face->blocks;
        screen->theme = face->theme;
        screen->fresh = true;
    }
    for (int i = 0; i < rows; i++) {
        memcpy(&screen->cells.cells[(size_t)(row + i) * (size_t)screen->cells.columns + (size_t)column],
               &screen->picture.cells[(size_t)i * (size_t)columns], sizeof(struct gm_cell) * (size_t)columns);
    }
}

void gm_screen_rule(const struct gm_sheet *whole, int side)
{
    int row = whole->height - 2, foot = whole->width - side;
    for (int i = 0; i < whole->width; i++) {
        gm_sheet_glyph(whole, i, row, side && i == foot ? 0x2534 : 0x2500, GM_GRID, false);
    }
    for (int i = 0; side && i < row; i++) {
        gm_sheet_glyph(whole, foot, i, 0x2502, GM_GRID, false);
    }
}

static void draw_head(const struct gm_sheet *sheet, const struct gm_shot *shot)
{
    char text[64];
    gm_speed_text(shot, text, sizeof text);
    gm_sheet_text(sheet, 0, 0, "geomint", GM_INK, true);
    gm_sheet_hit(sheet, 0, 0, 7, (struct gm_hit){.kind = GM_HIT_KEY, .index = 'l'});
    gm_sheet_right(sheet, sheet->width, 0, text, GM_INK, shot->paused);
    gm_sheet_hit(sheet, sheet->width / 2, 0, sheet->width / 2,
                 (struct gm_hit){.kind = GM_HIT_KEY, .index = ' '});
}

/* The rule below the picture is the past: a mark stands where the lanes are. */
static void draw_past(const struct gm_sheet *whole, const struct gm_shot *shot, int width)
{
    const struct gm_sheet sheet = gm_sheet_part(whole, 1, whole->height - 2, width - 2, 1);
    if (sheet.width < 1) {
        return;
    }
    if (shot->reach > 0 && shot->paused) {
        gm_sheet_slider(&sheet, 0, sheet.width, 0, shot->gone / shot->reach, false);
    }
    gm_sheet_hit(&sheet, 0, 0, sheet.width, (struct gm_hit){.kind = GM_HIT_PAST});
}

static const struct gm_hint study_hints[] = {{"esc", "back", 27},  {"x", "stop", 'x'}, {"p", "save", 'p'},
                                             {"b", "blocks", 'b'}, {"q", "quit", 'q'}, {NULL, NULL, 0}};

/* A study over the whole width, in so many rows, and how far it is. */
static void draw_study(const struct gm_sheet *whole, int rows, int below)
{
    char text[GM_MESSAGE];
    struct gm_studies *studies = whole->face->studies;
    const struct gm_sheet diagram = gm_sheet_part(whole, 0, 0, whole->width, rows);
    gm_studies_draw(&diagram, studies);
    if (below == 2) {
        gm_screen_rule(whole, 0);
    }
    if (below > 0) {
        struct gm_sheet last = gm_sheet_part(whole, 0, whole->height - 1, whole->width, 1);
        gm_studies_status(studies, text, sizeof text);
        const int from = 1 + gm_sheet_width(&last, text) + 3, most = last.width - 10;
        last.width = gm_hints_draw(&last, from < most ? from : most > 1 ? most : 1, study_hints) - 2;
        if (1 + gm_sheet_width(&last, text) > last.width && below == 2) {
            gm_screen_say_above(whole, text);
        } else {
            gm_sheet_cut(&last, 1, 0, text, GM_INK, false);
        }
    }
}

/* What is measured unseen, on the rule above the last row. */
static void draw_news(const struct gm_sheet *whole)
{
    char text[GM_MESSAGE] = "", framed[GM_MESSAGE + 2];
    if (whole->face->studies) {
        gm_studies_news(whole->face->studies, text, sizeof text);
    }
    if (text[0]) {
        snprintf(framed, sizeof framed, " %s ", text);
        gm_sheet_text(whole, 2, whole->height - 2, framed, GM_INK, true);
    }
}

static const struct gm_hint page_hints[] = {
    {"?", "back", '?'}, {"↑↓", "scroll", 0}, {"q", "quit", 'q'}, {NULL, NULL, 0}};
static const struct gm_hint command_hints[] = {{"esc", "back", 27},
                                               {"y", "copy the other", 'y'},
                                               {"↑↓", "scroll", 0},
                                               {"q", "quit", 'q'},
                                               {NULL, NULL, 0}};

void gm_screen_draw_page(const struct gm_sheet *whole, struct gm_face *face, const struct gm_shot *shot)
{
    const int below = gm_screen_status_rows(whole->cells);
    const struct gm_sheet page = gm_sheet_part(whole, 1, 0, whole->width - 2, whole->height - below);
    gm_page_draw(&page, face, shot);
    if (below == 2) {
        gm_screen_rule(whole, 0);
    }
    if (below > 0) {
        const struct gm_sheet last = gm_sheet_part(whole, 0, whole->height - 1, whole->width, 1);
        gm_hints_draw(&last, 1, face->page == GM_PAGE_COMMAND ? command_hints : page_hints);
    }
}

void gm_screen_draw(struct gm_screen *screen, struct gm_face *face, const struct gm_shot *shot, bool fresh)
{
    struct gm_cells *cells = &screen->cells;
    int below = gm_screen_status_rows(cells), rows = cells->rows - below;
    const struct gm_sheet whole = gm_screen_clear(screen, face);
    if (fresh) {
        screen->fresh = false;
    }
    if (face->page != GM_PAGE_SCENE) {
        gm_screen_draw_page(&whole, face, shot);
        return;
    }
    if (face->guide) {
        const int told = gm_guide_rows(&whole, face->guide);
        const struct gm_sheet panel = gm_sheet_part(&whole, 0, rows - told, cells->columns, told);
        gm_guide_draw(&panel, face->guide);
        rows -= told;
    }
    if (face->studies && face->studies->shown != GM_STUDY_NONE) {
        draw_study(&whole, rows, below);
        return;
    }
    int side = side_columns(cells, face), width = cells->columns - side;
    gm_screen_picture(screen, face, shot, 0, 0, width, rows);
    for (int row = 0; row < rows; row++) {
        gm_sheet_hit(&whole, 0, row, width, (struct gm_hit){.kind = GM_HIT_PICTURE});
    }
    if (below == 2) {
        gm_screen_rule(&whole, face->guide ? 0 : side);
        draw_past(&whole, shot, width);
        draw_news(&whole);
    }
    if (side) {
        const struct gm_sheet sheet = gm_sheet_part(&whole, width + 2, 0, side - 3, rows);
        const struct gm_sheet body = gm_sheet_part(&sheet, 0, 1, sheet.width, rows - 1);
        draw_head(&sheet, shot);
        if (face->choosing != GM_CHOOSE_NOTHING) {
            gm_chooser_draw(&body, shot);
        } else {
            gm_side_draw(&body, shot);
        }
    }
    if (below > 0) {
        gm_status_draw(&whole, shot, side);
    }
}
