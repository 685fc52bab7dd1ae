/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The picture of a user-defined system: the panels for its components, sections and sights. */
#ifndef GM_SCENES_ODE_SYSTEM_DRAW_H
#define GM_SCENES_ODE_SYSTEM_DRAW_H

#include "scenes/common/system/look.h"

void gm_system_draw(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture);

#endif
