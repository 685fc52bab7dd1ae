/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_ODE_SYSTEM_SPACE_H
#define GM_SCENES_ODE_SYSTEM_SPACE_H

#include "scenes/common/space.h"
#include "scenes/common/system/look.h"

/* A user-defined system in space: its range and surfaces from the lane's camera. */

/* The range of a sight up to now. */
struct gm_seen {
    double low[3], high[3]; /* for each coordinate; low > high: empty */
    double far;             /* the largest distance from the origin */
    bool left;              /* the lane has a scale of its own */
};

/* Sets the panel's axes and draws the parts at rest: surfaces with the axes through them, or else the box of
   the range. */
struct gm_space gm_system_space(struct gm_picture *picture, struct gm_panel *panel,
                                const struct gm_lane *lane, const struct gm_seen *seen,
                                const char *const names[3]);
/* Gives the space the surfaces of a lane. */
void gm_system_take_surfaces(struct gm_picture *picture, const struct gm_lane *lane, struct gm_space *space);

#endif
