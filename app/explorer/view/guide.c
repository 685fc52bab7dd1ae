/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A tour in the explorer: its keys, and its texts below the picture. */
#include "app/explorer/view/view.h"

#include <stdio.h>

enum { MOST_ROWS = 100, LEAST_HEIGHT = 8 };

struct gm_guide gm_guide_at(const struct gm_tour *tour, size_t step)
{
    return (struct gm_guide){.tour = tour, .step = step, .answered = !tour->steps[step].ask};
}

/* ---- texts ---- */

/* Draws a mark such as "Watch:" before a text (NULL: neither); returns the rows. */
static int draw_marked(const struct gm_sheet *sheet, int row, const char *mark, const char *text)
{
    if (!text) {
        return 0;
    }
    gm_sheet_text(sheet, 0, row, mark, GM_INK, true);
    return gm_sheet_wrapped(sheet, gm_sheet_width(sheet, mark) + 1, row, MOST_ROWS, text, GM_INK);
}

/* Draws the paragraphs below row 0; returns the row after them. */
static int draw_texts(const struct gm_sheet *sheet, const struct gm_guide *guide)
{
    const struct gm_tour_step *step = &guide->tour->steps[guide->step];
    const char *first = step->ask && guide->answered ? step->answer : step->say;
    int row = 1;
    row += gm_sheet_wrapped(sheet, 0, row, MOST_ROWS, first, GM_INK);
    if (!guide->answered) {
        return row + draw_marked(sheet, row, "Predict:", step->ask);
    }
    row += draw_marked(sheet, row, "Watch:", step->watch);
    row += draw_marked(sheet, row, "Try:", step->attempt);
    return row;
}

int gm_guide_rows(const struct gm_sheet *screen, const struct gm_guide *guide)
{
    const struct gm_sheet nothing = gm_sheet_part(screen, 0, 0, screen->width - 2, 0);
    const int wanted = draw_texts(&nothing, guide), most = screen->height * 2 / 5;
    return screen->height < LEAST_HEIGHT ? 0 : wanted < most ? wanted : most;
}

/* Draws the tour's keys at the right of the rule; returns their first column. */
static int draw_keys(const struct gm_sheet *sheet, const struct gm_guide *guide)
{
    char hints[64];
    const bool on = !guide->answered || guide->step + 1 < guide->tour->count;
    const char *forward = guide->answered ? "n:next|" : "n:answer|";
    snprintf(hints, sizeof hints, "%s%sa:again", on ? forward : "", guide->step > 0 ? "N:back|" : "");
    const struct gm_sheet nothing = gm_sheet_part(sheet, 0, 0, sheet->width, 0);
    for (int i = gm_sheet_hints(&nothing, 1, hints) - 2; i < sheet->width; i++) {
        gm_sheet_glyph(sheet, i, 0, ' ', GM_GRID, false);
    }
    return gm_sheet_hints(sheet, 1, hints);
}

void gm_guide_draw(const struct gm_sheet *sheet, const struct gm_guide *guide)
{
    const struct gm_tour *tour = guide->tour;
    char text[256];
    if (sheet->height < 1) {
        return;
    }
    for (int i = 0; i < sheet->width; i++) {
        gm_sheet_glyph(sheet, i, 0, 0x2500, GM_GRID, false);
    }
    const int begin = draw_keys(sheet, guide);
    snprintf(text, sizeof text, " %.80s %zu/%zu: %.120s ", tour->title, guide->step + 1, tour->count,
             tour->steps[guide->step].title);
    const struct gm_sheet head = gm_sheet_part(sheet, 0, 0, begin > 1 ? begin - 1 : 0, 1);
    gm_sheet_text(&head, 1, 0, text, GM_INK, true);
    const struct gm_sheet body = gm_sheet_part(sheet, 1, 0, sheet->width - 2, sheet->height);
    if (draw_texts(&body, guide) > sheet->height) {
        gm_sheet_text(&body, body.width - 1, body.height - 1, "…", GM_INK, true);
    }
}
