/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_VIEW_MODES_H
#define GM_APP_EXPLORER_VIEW_MODES_H

#include "app/explorer/view/keys.h"

/* What takes the keys for a while: a page, the list of schemes, a line that is typed. */

enum gm_key_result gm_chooser_open(const struct gm_press *press, enum gm_choosing choosing);
enum gm_key_result gm_prompt_open(const struct gm_press *press, enum gm_prompt prompt);
/* The page of one scheme. */
enum gm_key_result gm_page_open_scheme(const struct gm_press *press, const struct gm_scheme *scheme);

/* A key while a page is open: scrolls it, or closes it. */
enum gm_key_result gm_page_press(int key, struct gm_face *face);

/* Whether the key belongs to one of them; then what it did. */
bool gm_mode_press(const struct gm_press *press, enum gm_key_result *result);

/* Adds what was typed to a line of GM_TYPED bytes, or takes the last letter away; false for other keys. */
bool gm_typed_key(char *typed, int key);

#endif
