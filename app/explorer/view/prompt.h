/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_VIEW_PROMPT_H
#define GM_APP_EXPLORER_VIEW_PROMPT_H

#include "app/explorer/surface/keystroke.h"

/* A line that is typed: a time to run ahead to, a parameter's value. */

/* Begins it, if there is something to type a value of. */
enum gm_key_result gm_prompt_open(const struct gm_keystroke *press, enum gm_prompt prompt);
/* A key while it is open. */
enum gm_key_result gm_prompt_press(const struct gm_keystroke *press);
/* What it asks, with what was typed; while it is open. */
void gm_prompt_text(const struct gm_face *face, const struct gm_shot *shot, char *text, size_t size);

#endif
