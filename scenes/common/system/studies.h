/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The figures and studies of a system's scene: from its file, or suited to its frequencies. */
#ifndef GM_SCENES_COMMON_SYSTEM_STUDIES_H
#define GM_SCENES_COMMON_SYSTEM_STUDIES_H

#include "scenes/common/system/look.h"

/* Makes figures, work and stability of a scene that has rows, observables and schemes. `radian` is 1 / the
   largest frequency at the start, the unit of steps unless the file names another; NULL: a field, which has a
   map of stability if its file does, and whose work is set. */
void gm_system_make_studies(struct gm_system_scene *system_scene, const struct gm_problem *problem,
                            double (*radian)(const void *parameters));

#endif
