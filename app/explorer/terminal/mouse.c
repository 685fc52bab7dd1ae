/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The mouse, out of the keys that make up its reports. */
#include "app/explorer/terminal/device.h"

#include <stdio.h>

enum { BUTTON = 3, SHIFTS = 4 + 8 + 16, MOVES = 32, WHEEL = 64 };

static bool understand(const char *text, char end, struct gm_mouse_event *event)
{
    int code, column, row;
    if (sscanf(text, "%d;%d;%d", &code, &column, &row) != 3 || column < 1 || row < 1) {
        return false;
    }
    code &= ~SHIFTS;
    event->column = column - 1;
    event->row = row - 1;
    if (code == WHEEL || code == WHEEL + 1) {
        event->kind = code == WHEEL ? GM_MOUSE_UP : GM_MOUSE_DOWN;
        return end == 'M';
    }
    if ((code & ~MOVES & ~BUTTON) != 0 || (code & BUTTON) != 0) {
        return false; /* of the buttons only the left one counts */
    }
    event->kind = end == 'm' ? GM_MOUSE_RELEASE : code & MOVES ? GM_MOUSE_DRAG : GM_MOUSE_PRESS;
    return true;
}

enum gm_mouse_result gm_mouse_feed(struct gm_mouse *mouse, int key, struct gm_mouse_event *event)
{
    if (key == GM_KEY_MOUSE) {
        mouse->reading = true;
        mouse->length = 0;
        return GM_MOUSE_PART;
    }
    if (!mouse->reading) {
        return GM_MOUSE_NOT;
    }
    if (key == 'M' || key == 'm') {
        mouse->reading = false;
        mouse->text[mouse->length] = '\0';
        return understand(mouse->text, (char)key, event) ? GM_MOUSE_EVENT : GM_MOUSE_PART;
    }
    if (mouse->length + 1 == sizeof mouse->text || !((key >= '0' && key <= '9') || key == ';')) {
        mouse->reading = false;
        return GM_MOUSE_NOT;
    }
    mouse->text[mouse->length++] = (char)key;
    return GM_MOUSE_PART;
}
