/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The appearance of the prompt for a user-defined system or scheme, or a map. */
#include "app/explorer/view/view.h"

#include <stdio.h>
#include <string.h>

/* The prompt has the line, its caret, rows for LETTERS letters of the fault, and on taller screens a rule
   with the question. The scene, the keys, the line and its caret have priority. */
enum { LETTERS = 150, FEW_ROWS = 2, FEW_SCREEN_ROWS = 16, SCREEN_ROWS = 7 };

static const char *const questions[GM_TYPED_KINDS] = {
    [GM_TYPED_SYSTEM] = " Your own system: a formula with its values, a file, or a name ",
    [GM_TYPED_SWITCH] = " Your own scheme for this lane: coefficients, or a file ",
    [GM_TYPED_MAP] = " A map of runs: two keys with ranges a..b:n, and measure=what it shows, as megno ",
    [GM_TYPED_FORK] = " Your own scheme for one more lane: coefficients, or a file ",
};

/* Returns the rows for a fault, at most. */
static int rows_told(int columns)
{
    const int width = columns > 2 ? columns - 2 : 1, rows = (LETTERS + width - 1) / width;
    return rows > 2 ? rows : 2;
}

/* Returns the prompt's rows on a screen of this size, in cells; 0: it is closed. */
static int rows_of(const struct gm_typed_prompt *prompt, int columns, int rows)
{
    if (!prompt || prompt->kind == GM_TYPED_NONE || rows < 4) {
        return 0;
    }
    const int told = rows_told(columns), room = rows - SCREEN_ROWS;
    return room < 1 ? FEW_ROWS : room < told ? 2 + room : 2 + told + (rows >= FEW_SCREEN_ROWS);
}

static void verdict(const struct gm_typed_prompt *prompt, char *text, size_t size)
{
    if (prompt->line.refused > 0) {
        snprintf(text, size,
                 "A line has room for %d bytes, and the last %zu that came were left out: a file has more.",
                 GM_EDIT - 1, prompt->line.refused);
    } else if (!prompt->checked) {
        snprintf(text, size, "%s", prompt->entered ? "It is read …" : prompt->fault.sentence);
    } else if (prompt->fault.sentence[0]) {
        snprintf(text, size, "%s", prompt->fault.sentence);
    } else {
        snprintf(text, size, "That is right: enter takes it.");
    }
}

int gm_typed_prompt_draw(const struct gm_sheet *whole, const struct gm_typed_prompt *prompt)
{
    static const char hints[] = "enter:take it|esc:back|← →:move|ctrl-U:clear";
    char text[GM_MESSAGE + 128];
    const int rows = rows_of(prompt, whole->width, whole->height);
    if (rows == 0) {
        return 0;
    }
    const struct gm_sheet sheet = gm_sheet_part(whole, 0, whole->height - 1 - rows, whole->width, rows);
    const struct gm_sheet last = gm_sheet_part(whole, 0, whole->height - 1, whole->width, 1);
    const bool rule = rows > 2 + rows_told(sheet.width), caret = rows > FEW_ROWS,
               wrong = prompt->fault.sentence[0] != '\0';
    const int below = rule + 1 + caret;
    const struct gm_sheet line = gm_sheet_part(&sheet, 1, rule, sheet.width - 2, 1);
    const struct gm_sheet told = gm_sheet_part(&sheet, 1, below, sheet.width - 2, rows - below);
    for (int i = 0; rule && i < sheet.width; i++) {
        gm_sheet_glyph(&sheet, i, 0, 0x2500, GM_GRID, false);
    }
    if (rule) {
        gm_sheet_cut(&sheet, 1, 0, questions[prompt->kind], GM_INK, true);
    }
    gm_edit_draw(&line, 0, &prompt->line);
    if (caret && prompt->checked && wrong && prompt->fault.at >= 0) {
        gm_sheet_glyph(&sheet, 1 + gm_edit_column(&line, &prompt->line, (size_t)prompt->fault.at), rule + 1,
                       '^', GM_INITIAL, true);
    }
    verdict(prompt, text, sizeof text);
    gm_sheet_wrapped(&told, 0, 0, told.height, text, prompt->checked && wrong ? GM_INITIAL : GM_SECONDARY);
    gm_sheet_hints(&last, 1, prompt->checked && !wrong ? hints : strchr(hints, '|') + 1);
    return rows + 1;
}
