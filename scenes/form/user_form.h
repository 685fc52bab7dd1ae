/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_FORM_USER_FORM_H
#define GM_SCENES_FORM_USER_FORM_H

#include "core/model/system.h"
#include "scenes/common/scene.h"

/* Returns a scene of a system of forms, and takes the system, as gm_system_scene_open (scenes/ode/system.h) does
   for motions. */
const struct gm_scene *gm_form_scene_open(struct gm_user_system *system, const char *name,
                                          const char *const *words, struct gm_fault *fault, char *sentence);

#endif
