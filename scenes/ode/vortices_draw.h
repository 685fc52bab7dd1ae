/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_ODE_VORTICES_DRAW_H
#define GM_SCENES_ODE_VORTICES_DRAW_H

#include "scenes/ode/vortices_start.h"

/* The pictures of scenes/ode/vortices.c. */

/* tracks: radii of vortex 1 in the section; positions, x and y in turn, recent ones and all since the
   start */
enum { GM_SECTION, GM_TRAIL, GM_PAST };

void gm_vortices_draw(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture);

#endif
