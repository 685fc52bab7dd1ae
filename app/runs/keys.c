/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The names of keys, and the orders that they give. */
#include <curses.h>
#include <string.h>
#include <strings.h>

#include "app/runs/session.h"
#include "core/basics.h"

/* The words of scripts and, below them, the other labels of hints. */
static const struct {
    const char *name;
    int key;
} named[] = {{"ENTER", '\n'},     {"ESC", GM_KEY_ESCAPE}, {"TAB", '\t'},
             {"SPACE", ' '},      {"UP", KEY_UP},         {"DOWN", KEY_DOWN},
             {"LEFT", KEY_LEFT},  {"RIGHT", KEY_RIGHT},   {"BACKSPACE", KEY_BACKSPACE},
             {"PGUP", KEY_PPAGE}, {"PGDN", KEY_NPAGE},    {"HOME", KEY_HOME},
             {"END", KEY_END},    {"F1", KEY_F(1)},       {"CTRL-U", 'U' - '@'},
             {"↑", KEY_UP},       {"↓", KEY_DOWN},        {"←", KEY_LEFT},
             {"→", KEY_RIGHT},    {"⌫", KEY_BACKSPACE}};

int gm_key_named(const char *word, size_t length)
{
    for (size_t i = 0; length > 0 && i < GM_COUNT(named); i++) {
        if (strlen(named[i].name) == length && strncasecmp(word, named[i].name, length) == 0) {
            return named[i].key;
        }
    }
    return length == 1 ? word[0] : 0;
}

const char *gm_key_name(size_t index)
{
    return index < GM_COUNT(named) && (unsigned char)named[index].name[0] < 0x80 ? named[index].name : NULL;
}

bool gm_key_order(int key, struct gm_order *order)
{
    static const struct {
        int key;
        enum gm_order_kind kind;
        int amount;
    } rows[] = {
#define GM_KEYS(...)
#define GM_ORDER_KEYS(label, hint, rank, text, ...) __VA_ARGS__,
#include "app/runs/keys.def"
#undef GM_ORDER_KEYS
#undef GM_KEYS
    };
    for (size_t i = 0; i < GM_COUNT(rows); i++) {
        if (rows[i].key == key) {
            *order = (struct gm_order){.kind = rows[i].kind, .amount = rows[i].amount};
            return true;
        }
    }
    return false;
}
