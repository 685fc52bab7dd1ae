/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The start: the scenes, and a live look at the chosen one. */
#include <ctype.h>
#include <stdio.h>
#include <string.h>

#include "app/explorer/screen.h"

static bool contains(const char *text, const char *word, size_t length)
{
    for (; *text; text++) {
        size_t i = 0;
        while (i < length && tolower((unsigned char)text[i]) == tolower((unsigned char)word[i])) {
            i++;
        }
        if (i == length) {
            return true;
        }
    }
    return false;
}

bool gm_is_found(const char *typed, const char *const *texts)
{
    while (*typed) {
        size_t length = strcspn(typed, " ");
        bool found = length == 0;
        for (size_t i = 0; !found && texts[i]; i++) {
            found = contains(texts[i], typed, length);
        }
        if (!found) {
            return false;
        }
        typed += length + (typed[length] == ' ');
    }
    return true;
}

static const struct gm_hint start_hints[] = {
    {"enter", "open", '\n'}, {"↑↓", "choose", 0}, {"a–z", "search", 0}, {"q", "quit", 'q'}, {NULL, NULL, 0}};
static const struct gm_hint search_hints[] = {
    {"enter", "open", '\n'}, {"↑↓", "choose", 0}, {"esc", "all scenes", 27}, {NULL, NULL, 0}};

enum {
    NAME_COLUMNS = 17,
    TITLE_COLUMNS = 38,
    LOOK_FROM_COLUMNS = 64,
    LOOK_FROM_ROWS = 14,
    TITLES_FROM = 120
};

static void draw_list(const struct gm_sheet *sheet, const struct gm_start *start, bool titles)
{
    int rows = sheet->height, first = 0, count = (int)start->count, choice = (int)start->choice;
    if (count == 0) {
        gm_sheet_text(sheet, 2, 0, "nothing found", GM_SECONDARY, false);
        return;
    }
    if (choice >= rows) {
        first = choice - rows + 1;
    }
    for (int i = first; i < count && i < first + rows; i++) {
        const struct gm_scene *scene = start->found[i];
        bool chosen = i == choice;
        gm_sheet_text(sheet, 0, i - first, chosen ? "▸" : " ", GM_LANE, true);
        gm_sheet_text(sheet, 2, i - first, scene->name, chosen ? GM_LANE : GM_INK, chosen);
        if (titles) {
            gm_sheet_text(sheet, NAME_COLUMNS + 1, i - first, scene->title, GM_SECONDARY, chosen);
        }
        gm_sheet_hit(sheet, 0, i - first, sheet->width,
                     (struct gm_hit){.kind = GM_HIT_SCENE, .index = (size_t)i});
    }
}

static int wrapped_rows(const struct gm_sheet *sheet, const char *text)
{
    struct gm_sheet nothing = *sheet;
    nothing.height = 0;
    return gm_sheet_wrapped(&nothing, 0, 0, 100, text, GM_INK);
}

/* The chosen scene: what it is, a live look, and what to watch. */
static void draw_look(struct gm_screen *screen, const struct gm_sheet *sheet, const struct gm_scene *scene,
                      const struct gm_shot *shot, const char *said)
{
    int row = 0, rows = sheet->height;
    const char *watch = scene->watch ? scene->watch : "", *blurb = scene->blurb ? scene->blurb : "";
    gm_sheet_text(sheet, 0, row++, scene->title, GM_INK, true);
    if (rows >= 30) {
        row += gm_sheet_wrapped(sheet, 0, row, 4, blurb, GM_SECONDARY) + 1;
    }
    int below = wrapped_rows(sheet, watch), picture = rows - row - below - (rows >= 30);
    if (said[0]) {
        gm_sheet_wrapped(sheet, 0, row + 1, picture, said, GM_INITIAL);
    } else if (shot && picture >= 4) {
        gm_screen_picture(screen, sheet->face, shot, sheet->column, sheet->row + row, sheet->width, picture);
    } else if (picture >= 1) {
        gm_sheet_text(sheet, sheet->width / 2 - 1, row + picture / 2, "…", GM_SECONDARY, false);
    }
    gm_sheet_wrapped(sheet, 0, rows - below, below, watch, GM_INK);
}

void gm_screen_draw_start(struct gm_screen *screen, const struct gm_face *face, const struct gm_start *start,
                          const struct gm_shot *shot, bool fresh, const char *said)
{
    const struct gm_sheet whole = gm_screen_clear(screen, face);
    int below = gm_screen_status_rows(&screen->cells), rows = whole.height - below, at = 0;
    char text[GM_TYPED + 16];
    if (fresh) {
        screen->fresh = false;
    }
    if (rows > 6) {
        gm_sheet_text(&whole, 1, 0, "geomint", GM_INK, true);
        gm_sheet_text(&whole, 10, 0, "what a geometric integrator keeps, and an ordinary one loses",
                      GM_SECONDARY, false);
        at = rows > 22 ? 2 : 1;
    }
    bool look = whole.width >= LOOK_FROM_COLUMNS && whole.height >= LOOK_FROM_ROWS;
    bool titles = !look || whole.width >= TITLES_FROM;
    int list = look && !titles ? NAME_COLUMNS + 1 : look ? NAME_COLUMNS + TITLE_COLUMNS : whole.width - 2;
    const struct gm_sheet left = gm_sheet_part(&whole, 1, at, list, rows - at);
    draw_list(&left, start, titles);
    if (look && start->choice < start->count) {
        const struct gm_sheet right = gm_sheet_part(&whole, list + 3, at, whole.width - list - 4, rows - at);
        draw_look(screen, &right, start->found[start->choice], shot, said);
    }
    if (below == 2) {
        gm_screen_rule(&whole, 0);
    }
    if (below > 0) {
        const struct gm_sheet last = gm_sheet_part(&whole, 0, whole.height - 1, whole.width, 1);
        int column = 1;
        if (start->typed[0]) {
            snprintf(text, sizeof text, "search: %s_", start->typed);
            column += gm_sheet_text(&last, 1, 0, text, GM_INK, true) + 2;
        } else if (whole.width >= 80) {
            column += gm_sheet_text(&last, 1, 0, "Type to search the scenes.", GM_SECONDARY, false) + 2;
        }
        gm_hints_draw(&last, column, start->typed[0] ? search_hints : start_hints);
    }
}
