/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The screen is composed once for all that has happened since, and no sooner than the terminal takes it. */
#include "app/explorer/events.h"

#include "app/explorer/view/scene.h"
#include "render/clock.h"

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

/* A scene that was opened says for a while what to watch. */
static void begin_watch(struct gm_explorer *explorer)
{
    enum { WATCH_MILLISECONDS = 8000 };
    struct gm_face *face = &explorer->face;
    if (face->watched != explorer->open.shot->scene) {
        face->watched = explorer->open.shot->scene;
        face->watch_until = gm_clock_milliseconds() + WATCH_MILLISECONDS;
    }
}

/* A page about a scheme wants it measured. */
static void ask_measure(struct gm_explorer *explorer)
{
    struct gm_face *face = &explorer->face;
    if (face->page == GM_PAGE_HELP) {
        face->explained = explorer->open.shot->lanes[explorer->open.shot->selected].scheme;
    }
    if (face->page == GM_PAGE_HELP || face->page == GM_PAGE_SCHEME) {
        gm_measure_ask(&explorer->measure, face->explained);
        face->measured = gm_measure_text(&explorer->measure);
    }
}

static void draw(struct gm_explorer *explorer)
{
    struct gm_screen *screen = &explorer->screen;
    if (explorer->list.shown) {
        bool looked = gm_explorer_is_looked_at(explorer);
        gm_screen_draw_start(screen, &explorer->face, &explorer->list.start,
                             looked ? explorer->open.shot : NULL, explorer->fresh,
                             looked ? explorer->open.said : "");
    } else if (explorer->open.shot) {
        ask_measure(explorer);
        begin_watch(explorer);
        gm_screen_draw_scene(screen, &explorer->face, explorer->open.shot, explorer->fresh);
    } else {
        return;
    }
    explorer->fresh = false;
    explorer->dirty = !gm_display_show(
        &explorer->display,
        &(const struct gm_composed){.cells = &screen->cells,
                                    .room = screen->pixels,
                                    .pixels = explorer->face.pixels,
                                    .theme = explorer->face.theme,
                                    .picture = explorer->open.shot ? explorer->open.shot->picture : NULL});
}

int gm_explorer_output(struct gm_explorer *explorer)
{
    int64_t now = gm_clock_milliseconds();
    if (explorer->list.shown && explorer->list.look_due >= 0 && explorer->list.look_due <= now) {
        gm_explorer_look(explorer);
    }
    bool good = gm_display_send(&explorer->display);
    if (explorer->dirty && gm_display_takes(&explorer->display)) {
        const double begun = gm_clock_seconds();
        draw(explorer);
        explorer->draw_cost = gm_clock_seconds() - begun;
        good = good && gm_display_send(&explorer->display);
    }
    if (!good) {
        gm_explorer_leave(explorer, GM_EXIT_FILE);
    }
    if (explorer->list.shown && explorer->list.look_due >= 0) {
        return (int)(explorer->list.look_due - now);
    }
    if (!gm_display_takes(&explorer->display)) {
        return gm_display_patience(&explorer->display);
    }
    if (!explorer->open.worker || explorer->open.asked || explorer->dirty) {
        return -1;
    }
    int64_t wait = explorer->open.next_shot - now;
    if (wait > 0) {
        return (int)wait;
    }
    gm_worker_want(explorer->open.worker);
    explorer->open.asked = true;
    return -1;
}
