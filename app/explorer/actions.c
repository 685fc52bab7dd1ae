/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The keys of an open scene: the table of actions, and the keys of pages, of the list of schemes and of a typed
   value; and the mouse. */
#include "app/explorer/events.h"

#include <curses.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/basics.h"
#include "render/clock.h"

/* A key's code, and the arguments of its row's function: an order, a list, a prompt, a page or a study, and a
   direction. */
struct key {
    int code, meaning, amount;
};

static void order(struct gm_explorer *explorer, const struct key *key)
{
    gm_explorer_order(explorer,
                      (struct gm_order){.kind = (enum gm_order_kind)key->meaning, .amount = key->amount});
}

/* ---- orders that depend on the screen ---- */

/* Gives an order with the current theme. */
static void order_picture(struct gm_explorer *explorer, const struct key *key)
{
    struct gm_face *face = &explorer->face;
    face->awaited = face->awaited || key->meaning == GM_ORDER_TELL;
    order(explorer, &(const struct key){.meaning = key->meaning, .amount = (int)face->theme});
}

static void order_portrait(struct gm_explorer *explorer, const struct key *key)
{
    const struct gm_parameter *row = gm_scene_parameter(explorer->open.scene, "portrait");
    if (row) {
        gm_explorer_order(explorer,
                          (struct gm_order){.kind = GM_ORDER_MOVE, .amount = key->amount, .row = row});
    }
}

static void order_parameter(struct gm_explorer *explorer, const struct key *key)
{
    const struct gm_shot *shot = explorer->open.shot;
    const size_t chosen = explorer->face.parameter;
    explorer->face.explaining = true;
    if (chosen < shot->parameter_count) {
        gm_explorer_order(explorer, (struct gm_order){.kind = (enum gm_order_kind)key->meaning,
                                                      .amount = key->amount,
                                                      .row = shot->parameters[chosen].row});
    }
}

/* Moves around a picture in space with shift and the arrows; elsewhere changes a parameter finely. */
static void order_look(struct gm_explorer *explorer, const struct key *key)
{
    enum { DEGREES = 5 };
    const bool across = key->meaning == GM_ORDER_NUDGE;
    if (explorer->open.shot->in_space) {
        const int x = across ? DEGREES * key->amount : 0, y = across ? 0 : DEGREES * key->amount;
        gm_explorer_order(explorer, (struct gm_order){.kind = GM_ORDER_LOOK, .x = x, .y = y, .value = 1});
    } else if (across) {
        order_parameter(explorer, key);
    }
}

static void order_zoom(struct gm_explorer *explorer, const struct key *key)
{
    const double factor = key->amount > 0 ? 1.25 : 1 / 1.25;
    gm_explorer_order(explorer, (struct gm_order){.kind = GM_ORDER_LOOK, .value = factor});
}

/* ---- the screen ---- */

static void open_prompt(struct gm_explorer *explorer, const struct key *key)
{
    if (key->meaning != GM_PROMPT_VALUE || explorer->face.parameter < explorer->open.shot->parameter_count) {
        explorer->face.prompt = (enum gm_prompt)key->meaning;
        explorer->face.typed[0] = '\0';
    }
}

/* Returns the first scheme after the selected lane's that no lane uses; NULL: no scheme fits. */
static const struct gm_scheme *first_choice(const struct gm_shot *shot)
{
    size_t own = 0;
    for (size_t i = 0; i < shot->scheme_count; i++) {
        if (shot->schemes[i] == shot->lanes[shot->selected].scheme) {
            own = i;
        }
    }
    for (size_t i = 1; i < shot->scheme_count; i++) {
        const struct gm_scheme *scheme = shot->schemes[(own + i) % shot->scheme_count];
        if (!gm_shot_uses(shot, scheme)) {
            return scheme;
        }
    }
    return shot->scheme_count > 0 ? shot->schemes[own] : NULL;
}

static void choose_scheme(struct gm_explorer *explorer, const struct key *key)
{
    explorer->face.choosing = (enum gm_choosing)key->meaning;
    explorer->face.typed[0] = '\0';
    explorer->face.choice = first_choice(explorer->open.shot);
}

