/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "app/explorer/guide.h"

#include <curses.h>
#include <stdio.h>

#include "app/explorer/paragraph.h"

struct gm_guide gm_guide_open(const struct gm_tour *tour)
{
    return (struct gm_guide){.tour = tour, .answered = !tour->steps[0].ask};
}

static enum gm_guide_result go(struct gm_guide *guide, size_t step)
{
    if (step >= guide->tour->count) {
        return GM_GUIDE_END;
    }
    guide->step = step;
    guide->answered = !guide->tour->steps[step].ask;
    return GM_GUIDE_OPEN;
}

enum gm_guide_result gm_guide_press(struct gm_guide *guide, int key)
{
    switch (key) {
    case '\n':
    case '\r':
    case KEY_ENTER:
        if (!guide->answered) {
            guide->answered = true;
            return GM_GUIDE_RUN;
        }
        return go(guide, guide->step + 1);
    case 'n':
        return go(guide, guide->step + 1);
    case 'N':
        return go(guide, guide->step - 1); /* before the first one there is none: the number wraps around */
    case 't':
        return go(guide, guide->step);
    default:
        return GM_GUIDE_IGNORED;
    }
}

/* ---- what is told ---- */

/* "Watch: " in front of what is to be watched. */
static int draw_marked(const struct gm_sheet *sheet, int row, const char *mark, const char *text)
{
    if (!text) {
        return 0;
    }
    gm_sheet_text(sheet, 0, row, mark, GM_SECONDARY, true);
    return gm_paragraph_draw(sheet, gm_sheet_width(sheet, mark) + 1, row, text, GM_SECONDARY, false);
}

/* Draws the paragraphs below row 0; returns the row after them. */
static int draw_texts(const struct gm_sheet *sheet, const struct gm_guide *guide)
{
    const struct gm_tour_step *step = &guide->tour->steps[guide->step];
    int row = 1;
    if (step->ask && guide->answered) {
        row += gm_paragraph_draw(sheet, 0, row, step->answer, GM_INK, false);
    } else {
        row += gm_paragraph_draw(sheet, 0, row, step->say, GM_INK, false);
    }
    if (!guide->answered) {
        row += gm_paragraph_draw(sheet, 0, row, step->ask, GM_INK, true);
        return row;
    }
    row += draw_marked(sheet, row, "Watch:", step->watch);
    row += draw_marked(sheet, row, "Try:", step->attempt);
    return row;
}

/* At most two fifths of the screen, so that there is still something to see. */
int gm_guide_rows(const struct gm_sheet *screen, const struct gm_guide *guide)
{
    const struct gm_sheet nothing = {screen->cells, screen->face, 0, 0, screen->width - 2, 0};
    const int wanted = draw_texts(&nothing, guide), most = screen->height * 2 / 5;
    return screen->height < 8 ? 0 : wanted < most ? wanted : most;
}

void gm_guide_draw(const struct gm_sheet *sheet, const struct gm_guide *guide)
{
    const struct gm_tour *tour = guide->tour;
    const bool last = guide->step + 1 == tour->count;
    char text[256], keys[64];
    if (sheet->height < 1) {
        return;
    }
    for (int i = 0; i < sheet->width; i++) {
        gm_sheet_glyph(sheet, i, 0, 0x2500, GM_GRID, false);
    }
    snprintf(keys, sizeof keys, " %s%s%s ", guide->answered ? (last ? "" : "enter next  ") : "enter answer  ",
             guide->step > 0 ? "N back  " : "", "t again");
    const int begin = sheet->width - gm_sheet_width(sheet, keys) - 1;
    gm_sheet_text(sheet, begin, 0, keys, GM_SECONDARY, false);
    snprintf(text, sizeof text, " %.80s %zu/%zu: %.120s ", tour->title, guide->step + 1, tour->count,
             tour->steps[guide->step].title);
    struct gm_sheet head = *sheet;
    head.width = begin > 1 ? begin - 1 : 0;
    gm_sheet_text(&head, 1, 0, text, GM_INK, true);
    const struct gm_sheet body = {sheet->cells, sheet->face,      sheet->column + 1,
                                  sheet->row,   sheet->width - 2, sheet->height};
    if (draw_texts(&body, guide) > sheet->height) {
        gm_sheet_text(&body, body.width - 1, body.height - 1, "…", GM_INK, true);
    }
}
