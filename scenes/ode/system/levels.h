/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The curves F = 0 that a system's file draws into its plane or its section (level:). */
#ifndef GM_SCENES_ODE_SYSTEM_LEVELS_H
#define GM_SCENES_ODE_SYSTEM_LEVELS_H

#include "scenes/ode/system/space.h"

/* Whether the levels hold the two names of their plane, parameters, values at the start and exact solutions alone. False
   with a sentence. */
bool gm_system_check_levels(struct gm_system_scene *system_scene, char *sentence);

/* Whether there are levels in what a sight shows. */
bool gm_system_has_level(const struct gm_system_scene *system_scene, const struct gm_sight *sight);

/* Adds to a lane's range the closed curves around its start; what a wider search finds open adds nothing. */
void gm_system_hold_levels(const struct gm_lane *lane, const struct gm_sight *sight, struct gm_seen *range);

/* Draws the lane's curves into a panel whose axes are set. */
void gm_system_draw_levels(struct gm_picture *picture, struct gm_panel *panel, const struct gm_lane *lane,
                           const struct gm_sight *sight);

/* The text that says what is grey, "; grey: the exact orbit"; "" if nothing is. */
const char *gm_system_level_text(struct gm_picture *picture, const struct gm_lane *const *lanes,
                                 size_t count);

#endif
