/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What takes the keys for a while: pages, the list of schemes, the typed line. */
#include "app/explorer/view/modes.h"

#include <curses.h>
#include <stdio.h>
#include <string.h>

enum { PAGE = 10 };

bool gm_typed_key(char *typed, int key)
{
    size_t length = strlen(typed);
    if (gm_key_is_erase(key)) {
        typed[length > 0 ? length - 1 : 0] = '\0';
        return true;
    }
    if (key < ' ' || key > '~' || length + 1 >= GM_TYPED) {
        return key >= ' ' && key <= '~';
    }
    typed[length] = (char)key;
    typed[length + 1] = '\0';
    return true;
}

/* ---- pages ---- */

enum gm_key_result gm_page_open_scheme(const struct gm_press *press, const struct gm_scheme *scheme)
{
    press->face->page = GM_PAGE_SCHEME;
    press->face->explained = scheme;
    press->face->scroll = 0;
    return GM_KEY_FACE;
}

enum gm_key_result gm_page_press(int key, struct gm_face *face)
{
    switch (key) {
    case 'q':
        return GM_KEY_LEAVE;
    case KEY_UP:
        face->scroll--;
        return GM_KEY_FACE;
    case KEY_DOWN:
        face->scroll++;
        return GM_KEY_FACE;
    case KEY_PPAGE:
        face->scroll -= PAGE;
        return GM_KEY_FACE;
    case KEY_NPAGE:
    case ' ':
        face->scroll += PAGE;
        return GM_KEY_FACE;
    case 'y':
        if (face->page == GM_PAGE_COMMAND) {
            face->command = (face->command + 1) % GM_COMMANDS;
            return GM_KEY_COPY;
        }
        break;
    default:
        break;
    }
    face->page = GM_PAGE_SCENE;
    return GM_KEY_FACE;
}

/* ---- the list of schemes ---- */

/* The first scheme after the selected lane's that no lane has. */
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
    return shot->schemes[own];
}

enum gm_key_result gm_chooser_open(const struct gm_press *press, enum gm_choosing choosing)
{
    press->face->choosing = choosing;
    press->face->typed[0] = '\0';
    press->face->choice = press->shot->scheme_count > 0 ? first_choice(press->shot) : NULL;
    return GM_KEY_FACE;
}

/* The next listed scheme up or down from the chosen one. */
static void move_choice(struct gm_face *face, const struct gm_shot *shot, int by)
{
    const struct gm_scheme *found[GM_SHOT_SCHEMES];
    size_t count = gm_schemes_found(face, shot, found), at = 0;
    if (count == 0) {
        face->choice = NULL;
        return;
    }
    for (size_t i = 0; i < count; i++) {
        at = found[i] == face->choice ? i : at;
    }
    long next = (long)at + by, last = (long)count - 1;
    if (by == 1 || by == -1) {
        next = (next + (long)count) % (long)count;
    }
    face->choice = found[next < 0 ? 0 : next > last ? last : next];
}

/* What answers best to what was typed; with nothing typed, what was chosen stays so. */
static void choose_best(struct gm_face *face, const struct gm_shot *shot)
{
    const struct gm_scheme *found[GM_SHOT_SCHEMES];
    const size_t count = gm_schemes_found(face, shot, found);
    if (face->typed[0] || !face->choice) {
        face->choice = count > 0 ? found[0] : NULL;
    }
}

static enum gm_key_result press_in_chooser(const struct gm_press *press)
{
    struct gm_face *face = press->face;
    if (gm_key_is_escape(press->key) || (gm_key_is_erase(press->key) && !face->typed[0])) {
        face->choosing = GM_CHOOSE_NOTHING;
        return GM_KEY_FACE;
    }
    if (gm_key_is_enter(press->key)) {
        if (!face->choice) {
            return GM_KEY_FACE;
        }
        enum gm_order_kind kind = face->choosing == GM_CHOOSE_FORK ? GM_ORDER_FORK : GM_ORDER_SWITCH;
        face->choosing = GM_CHOOSE_NOTHING;
        return gm_key_order(press, (struct gm_order){.kind = kind, .scheme = face->choice});
    }
    switch (press->key) {
    case KEY_UP:
    case KEY_BTAB:
        move_choice(face, press->shot, -1);
        return GM_KEY_FACE;
    case KEY_DOWN:
    case '\t':
        move_choice(face, press->shot, 1);
        return GM_KEY_FACE;
    case KEY_PPAGE:
        move_choice(face, press->shot, -PAGE);
        return GM_KEY_FACE;
    case KEY_NPAGE:
        move_choice(face, press->shot, PAGE);
        return GM_KEY_FACE;
    case '?':
        return face->choice ? gm_page_open_scheme(press, face->choice) : GM_KEY_FACE;
    default:
        if (gm_typed_key(face->typed, press->key)) {
            choose_best(face, press->shot);
        }
        return GM_KEY_FACE;
    }
}

/* ---- a line that is typed ---- */

enum gm_key_result gm_prompt_open(const struct gm_press *press, enum gm_prompt prompt)
{
    struct gm_face *face = press->face;
    if (prompt == GM_PROMPT_VALUE && face->parameter >= press->shot->parameter_count) {
        return GM_KEY_FACE;
    }
    face->prompt = prompt;
    face->typed[0] = '\0';
    return GM_KEY_FACE;
}

static enum gm_key_result press_in_prompt(const struct gm_press *press)
{
    struct gm_face *face = press->face;
    if (gm_key_is_escape(press->key)) {
        face->prompt = GM_PROMPT_NONE;
        return GM_KEY_FACE;
    }
    if (!gm_key_is_enter(press->key)) {
        gm_typed_key(face->typed, press->key);
        return GM_KEY_FACE;
    }
    enum gm_prompt prompt = face->prompt;
    face->prompt = GM_PROMPT_NONE;
    if (!face->typed[0] && prompt == GM_PROMPT_VALUE) {
        return GM_KEY_FACE;
    }
    struct gm_order order = {.kind = prompt == GM_PROMPT_AHEAD ? GM_ORDER_AHEAD : GM_ORDER_TYPE};
    if (face->typed[0]) {
        snprintf(order.text, sizeof order.text, "%s", face->typed);
    } else {
        gm_ahead_text(press->shot, order.text, sizeof order.text);
    }
    if (prompt == GM_PROMPT_VALUE) {
        order.row = press->shot->parameters[face->parameter].row;
        order.of_scheme = press->shot->parameters[face->parameter].of_scheme;
    }
    return gm_key_order(press, order);
}

/* While the worker runs ahead any key stops it. */
static bool stops_running(const struct gm_press *press, enum gm_key_result *result)
{
    if (!press->shot->running_ahead || press->key == 'q') {
        return false;
    }
    *result = gm_key_order(press, (struct gm_order){.kind = GM_ORDER_HALT});
    return true;
}

bool gm_mode_press(const struct gm_press *press, enum gm_key_result *result)
{
    struct gm_face *face = press->face;
    if (stops_running(press, result)) {
        return true;
    }
    if (face->page != GM_PAGE_SCENE) {
        *result = gm_page_press(press->key, face);
        return true;
    }
    if (face->choosing != GM_CHOOSE_NOTHING) {
        *result = press_in_chooser(press);
        return true;
    }
    if (face->prompt != GM_PROMPT_NONE) {
        *result = press_in_prompt(press);
        return true;
    }
    return false;
}
