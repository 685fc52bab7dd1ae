/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_ODE_SYSTEM_H
#define GM_SCENES_ODE_SYSTEM_H

#include "core/model/system.h"
#include "scenes/common/scene.h"

/* Makes a scene of a system opened by gm_equations_open, and takes it: the scene's end, or a failure here,
   closes it. `name` is the scene's; `words`, NULL-terminated, are its source (gm_scene), NULL: it is a scene
   of the program; `typed`: its values were given with its formula, so none is a default. On failure returns
   NULL with a sentence, and a fault if a word of a choice is wrong. */
const struct gm_scene *gm_system_scene_open(struct gm_user_system *system, const char *name,
                                            const char *const *words, bool typed, struct gm_fault *fault,
                                            char *sentence);

#endif
