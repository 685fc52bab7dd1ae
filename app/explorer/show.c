/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is shown, and when. */
#include "app/explorer/events.h"

void gm_explorer_resize(struct gm_explorer *explorer)
{
    int columns, rows;
    gm_terminal_size(&columns, &rows);
    if (!gm_screen_resize(&explorer->screen, columns, rows)) {
        gm_explorer_leave(explorer, GM_EXIT_USAGE);
    }
    gm_display_forget(&explorer->display);
    gm_terminal_cell(&explorer->terminal.cell_width, &explorer->terminal.cell_height);
    if (explorer->face.pixels) {
        gm_writer_tell(&explorer->display.writer, GM_ASK_CELL); /* letters may have another size too */
    }
    explorer->dirty = explorer->fresh = true;
}

/* A page about a scheme wants it measured. */
static void ask_measure(struct gm_explorer *explorer)
{
    struct gm_face *face = &explorer->face;
    if (face->page == GM_PAGE_HELP) {
        face->explained = explorer->shot->lanes[explorer->shot->selected].scheme;
    }
    if (face->page == GM_PAGE_HELP || face->page == GM_PAGE_SCHEME) {
        gm_measure_ask(&explorer->measure, face->explained);
        face->measured = gm_measure_text(&explorer->measure);
    }
}

static void draw(struct gm_explorer *explorer)
{
    struct gm_screen *screen = &explorer->screen;
    struct gm_picture *picture = explorer->shot ? explorer->shot->picture : NULL;
    if (explorer->at_start) {
        bool looked = gm_explorer_is_looked_at(explorer);
        gm_screen_draw_start(screen, &explorer->face, &explorer->start, looked ? explorer->shot : NULL,
                             explorer->fresh, looked ? explorer->said : "");
    } else if (explorer->shot) {
        ask_measure(explorer);
        gm_screen_draw(screen, &explorer->face, explorer->shot, explorer->fresh);
    } else {
        return;
    }
    explorer->fresh = false;
    explorer->dirty = !gm_display_show(&explorer->display, screen, &explorer->face, picture);
}

int gm_explorer_output(struct gm_explorer *explorer)
{
    int64_t now = gm_explorer_milliseconds();
    if (explorer->at_start && explorer->look_due >= 0 && explorer->look_due <= now) {
        gm_explorer_look(explorer);
    }
    bool good = gm_display_send(&explorer->display);
    if (explorer->dirty && gm_display_takes(&explorer->display)) {
        draw(explorer);
        good = good && gm_display_send(&explorer->display);
    }
    if (!good) {
        gm_explorer_leave(explorer, GM_EXIT_FILE);
    }
    if (explorer->at_start && explorer->look_due >= 0) {
        return (int)(explorer->look_due - now);
    }
    if (!gm_display_takes(&explorer->display)) {
        return gm_display_patience(&explorer->display);
    }
    if (!explorer->worker || explorer->asked || explorer->dirty) {
        return -1;
    }
    int64_t wait = explorer->next_shot - now;
    if (wait > 0) {
        return (int)wait;
    }
    gm_worker_want(explorer->worker);
    explorer->asked = true;
    return -1;
}
