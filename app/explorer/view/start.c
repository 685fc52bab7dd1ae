/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The start screen: scenes, tours, systems and rooms of files, with a preview of the chosen one. */
#include "app/explorer/view/view.h"

#include <stdio.h>
#include <string.h>

#include "core/basics.h"

enum {
    NAME_COLUMNS = 17, /* columns before a title */
    LONGEST_NAME = 22, /* columns of a name in a list without titles */
    TITLE_COLUMNS = 38,
    LOOK_FROM_COLUMNS = 64,
    LOOK_FROM_ROWS = 14,
    TITLES_FROM = 120
};

static const char *const headings[GM_START_GROUPS] = {NULL, "TOURS", "SYSTEMS", "ROOMS"};
static const char *const group_names[GM_START_GROUPS] = {"scenes", "tours", "systems", "rooms"};

bool gm_start_is_user(const struct gm_start_entry *entry)
{
    return entry->group == GM_START_SCENES && !entry->scene;
}

size_t gm_start_next_group(const struct gm_start *start)
{
    size_t next = start->choice;
    if (start->count == 0) {
        return next;
    }
    while (next < start->count && start->found[next].group == start->found[start->choice].group) {
        next++;
    }
    const bool last = next == start->count,
               alone = last && start->found[0].group == start->found[next - 1].group;
    return alone ? start->choice : last ? 0 : next;
}

static void draw_entry(const struct gm_sheet *sheet, int row, const struct gm_start_entry *entry,
                       size_t index, bool chosen, bool titles)
{
    gm_sheet_text(sheet, 0, row, chosen ? "▸" : " ", GM_LANE, true);
    const int columns = gm_sheet_text(sheet, 2, row, entry->name, chosen ? GM_LANE : GM_INK, chosen);
    if (titles) {
        const int behind = columns + 3 > NAME_COLUMNS + 1 ? columns + 3 : NAME_COLUMNS + 1;
        gm_sheet_text(sheet, behind, row, entry->title, GM_SECONDARY, chosen);
    }
    gm_sheet_hit(sheet, 0, row, sheet->width, (struct gm_hit){.kind = GM_HIT_SCENE, .index = index});
}

/* Returns the lines above an entry for its group: a heading, and except at the top a blank. */
static int lines_above(const struct gm_start *start, size_t i)
{
    const enum gm_start_group group = start->found[i].group;
    const bool begins = i == 0 || start->found[i - 1].group != group;
    return begins && headings[group] ? 1 + (i > 0) : 0;
}

static void draw_list(const struct gm_sheet *sheet, const struct gm_start *start, bool titles)
{
    if (start->count == 0) {
        gm_sheet_text(sheet, 2, 0, "nothing found", GM_SECONDARY, false);
        return;
    }
    int lines = 0, chosen = 0;
    for (size_t i = 0; i < start->count; i++) {
        lines += lines_above(start, i) + 1;
        chosen = i == start->choice ? lines - 1 : chosen;
    }
    /* the choice is in the middle of a list that is longer than the sheet */
    int first = chosen - sheet->height / 2;
    first = first > lines - sheet->height ? lines - sheet->height : first;
    first = first < 0 ? 0 : first;
    int row = -first;
    for (size_t i = 0; i < start->count; i++, row++) {
        const int above = lines_above(start, i);
        row += above;
        if (above > 0 && row > 0 && row <= sheet->height) {
            gm_sheet_text(sheet, 2, row - 1, headings[start->found[i].group], GM_SECONDARY, true);
        }
        if (row >= 0 && row < sheet->height) {
            draw_entry(sheet, row, &start->found[i], i, i == start->choice, titles);
        }
    }
    if (first > 0) {
        gm_sheet_text(sheet, sheet->width - 1, 0, "↑", GM_SECONDARY, true);
    }
    if (first + sheet->height < lines) {
        gm_sheet_text(sheet, sheet->width - 1, sheet->height - 1, "↓", GM_SECONDARY, true);
    }
}

