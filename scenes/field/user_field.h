/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_FIELD_USER_FIELD_H
#define GM_SCENES_FIELD_USER_FIELD_H

#include "core/model/system.h"
#include "scenes/common/scene.h"

/* Makes a scene of a system that is a field, and takes it: as gm_system_scene_open (scenes/ode/system.h) does
   of all others. A wave equation is on a moving mesh where that is said. */
const struct gm_scene *gm_user_field_open(struct gm_user_system *system, const char *name,
                                          const char *const *words, bool moves, char *sentence);
/* How many of these schemes, by blanks or commas, are of moving meshes; NULL: none. Of what is left: *others. */
size_t gm_user_field_moving(const char *schemes, size_t *others);
void gm_user_field_close(const struct gm_scene *scene);

#endif
