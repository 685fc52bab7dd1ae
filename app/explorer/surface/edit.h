/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_SURFACE_EDIT_H
#define GM_APP_EXPLORER_SURFACE_EDIT_H

#include "app/explorer/surface/sheet.h"

/* A line of text that is edited anywhere in it, and scrolls sideways where it is longer than its room. */

enum { GM_EDIT = 8192 }; /* bytes; what is longer belongs in a file */

struct gm_edit {
    char text[GM_EDIT];
    size_t length, at; /* the cursor is in front of byte `at` */
    size_t refused;    /* letters that found no room since the last one that did */
};

/* A new text, as much of it as there is room for; the cursor before byte `at`, or at its end. */
void gm_edit_set(struct gm_edit *line, const char *text, size_t at);
/* A key: letters, byte by byte, and those that move or take away. False for other keys; control characters
   change nothing. */
bool gm_edit_press(struct gm_edit *line, int key);

/* Draws it in one row with its cursor, a cell of its own, in sight. */
void gm_edit_draw(const struct gm_sheet *sheet, int row, const struct gm_edit *line);
/* The column where byte `at` is drawn; at the edge where it is out of sight. */
int gm_edit_column(const struct gm_sheet *sheet, const struct gm_edit *line, size_t at);

#endif