/* Draws a message and below it the faulty line with a caret, in unchanged columns. */
static void draw_fault(const struct gm_sheet *sheet, int row, int rows, const char *said)
{
    const char *line = said + strcspn(said, "\n");
    char text[GM_MESSAGE];
    snprintf(text, sizeof text, "%.*s", (int)(line - said), said);
    row += gm_sheet_wrapped(sheet, 0, row, rows, text, GM_INITIAL);
    for (; *line == '\n' && row < sheet->height; row++) {
        const char *end = line + 1 + strcspn(line + 1, "\n");
        snprintf(text, sizeof text, "%.*s", (int)(end - line - 1), line + 1);
        gm_sheet_text(sheet, 0, row, text, GM_INK, false);
        line = end;
    }
}

/* Draws the chosen scene's title, description, preview, and what to watch, as far as the scene is made. */
static void draw_look(struct gm_screen *screen, const struct gm_sheet *sheet,
                      const struct gm_start_entry *entry, const struct gm_shot *shot, const char *said)
{
    int row = 0, rows = sheet->height;
    const struct gm_scene *scene = entry->scene ? entry->scene : shot ? shot->scene : NULL;
    const char *watch = scene && scene->watch ? scene->watch : "",
               *blurb = scene && scene->blurb ? scene->blurb : "";
    gm_sheet_text(sheet, 0, row++, entry->title, GM_INK, true);
    if (rows >= 30) {
        row += gm_sheet_wrapped(sheet, 0, row, 4, blurb, GM_SECONDARY) + 1;
    }
    const struct gm_sheet nothing = gm_sheet_part(sheet, 0, 0, sheet->width, 0);
    int below = gm_sheet_wrapped(&nothing, 0, 0, 100, watch, GM_INK);
    int picture = rows - row - below - (rows >= 30);
    if (said[0]) {
        draw_fault(sheet, row + 1, picture, said);
    } else if (shot && picture >= 4) {
        const struct gm_sheet look = gm_sheet_part(sheet, 0, row, sheet->width, picture);
        gm_screen_picture(screen, &look, shot);
    } else if (picture >= 1) {
        gm_sheet_text(sheet, sheet->width / 2 - 1, row + picture / 2, "…", GM_SECONDARY, false);
    }
    gm_sheet_wrapped(sheet, 0, rows - below, below, watch, GM_INK);
}

/* Draws the chosen tour's description and its steps. */
static void draw_tour(const struct gm_sheet *sheet, const struct gm_tour *tour)
{
    int row = 0;
    gm_sheet_text(sheet, 0, row++, tour->title, GM_INK, true);
    row += gm_sheet_wrapped(sheet, 0, row, 4, tour->about ? tour->about : "", GM_SECONDARY) + 1;
    for (size_t i = 0; i < tour->count; i++) {
        const struct gm_tour_step *step = &tour->steps[i];
        char number[24];
        snprintf(number, sizeof number, "%zu.", i + 1);
        gm_sheet_text(sheet, 0, row, number, GM_SECONDARY, false);
        row += gm_sheet_wrapped(sheet, 4, row, 2, step->title, GM_INK);
    }
    gm_sheet_wrapped(sheet, 0, row + 1, 3,
                     "enter begins it. A step may ask for a prediction before it shows.", GM_SECONDARY);
}

