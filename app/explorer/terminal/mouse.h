/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_TERMINAL_MOUSE_H
#define GM_APP_EXPLORER_TERMINAL_MOUSE_H

#include <stdbool.h>
#include <stddef.h>

/* The mouse, as terminals report it (SGR, xterm's modes 1002 and 1006): read here rather than by ncurses,
   whose terminfo entries still name the older form, which ends at column 223 and knows no dragging. */

#define GM_MOUSE_ON "\033[?1002h\033[?1006h"
#define GM_MOUSE_OFF "\033[?1006l\033[?1002l"
#define GM_MOUSE_FRONT "\033[<" /* what every report begins with */

enum { GM_KEY_MOUSE = 01200 }; /* the number that ncurses gives to that */

enum gm_mouse_kind { GM_MOUSE_PRESS, GM_MOUSE_DRAG, GM_MOUSE_RELEASE, GM_MOUSE_UP, GM_MOUSE_DOWN };

struct gm_mouse_event {
    enum gm_mouse_kind kind; /* of the left button, or the wheel */
    int column, row;         /* from 0 */
};

struct gm_mouse {
    bool reading;
    char text[24];
    size_t length;
};

enum gm_mouse_result { GM_MOUSE_NOT, GM_MOUSE_PART, GM_MOUSE_EVENT };

/* Takes a key; those that belong to a report are its own. */
enum gm_mouse_result gm_mouse_feed(struct gm_mouse *mouse, int key, struct gm_mouse_event *event);

#endif
