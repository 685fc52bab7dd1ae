/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The keys of a scene, one row each. */
#include "app/explorer/view/keys.h"

#include <curses.h>

#include "app/explorer/view/chooser.h"
#include "app/explorer/view/prompt.h"
#include "core/basics.h"

static enum gm_key_result order(const struct gm_keystroke *press, enum gm_order_kind kind, int amount)
{
    return gm_keystroke_order(press, (struct gm_order){.kind = kind, .amount = amount});
}

/* ---- time ---- */

static enum gm_key_result press_pause(const struct gm_keystroke *press)
{
    return order(press, GM_ORDER_PAUSE, 0);
}

static enum gm_key_result press_step(const struct gm_keystroke *press)
{
    return order(press, press->key == '.' ? GM_ORDER_FORWARD : GM_ORDER_BACK, 0);
}

static enum gm_key_result press_speed(const struct gm_keystroke *press)
{
    return order(press, GM_ORDER_SPEED, press->key == ']' ? 1 : -1);
}

static enum gm_key_result press_past(const struct gm_keystroke *press)
{
    bool ends = press->key == KEY_HOME || press->key == KEY_END;
    return gm_keystroke_order(press,
                              (struct gm_order){.kind = GM_ORDER_VISIT,
                                                .amount = ends                      ? 0
                                                          : press->key == KEY_PPAGE ? -1
                                                                                    : 1,
                                                .value = press->key == KEY_END ? press->shot->reach : 0});
}

static enum gm_key_result press_turn(const struct gm_keystroke *press)
{
    return order(press, GM_ORDER_TURN, 0);
}

static enum gm_key_result press_ahead(const struct gm_keystroke *press)
{
    return gm_prompt_open(press, GM_PROMPT_AHEAD);
}

static enum gm_key_result press_restart(const struct gm_keystroke *press)
{
    return order(press, GM_ORDER_RESTART, 0);
}

/* ---- lanes and schemes ---- */

static enum gm_key_result press_select(const struct gm_keystroke *press)
{
    return order(press, GM_ORDER_SELECT, press->key == KEY_BTAB ? -1 : 1);
}

static enum gm_key_result press_switch(const struct gm_keystroke *press)
{
    return gm_chooser_open(press, GM_CHOOSE_SWITCH);
}

static enum gm_key_result press_fork(const struct gm_keystroke *press)
{
    return gm_chooser_open(press, GM_CHOOSE_FORK);
}

static enum gm_key_result press_lanes(const struct gm_keystroke *press)
{
    return order(press, press->key == 'c' ? GM_ORDER_ADD : GM_ORDER_REMOVE, 0);
}

static enum gm_key_result press_overlay(const struct gm_keystroke *press)
{
    return order(press, GM_ORDER_OVERLAY, 0);
}

/* ---- parameters ---- */

static enum gm_key_result press_choose(const struct gm_keystroke *press)
{
    size_t count = press->shot->parameter_count;
    if (count > 0) {
        press->face->parameter = (press->face->parameter + (press->key == KEY_UP ? count - 1 : 1)) % count;
    }
    press->face->explaining = true;
    return GM_KEY_DONE;
}

static enum gm_key_result order_parameter(const struct gm_keystroke *press, enum gm_order_kind kind,
                                          int amount)
{
    size_t chosen = press->face->parameter;
    press->face->explaining = true;
    if (chosen >= press->shot->parameter_count) {
        return GM_KEY_DONE;
    }
    const struct gm_shot_parameter *parameter = &press->shot->parameters[chosen];
    return gm_keystroke_order(
        press, (struct gm_order){
                   .kind = kind, .amount = amount, .row = parameter->row, .of_scheme = parameter->of_scheme});
}

static enum gm_key_result press_change(const struct gm_keystroke *press)
{
    return order_parameter(press, GM_ORDER_MOVE, press->key == KEY_LEFT ? -1 : 1);
}

static enum gm_key_result press_nudge(const struct gm_keystroke *press)
{
    return order_parameter(press, GM_ORDER_NUDGE, press->key == '-' ? -1 : 1);
}

