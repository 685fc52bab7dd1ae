/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a key does on the main screen, and what has to happen because of it. */
#ifndef GM_APP_EXPLORER_VIEW_KEYS_H
#define GM_APP_EXPLORER_VIEW_KEYS_H

#include "app/explorer/view/screen.h"
#include "app/explorer/worker/worker.h"

enum gm_key_result {
    GM_KEY_IGNORED,
    GM_KEY_FACE,    /* the screen itself changed */
    GM_KEY_ORDER,   /* an order went to the worker */
    GM_KEY_BLOCKS,  /* another way to show pictures is wanted */
    GM_KEY_REPAINT, /* everything is to be written again */
    GM_KEY_THEME,   /* the same, in other colours */
    GM_KEY_SCENES,  /* to the list of scenes */
    GM_KEY_STUDY,   /* a diagram in the background, by the key */
    GM_KEY_TOUR,    /* another step of a tour, by the key */
    GM_KEY_COPY,    /* the chosen command line to the clipboard */
    GM_KEY_LEAVE,
};

/* A key, and what it acts on. */
struct gm_press {
    int key; /* as ncurses numbers it */
    struct gm_face *face;
    const struct gm_shot *shot;
    struct gm_worker *worker;
};

enum { GM_KEY_CODES = 4 };

/* Everything there is to say of a key while a scene is open: the help, the hints in the status line and what
   the key does come from this one row. */
struct gm_key_row {
    int codes[GM_KEY_CODES]; /* the keys; 0 ends them */
    const char *label;       /* as the help writes them */
    const char *hint;        /* a word for the status line; NULL: none */
    int rank;                /* of the hint: the smallest comes first */
    const char *text;        /* for the help; NULL: another row says it */
    enum gm_key_result (*press)(const struct gm_press *press);
};
extern const struct gm_key_row gm_key_rows[];
extern const size_t gm_key_row_count;

/* What a key does while a scene is open. */
enum gm_key_result gm_key_press(const struct gm_press *press);

/* Sends an order; for rows of other files. */
enum gm_key_result gm_key_order(const struct gm_press *press, struct gm_order order);

/* Which keys mean the same everywhere. */
bool gm_key_is_enter(int key);
bool gm_key_is_erase(int key);
bool gm_key_is_escape(int key);

#endif
