/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The mouse: clicks, drags and the wheel. */
#include <curses.h>
#include <stdio.h>
#include <stdlib.h>

#include "app/explorer/events.h"
#include "app/explorer/view/view.h"

/* Returns a column's position in a hit, 0 to 1. */
static double part_of(const struct gm_hit *hit, int column)
{
    double part = hit->width > 1 ? (double)(column - hit->column) / (hit->width - 1) : 0;
    return part < 0 ? 0 : part > 1 ? 1 : part;
}

/* Moves a slider with the pressed button; `begins`: it was just pressed. */
static void drag(struct gm_explorer *explorer, int column, bool begins)
{
    const struct gm_shot *shot = explorer->open.shot;
    struct gm_order order = {.value = part_of(&explorer->pointer.held, column)};
    if (!shot) {
        return;
    }
    if (explorer->pointer.held.kind == GM_HIT_PAST) {
        order.kind = GM_ORDER_VISIT;
        order.value *= shot->reach;
    } else if (explorer->pointer.held.kind == GM_HIT_SLIDER &&
               explorer->pointer.held.index < shot->parameter_count) {
        order.kind = GM_ORDER_SLIDE;
        order.amount = begins;
        order.row = shot->parameters[explorer->pointer.held.index].row;
    } else {
        return;
    }
    gm_worker_order(explorer->open.worker, order);
}

/* Chooses a parameter. One without a slider takes its next value at a second click. */
static void click_parameter(struct gm_explorer *explorer, size_t index)
{
    const struct gm_shot_parameter *parameter = &explorer->open.shot->parameters[index];
    bool again = explorer->face.parameter == index;
    explorer->face.parameter = index;
    explorer->face.explaining = true;
    if (again && parameter->position < 0) {
        gm_worker_order(explorer->open.worker,
                        (struct gm_order){.kind = GM_ORDER_MOVE, .amount = 1, .row = parameter->row});
    }
}

static void click_picture(struct gm_explorer *explorer, const struct gm_mouse_event *event)
{
    struct gm_order order = {.kind = GM_ORDER_POINT};
    const struct gm_screen *screen = &explorer->screen;
    if (!explorer->open.shot->scene->point) {
        return;
    }
    struct gm_picture *picture = explorer->open.shot->picture;
    const struct gm_panel *panel =
        screen->pixels.columns > 0
            ? gm_display_locate(&explorer->display, picture, event->column, event->row, &order.x, &order.y)
            : gm_cells_locate(&screen->picture.cells, picture, screen->picture.blocks,
                              event->column - screen->picture_column, event->row - screen->picture_row,
                              &order.x, &order.y);
    if (panel) {
        gm_worker_order(explorer->open.worker, order);
    }
}

/* Opens the run at a point of a map; the map's key shows the map again. */
static void click_study(struct gm_explorer *explorer, const struct gm_mouse_event *event)
{
    struct gm_open *open = &explorer->open;
    struct gm_typed_fault fault;
    char *words = gm_studies_pick(&open->studies, explorer->face.blocks, event->column, event->row);
    if (words && !gm_explorer_open_line(explorer, words, &fault)) {
        snprintf(open->studies.notice, sizeof open->studies.notice, "%s", fault.sentence);
    }
    free(words);
}

/* Returns true if the hit is a picture in space. */
static bool is_in_space(const struct gm_explorer *explorer, const struct gm_hit *hit)
{
    return hit && hit->kind == GM_HIT_PICTURE && !explorer->list.shown && explorer->open.shot &&
           explorer->open.shot->in_space && explorer->face.page == GM_PAGE_SCENE &&
           explorer->open.studies.shown == GM_STUDY_NONE;
}

/* Turns the picture with the button: half a turn for the width of the screen. A row is as high as two
   columns are wide. */
