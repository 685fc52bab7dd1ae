/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The figures and studies of a system's scene: as its file says, or as its frequencies suggest. */
#ifndef GM_SCENES_ODE_SYSTEM_STUDIES_H
#define GM_SCENES_ODE_SYSTEM_STUDIES_H

#include "scenes/ode/system/look.h"

/* Makes figures, work and stability of a scene whose rows, observables and schemes are there. `radian` is 1 / the largest
   frequency at the start, the unit of steps where the file names no other. False with a sentence. */
bool gm_system_make_studies(struct gm_system_scene *system_scene, const struct gm_problem *problem,
                            double (*radian)(const void *parameters), char *sentence);

#endif
