/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Keys, as they act on the explorer. */
#include "app/explorer/events.h"

#include "app/explorer/view/keys.h"

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
    const char *command = explorer->shot->commands[explorer->face.command];
    if (command) {
        gm_writer_copy(&explorer->display.writer, command);
    }
}

void gm_explorer_press(struct gm_explorer *explorer, int key)
{
    if (explorer->at_start) {
        gm_explorer_press_at_start(explorer, key);
        return;
    }
    if (!explorer->shot) { /* before the first picture there is only leaving */
        if (key == 'q') {
            gm_explorer_leave(explorer, GM_EXIT_OK);
        } else if (key == 'l') {
            gm_explorer_show_start(explorer);
        } else if (key == 'n' || key == 'N' || key == 'a') {
            gm_explorer_press_in_tour(explorer, key);
        }
        return;
    }
    const struct gm_face *face = &explorer->face;
    const bool plain =
        face->page == GM_PAGE_SCENE && face->choosing == GM_CHOOSE_NOTHING && face->prompt == GM_PROMPT_NONE;
    if (plain && gm_studies_press(&explorer->studies, key, face->theme)) {
        explorer->dirty = true;
        return;
    }
    const struct gm_press one = {key, &explorer->face, explorer->shot, explorer->worker};
    switch (gm_key_press(&one)) {
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
        explorer->studies.shown = GM_STUDY_NONE;
        gm_explorer_show_start(explorer);
        break;
    case GM_KEY_STUDY:
        gm_studies_begin(&explorer->studies, key, explorer->shot, explorer->wake);
        explorer->dirty = true;
        break;
    case GM_KEY_TOUR:
        gm_explorer_press_in_tour(explorer, key);
        break;
    case GM_KEY_COPY:
        gm_explorer_copy(explorer);
        explorer->dirty = true;
        break;
    case GM_KEY_FACE:
    case GM_KEY_ORDER:
        explorer->dirty = true;
        break;
    case GM_KEY_IGNORED:
        break;
    }
}
