/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_VIEW_STATUS_H
#define GM_APP_EXPLORER_VIEW_STATUS_H

#include "app/explorer/surface/screen.h"

/* The last row: what there is to say, to answer or to watch at the left, keys at the right. */

/* Beside a panel of so many columns, which tells the speed; 0: there is none. */
void gm_status_draw(const struct gm_sheet *whole, const struct gm_shot *shot, int side);
/* The speed of the clock, whether it stands, the length of a movie. */
void gm_status_speed(const struct gm_shot *shot, char *text, size_t size);

#endif
