/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_KEYS_H
#define GM_APP_EXPLORER_KEYS_H

#include "app/explorer/screen.h"
#include "app/explorer/worker.h"

enum gm_key_result {
    GM_KEY_IGNORED,
    GM_KEY_FACE,    /* the screen itself changed */
    GM_KEY_ORDER,   /* an order went to the worker */
    GM_KEY_BLOCKS,  /* another way to show pictures is wanted */
    GM_KEY_REPAINT, /* everything is to be written again */
    GM_KEY_LEAVE,
};

/* What a key does while a scene is open. */
enum gm_key_result gm_key_press(int key, struct gm_face *face, const struct gm_shot *shot,
                                struct gm_worker *worker);

#endif
