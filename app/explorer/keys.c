/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "app/explorer/keys.h"

#include <curses.h>

enum { ESCAPE = 27, REDRAW = 'L' - '@', PAGE = 10 };

static bool is_enter(int key)
{
    return key == '\n' || key == '\r' || key == KEY_ENTER;
}

static bool is_erase(int key)
{
    return key == KEY_BACKSPACE || key == 127 || key == 8;
}

static enum gm_key_result press_in_help(int key, struct gm_face *face)
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
    default:
        face->help = false;
        return GM_KEY_FACE;
    }
}

/* The first scheme after the selected lane's that no lane has. */
static size_t first_choice(const struct gm_shot *shot)
{
    size_t own = 0;
    for (size_t i = 0; i < shot->scheme_count; i++) {
        if (shot->schemes[i] == shot->lanes[shot->selected].scheme) {
            own = i;
        }
    }
    for (size_t i = 1; i < shot->scheme_count; i++) {
        size_t at = (own + i) % shot->scheme_count;
        bool used = false;
        for (size_t k = 0; k < shot->lane_count; k++) {
            used = used || shot->lanes[k].scheme == shot->schemes[at];
        }
        if (!used) {
            return at;
        }
    }
    return own;
}

static enum gm_key_result press_in_chooser(int key, struct gm_face *face, const struct gm_shot *shot,
                                           struct gm_worker *worker)
{
    size_t count = shot->scheme_count;
    if (key == 'q') {
        return GM_KEY_LEAVE;
    }
    if (is_enter(key) && face->choice < count) {
        gm_worker_order(worker,
                        (struct gm_order){.kind = GM_ORDER_SWITCH, .scheme = shot->schemes[face->choice]});
        face->choosing = false;
        return GM_KEY_ORDER;
    }
    if ((key == KEY_UP || key == KEY_DOWN || key == 's') && count > 0) {
        face->choice = (face->choice + (key == KEY_UP ? count - 1 : 1)) % count;
    } else if (key == ESCAPE || is_erase(key)) {
        face->choosing = false;
    } else {
        return GM_KEY_IGNORED;
    }
    return GM_KEY_FACE;
}

static enum gm_key_result order(struct gm_worker *worker, enum gm_order_kind kind, int amount)
{
    gm_worker_order(worker, (struct gm_order){.kind = kind, .amount = amount});
    return GM_KEY_ORDER;
}

static enum gm_key_result order_parameter(struct gm_worker *worker, enum gm_order_kind kind, int amount,
                                          struct gm_face *face, const struct gm_shot *shot)
{
    if (face->parameter >= shot->parameter_count) {
        return GM_KEY_IGNORED;
    }
    const struct gm_shot_parameter *parameter = &shot->parameters[face->parameter];
    face->explaining = true;
    gm_worker_order(worker, (struct gm_order){
                                .kind = kind,
                                .amount = amount,
                                .row = parameter->row,
                                .of_scheme = parameter->of_scheme,
                            });
    return GM_KEY_ORDER;
}

static enum gm_key_result choose_parameter(struct gm_face *face, const struct gm_shot *shot, size_t step)
{
    if (shot->parameter_count > 0) {
        face->parameter = (face->parameter + step) % shot->parameter_count;
    }
    face->explaining = true;
    return GM_KEY_FACE;
}

enum gm_key_result gm_key_press(int key, struct gm_face *face, const struct gm_shot *shot,
                                struct gm_worker *worker)
{
    face->read = shot->message_number;
    if (key == REDRAW) {
        return GM_KEY_REPAINT;
    }
    if (face->help) {
        return press_in_help(key, face);
    }
    if (face->choosing) {
        return press_in_chooser(key, face, shot, worker);
    }
    face->explaining = false;
    switch (key) {
    case 'q':
        return GM_KEY_LEAVE;
    case '?':
        face->help = true;
        face->scroll = 0;
        return GM_KEY_FACE;
    case 'b':
        return GM_KEY_BLOCKS;
    case 's':
        face->choosing = true;
        face->choice = first_choice(shot);
        return GM_KEY_FACE;
    case KEY_UP:
        return choose_parameter(face, shot, shot->parameter_count ? shot->parameter_count - 1 : 0);
    case KEY_DOWN:
        return choose_parameter(face, shot, 1);
    case KEY_LEFT:
        return order_parameter(worker, GM_ORDER_MOVE, -1, face, shot);
    case KEY_RIGHT:
        return order_parameter(worker, GM_ORDER_MOVE, 1, face, shot);
    case ' ':
        return order(worker, GM_ORDER_PAUSE, 0);
    case '.':
        return order(worker, GM_ORDER_FORWARD, 0);
    case ',':
        return order(worker, GM_ORDER_BACK, 0);
    case '[':
        return order(worker, GM_ORDER_SPEED, -1);
    case ']':
        return order(worker, GM_ORDER_SPEED, 1);
    case 'r':
        return order(worker, GM_ORDER_RESTART, 0);
    case 'c':
        return order(worker, GM_ORDER_ADD, 0);
    case 'x':
        return order(worker, GM_ORDER_REMOVE, 0);
    case 'p':
        return order(worker, GM_ORDER_SAVE, 0);
    case '\t':
        return order(worker, GM_ORDER_SELECT, 1);
    case KEY_BTAB:
        return order(worker, GM_ORDER_SELECT, -1);
    default:
        if (is_erase(key)) {
            return order_parameter(worker, GM_ORDER_STANDARD, 0, face, shot);
        }
        return GM_KEY_FACE; /* any other key dismisses a message */
    }
}
