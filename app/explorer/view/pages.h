/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_VIEW_PAGES_H
#define GM_APP_EXPLORER_VIEW_PAGES_H

#include "app/explorer/surface/keystroke.h"
#include "app/explorer/surface/screen.h"

/* Pages that explain: the scene with the keys and claims, a scheme, the command lines, the list of scenes. */

/* A key while a page is open: scrolls it, or closes it. */
enum gm_key_result gm_pages_press(int key, struct gm_face *face);
/* The open page, with its keys in the last row; the shot may be NULL for GM_PAGE_START. */
void gm_screen_draw_page(const struct gm_sheet *whole, struct gm_face *face, const struct gm_shot *shot);

#endif