static void choose_parameter(struct gm_explorer *explorer, const struct key *key)
{
    const size_t count = explorer->open.shot->parameter_count;
    if (count > 0) {
        explorer->face.parameter = (explorer->face.parameter + (key->amount < 0 ? count - 1 : 1)) % count;
    }
    explorer->face.explaining = true;
}

static void next_side(struct gm_explorer *explorer, const struct key *key)
{
    explorer->face.side = (enum gm_side_panel)((explorer->face.side + key->amount) % GM_SIDE_COUNT);
}

static void next_theme(struct gm_explorer *explorer)
{
    struct gm_face *face = &explorer->face;
    struct gm_writer *writer = &explorer->display.writer;
    const bool dark = face->theme == GM_THEME_DARK;
    if (face->only_monochrome || (dark && !face->monochrome)) {
        face->theme = dark ? GM_THEME_LIGHT : GM_THEME_DARK;
    } else {
        face->monochrome = !face->monochrome;
        face->theme = GM_THEME_DARK;
    }
    writer->theme = face->theme;
    writer->colours = face->monochrome ? GM_COLOURS_NONE : explorer->terminal.colours;
    gm_display_forget(&explorer->display);
    explorer->fresh = true;
}

static void next_blocks(struct gm_explorer *explorer)
{
    struct gm_face *face = &explorer->face;
    const struct gm_graphics next =
        gm_graphics_next(&explorer->terminal, (struct gm_graphics){face->pixels, face->blocks});
    face->pixels = next.pixels;
    face->blocks = next.blocks;
}

static void open_page_on(struct gm_face *face, enum gm_page page, const struct gm_scheme *scheme)
{
    face->page = page;
    face->explained = scheme;
    face->scroll = 0;
}

static void open_page(struct gm_explorer *explorer, const struct key *key)
{
    const struct gm_shot *shot = explorer->open.shot;
    open_page_on(&explorer->face, (enum gm_page)key->meaning, shot->lanes[shot->selected].scheme);
}

/* ---- what replaces or leaves the scene ---- */

/* Starts a diagram of the scene with its current settings in the background. */
static void begin_study(struct gm_explorer *explorer, const struct key *key)
{
    gm_studies_begin(&explorer->open.studies, (enum gm_study_kind)key->meaning, explorer->open.shot,
                     explorer->wake);
}

static void leave_scene(struct gm_explorer *explorer)
{
    gm_studies_leave(&explorer->open.studies);
    gm_explorer_show_start(explorer);
}

/* Shows another step of the tour, if there is one. */
static void go_in_tour(struct gm_explorer *explorer, const struct key *key)
{
    struct gm_open *open = &explorer->open;
    struct gm_guide *guide = &open->guide;
    if (!guide->tour) {
        return;
    }
    if (key->amount > 0 && !guide->answered) {
        guide->answered = true;
        gm_open_study(open);
        gm_explorer_order(explorer, (struct gm_order){.kind = GM_ORDER_RUN});
        return;
    }
    const size_t step = guide->step + (size_t)key->amount; /* before the first: a number without a step */
    if (step < guide->tour->count) {
        *guide = gm_guide_at(guide->tour, step);
        explorer->face.parameter = 0;
        if (!gm_open_step(open, explorer->message)) {
            gm_explorer_leave(explorer, GM_EXIT_USAGE);
        }
    }
}

/* Shows the hint of an exercise, or saves its answer. */
static void work_on_exercise(struct gm_explorer *explorer, const struct key *key)
{
    struct gm_guide *guide = &explorer->open.guide;
    if (!guide->tour || guide->tour->steps[guide->step].expectation_count == 0) {
        return;
    }
    if (key->code == 'H') {
        guide->hinted = true;
    } else {
        order(explorer, key);
    }
}

/* ---- the table ---- */

enum { CODES = 4 };

static const struct {
    struct key keys[CODES]; /* a code of 0 ends them */
    void (*act)(struct gm_explorer *explorer, const struct key *key);
    void (*call)(struct gm_explorer *explorer); /* if there is no `act` */
} rows[] = {
#define GM_ORDER_KEYS(...)
#define GM_KEYS(label, hint, rank, text, function, ...) {.keys = {__VA_ARGS__}, .function},
#include "app/runs/keys.def"
#undef GM_KEYS
#undef GM_ORDER_KEYS
};

