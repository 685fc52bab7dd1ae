/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The keys of a scene, and typed lines, from their first key to their order. */
#include "app/explorer/view/view.h"

#include <curses.h>
#include <stdio.h>
#include <string.h>

#include "core/basics.h"

/* ---- typed lines ---- */

/* Writes the time to run ahead to if no time is typed. */
static void ahead_text(const struct gm_shot *shot, char *text, size_t size)
{
    snprintf(text, size, "%.6g", shot->ahead);
}

enum gm_key_result gm_prompt_open(const struct gm_keystroke *press, enum gm_prompt prompt)
{
    struct gm_face *face = press->face;
    if (prompt == GM_PROMPT_VALUE && face->parameter >= press->shot->parameter_count) {
        return GM_KEY_DONE;
    }
    face->prompt = prompt;
    face->typed[0] = '\0';
    return GM_KEY_DONE;
}

enum gm_key_result gm_prompt_press(const struct gm_keystroke *press)
{
    struct gm_face *face = press->face;
    if (gm_key_is_escape(press->key)) {
        face->prompt = GM_PROMPT_NONE;
        return GM_KEY_DONE;
    }
    if (!gm_key_is_enter(press->key)) {
        gm_typed_key(face->typed, press->key);
        return GM_KEY_DONE;
    }
    enum gm_prompt prompt = face->prompt;
    face->prompt = GM_PROMPT_NONE;
    if (!face->typed[0] && prompt == GM_PROMPT_VALUE) {
        return GM_KEY_DONE;
    }
    struct gm_order order = {.kind = prompt == GM_PROMPT_AHEAD ? GM_ORDER_AHEAD : GM_ORDER_TYPE};
    if (face->typed[0]) {
        snprintf(order.text, sizeof order.text, "%s", face->typed);
    } else {
        ahead_text(press->shot, order.text, sizeof order.text);
    }
    if (prompt == GM_PROMPT_VALUE) {
        order.row = press->shot->parameters[face->parameter].row;
        order.of_scheme = press->shot->parameters[face->parameter].of_scheme;
    }
    return gm_keystroke_order(press, order);
}

/* Returns the end of the typed text, where letters are added, and sets the mark before it; the help needs
   the rest. */
static const char *end_of(const char *typed, const char **before)
{
    enum { SHOWN = 40 };
    const size_t length = strlen(typed);
    *before = length > SHOWN ? "…" : "";
    return length > SHOWN ? typed + length - SHOWN : typed;
}

void gm_prompt_text(const struct gm_face *face, const struct gm_shot *shot, char *text, size_t size)
{
    const char *before, *typed = end_of(face->typed, &before);
    if (face->prompt == GM_PROMPT_AHEAD) {
        char standard[32] = "";
        ahead_text(shot, standard, sizeof standard);
        snprintf(text, size, "Run ahead to t = %s%s_   (enter alone: %s)", before, typed, standard);
    } else {
        const struct gm_parameter *row = shot->parameters[face->parameter].row;
        snprintf(text, size, "%s = %s%s_   (%s)", row->key, before, typed, row->help);
    }
}

/* ---- keys ---- */

/* Returns the result in `meaning`, for the explorer to handle. */
static enum gm_key_result pass_on(const struct gm_keystroke *press, const struct gm_key_code *key)
{
    (void)press;
    return (enum gm_key_result)key->meaning;
}

/* ---- orders ---- */

static enum gm_key_result order(const struct gm_keystroke *press, const struct gm_key_code *key)
{
    return gm_keystroke_order(
        press, (struct gm_order){.kind = (enum gm_order_kind)key->meaning, .amount = key->amount});
}

/* Gives an order with the current theme. */
static enum gm_key_result order_picture(const struct gm_keystroke *press, const struct gm_key_code *key)
{
    const struct gm_key_code coloured = {.meaning = key->meaning, .amount = (int)press->face->theme};
    press->face->awaited = press->face->awaited || key->meaning == GM_ORDER_TELL;
    return order(press, &coloured);
}

static enum gm_key_result order_visit(const struct gm_keystroke *press, const struct gm_key_code *key)
{
    return gm_keystroke_order(press,
                              (struct gm_order){.kind = GM_ORDER_VISIT,
                                                .amount = key->amount,
                                                .value = key->code == KEY_END ? press->shot->reach : 0});
}

