/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_VIEW_KEYS_H
#define GM_APP_EXPLORER_VIEW_KEYS_H

#include "app/explorer/surface/keystroke.h"

/* The keys while a scene is open, and nothing else takes them: one table. */

enum { GM_KEY_CODES = 4 };

/* A key of a row, and what the row's function takes it for: an order, a list, a prompt or a page, and which way. */
struct gm_key_code {
    int code, meaning, amount;
};

/* Everything there is to say of a key while a scene is open: the help, the hints in the status line and what
   the key does come from this one row. */
struct gm_key_row {
    struct gm_key_code keys[GM_KEY_CODES]; /* the code 0 ends them */
    const char *label;                     /* as the help writes them */
    const char *hint;                      /* a word for the status line; NULL: none */
    int rank;                              /* of the hint: the smallest comes first */
    const char *text;                      /* for the help; NULL: another row says it */
    enum gm_key_result (*press)(const struct gm_keystroke *press, const struct gm_key_code *key);
};
extern const struct gm_key_row gm_key_rows[];
extern const size_t gm_key_row_count;

/* What a key does while a scene is open. */
enum gm_key_result gm_key_press(const struct gm_keystroke *press);

#endif