/* Draws examples for a user-defined system. */
static void draw_own(const struct gm_sheet *sheet)
{
    static const char *const examples[][2] = {
        {"H=p^2/2 - cos(q) q=2 p=0", "a Hamiltonian, and where it starts"},
        {"H=p^2/2 + q^4/4 - k*q^2 q=1.5 p=0 k=0.5", "with a parameter: each is a slider"},
        {"rate=x = y rate=y = -x - c*y x=1 y=0 c=0.1", "any differential equation"},
        {"./my.system dt=0.01", "a file; docs/systems.md"},
    };
    int row = 0;
    gm_sheet_text(sheet, 0, row++, "Your own system", GM_INK, true);
    row += gm_sheet_wrapped(
        sheet, 0, row, 4,
        "A formula, typed as on the command line, runs a tenth of a second later, with every "
        "scheme that fits.",
        GM_SECONDARY);
    row++;
    for (size_t i = 0; i < GM_COUNT(examples); i++) {
        row += gm_sheet_wrapped(sheet, 0, row, 2, examples[i][0], GM_INK);
        row += gm_sheet_wrapped(sheet, 2, row, 1, examples[i][1], GM_SECONDARY);
    }
    gm_sheet_wrapped(sheet, 0, row + 1, 2, "enter opens the line to type in.", GM_SECONDARY);
}

/* Draws the last row: the typed search, or a hint that one can search, and the keys. */
static void draw_keys(const struct gm_sheet *sheet, const struct gm_start *start)
{
    const size_t next = gm_start_next_group(start);
    char text[GM_TYPED + 16], hints[80];
    if (start->typed[0]) {
        snprintf(text, sizeof text, "search: %s_", start->typed);
    } else {
        snprintf(text, sizeof text, "Type to search.");
    }
    const int width =
        gm_sheet_text(sheet, 1, 0, text, start->typed[0] ? GM_INK : GM_SECONDARY, start->typed[0]);
    snprintf(hints, sizeof hints, "enter:open|↑↓:choose%s%s|%s|?:help", next != start->choice ? "|tab:" : "",
             next != start->choice ? group_names[start->found[next].group] : "",
             start->typed[0] ? "esc:all" : "q:quit");
    gm_sheet_hints(sheet, 1 + width + 2, hints);
}

void gm_screen_draw_start(struct gm_screen *screen, struct gm_face *face, const struct gm_start *start,
                          const struct gm_shot *shot, bool fresh, const char *said)
{
    const struct gm_sheet whole = gm_screen_clear(screen, face);
    int at = 0;
    if (fresh) {
        screen->picture.fresh = false;
    }
    if (face->page == GM_PAGE_START) {
        gm_screen_draw_page(&whole, face, NULL);
        return;
    }
    const int asked = gm_typed_prompt_draw(&whole, face->typed_prompt);
    const int below = gm_screen_rows_below(&screen->cells), rows = whole.height - (asked ? asked : below);
    if (rows > 6) {
        gm_sheet_text(&whole, 1, 0, "geomint", GM_INK, true);
        gm_sheet_text(&whole, 10, 0, "what a geometric integrator conserves, and an ordinary one loses",
                      GM_SECONDARY, false);
        at = rows > 22 ? 2 : 1;
    }
    bool look = whole.width >= LOOK_FROM_COLUMNS && whole.height >= LOOK_FROM_ROWS;
    bool titles = !look || whole.width >= TITLES_FROM;
    int list = look && !titles ? LONGEST_NAME + 1 : look ? NAME_COLUMNS + TITLE_COLUMNS : whole.width - 2;
    const struct gm_sheet left = gm_sheet_part(&whole, 1, at, list, rows - at);
    draw_list(&left, start, titles);
    if (look && start->choice < start->count) {
        const struct gm_start_entry *chosen = &start->found[start->choice];
        const struct gm_sheet right = gm_sheet_part(&whole, list + 3, at, whole.width - list - 4, rows - at);
        if (chosen->tour) {
            draw_tour(&right, chosen->tour);
        } else if (gm_start_is_user(chosen)) {
            draw_own(&right);
        } else {
            draw_look(screen, &right, chosen, shot, said);
        }
    }
    if (!asked) {
        const struct gm_sheet last = gm_screen_foot(&whole);
        if (below > 0) {
            draw_keys(&last, start);
        }
    }
}
