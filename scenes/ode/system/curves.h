/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Quantities of a user-defined system over time: show=t:NAME+NAME, and the views whose first axis is the time. */
#ifndef GM_SCENES_ODE_SYSTEM_CURVES_H
#define GM_SCENES_ODE_SYSTEM_CURVES_H

#include "scenes/common/graph.h"
#include "scenes/common/system/look.h"

/* Returns true if the text is one of the words of show=, or t: with names of one of the file's systems; else false
   with a sentence. The row's `admitting` is the first of them. */
bool gm_system_admits_show(const struct gm_parameter *row, const char *text, char *sentence);

/* Returns true if the lane's own system has the names that the lane shows over time; else false with a sentence. */
bool gm_system_can_show(const struct gm_system_lane *lane, char *sentence);

/* Returns the sight that a lane shows, in the picture's memory if it is of names over time; NULL when out of
   memory. */
const struct gm_sight *gm_system_curves(struct gm_picture *picture, const struct gm_lane *lane);

/* Draws the current lane of a walk, whose sight is over time, into a panel whose axes are set; `now` are the
   numbers of the sight now. */
void gm_system_draw_curves(struct gm_picture *picture, struct gm_panel *panel, const struct gm_walk *walk,
                           const struct gm_paths *paths, const double *now);

#endif
