/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The screen while a scene is open: where its parts are, and which of them there are. */
#include "app/explorer/view/scene.h"

#include <stdio.h>

#include "app/explorer/view/chooser.h"
#include "app/explorer/view/guide.h"
#include "app/explorer/view/pages.h"
#include "app/explorer/view/side.h"
#include "app/explorer/view/status.h"
#include "app/explorer/view/studies.h"
#include "app/explorer/view/typed_system.h"

enum { SIDE_LEAST = 31, SIDE_MOST = 58 };

/* Where there is no room for picture and panel, the panel comes when it is asked for, and alone. */
static int side_columns(const struct gm_cells *cells, const struct gm_face *face)
{
    const bool choosing = face->choosing != GM_CHOOSE_NOTHING;
    if (cells->columns < GM_SCREEN_COLUMNS || cells->rows < GM_SCREEN_ROWS) {
        const bool asked = choosing || (face->side != GM_SIDE_ALL && face->side != GM_SIDE_NONE);
        return asked ? cells->columns : 0;
    }
    if (face->side == GM_SIDE_NONE && !choosing) {
        return 0;
    }
    int columns = cells->columns * 2 / 5;
    return columns < SIDE_LEAST ? SIDE_LEAST : columns > SIDE_MOST ? SIDE_MOST : columns;
}

static void draw_head(const struct gm_sheet *sheet, const struct gm_shot *shot)
{
    char text[64];
    gm_status_speed(shot, text, sizeof text);
    gm_sheet_text(sheet, 0, 0, "geomint", GM_INK, true);
    gm_sheet_hit(sheet, 0, 0, 7, (struct gm_hit){.kind = GM_HIT_KEY, .index = 'l'});
    gm_sheet_right(sheet, sheet->width, 0, text, GM_INK, shot->paused);
    gm_sheet_hit(sheet, sheet->width / 2, 0, sheet->width / 2,
                 (struct gm_hit){.kind = GM_HIT_KEY, .index = ' '});
}

/* The rule below the picture is the past: a mark stands where the lanes are. */
static void draw_past(const struct gm_sheet *whole, const struct gm_shot *shot, int width)
{
    const struct gm_sheet sheet = gm_sheet_part(whole, 1, whole->height - 2, width - 2, 1);
    if (sheet.width < 1) {
        return;
    }
    if (shot->reach > 0 && shot->paused) {
        gm_sheet_slider(&sheet, 0, sheet.width, 0, shot->gone / shot->reach, false);
    }
    gm_sheet_hit(&sheet, 0, 0, sheet.width, (struct gm_hit){.kind = GM_HIT_PAST});
}

static const struct gm_hint study_hints[] = {{"esc", "back", 27},  {"x", "stop", 'x'}, {"p", "save", 'p'},
                                             {"b", "blocks", 'b'}, {"q", "quit", 'q'}, {NULL, NULL, 0}};

/* A study over the whole width, in so many rows, and how far it is. */
static void draw_study(const struct gm_sheet *whole, int rows, int below)
{
    char text[GM_MESSAGE];
    struct gm_studies *studies = whole->face->studies;
    const struct gm_sheet diagram = gm_sheet_part(whole, 0, 0, whole->width, rows);
    gm_studies_draw(&diagram, studies);
    for (int row = 0; row < rows; row++) {
        gm_sheet_hit(&diagram, 0, row, diagram.width, (struct gm_hit){.kind = GM_HIT_PICTURE});
    }
    if (below == 2) {
        gm_screen_rule(whole, 0);
    }
    if (below > 0) {
        struct gm_sheet last = gm_sheet_part(whole, 0, whole->height - 1, whole->width, 1);
        gm_studies_status(studies, text, sizeof text);
        const int from = 1 + gm_sheet_width(&last, text) + 3, most = last.width - 10;
        last.width = gm_sheet_hints(&last, from < most ? from : most > 1 ? most : 1, study_hints) - 2;
        if (1 + gm_sheet_width(&last, text) > last.width && below == 2) {
            gm_screen_say_above(whole, text);
        } else {
            gm_sheet_cut(&last, 1, 0, text, GM_INK, false);
        }
    }
}

/* What is measured unseen, on the rule above the last row. */
static void draw_news(const struct gm_sheet *whole, const struct gm_scene *scene)
{
    char text[GM_MESSAGE] = "", framed[GM_MESSAGE + 2];
    if (whole->face->studies) {
        gm_studies_news(whole->face->studies, scene, text, sizeof text);
    }
    if (text[0]) {
        snprintf(framed, sizeof framed, " %s ", text);
        gm_sheet_text(whole, 2, whole->height - 2, framed, GM_INK, true);
    }
}

void gm_screen_draw_scene(struct gm_screen *screen, struct gm_face *face, const struct gm_shot *shot,
                          bool fresh)
{
    struct gm_cells *cells = &screen->cells;
    int below = gm_screen_rows_below(cells), rows = cells->rows - below;
    const struct gm_sheet whole = gm_screen_clear(screen, face);
    if (fresh) {
        screen->picture.fresh = false;
    }
    if (face->page != GM_PAGE_SCENE) {
        gm_screen_draw_page(&whole, face, shot);
        return;
    }
    const int asked = gm_typed_prompt_rows(face->typed_prompt, cells->columns, cells->rows);
    if (asked) {
        const struct gm_sheet panel =
            gm_sheet_part(&whole, 0, cells->rows - 1 - asked, cells->columns, asked);
        gm_typed_prompt_draw(&panel, face->typed_prompt);
        rows = cells->rows - 1 - asked;
    }
    if (face->guide && !asked) {
        const int told = gm_guide_rows(&whole, face->guide);
        const struct gm_sheet panel = gm_sheet_part(&whole, 0, rows - told, cells->columns, told);
        gm_guide_draw(&panel, face->guide);
        rows -= told;
    }
    if (face->studies && face->studies->shown != GM_STUDY_NONE) {
        draw_study(&whole, rows, below);
        return;
    }
    int side = side_columns(cells, face), width = cells->columns - side;
    const struct gm_sheet picture = gm_sheet_part(&whole, 0, 0, width, rows);
    gm_screen_picture(screen, &picture, shot);
    for (int row = 0; row < rows; row++) {
        gm_sheet_hit(&whole, 0, row, width, (struct gm_hit){.kind = GM_HIT_PICTURE});
    }
    if (below == 2 && !asked) {
        gm_screen_rule(&whole, face->guide ? 0 : side);
        draw_past(&whole, shot, width);
        draw_news(&whole, shot->scene);
    }
    if (side) {
        const struct gm_sheet sheet = gm_sheet_part(&whole, width + 2, 0, side - 3, rows);
        const struct gm_sheet body = gm_sheet_part(&sheet, 0, 1, sheet.width, rows - 1);
        draw_head(&sheet, shot);
        if (face->choosing != GM_CHOOSE_NOTHING) {
            gm_chooser_draw(&body, shot);
        } else {
            gm_side_draw(&body, shot);
        }
    }
    if (asked) {
        const struct gm_sheet last = gm_sheet_part(&whole, 0, cells->rows - 1, cells->columns, 1);
        gm_typed_prompt_keys(&last, face->typed_prompt);
    } else if (below > 0) {
        gm_status_draw(&whole, shot, side);
    }
}
