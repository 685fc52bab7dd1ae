/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_SURFACE_SCREEN_H
#define GM_APP_EXPLORER_SURFACE_SCREEN_H

#include "app/explorer/surface/sheet.h"
#include "app/runs/shot.h"
#include "render/files/inline_image.h"

/* The screen as cells: what is composed on it, what can be clicked, where its picture is. Nothing here knows
   the terminal. */

struct gm_screen {
    struct gm_cells cells;
    struct gm_painting picture;      /* kept, as it changes less often than what is around it */
    int picture_column, picture_row; /* where it is */
    struct gm_inline_place pixels; /* cells for a picture of pixels, all without a glyph; no columns: none */
    struct gm_hits hits;           /* what can be clicked */
};

bool gm_screen_resize(struct gm_screen *screen, int columns, int rows);
void gm_screen_close(struct gm_screen *screen);

/* The whole screen, blank. */
struct gm_sheet gm_screen_clear(struct gm_screen *screen, const struct gm_face *face);
/* From so many on there is room for a panel, and for two rows below the rest. */
enum { GM_SCREEN_COLUMNS = 60, GM_SCREEN_ROWS = 12 };
/* The rows below the rest: a rule and the last one, that alone, or none. */
int gm_screen_rows_below(const struct gm_cells *cells);
/* The rule, and the line at the left of a panel of so many columns; 0: there is none. */
void gm_screen_rule(const struct gm_sheet *whole, int side);
/* What does not fit beside the hints, and answers the user, has rows of its own above the last one, as many
   as it takes up to a third of them. */
void gm_screen_say_above(const struct gm_sheet *whole, const char *text);
/* Paints the shot's picture, or leaves its cells to the pixels. */
void gm_screen_picture(struct gm_screen *screen, const struct gm_sheet *sheet, const struct gm_shot *shot);

#endif
