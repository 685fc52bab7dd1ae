/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The phase portrait of a user-defined system of two components, under its trajectories: portrait=yes, and the
   window of its plane. */
#ifndef GM_SCENES_ODE_SYSTEM_PHASE_H
#define GM_SCENES_ODE_SYSTEM_PHASE_H

#include "core/ode/portrait/portrait.h"
#include "scenes/common/system/look.h"

/* Returns true if a system has a portrait; else false with a sentence. With another word of a choice a file may be
   another system, so this is about a lane's own. */
bool gm_system_is_plane(const struct gm_system_scene *system_scene, char *sentence);

/* Return true if a text is a value of portrait= for the system of the row, or of window=; else false with a
   sentence. */
bool gm_system_admits_portrait(const struct gm_parameter *row, const char *text, char *sentence);
bool gm_system_admits_window(const struct gm_parameter *row, const char *text, char *sentence);

/* Reads the lane's window of a sight's axes. Returns false if it is chosen by the picture. */
bool gm_system_window(const struct gm_system_lane *lane, const struct gm_sight *sight,
                      struct gm_window *window);

/* Returns true if a lane draws its portrait under a sight. */
bool gm_system_has_portrait(const struct gm_system_lane *lane, const struct gm_sight *sight);

/* The portrait in the lane's window, or in the box of its trajectory widened by a quarter: gm_scene, portrait. */
bool gm_system_portrait(const struct gm_lane *lane, struct gm_portrait *portrait);

/* Draws the portrait into a panel whose axes are set. */
void gm_system_draw_portrait(struct gm_picture *picture, struct gm_panel *panel, const struct gm_lane *lane);

#endif