/* Carries out a key of the table; returns false if it has no row. */
static bool act_on(struct gm_explorer *explorer, int key)
{
    struct gm_order order;
    if (gm_key_order(key, &order)) {
        gm_explorer_order(explorer, order);
        return true;
    }
    for (size_t i = 0; i < GM_COUNT(rows); i++) {
        for (size_t k = 0; k < CODES && rows[i].keys[k].code; k++) {
            if (rows[i].keys[k].code != key) {
                continue;
            }
            if (rows[i].act) {
                rows[i].act(explorer, &rows[i].keys[k]);
            } else {
                rows[i].call(explorer);
            }
            return true;
        }
    }
    return false;
}

/* Explains a key without a meaning, once for each key. */
static void hint_at(struct gm_face *face, int key)
{
    enum { HINT_MILLISECONDS = 3000 };
    if (key < 0 || key >= GM_KEY_NUMBERS || (face->hinted[key / 32] >> key % 32 & 1)) {
        return;
    }
    face->hinted[key / 32] |= 1u << key % 32;
    snprintf(face->hint, sizeof face->hint, key > ' ' && key <= '~' ? "%c" : "this key", key);
    gm_append(face->hint, sizeof face->hint, " does nothing here; ? lists the keys");
    face->hint_until = gm_clock_milliseconds() + HINT_MILLISECONDS;
}

/* ---- above the scene ---- */

enum { PAGE = 10 }; /* lines per press of PgUp or PgDn */

static void press_in_page(struct gm_explorer *explorer, int key)
{
    struct gm_face *face = &explorer->face;
    const bool command = face->page == GM_PAGE_COMMAND;
    if (key == 'q') {
        gm_explorer_quit(explorer);
    } else if (key == KEY_UP || key == KEY_DOWN) {
        face->scroll += key == KEY_UP ? -1 : 1;
    } else if (key == KEY_PPAGE || key == KEY_NPAGE || key == ' ') {
        face->scroll += key == KEY_PPAGE ? -PAGE : PAGE;
    } else if (key == 'y' && command) {
        face->command = (face->command + 1) % GM_COMMANDS;
        gm_explorer_copy(explorer);
    } else {
        if (key == 's' && command) {
            explorer->open.unsaved = false;
            gm_explorer_order(explorer, (struct gm_order){.kind = GM_ORDER_SYSTEM});
        } else if (face->page == GM_PAGE_HELP) {
            face->watched = NULL; /* the sentence on what to watch is shown again */
        }
        face->page = GM_PAGE_SCENE;
    }
}

/* Moves the choice in the list of schemes; by 1 it goes around. */
static void move_choice(struct gm_face *face, const struct gm_shot *shot, long by)
{
    const struct gm_scheme *found[GM_SHOT_SCHEMES];
    const long count = (long)gm_chooser_find(face, shot, found);
    long at = 0;
    for (long i = 0; i < count; i++) {
        at = found[i] == face->choice ? i : at;
    }
    const long next = at + by, last = count - 1,
               around = by == 1 || by == -1 ? (next + count) % (count > 0 ? count : 1) : next;
    face->choice = count == 0 ? NULL : found[around < 0 ? 0 : around > last ? last : around];
}

static void press_in_chooser(struct gm_explorer *explorer, int key)
{
    struct gm_face *face = &explorer->face;
    const struct gm_shot *shot = explorer->open.shot;
    if (key == GM_KEY_ESCAPE || (key == KEY_BACKSPACE && !face->typed[0])) {
        face->choosing = GM_CHOOSE_NOTHING;
    } else if (key == '\n' && face->choice) {
        gm_explorer_choose(explorer, face->choice);
    } else if (key == KEY_UP || key == KEY_BTAB || key == KEY_DOWN || key == '\t') {
        move_choice(face, shot, key == KEY_UP || key == KEY_BTAB ? -1 : 1);
    } else if (key == KEY_PPAGE || key == KEY_NPAGE) {
        move_choice(face, shot, key == KEY_PPAGE ? -PAGE : PAGE);
    } else if (key == '?' && face->choice && face->choice != &gm_chooser_user) {
        open_page_on(face, GM_PAGE_SCHEME, face->choice);
    } else if (key != '?' && gm_typed_key(face->typed, key) && (face->typed[0] || !face->choice)) {
        const struct gm_scheme *found[GM_SHOT_SCHEMES];
        face->choice = gm_chooser_find(face, shot, found) > 0 ? found[0] : NULL;
    }
}

