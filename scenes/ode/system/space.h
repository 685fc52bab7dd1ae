/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_ODE_SYSTEM_SPACE_H
#define GM_SCENES_ODE_SYSTEM_SPACE_H

#include "scenes/common/space.h"
#include "scenes/ode/system/look.h"

/* A system of somebody's own in space: its bodies, rods and surfaces as they are seen from the lane's camera. */

/* What has been seen of a sight up to now. */
struct gm_seen {
    double low[3], high[3]; /* of each coordinate; low > high: nothing */
    double far;             /* the largest distance from the origin */
    bool left;              /* it has a scale of its own */
};

/* Sets the panel's axes and draws what stands still: surfaces with the axes through them, or else the box of what
   is seen. */
struct gm_space gm_system_space(struct gm_picture *picture, struct gm_panel *panel,
                                const struct gm_lane *lane, const struct gm_seen *seen,
                                const char *const names[3]);
/* Draws the lane in that space, behind and before the surfaces that are its own. */
void gm_system_draw_in_space(struct gm_picture *picture, struct gm_panel *panel, struct gm_space *space,
                             const struct gm_lane *lane, const struct gm_paths *paths);

#endif
