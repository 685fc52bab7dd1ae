/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_ODE_SYSTEM_AIM_H
#define GM_SCENES_ODE_SYSTEM_AIM_H

#include "scenes/ode/system/look.h"

/* The places of a start with which the moving body that is nearest to the point (x, y) stands there, or as near as
   it comes; the momenta stay. At most GM_CHOICES; 0: there is no such body, more of them would change, or they are
   held by constraints. `start`: the n components now. */
size_t gm_system_aim(const struct gm_system_lane *lane, const double *start, double x, double y,
                     struct gm_choice *choices);

#endif