/* In space shift with the arrows goes around what is seen, else it changes finely. */
static enum gm_key_result press_look(const struct gm_keystroke *press)
{
    enum { DEGREES = 5 };
    if (press->shot->in_space) {
        const int key = press->key;
        return gm_keystroke_order(press, (struct gm_order){.kind = GM_ORDER_LOOK,
                                                           .x = key == KEY_SLEFT    ? -DEGREES
                                                                : key == KEY_SRIGHT ? DEGREES
                                                                                    : 0,
                                                           .y = key == KEY_SR   ? DEGREES
                                                                : key == KEY_SF ? -DEGREES
                                                                                : 0,
                                                           .value = 1});
    }
    const bool across = press->key == KEY_SLEFT || press->key == KEY_SRIGHT;
    return across ? order_parameter(press, GM_ORDER_NUDGE, press->key == KEY_SLEFT ? -1 : 1) : GM_KEY_DONE;
}

static enum gm_key_result press_zoom(const struct gm_keystroke *press)
{
    return gm_keystroke_order(
        press, (struct gm_order){.kind = GM_ORDER_LOOK, .value = press->key == 'z' ? 1.25 : 1 / 1.25});
}

static enum gm_key_result press_type(const struct gm_keystroke *press)
{
    return gm_prompt_open(press, GM_PROMPT_VALUE);
}

static enum gm_key_result press_default(const struct gm_keystroke *press)
{
    return order_parameter(press, GM_ORDER_STANDARD, 0);
}

/* ---- the screen ---- */

static enum gm_key_result press_side(const struct gm_keystroke *press)
{
    press->face->side = (enum gm_side_panel)((press->face->side + 1) % GM_SIDE_COUNT);
    return GM_KEY_DONE;
}

static enum gm_key_result press_theme(const struct gm_keystroke *press)
{
    struct gm_face *face = press->face;
    if (face->monochrome) {
        face->monochrome = face->only_monochrome;
        face->theme = face->only_monochrome && face->theme == GM_THEME_DARK ? GM_THEME_LIGHT : GM_THEME_DARK;
    } else if (face->theme == GM_THEME_DARK) {
        face->theme = GM_THEME_LIGHT;
    } else {
        face->monochrome = true;
        face->theme = GM_THEME_DARK;
    }
    return GM_KEY_THEME;
}

static enum gm_key_result press_save(const struct gm_keystroke *press)
{
    return order(press, GM_ORDER_SAVE, (int)press->face->theme);
}

static enum gm_key_result press_record(const struct gm_keystroke *press)
{
    return order(press, GM_ORDER_RECORD, (int)press->face->theme);
}

static enum gm_key_result press_tell(const struct gm_keystroke *press)
{
    press->face->awaited = true;
    return order(press, GM_ORDER_TELL, (int)press->face->theme);
}

static enum gm_key_result press_help(const struct gm_keystroke *press)
{
    press->face->page = GM_PAGE_HELP;
    press->face->scroll = 0;
    return GM_KEY_DONE;
}

static enum gm_key_result press_formula(const struct gm_keystroke *press)
{
    return gm_keystroke_scheme_page(press, press->shot->lanes[press->shot->selected].scheme);
}

