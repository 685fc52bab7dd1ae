/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The page that explains everything: the scene, the keys, the letters of the claims, the selected scheme. */
#include <stdio.h>
#include <string.h>

#include "app/explorer/screen.h"

/* A column of the page that grows downwards, scrolled by the sheet's face. */
struct page {
    struct gm_sheet sheet;
    int row, scroll;
};

static void put(struct page *page, int column, const char *text, enum gm_role role, bool bold)
{
    gm_sheet_text(&page->sheet, column, page->row - page->scroll, text, role, bold);
}

/* Breaks a text at its blanks; lines after the first begin at `column` too. */
static void put_wrapped(struct page *page, int column, const char *text, enum gm_role role)
{
    int room = page->sheet.width - column;
    while (*text && room > 0) {
        char line[512];
        size_t fits = 0;
        for (size_t i = 1; i < sizeof line; i++) {
            bool end = text[i] == '\0' || text[i] == '\n', blank = end || text[i] == ' ';
            if (blank) {
                snprintf(line, sizeof line, "%.*s", (int)i, text);
                if (gm_sheet_width(&page->sheet, line) > room && fits > 0) {
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
        put(page, column, line, role, false);
        page->row++;
        text += fits;
        while (*text == ' ' || *text == '\n') {
            text++;
        }
    }
}

static void put_heading(struct page *page, const char *text)
{
    if (page->row > 0) {
        page->row++;
    }
    put(page, 0, text, GM_SECONDARY, true);
    page->row++;
}

static void put_scene(struct page *page, const struct gm_scene *scene)
{
    put(page, 0, scene->title, GM_INK, true);
    page->row++;
    put_wrapped(page, 0, scene->blurb ? scene->blurb : "", GM_INK);
    put_wrapped(page, 0, scene->watch ? scene->watch : "", GM_SECONDARY);
}

static void put_keys(struct page *page)
{
    static const struct {
        const char *key, *text;
    } keys[] = {
        {"space", "pause and go on"},
        {". ,", "one step forward, one step back; this pauses"},
        {"[ ]", "slower, faster"},
        {"↑ ↓", "choose a parameter"},
        {"← →", "change it; live ones act at once, others start again"},
        {"⌫", "set it to its default"},
        {"tab", "select a lane"},
        {"s", "switch its scheme in flight, from the present state on"},
        {"c x", "add a lane to compare; remove the selected one"},
        {"r", "restart"},
        {"p", "save the picture as PNG; `geomint again` redoes it"},
        {"b", "pixels, braille, quadrants, half blocks, ASCII: what the terminal has"},
        {"?", "this page"},
        {"q", "quit"},
    };
    put_heading(page, "KEYS");
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++) {
        put(page, 0, keys[i].key, GM_INK, true);
        put_wrapped(page, 8, keys[i].text, GM_INK);
    }
}

static void put_claims(struct page *page)
{
    put_heading(page, "CLAIMS");
    for (unsigned bit = 0; bit < GM_CLAIM_COUNT; bit++) {
        put(page, 0, gm_claim_letter(bit), GM_INK, true);
        put_wrapped(page, 8, gm_claim_word(bit), GM_INK);
    }
    put_wrapped(page, 0, "`geomint certify` measures every one of them.", GM_SECONDARY);
}

static void put_scheme(struct page *page, const struct gm_shot_lane *lane)
{
    const struct gm_scheme *scheme = lane->scheme;
    char text[32];
    put_heading(page, "THE SELECTED SCHEME");
    put(page, 0, scheme->title, gm_lane_role(lane->shown.colour), true);
    snprintf(text, sizeof text, "order %d", scheme->order);
    put(page, gm_sheet_width(&page->sheet, scheme->title) + 2, text, GM_SECONDARY, false);
    page->row++;
    for (const char *at = scheme->formula; at && *at;) {
        char line[256];
        size_t length = strcspn(at, "\n");
        snprintf(line, sizeof line, "%.*s", (int)length, at);
        put(page, 2, line, GM_INK, false);
        page->row++;
        at += length + (at[length] == '\n');
    }
    put_wrapped(page, 0, scheme->reference ? scheme->reference : "", GM_SECONDARY);
}

enum { TWO_COLUMNS = 110, COLUMN_GAP = 4 };

static int draw(const struct gm_sheet *sheet, int scroll, const struct gm_shot *shot)
{
    bool two = sheet->width >= TWO_COLUMNS;
    struct page left = {.sheet = *sheet, .scroll = scroll};
    if (two) {
        left.sheet.width = (sheet->width - COLUMN_GAP) / 2;
    }
    struct page right = left;
    if (two) {
        right.sheet.column += left.sheet.width + COLUMN_GAP;
    }
    put_scene(&left, shot->scene);
    put_keys(&left);
    if (!two) {
        right.row = left.row;
    }
    put_claims(&right);
    put_scheme(&right, &shot->lanes[shot->selected]);
    return left.row > right.row ? left.row : right.row;
}

void gm_help_draw(const struct gm_sheet *sheet, struct gm_face *face, const struct gm_shot *shot)
{
    /* Measured first on no rows at all, so that scrolling stops at the last line. */
    struct gm_sheet nothing = *sheet;
    nothing.height = 0;
    int most = draw(&nothing, 0, shot) - sheet->height;
    if (face->scroll > most) {
        face->scroll = most;
    }
    if (face->scroll < 0) {
        face->scroll = 0;
    }
    draw(sheet, face->scroll, shot);
}
