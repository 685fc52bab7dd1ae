/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Members on the edge of a disc, drawn as its shape in the plane that is shown. */
#ifndef GM_SCENES_ODE_SYSTEM_SHAPES_H
#define GM_SCENES_ODE_SYSTEM_SHAPES_H

#include "scenes/common/system/look.h"

/* Returns true if the members of a lane are a disc in the plane of a sight. */
bool gm_system_is_disc(const struct gm_lane *lane, const struct gm_sight *sight);

/* Draws the shape now and earlier ones; the first in red. The axes are set. */
void gm_system_draw_shapes(struct gm_picture *picture, struct gm_panel *panel, const struct gm_lane *lane);

#endif