/* In the order of the help. A further key is a further row. */
const struct gm_key_row gm_key_rows[] = {
    {{' '}, "space", "pause", 2, "pause and go on", .press = press_pause},
    {{'.', ','}, ". ,", "step", 9, "one step forward, one step back; this pauses", .press = press_step},
    {{'[', ']'},
     "[ ]",
     "speed",
     10,
     "slower, faster: model time per second, down to single steps",
     .press = press_speed},
    {{KEY_PPAGE, KEY_NPAGE, KEY_HOME, KEY_END},
     "PgUp PgDn",
     NULL,
     0,
     "through the snapshots of the past; Home, End: the first, the last",
     .press = press_past},
    {{'B'},
     "B",
     "back in time",
     14,
     "turn time, dt to −dt, and see which scheme returns",
     .press = press_turn},
    {{'>'}, ">", "ahead", 15, "run ahead to a time, without drawing", .press = press_ahead},
    {{'r'}, "r", "restart", 8, "restart", .press = press_restart},
    {{'\t', KEY_BTAB}, "tab", "lane", 12, "select a lane", .press = press_select},
    {{'s'},
     "s",
     "scheme",
     4,
     "switch its scheme in flight, from the present state on",
     .press = press_switch},
    {{'f'}, "f", "fork", 6, "fork it: from here on with another scheme as well", .press = press_fork},
    {{'i'},
     "i",
     NULL,
     0,
     "its scheme: formula, order, claims as measured, reference",
     .press = press_formula},
    {{'c', 'x'},
     "c x",
     "compare",
     5,
     "add a lane from the start; remove the selected one",
     .press = press_lanes},
    {{'o'}, "o", "overlay", 13, "lanes in one panel, or side by side", .press = press_overlay},
    {{KEY_UP, KEY_DOWN}, "↑ ↓", NULL, 0, "choose a parameter", .press = press_choose},
    {{KEY_LEFT, KEY_RIGHT},
     "← →",
     "change",
     7,
     "change it; live ones act at once, others start again",
     .press = press_change},
    {{'-', '+'}, "- +", NULL, 0, "change it finely, by about a tenth of that", .press = press_nudge},
    {{KEY_SLEFT, KEY_SRIGHT, KEY_SR, KEY_SF},
     "shift ← →",
     NULL,
     0,
     "in space: go around it, with ↑ ↓ above or below, as dragging the picture does; else as - +",
     .press = press_look},
    {{'z', 'Z'},
     "z Z",
     NULL,
     0,
     "in space: nearer, further; so does the wheel over the picture",
     .press = press_zoom},
    {{'\n', '\r', KEY_ENTER}, "enter", NULL, 0, "type its value: 0.013, 1e-3, pi/60", .press = press_type},
    {{KEY_BACKSPACE, 127, 8}, "⌫", NULL, 0, "set it to its default", .press = press_default},
    {{'v'},
     "v",
     "view",
     16,
     "more room for: schemes, parameters, observables, the picture",
     .press = press_side},
    {{'t'}, "t", "theme", 18, "dark, light, monochrome", .press = press_theme},
    {{'b'},
     "b",
     "blocks",
     17,
     "pixels, braille, quadrants, half blocks, ASCII: what the terminal has",
     .result = GM_KEY_BLOCKS},
    {{'e'},
     "e",
     "formula",
     6,
     "a system of your own: edit the formula of this one, or type another",
     .result = GM_KEY_TYPED},
    {{'p'}, "p", "save", 11, "save the picture as PNG; `geomint again` redoes it", .press = press_save},
    {{'R'}, "R", "record", 20, "begin a movie of what is seen; again: end it", .press = press_record},
    {{'y'},
     "y",
     "command",
     21,
     "command lines: of this view as a picture, and of the explorer; copied too; s there saves your own system",
     .press = press_tell},
    {{'w', 'm'},
     "w m",
     "diagrams",
     20,
     "in the background: what an accuracy costs (work-precision); which step stays bounded (a map)",
     .result = GM_KEY_STUDY},
    {{'M'},
     "M",
     "map",
     20,
     "many runs over two keys, as a map that grows; a click in it opens the run",
     .result = GM_KEY_MAP},
    {{'n', 'N', 'a'},
     "n N a",
     NULL,
     0,
     "in a tour: answer or next step, step before, this one again",
     .result = GM_KEY_TOUR},
    {{'l', 27}, "l esc", "scenes", 19, "back to the list of scenes", .result = GM_KEY_SCENES},
    {{'?'},
     "?",
     "help",
     1,
     "this page; in a list of schemes, the page of the chosen one",
     .press = press_help},
    {{GM_KEY_REDRAW}, "ctrl-L", NULL, 0, "draw the screen again", .result = GM_KEY_REPAINT},
    {{'q'}, "q", "quit", 3, "quit", .result = GM_KEY_LEAVE},
};
const size_t gm_key_row_count = GM_COUNT(gm_key_rows);

enum gm_key_result gm_key_press(const struct gm_keystroke *press)
{
    press->face->explaining = false;
    for (size_t i = 0; i < gm_key_row_count; i++) {
        for (size_t k = 0; k < GM_KEY_CODES && gm_key_rows[i].codes[k]; k++) {
            if (gm_key_rows[i].codes[k] == press->key) {
                const struct gm_key_row *row = &gm_key_rows[i];
                return row->press ? row->press(press) : row->result;
            }
        }
    }
    return GM_KEY_DONE; /* any other key dismisses a message */
}