static void drag_space(struct gm_explorer *explorer, const struct gm_mouse_event *event)
{
    struct gm_pointer *pointer = &explorer->pointer;
    const double degrees = 180. / (explorer->screen.cells.columns > 0 ? explorer->screen.cells.columns : 1);
    gm_worker_order(explorer->open.worker, (struct gm_order){.kind = GM_ORDER_LOOK,
                                                             .x = degrees * (pointer->column - event->column),
                                                             .y = 2 * degrees * (event->row - pointer->row),
                                                             .value = 1});
    pointer->column = event->column;
    pointer->row = event->row;
}

/* Handles the wheel: zooms a picture in space, else scrolls a list or changes the speed. */
static void turn_wheel(struct gm_explorer *explorer, const struct gm_mouse_event *event, bool lists)
{
    const bool up = event->kind == GM_MOUSE_UP;
    const bool space =
        !lists && is_in_space(explorer, gm_hits_at(&explorer->screen.hits, event->column, event->row));
    gm_explorer_key(explorer, lists ? (up ? KEY_UP : KEY_DOWN) : space ? (up ? 'z' : 'Z') : up ? ']' : '[');
}

static void click(struct gm_explorer *explorer, const struct gm_mouse_event *event)
{
    const struct gm_hit *hit = gm_hits_at(&explorer->screen.hits, event->column, event->row);
    if (explorer->face.loss && !(hit && hit->kind == GM_HIT_KEY)) { /* like any key but q */
        explorer->face.loss = NULL;
        return;
    }
    explorer->pointer.holding = hit != NULL;
    if (!hit) {
        return;
    }
    explorer->pointer.held = *hit;
    explorer->pointer.column = event->column;
    explorer->pointer.row = event->row;
    if (hit->kind == GM_HIT_KEY) {
        gm_explorer_key(explorer, (int)hit->index);
        return;
    }
    if (hit->kind == GM_HIT_SCENE) {
        gm_explorer_click_entry(explorer, hit->index);
        return;
    }
    if (explorer->list.shown || !explorer->open.shot) {
        return;
    }
    explorer->face.read = explorer->open.shot->message_number;
    switch (hit->kind) {
    case GM_HIT_LANE:
        gm_worker_order(explorer->open.worker,
                        (struct gm_order){.kind = GM_ORDER_SELECT, .value = (double)hit->index});
        break;
    case GM_HIT_SCHEME:
        gm_explorer_choose(explorer, hit->scheme);
        break;
    case GM_HIT_SLIDER:
        explorer->face.parameter = hit->index;
        explorer->face.explaining = true;
        drag(explorer, event->column, true);
        break;
    case GM_HIT_PARAMETER:
        click_parameter(explorer, hit->index);
        break;
    case GM_HIT_PAST:
        drag(explorer, event->column, true);
        break;
    case GM_HIT_PICTURE:
        if (explorer->open.studies.shown != GM_STUDY_NONE) {
            click_study(explorer, event);
        } else {
            click_picture(explorer, event);
        }
        break;
    case GM_HIT_KEY:
    case GM_HIT_SCENE:
        break;
    }
}

void gm_explorer_point(struct gm_explorer *explorer, const struct gm_mouse_event *event)
{
    bool lists = explorer->list.shown || explorer->face.page != GM_PAGE_SCENE ||
                 explorer->face.choosing != GM_CHOOSE_NOTHING;
    explorer->dirty = true;
    switch (event->kind) {
    case GM_MOUSE_PRESS:
        click(explorer, event);
        break;
    case GM_MOUSE_DRAG:
        if (explorer->pointer.holding && is_in_space(explorer, &explorer->pointer.held)) {
            drag_space(explorer, event);
        } else if (explorer->pointer.holding && !explorer->list.shown) {
            drag(explorer, event->column, false);
        }
        break;
    case GM_MOUSE_RELEASE:
        explorer->pointer.holding = false;
        break;
    case GM_MOUSE_UP:
    case GM_MOUSE_DOWN:
        turn_wheel(explorer, event, lists);
        break;
    }
}
