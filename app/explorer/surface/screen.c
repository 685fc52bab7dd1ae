/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The screen as cells. */
#include "app/explorer/surface/screen.h"

#include <stdlib.h>

struct gm_sheet gm_screen_clear(struct gm_screen *screen, const struct gm_face *face)
{
    gm_cells_clear(&screen->cells, face->theme);
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

void gm_screen_say_above(const struct gm_sheet *whole, const char *text)
{
    const struct gm_sheet nothing = gm_sheet_part(whole, 1, 0, whole->width - 2, 0);
    const int wanted = gm_sheet_wrapped(&nothing, 0, 0, whole->height, text, GM_INK),
              most = whole->height / 3, rows = wanted < most ? wanted : most,
              first = whole->height - 1 - rows;
    for (int row = first; row < first + rows; row++) {
        for (int column = 0; column < whole->width; column++) {
            gm_sheet_glyph(whole, column, row, ' ', GM_INK, false);
        }
    }
    const struct gm_sheet above = gm_sheet_part(whole, 1, first, whole->width - 2, rows);
    gm_sheet_wrapped(&above, 0, 0, rows, text, GM_INK);
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
        leave_for_pixels(screen, sheet->column, sheet->row, sheet->width, sheet->height);
        return;
    }
    if (face->guide) {
        shot->picture->caption = ""; /* a tour has words of its own, and may ask for a prediction */
    }
    gm_sheet_paint(sheet, &screen->picture, shot->picture);
}
