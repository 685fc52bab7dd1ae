/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Code of the program beyond the formulas of a system's file, which names it: hook: NAME. */
#ifndef GM_SCENES_COMMON_SYSTEM_HOOK_H
#define GM_SCENES_COMMON_SYSTEM_HOOK_H

#include "scenes/common/system/look.h"

struct gm_hook {
    const char *name, *needs; /* the systems that it suits: "three components" */
    bool (*suits)(const struct gm_user_system *system);
    size_t members; /* members of every lane of a motion; the first is observed */
    /* Moves the members, which all start at one point; y[component * members + member]. */
    void (*place)(double *y);
    bool on_moving_mesh; /* of a field: it observes waves on a moving mesh, else those on a ring */
    /* They supplement those of a motion and of a moving mesh, and replace those of waves on a ring. */
    const struct gm_observable *observables;
    size_t observable_count;
};

/* Finds the hook that the file names, if it does. Refuses one that is unknown, or suits other systems. */
void gm_system_find_hook(struct gm_system_scene *system_scene);

#endif
