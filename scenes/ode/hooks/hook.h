/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Code of the program beyond the formulas of a system's file, which names it: hook: NAME. */
#ifndef GM_SCENES_ODE_HOOKS_HOOK_H
#define GM_SCENES_ODE_HOOKS_HOOK_H

#include "core/model/system.h"
#include "scenes/common/scene.h"

struct gm_hook {
    const char *name, *needs; /* the systems that it suits: "three components" */
    bool (*suits)(const struct gm_user_system *system);
    size_t members; /* members of every lane; the first is observed */
    /* Moves the members, which all start at one point; y[component * members + member]. */
    void (*place)(double *y);
    const struct gm_observable *observables;
    size_t observable_count;
};

#define GM_HOOK(name) extern const struct gm_hook gm_hook_##name;
#include "scenes/ode/hooks/hooks.def"
#undef GM_HOOK

#endif