static void press_in_prompt(struct gm_explorer *explorer, int key)
{
    struct gm_face *face = &explorer->face;
    const struct gm_shot *shot = explorer->open.shot;
    const bool ahead = face->prompt == GM_PROMPT_AHEAD;
    if (key != '\n' && key != GM_KEY_ESCAPE) {
        gm_typed_key(face->typed, key);
        return;
    }
    face->prompt = GM_PROMPT_NONE;
    if (key == '\n' && (face->typed[0] || ahead)) {
        struct gm_order order = {.kind = ahead ? GM_ORDER_AHEAD : GM_ORDER_TYPE,
                                 .row = ahead ? NULL : shot->parameters[face->parameter].row};
        snprintf(order.text, sizeof order.text, "%s", face->typed);
        if (!face->typed[0]) {
            snprintf(order.text, sizeof order.text, "%.6g", shot->ahead);
        }
        gm_explorer_order(explorer, order);
    }
}

/* ---- all keys ---- */

/* Passes a key to the part that is open above the scene, or to the table. */
static void press_in_scene(struct gm_explorer *explorer, int key)
{
    struct gm_face *face = &explorer->face;
    const struct gm_shot *shot = explorer->open.shot;
    const bool plain =
        face->page == GM_PAGE_SCENE && face->choosing == GM_CHOOSE_NOTHING && face->prompt == GM_PROMPT_NONE;
    if (plain && gm_studies_press(&explorer->open.studies, key, face->theme)) {
        return;
    }
    const bool said = shot->message[0] && shot->message_number != face->read;
    face->read = shot->message_number;
    face->watch_until = face->hint_until = 0;
    if (key == GM_KEY_REDRAW) {
        gm_explorer_resize(explorer);
    } else if (shot->running_ahead && key != 'q') { /* any key stops running ahead */
        gm_explorer_order(explorer, (struct gm_order){.kind = GM_ORDER_HALT});
    } else if (face->page != GM_PAGE_SCENE) {
        press_in_page(explorer, key);
    } else if (face->choosing != GM_CHOOSE_NOTHING) {
        press_in_chooser(explorer, key);
    } else if (face->prompt != GM_PROMPT_NONE) {
        press_in_prompt(explorer, key);
    } else if (key == GM_KEY_ESCAPE && (said || face->explaining)) { /* esc first dismisses the message */
        face->explaining = false;
    } else {
        face->explaining = false;
        if (!act_on(explorer, key)) {
            hint_at(face, key);
        }
    }
}

void gm_explorer_key(struct gm_explorer *explorer, int key)
{
    struct gm_face *face = &explorer->face;
    const bool enter = key == '\r' || key == KEY_ENTER, erase = key == 127 || key == 8;
    key = enter ? '\n' : erase ? KEY_BACKSPACE : key; /* one code for the keys of one meaning */
    explorer->dirty = true;
    if (face->loss) {
        face->loss = NULL;
        if (key == 'q') {
            gm_explorer_leave(explorer, GM_EXIT_OK);
        }
    } else if (explorer->typed_prompt.kind != GM_TYPED_NONE && key != GM_KEY_REDRAW) {
        gm_explorer_press_typed(explorer, key);
    } else if (explorer->list.shown && face->page != GM_PAGE_SCENE) {
        press_in_page(explorer, key);
    } else if (explorer->list.shown) {
        gm_explorer_press_list(explorer, key);
    } else if (explorer->open.shot) {
        press_in_scene(explorer, key);
    } else if (key == 'q') { /* before the first picture one can only leave */
        gm_explorer_leave(explorer, GM_EXIT_OK);
    } else if (key == 'l' || key == GM_KEY_ESCAPE) {
        gm_explorer_show_start(explorer);
    } else if (key == 'n' || key == 'N' || key == 'a') {
        act_on(explorer, key);
    }
}

/* ---- the mouse: clicks, drags and the wheel ---- */

