/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The sights of a user-defined system. */
#ifndef GM_SCENES_ODE_SYSTEM_SIGHTS_H
#define GM_SCENES_ODE_SYSTEM_SIGHTS_H

#include "scenes/common/system/look.h"

/* Makes the sights, the section and the words of show=, with space for one more. */
void gm_system_make_sights(struct gm_system_scene *system_scene);

/* Opens the surfaces that the file names; refuses too many. */
void gm_system_open_surfaces(struct gm_system_scene *system_scene);

#endif
