/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_PARAGRAPH_H
#define GM_APP_EXPLORER_PARAGRAPH_H

#include "app/explorer/screen.h"

/* Writes a text, broken at its blanks, from `row` on; every line begins at `column`. Returns the rows that it
   takes, also where the sheet is too low for them: a sheet of height 0 measures. */
int gm_paragraph_draw(const struct gm_sheet *sheet, int column, int row, const char *text, enum gm_role role,
                      bool bold);

#endif
