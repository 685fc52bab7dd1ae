/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_VIEW_SCENE_H
#define GM_APP_EXPLORER_VIEW_SCENE_H

#include "app/explorer/surface/screen.h"

/* The screen while a scene is open: the picture at the left, the side panel at the right, a status line
   below; or a page, or a study. */

/* `fresh` says that the shot's picture is a new one. */
void gm_screen_draw_scene(struct gm_screen *screen, struct gm_face *face, const struct gm_shot *shot,
                          bool fresh);

#endif
