/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_SURFACE_KEYSTROKE_H
#define GM_APP_EXPLORER_SURFACE_KEYSTROKE_H

#include "app/explorer/surface/face.h"
#include "app/explorer/worker/worker.h"

/* A key that is pressed while a scene is open: what it acts on, and what came of it. */

enum gm_key_result {
    GM_KEY_DONE,    /* all that it does */
    GM_KEY_BLOCKS,  /* another way to show pictures is wanted */
    GM_KEY_REPAINT, /* everything is to be written again */
    GM_KEY_THEME,   /* the same, in other colours */
    GM_KEY_SCENES,  /* to the list of scenes */
    GM_KEY_STUDY,   /* a diagram in the background, by the key */
    GM_KEY_MAP,     /* a map of many runs is asked for */
    GM_KEY_TOUR,    /* another step of a tour, by the key */
    GM_KEY_TYPED,   /* a system of one's own; from the list of schemes a scheme */
    GM_KEY_FILE,    /* the system of one's own to a file */
    GM_KEY_COPY,    /* the chosen command line to the clipboard */
    GM_KEY_LEAVE,
};

/* A key, and what it acts on. */
struct gm_keystroke {
    int key; /* as ncurses numbers it */
    struct gm_face *face;
    const struct gm_shot *shot;
    struct gm_worker *worker;
};

/* Which keys mean the same everywhere. */
enum { GM_KEY_REDRAW = 'L' - '@' };
bool gm_key_is_enter(int key);
bool gm_key_is_erase(int key);
bool gm_key_is_escape(int key);

/* Adds what was typed to a line of GM_TYPED bytes, or takes the last letter away; false for other keys. */
bool gm_typed_key(char *typed, int key);

/* Sends an order. */
enum gm_key_result gm_keystroke_order(const struct gm_keystroke *press, struct gm_order order);
/* Opens a page, one about a scheme. */
enum gm_key_result gm_keystroke_page(const struct gm_keystroke *press, enum gm_page page,
                                     const struct gm_scheme *scheme);

#endif
