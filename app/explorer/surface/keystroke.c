/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What all keys have in common. */
#include "app/explorer/surface/keystroke.h"

#include <curses.h>
#include <string.h>

enum { ESCAPE = 27 };

bool gm_key_is_enter(int key)
{
    return key == '\n' || key == '\r' || key == KEY_ENTER;
}

bool gm_key_is_erase(int key)
{
    return key == KEY_BACKSPACE || key == 127 || key == 8;
}

bool gm_key_is_escape(int key)
{
    return key == ESCAPE;
}

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

enum gm_key_result gm_keystroke_order(const struct gm_keystroke *press, struct gm_order order)
{
    gm_worker_order(press->worker, order);
    return GM_KEY_DONE;
}

enum gm_key_result gm_keystroke_page(const struct gm_keystroke *press, enum gm_page page,
                                     const struct gm_scheme *scheme)
{
    press->face->page = page;
    press->face->explained = scheme;
    press->face->scroll = 0;
    return GM_KEY_DONE;
}