/* Shows or hides the phase portrait, if the scene has one. */
static enum gm_key_result order_portrait(const struct gm_keystroke *press, const struct gm_key_code *key)
{
    for (size_t i = 0; i < press->shot->parameter_count; i++) {
        const struct gm_parameter *row = press->shot->parameters[i].row;
        if (strcmp(row->key, "portrait") == 0) {
            return gm_keystroke_order(press, (struct gm_order){.kind = (enum gm_order_kind)key->meaning,
                                                               .amount = key->amount,
                                                               .row = row});
        }
    }
    return GM_KEY_DONE;
}

static enum gm_key_result order_parameter(const struct gm_keystroke *press, const struct gm_key_code *key)
{
    size_t chosen = press->face->parameter;
    press->face->explaining = true;
    if (chosen >= press->shot->parameter_count) {
        return GM_KEY_DONE;
    }
    const struct gm_shot_parameter *parameter = &press->shot->parameters[chosen];
    return gm_keystroke_order(press, (struct gm_order){.kind = (enum gm_order_kind)key->meaning,
                                                       .amount = key->amount,
                                                       .row = parameter->row,
                                                       .of_scheme = parameter->of_scheme});
}

/* Moves around a picture in space with shift and the arrows; elsewhere changes a parameter finely. */
static enum gm_key_result order_look(const struct gm_keystroke *press, const struct gm_key_code *key)
{
    enum { DEGREES = 5 };
    const bool across = key->meaning == GM_ORDER_NUDGE;
    if (press->shot->in_space) {
        return gm_keystroke_order(press, (struct gm_order){.kind = GM_ORDER_LOOK,
                                                           .x = across ? DEGREES * key->amount : 0,
                                                           .y = across ? 0 : DEGREES * key->amount,
                                                           .value = 1});
    }
    return across ? order_parameter(press, key) : GM_KEY_DONE;
}

static enum gm_key_result order_zoom(const struct gm_keystroke *press, const struct gm_key_code *key)
{
    return gm_keystroke_order(
        press, (struct gm_order){.kind = GM_ORDER_LOOK, .value = key->amount > 0 ? 1.25 : 1 / 1.25});
}

/* ---- the screen ---- */

static enum gm_key_result open_prompt(const struct gm_keystroke *press, const struct gm_key_code *key)
{
    return gm_prompt_open(press, (enum gm_prompt)key->meaning);
}

static enum gm_key_result choose_parameter(const struct gm_keystroke *press, const struct gm_key_code *key)
{
    size_t count = press->shot->parameter_count;
    if (count > 0) {
        press->face->parameter = (press->face->parameter + (key->amount < 0 ? count - 1 : 1)) % count;
    }
    press->face->explaining = true;
    return GM_KEY_DONE;
}

static enum gm_key_result next_side(const struct gm_keystroke *press, const struct gm_key_code *key)
{
    press->face->side = (enum gm_side_panel)((press->face->side + key->amount) % GM_SIDE_COUNT);
    return GM_KEY_DONE;
}

static enum gm_key_result next_theme(const struct gm_keystroke *press, const struct gm_key_code *key)
{
    struct gm_face *face = press->face;
    (void)key;
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

static enum gm_key_result open_page(const struct gm_keystroke *press, const struct gm_key_code *key)
{
    const struct gm_shot *shot = press->shot;
    return gm_keystroke_page(press, (enum gm_page)key->meaning, shot->lanes[shot->selected].scheme);
}

const struct gm_key_row gm_key_rows[] = {
#define GM_KEYS(label, hint, rank, text, press, ...) {{__VA_ARGS__}, label, hint, rank, text, press},
#include "app/explorer/view/keys.def"
#undef GM_KEYS
};
const size_t gm_key_row_count = GM_COUNT(gm_key_rows);

enum gm_key_result gm_key_press(const struct gm_keystroke *press)
{
    press->face->explaining = false;
    for (size_t i = 0; i < gm_key_row_count; i++) {
        for (size_t k = 0; k < GM_KEY_CODES && gm_key_rows[i].keys[k].code; k++) {
            const struct gm_key_row *row = &gm_key_rows[i];
            if (row->keys[k].code == press->key) {
                return row->press(press, &row->keys[k]);
            }
        }
    }
    return GM_KEY_UNKNOWN;
}
