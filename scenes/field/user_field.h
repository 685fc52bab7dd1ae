/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_FIELD_USER_FIELD_H
#define GM_SCENES_FIELD_USER_FIELD_H

#include "core/model/system.h"
#include "scenes/common/scene.h"

/* Returns a scene of a system that is a field, and takes the system, as gm_system_scene_open
   (scenes/ode/system.h) does for all others. If `elsewhere`, a wave equation is on a moving mesh, and an equation
   that is recognised by its rates has the state of the schemes for it. */
const struct gm_scene *gm_user_field_open(struct gm_user_system *system, const char *name,
                                          const char *const *words, bool elsewhere, struct gm_fault *fault,
                                          char *sentence);
/* Returns how many of these schemes, separated by blanks or commas, or NULL, need that `elsewhere`; *others: the
   number of the rest. */
size_t gm_user_field_elsewhere(const struct gm_user_system *system, const char *schemes, size_t *others);

#endif
