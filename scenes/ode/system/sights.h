/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The sights of a user-defined system. */
#ifndef GM_SCENES_ODE_SYSTEM_SIGHTS_H
#define GM_SCENES_ODE_SYSTEM_SIGHTS_H

#include "scenes/common/system/look.h"

/* Makes the sights, the section and the words of show=, with space for one more; false when out of memory. */
bool gm_system_make_sights(struct gm_system_scene *system_scene);
void gm_system_close_sight(struct gm_sight *sight);

/* Opens the surfaces that the file names; false with a sentence if they are too many. */
bool gm_system_open_surfaces(struct gm_system_scene *system_scene, char *sentence);

#endif
