/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Code of the program for what the formulas of a system's file cannot say. The file names it: hook: NAME. */
#ifndef GM_SCENES_ODE_HOOKS_HOOK_H
#define GM_SCENES_ODE_HOOKS_HOOK_H

#include "core/model/system.h"
#include "scenes/common/scene.h"

struct gm_hook {
    const char *name, *needs; /* "three components", of the systems that it suits */
    bool (*suits)(const struct gm_user_system *system);
    size_t members; /* of every lane; the first is the one that is looked at */
    /* Moves the members, which all start at one point; y[component * members + member]. */
    void (*place)(double *y);
    const struct gm_observable *observables;
    size_t observable_count;
};

#define GM_HOOK(name) extern const struct gm_hook gm_hook_##name;
#include "scenes/ode/hooks/hooks.def"
#undef GM_HOOK

#endif
