/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The start: the scenes with a live look at the chosen one, and the tours. */
#include "app/explorer/view/start.h"

#include <stdio.h>
#include <string.h>

#include "app/explorer/view/own.h"
#include "app/explorer/view/pages.h"
#include "app/own/found.h"
#include "app/own/room.h"
#include "core/count.h"
#include "render/cells/text.h"

enum {
    NAME_COLUMNS = 17,
    TITLE_COLUMNS = 38,
    LOOK_FROM_COLUMNS = 64,
    LOOK_FROM_ROWS = 14,
    TITLES_FROM = 120,
    NAMES = 512
};

static const char *name_of(const struct gm_start_entry *entry)
{
    return entry->tour ? entry->tour->name : entry->scene ? entry->scene->name : GM_START_OWN;
}

static const char *title_of(const struct gm_start_entry *entry)
{
    return entry->tour    ? entry->tour->title
           : entry->scene ? entry->scene->title
                          : "A formula that you type, or a file";
}

static void draw_entry(const struct gm_sheet *sheet, int row, const struct gm_start_entry *entry,
                       size_t index, bool chosen, bool titles)
{
    gm_sheet_text(sheet, 0, row, chosen ? "▸" : " ", GM_LANE, true);
    gm_sheet_text(sheet, 2, row, name_of(entry), chosen ? GM_LANE : GM_INK, chosen);
    if (titles) {
        gm_sheet_text(sheet, NAME_COLUMNS + 1, row, title_of(entry), GM_SECONDARY, chosen);
    }
    gm_sheet_hit(sheet, 0, row, sheet->width, (struct gm_hit){.kind = GM_HIT_SCENE, .index = index});
}

/* The scenes, and below a heading the tours. */
static void draw_list(const struct gm_sheet *sheet, const struct gm_start *start, bool titles)
{
    const int scenes = (int)start->scenes, count = (int)start->count, choice = (int)start->choice;
    if (count == 0) {
        gm_sheet_text(sheet, 2, 0, "nothing found", GM_SECONDARY, false);
        return;
    }
    const bool tours = count > scenes;
    const int gap = tours && scenes > 0 && count + 2 <= sheet->height, heading = scenes + gap,
              behind = gap + tours, lines = count + behind;
    const int chosen = choice < scenes ? choice : choice + behind;
    /* the chosen one in the middle, where the list is longer than the sheet */
    int first = chosen - sheet->height / 2;
    first = first > lines - sheet->height ? lines - sheet->height : first;
    first = first < 0 ? 0 : first;
    for (int i = 0; i < count; i++) {
        const int row = (i < scenes ? i : i + behind) - first;
        if (row >= 0 && row < sheet->height) {
            draw_entry(sheet, row, &start->found[i], (size_t)i, i == choice, titles);
        }
    }
    if (tours && heading >= first) {
        gm_sheet_text(sheet, 2, heading - first, "TOURS", GM_SECONDARY, true);
    }
    if (first > 0) {
        gm_sheet_text(sheet, sheet->width - 1, 0, "↑", GM_SECONDARY, true);
    }
    if (first + sheet->height < lines) {
        gm_sheet_text(sheet, sheet->width - 1, sheet->height - 1, "↓", GM_SECONDARY, true);
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
        const struct gm_sheet look = gm_sheet_part(sheet, 0, row, sheet->width, picture);
        gm_screen_picture(screen, &look, shot);
    } else if (picture >= 1) {
        gm_sheet_text(sheet, sheet->width / 2 - 1, row + picture / 2, "…", GM_SECONDARY, false);
    }
    gm_sheet_wrapped(sheet, 0, rows - below, below, watch, GM_INK);
}

/* The chosen tour: what it is about, and its steps. */
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

static void add_name(const char *name, const void *data)
{
    char *names = *(char *const *)data;
    const size_t used = strlen(names);
    snprintf(names + used, NAMES - used, "%s%s", used ? ", " : "", name);
}

/* A system of one's own: what can be typed. */
static void draw_own(const struct gm_sheet *sheet)
{
    char names[NAMES] = "", *list = names;
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
    gm_system_each(add_name, &list);
    gm_room_each(add_name, &list);
    if (names[0]) {
        gm_text_tame(names);
        row += gm_sheet_wrapped(sheet, 0, row + 1, 1, "Or by name:", GM_SECONDARY) + 1;
        row += gm_sheet_wrapped(sheet, 0, row, 7, names, GM_INK);
    }
    gm_sheet_wrapped(sheet, 0, row + 1, 2, "enter opens the line to type in.", GM_SECONDARY);
}

/* The last row: what was typed, or that one can, and the keys. */
static void draw_keys(const struct gm_sheet *sheet, const struct gm_start *start)
{
    enum { MOST = 7 };
    struct gm_hint hints[MOST];
    size_t count = 0;
    char text[GM_TYPED + 16];
    int column = 1;
    if (start->typed[0]) {
        snprintf(text, sizeof text, "search: %s_", start->typed);
        column += gm_sheet_text(sheet, 1, 0, text, GM_INK, true) + 2;
    } else {
        column += gm_sheet_text(sheet, 1, 0, "Type to search.", GM_SECONDARY, false) + 2;
    }
    hints[count++] = (struct gm_hint){"enter", "open", '\n'};
    hints[count++] = (struct gm_hint){"↑↓", "choose", 0};
    if (start->scenes > 0 && start->scenes < start->count) {
        hints[count++] = (struct gm_hint){"tab", start->choice < start->scenes ? "tours" : "scenes", '\t'};
    }
    hints[count++] =
        start->typed[0] ? (struct gm_hint){"esc", "all", 27} : (struct gm_hint){"q", "quit", 'q'};
    hints[count++] = (struct gm_hint){"?", "help", '?'};
    hints[count] = (struct gm_hint){NULL, NULL, 0};
    gm_sheet_hints(sheet, column, hints);
}

void gm_screen_draw_start(struct gm_screen *screen, struct gm_face *face, const struct gm_start *start,
                          const struct gm_shot *shot, bool fresh, const char *said)
{
    const struct gm_sheet whole = gm_screen_clear(screen, face);
    const int asked = gm_own_prompt_rows(face->own, whole.height);
    const int below = gm_screen_rows_below(&screen->cells), rows = whole.height - (asked ? asked + 1 : below);
    int at = 0;
    if (fresh) {
        screen->picture.fresh = false;
    }
    if (face->page == GM_PAGE_START) {
        gm_screen_draw_page(&whole, face, NULL);
        return;
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
        const struct gm_start_entry *chosen = &start->found[start->choice];
        const struct gm_sheet right = gm_sheet_part(&whole, list + 3, at, whole.width - list - 4, rows - at);
        if (chosen->tour) {
            draw_tour(&right, chosen->tour);
        } else if (!chosen->scene) {
            draw_own(&right);
        } else {
            draw_look(screen, &right, chosen->scene, shot, said);
        }
    }
    if (asked) {
        const struct gm_sheet panel = gm_sheet_part(&whole, 0, rows, whole.width, asked),
                              last = gm_sheet_part(&whole, 0, whole.height - 1, whole.width, 1);
        gm_own_prompt_draw(&panel, face->own);
        gm_own_prompt_keys(&last, face->own);
        return;
    }
    if (below == 2) {
        gm_screen_rule(&whole, 0);
    }
    if (below > 0) {
        const struct gm_sheet last = gm_sheet_part(&whole, 0, whole.height - 1, whole.width, 1);
        draw_keys(&last, start);
    }
}
