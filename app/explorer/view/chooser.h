/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_VIEW_CHOOSER_H
#define GM_APP_EXPLORER_VIEW_CHOOSER_H

#include "app/explorer/surface/keystroke.h"
#include "app/explorer/surface/sheet.h"

/* The list of the schemes that fit: one is chosen for a switch or a fork. */

/* The last one of the list: it stands for a scheme that is to be typed. */
extern const struct gm_scheme gm_chooser_user;

enum gm_key_result gm_chooser_open(const struct gm_keystroke *press, enum gm_choosing choosing);
/* A key while it is open. */
enum gm_key_result gm_chooser_press(const struct gm_keystroke *press);
void gm_chooser_draw(const struct gm_sheet *sheet, const struct gm_shot *shot);

#endif
