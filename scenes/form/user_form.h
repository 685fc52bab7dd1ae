/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_FORM_USER_FORM_H
#define GM_SCENES_FORM_USER_FORM_H

#include "core/model/system.h"
#include "scenes/common/scene.h"

/* The source of a system: its name, its words or NULL, and the path of its file or NULL. */
struct gm_form_source {
    const char *name;
    const char *const *words;
    const char *path;
    bool unread; /* out: the file of the mesh could not be read */
};

/* Returns a scene of a system of forms, and takes the system, as gm_system_scene_open (scenes/ode/system.h) does
   for motions. */
const struct gm_scene *gm_form_scene_open(struct gm_user_system *system, struct gm_form_source *source,
                                          struct gm_fault *fault, char *sentence);

#endif
