/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_VIEW_CHOOSER_H
#define GM_APP_EXPLORER_VIEW_CHOOSER_H

#include "app/explorer/view/press.h"
#include "app/explorer/view/sheet.h"

/* The list of the schemes that fit: one is chosen for a switch or a fork. */

enum gm_key_result gm_chooser_open(const struct gm_press *press, enum gm_choosing choosing);
/* A key while it is open. */
enum gm_key_result gm_chooser_press(const struct gm_press *press);
void gm_chooser_draw(const struct gm_sheet *sheet, const struct gm_shot *shot);

#endif
