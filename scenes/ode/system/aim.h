/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_ODE_SYSTEM_AIM_H
#define GM_SCENES_ODE_SYSTEM_AIM_H

#include "scenes/common/system/look.h"

/* Sets the coordinates of a start with which the nearest moving body is at the point (x, y), or as near as
   possible; the momenta stay. Returns how many, at most GM_CHOICES; 0 if no body moves, more coordinates
   would change, or constraints hold them. `start`: the n current components. */
size_t gm_system_aim(const struct gm_system_lane *lane, const double *start, double x, double y,
                     struct gm_choice *choices);

#endif
