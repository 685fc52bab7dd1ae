/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_ODE_SYSTEM_H
#define GM_SCENES_ODE_SYSTEM_H

#include "core/model/system.h"
#include "scenes/common/scene.h"

/* Makes a scene of a system that was opened by gm_equations_open, and takes it: it is closed with the scene,
   or here where there is none. `name` is the scene's; `words`, NULL-terminated, what it was made of
   (gm_scene), or NULL: it is a scene of the program; `typed`: its values were given with its formula, so none is a default. NULL with a sentence, and a fault where one
   of its choices' words is what has it. */
const struct gm_scene *gm_system_scene_open(struct gm_user_system *system, const char *name,
                                            const char *const *words, bool typed, struct gm_fault *fault,
                                            char *sentence);
void gm_system_scene_close(const struct gm_scene *scene);

#endif
