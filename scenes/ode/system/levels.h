/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The curves F = 0 that a system's file draws into its plane or its section (level:). */
#ifndef GM_SCENES_ODE_SYSTEM_LEVELS_H
#define GM_SCENES_ODE_SYSTEM_LEVELS_H

#include "scenes/ode/system/space.h"

/* Refuses levels that contain more than the two names of their plane, parameters, values at the start and
   exact solutions. */
void gm_system_check_levels(struct gm_system_scene *system_scene);

/* Returns true if a sight shows levels. */
bool gm_system_has_level(const struct gm_system_scene *system_scene, const struct gm_sight *sight);

/* Adds the closed curves around a lane's start to its range; an open curve adds nothing. */
void gm_system_hold_levels(const struct gm_lane *lane, const struct gm_sight *sight, struct gm_seen *range);

/* Draws the lines on which a function changes its sign, from its values at the corners of a grid of cells over the
   panel, row by row from the lower left; none beside a value that is not finite. */
void gm_system_draw_zeros(struct gm_picture *picture, struct gm_panel *panel, struct gm_style style,
                          const double *values, const size_t cells[2]);

/* Draws the lane's curves into a panel whose axes are set. */
void gm_system_draw_levels(struct gm_picture *picture, struct gm_panel *panel, const struct gm_lane *lane,
                           const struct gm_sight *sight);

/* Returns the text that explains grey curves, "; grey: the exact orbit"; "" without one. */
const char *gm_system_level_text(struct gm_picture *picture, const struct gm_lane *const *lanes,
                                 size_t count);

#endif
