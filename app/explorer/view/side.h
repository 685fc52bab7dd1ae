/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_VIEW_SIDE_H
#define GM_APP_EXPLORER_VIEW_SIDE_H

#include "app/explorer/surface/sheet.h"
#include "app/runs/shot.h"

/* The side panel: schemes, parameters with their sliders, what is observed. */

void gm_side_draw(const struct gm_sheet *sheet, const struct gm_shot *shot);

#endif
