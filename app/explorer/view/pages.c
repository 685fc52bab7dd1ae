/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The content of the explaining pages, and scrolling. */
#include "app/explorer/view/view.h"

#include <stdio.h>
#include <string.h>

#include "core/basics.h"

/* A page that grows downwards, scrolled by `scroll` rows. */
struct page {
    struct gm_sheet sheet;
    int row, scroll;
};

static void put(struct page *page, int column, const char *text, enum gm_role role, bool bold)
{
    gm_sheet_text(&page->sheet, column, page->row - page->scroll, text, role, bold);
}

/* Adds a wrapped text; all its lines start at `column`. */
static void put_wrapped(struct page *page, int column, const char *text, enum gm_role role)
{
    page->row += gm_sheet_wrapped(&page->sheet, column, page->row - page->scroll, 100, text, role);
}

/* Adds a title, in bold if it has room in a line. */
static void put_title(struct page *page, const char *text, enum gm_role role)
{
    if (gm_sheet_width(&page->sheet, text) > page->sheet.width) {
        put_wrapped(page, 0, text, role);
    } else {
        put(page, 0, text, role, true);
        page->row++;
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

enum { KEY_COLUMNS = 11 };

static void put_key(struct page *page, const char *label, const char *text)
{
    put(page, 0, label, GM_INK, true);
    put_wrapped(page, KEY_COLUMNS, text, GM_INK);
}

static void put_key_rows(struct page *page)
{
#define GM_KEYS(label, hint, rank, text, ...) put_key(page, label, text);
#define GM_ORDER_KEYS GM_KEYS
#include "app/runs/keys.def"
#undef GM_ORDER_KEYS
#undef GM_KEYS
}

static void put_keys(struct page *page, const struct gm_scene *scene)
{
    put_heading(page, "KEYS");
    put_key_rows(page);
    put_heading(page, "MOUSE");
    put_wrapped(
        page, 0,
        "Never needed. Click a lane, a scheme, a parameter or a word of the last line; drag a slider, or the "
        "line under the picture through the past; the wheel changes the speed.",
        GM_INK);
    if (scene->point) {
        put_wrapped(page, 0, "In the picture of this scene a click is a new start.", GM_INK);
    }
}

static void put_claims(struct page *page)
{
    put_heading(page, "CLAIMS");
    for (unsigned bit = 0; bit < GM_CLAIM_COUNT; bit++) {
        put(page, 0, gm_claims[bit].letter, GM_INK, true);
        put_wrapped(page, 8, gm_claims[bit].word, GM_INK);
    }
    put_wrapped(page, 0, "`geomint certify` measures every one of them.", GM_SECONDARY);
}

/* Adds lines; each retains its indentation when wrapped. */
static void put_lines(struct page *page, int column, const char *text, enum gm_role role)
{
    for (const char *at = text; at && *at;) {
        char line[512];
        const size_t blanks = strspn(at, " "), length = strcspn(at, "\n");
        snprintf(line, sizeof line, "%.*s", (int)(length - blanks), at + blanks);
        const int rows = page->row;
        put_wrapped(page, column + (int)blanks, line, role);
        page->row += page->row == rows; /* an empty line takes a row */
        at += length + (at[length] == '\n');
    }
}

static void put_scheme(struct page *page, const struct gm_scheme *scheme, enum gm_role role)
{
    char text[32];
    const int width = gm_sheet_width(&page->sheet, scheme->title) + 2;
    snprintf(text, sizeof text, scheme->order > 0 ? "order %d" : "chooses its order", scheme->order);
    put_title(page, scheme->title, role);
    if (width + gm_sheet_width(&page->sheet, text) <= page->sheet.width) { /* beside the title */
        page->row--;
        put(page, width, text, GM_SECONDARY, false);
        page->row++;
    } else {
        put_wrapped(page, 0, text, GM_SECONDARY);
    }
    put_lines(page, 2, scheme->formula, GM_INK);
    put_wrapped(page, 0, scheme->reference ? scheme->reference : "", GM_SECONDARY);
}

static void put_measured(struct page *page, const char *heading, const char *meanwhile)
{
    const char *measured = page->sheet.face->measured;
    put_heading(page, heading);
    if (measured) {
        put_lines(page, 0, measured, GM_INK);
    } else {
        put(page, 0, meanwhile, GM_SECONDARY, false);
        page->row++;
    }
}

enum { TWO_COLUMNS = 110, COLUMN_GAP = 4 };

static int draw_help(const struct gm_sheet *sheet, int scroll, const struct gm_shot *shot)
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
    const struct gm_scene *scene = shot->scene;
    put_title(&left, scene->title, GM_INK);
    put_wrapped(&left, 0, scene->blurb ? scene->blurb : "", GM_INK);
    put_wrapped(&left, 0, scene->watch ? scene->watch : "", GM_SECONDARY);
    put_keys(&left, scene);
    if (!two) {
        right.row = left.row;
    }
    const struct gm_shot_lane *lane = &shot->lanes[shot->selected];
    put_claims(&right);
    put_heading(&right, "THE SELECTED SCHEME");
    put_scheme(&right, lane->scheme, gm_lane_role(lane->shown.colour));
    put_measured(&right, "AS MEASURED", "measuring …");
    return left.row > right.row ? left.row : right.row;
}

static int draw_commands(const struct gm_sheet *sheet, int scroll, const struct gm_shot *shot)
{
    static const char *const headings[GM_COMMANDS] = {
        [GM_COMMAND_PICTURE] = "THIS VIEW AS A PICTURE",
        [GM_COMMAND_EXPLORER] = "THE EXPLORER, FROM THE START",
    };
    struct page page = {.sheet = *sheet, .scroll = scroll};
    for (size_t i = 0; i < GM_COMMANDS; i++) {
        put_heading(&page, headings[i]);
        put(&page, 0, i == sheet->face->command ? "▸" : " ", GM_INK, true);
        put_wrapped(&page, 2, shot->commands[i] ? shot->commands[i] : "There is not enough memory.", GM_INK);
    }
    page.row++;
    if (shot->scene->text) {
        put_wrapped(&page, 0, "s saves the system, with the values that it has now, as a file.", GM_INK);
    }
    put_wrapped(&page, 0, "▸ was copied too, if the terminal lets programs do that.", GM_SECONDARY);
    return page.row;
}

static int draw_start_help(const struct gm_sheet *sheet, int scroll)
{
    static const char *const rows[][2] = {
        {"letters", "search names, titles and descriptions of scenes and tours; ⌫ takes one back"},
        {"↑ ↓", "choose; Home, End: the first, the last"},
        {"tab", "from the scenes to the tours, the systems and the rooms of files, and back"},
        {"enter", "open the chosen entry; one that was open resumes; “your own system” asks for a formula"},
        {"esc", "clear the search: the whole list"},
        {"?", "this page"},
        {"q", "quit, while nothing is typed"},
    };
    struct page page = {.sheet = *sheet, .scroll = scroll};
    put(&page, 0, "The list of scenes", GM_INK, true);
    page.row++;
    put_wrapped(
        &page, 0,
        "A scene is a problem, and schemes to compare on it; a preview of the chosen one is beside the "
        "list. A tour leads through scenes, step by step. Systems and rooms are scenes that files describe: bundled "
        "files, and yours in ~/.config/geomint.",
        GM_INK);
    put_heading(&page, "KEYS HERE");
    for (size_t i = 0; i < GM_COUNT(rows); i++) {
        put_key(&page, rows[i][0], rows[i][1]);
    }
    put_heading(&page, "KEYS IN A SCENE");
    put_key_rows(&page);
    return page.row;
}

static int draw(const struct gm_sheet *sheet, int scroll, const struct gm_shot *shot)
{
    if (sheet->face->page == GM_PAGE_START) {
        return draw_start_help(sheet, scroll);
    }
    if (sheet->face->page == GM_PAGE_COMMAND) {
        return draw_commands(sheet, scroll, shot);
    }
    if (sheet->face->page == GM_PAGE_HELP) {
        return draw_help(sheet, scroll, shot);
    }
    struct page page = {.sheet = *sheet, .scroll = scroll};
    if (sheet->face->page == GM_PAGE_INVARIANTS) {
        put_title(&page, shot->scene->title, GM_INK);
        put_measured(&page, "WHAT THE EQUATIONS CONSERVE", "searching …");
        return page.row;
    }
    put_scheme(&page, sheet->face->explained, GM_INK);
    put_measured(&page, "AS MEASURED", "measuring …");
    return page.row;
}

void gm_screen_draw_page(const struct gm_sheet *whole, struct gm_face *face, const struct gm_shot *shot)
{
    const int below = gm_screen_rows_below(whole->cells);
    const struct gm_sheet page = gm_sheet_part(whole, 1, 0, whole->width - 2, whole->height - below),
                          nothing = gm_sheet_part(&page, 0, 0, page.width, 0), last = gm_screen_foot(whole);
    const int most = draw(&nothing, 0, shot) - page.height; /* the last line, for scrolling */
    face->scroll = face->scroll > most ? most : face->scroll;
    face->scroll = face->scroll < 0 ? 0 : face->scroll;
    draw(&page, face->scroll, shot);
    if (below > 0) {
        gm_sheet_hints(&last, 1,
                       face->page != GM_PAGE_COMMAND ? "?:back|↑↓:scroll|q:quit"
                       : shot->scene->text ? "esc:back|y:copy the other|s:save the system|↑↓:scroll|q:quit"
                                           : "esc:back|y:copy the other|↑↓:scroll|q:quit");
    }
}