/* Moves a slider with the pressed button; `begins`: it was just pressed. */
static void drag(struct gm_explorer *explorer, int column, bool begins)
{
    const struct gm_shot *shot = explorer->open.shot;
    const struct gm_hit *held = &explorer->pointer.held;
    const double part = held->width > 1 ? (double)(column - held->column) / (held->width - 1) : 0;
    struct gm_order order = {.kind = GM_ORDER_VISIT, .value = fmin(fmax(part, 0), 1)};
    if (shot && held->kind == GM_HIT_PAST) {
        order.value *= shot->reach;
    } else if (shot && held->kind == GM_HIT_SLIDER && held->index < shot->parameter_count) {
        order.kind = GM_ORDER_SLIDE;
        order.amount = begins;
        order.row = shot->parameters[held->index].row;
    } else {
        return;
    }
    gm_explorer_order(explorer, order);
}

/* Chooses a parameter. One without a slider takes its next value at a second click. */
static void click_parameter(struct gm_explorer *explorer, size_t index)
{
    const struct gm_shot_parameter *parameter = &explorer->open.shot->parameters[index];
    bool again = explorer->face.parameter == index;
    explorer->face.parameter = index;
    explorer->face.explaining = true;
    if (again && parameter->position < 0) {
        gm_explorer_order(explorer,
                          (struct gm_order){.kind = GM_ORDER_MOVE, .amount = 1, .row = parameter->row});
    }
}

static void click_picture(struct gm_explorer *explorer, const struct gm_mouse_event *event)
{
    const struct gm_screen *screen = &explorer->screen;
    if (!explorer->open.shot->scene->point) {
        return;
    }
    struct gm_picture *picture = explorer->open.shot->picture;
    const struct gm_spot spot =
        screen->pixels.columns > 0
            ? gm_display_locate(&explorer->display, picture, event->column, event->row)
            : gm_cells_locate(&screen->picture.cells, picture, screen->picture.blocks,
                              event->column - screen->picture_column, event->row - screen->picture_row);
    if (spot.panel) {
        gm_explorer_order(explorer, (struct gm_order){.kind = GM_ORDER_POINT, .x = spot.x, .y = spot.y});
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
    gm_explorer_order(explorer, (struct gm_order){.kind = GM_ORDER_LOOK,
                                                  .x = degrees * (pointer->column - event->column),
                                                  .y = 2 * degrees * (event->row - pointer->row),
                                                  .value = 1});
    pointer->column = event->column;
    pointer->row = event->row;
}

/* Returns the newest hit at a cell of the screen, or NULL. */
static const struct gm_hit *hit_at(const struct gm_hits *hits, int column, int row)
{
    for (size_t i = hits->count; i-- > 0;) {
        const struct gm_hit *hit = &hits->hits[i];
        if (column >= hit->column && column < hit->column + hit->width && row >= hit->row &&
            row < hit->row + hit->height) {
            return hit;
        }
    }
    return NULL;
}

static void click(struct gm_explorer *explorer, const struct gm_mouse_event *event)
{
    const struct gm_hit *hit = hit_at(&explorer->screen.hits, event->column, event->row);
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
    if (hit->kind != GM_HIT_KEY && hit->kind != GM_HIT_SCENE) {
        if (explorer->list.shown || !explorer->open.shot) {
            return;
        }
        explorer->face.read = explorer->open.shot->message_number;
    }
    switch (hit->kind) {
    case GM_HIT_KEY:
        gm_explorer_key(explorer, (int)hit->index);
        break;
    case GM_HIT_SCENE:
        gm_explorer_click_entry(explorer, hit->index);
        break;
    case GM_HIT_LANE:
        gm_explorer_order(explorer, (struct gm_order){.kind = GM_ORDER_SELECT, .value = (double)hit->index});
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
    }
}

void gm_explorer_point(struct gm_explorer *explorer, const struct gm_mouse_event *event)
{
    const struct gm_hit *hit = hit_at(&explorer->screen.hits, event->column, event->row);
    const bool up = event->kind == GM_MOUSE_UP;
    const bool lists = explorer->list.shown || explorer->face.page != GM_PAGE_SCENE ||
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
        /* the wheel scrolls a list, zooms a picture in space, or changes the speed */
        if (lists) {
            gm_explorer_key(explorer, up ? KEY_UP : KEY_DOWN);
        } else if (is_in_space(explorer, hit)) {
            gm_explorer_key(explorer, up ? 'z' : 'Z');
        } else {
            gm_explorer_key(explorer, up ? ']' : '[');
        }
        break;
    }
}
