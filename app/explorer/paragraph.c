/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "app/explorer/paragraph.h"

#include <stdio.h>
#include <string.h>

int gm_paragraph_draw(const struct gm_sheet *sheet, int column, int row, const char *text, enum gm_role role,
                      bool bold)
{
    const int room = sheet->width - column, first = row;
    while (*text && room > 0) {
        char line[512];
        size_t fits = 0;
        for (size_t i = 1; i < sizeof line; i++) {
            const bool end = text[i] == '\0' || text[i] == '\n', blank = end || text[i] == ' ';
            if (blank) {
                snprintf(line, sizeof line, "%.*s", (int)i, text);
                if (gm_sheet_width(sheet, line) > room && fits > 0) {
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
        snprintf(line, sizeof line, "%.*s", (int)fits, text);
        gm_sheet_text(sheet, column, row++, line, role, bold);
        text += fits;
        while (*text == ' ' || *text == '\n') {
            text++;
        }
    }
    return row - first;
}
