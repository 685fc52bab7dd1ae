/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A key to whoever it is for: a prompt, a list, a study, a tour, the scene; or to the explorer itself. */
#include "app/explorer/events.h"

#include "app/explorer/view/chooser.h"
#include "app/explorer/view/keys.h"
#include "app/explorer/view/pages.h"
#include "app/explorer/view/prompt.h"

/* In other colours, or none. */
static void repaint(struct gm_explorer *explorer)
{
    struct gm_writer *writer = &explorer->display.writer;
    writer->theme = explorer->face.theme;
    writer->colours = explorer->face.monochrome ? GM_COLOURS_NONE : explorer->terminal.colours;
    gm_display_forget(&explorer->display);
    explorer->dirty = explorer->fresh = true;
}

static void next_graphics(struct gm_explorer *explorer)
{
    struct gm_face *face = &explorer->face;
    struct gm_graphics graphics =
        gm_graphics_next(&explorer->terminal, (struct gm_graphics){face->pixels, face->blocks});
    face->pixels = graphics.pixels;
    face->blocks = graphics.blocks;
    explorer->dirty = true;
}

void gm_explorer_copy(struct gm_explorer *explorer)
{
    const char *command = explorer->open.shot->commands[explorer->face.command];
    if (command) {
        gm_writer_copy(&explorer->display.writer, command);
    }
}

/* Another step of the tour, if there is one. */
static void press_in_tour(struct gm_explorer *explorer, int key)
{
    struct gm_open *open = &explorer->open;
    if (!open->guide.tour) {
        return;
    }
    explorer->dirty = true;
    switch (gm_guide_press(&open->guide, key)) {
    case GM_GUIDE_OPEN:
        explorer->face.parameter = 0;
        if (!gm_open_step(open, explorer->message)) {
            gm_explorer_leave(explorer, GM_EXIT_USAGE);
        }
        break;
    case GM_GUIDE_RUN:
        gm_open_study(open);
        gm_worker_order(open->worker, (struct gm_order){.kind = GM_ORDER_RUN});
        break;
    case GM_GUIDE_END:
        break;
    }
}

/* A key of an open scene: it belongs to what is open above it, or is one of the table. */
static enum gm_key_result press_in_scene(const struct gm_keystroke *press)
{
    struct gm_face *face = press->face;
    const bool said = press->shot->message[0] && press->shot->message_number != face->read;
    face->read = press->shot->message_number;
    face->watch_until = 0;
    if (press->key == GM_KEY_REDRAW) {
        return GM_KEY_REPAINT;
    }
    if (press->shot->running_ahead && press->key != 'q') { /* any key stops it */
        return gm_keystroke_order(press, (struct gm_order){.kind = GM_ORDER_HALT});
    }
    if (face->page != GM_PAGE_SCENE) {
        return gm_pages_press(press->key, face);
    }
    if (face->choosing != GM_CHOOSE_NOTHING) {
        return gm_chooser_press(press);
    }
    if (face->prompt != GM_PROMPT_NONE) {
        return gm_prompt_press(press);
    }
    if (gm_key_is_escape(press->key) && (said || face->explaining)) { /* first away with what is said */
        face->explaining = false;
        return GM_KEY_DONE;
    }
    return gm_key_press(press);
}

void gm_explorer_key(struct gm_explorer *explorer, int key)
{
    if (explorer->typed_prompt.kind != GM_TYPED_NONE && key != GM_KEY_REDRAW) {
        gm_explorer_press_typed(explorer, key);
        return;
    }
    if (explorer->list.shown) {
        gm_explorer_press_in_list(explorer, key);
        return;
    }
    if (!explorer->open.shot) { /* before the first picture there is only leaving */
        if (key == 'q') {
            gm_explorer_leave(explorer, GM_EXIT_OK);
        } else if (key == 'l' || gm_key_is_escape(key)) {
            gm_explorer_show_start(explorer);
        } else if (key == 'n' || key == 'N' || key == 'a') {
            press_in_tour(explorer, key);
        }
        return;
    }
    const struct gm_face *face = &explorer->face;
    const bool plain =
        face->page == GM_PAGE_SCENE && face->choosing == GM_CHOOSE_NOTHING && face->prompt == GM_PROMPT_NONE;
    if (plain && gm_studies_press(&explorer->open.studies, key, face->theme)) {
        explorer->dirty = true;
        return;
    }
    const struct gm_keystroke one = {key, &explorer->face, explorer->open.shot, explorer->open.worker};
    switch (press_in_scene(&one)) {
    case GM_KEY_LEAVE:
        gm_explorer_leave(explorer, GM_EXIT_OK);
        break;
    case GM_KEY_BLOCKS:
        next_graphics(explorer);
        break;
    case GM_KEY_REPAINT:
        gm_explorer_resize(explorer);
        break;
    case GM_KEY_THEME:
        repaint(explorer);
        break;
    case GM_KEY_SCENES:
        explorer->open.studies.shown = GM_STUDY_NONE;
        gm_explorer_show_start(explorer);
        break;
    case GM_KEY_STUDY:
        gm_studies_begin(&explorer->open.studies, key, explorer->open.shot, explorer->wake);
        explorer->dirty = true;
        break;
    case GM_KEY_MAP:
        gm_explorer_ask_map(explorer);
        break;
    case GM_KEY_TYPED: {
        const enum gm_choosing choosing = face->choosing;
        explorer->face.choosing = GM_CHOOSE_NOTHING;
        if (choosing == GM_CHOOSE_NOTHING) {
            gm_explorer_ask_system(explorer);
        } else {
            gm_explorer_ask_scheme(explorer, choosing == GM_CHOOSE_FORK);
        }
        break;
    }
    case GM_KEY_TOUR:
        press_in_tour(explorer, key);
        break;
    case GM_KEY_FILE:
        gm_worker_order(explorer->open.worker, (struct gm_order){.kind = GM_ORDER_SYSTEM});
        explorer->dirty = true;
        break;
    case GM_KEY_COPY:
        gm_explorer_copy(explorer);
        explorer->dirty = true;
        break;
    case GM_KEY_DONE:
        explorer->dirty = true;
        break;
    }
}
