/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "scenes/common/system/hook.h"

#include <string.h>

#include "core/basics.h"

#define GM_HOOK(name) extern const struct gm_hook gm_hook_##name;
#include "scenes/common/system/hooks.def"
#undef GM_HOOK

void gm_system_find_hook(struct gm_system_scene *system_scene)
{
    static const struct gm_hook *const hooks[] = {
#define GM_HOOK(name) &gm_hook_##name,
#include "scenes/common/system/hooks.def"
#undef GM_HOOK
    };
    const char *name = system_scene->system.texts[GM_WORD_HOOK];
    for (size_t i = 0; name && i < GM_COUNT(hooks); i++) {
        system_scene->hook = strcmp(hooks[i]->name, name) == 0 ? hooks[i] : system_scene->hook;
    }
    const struct gm_hook *hook = system_scene->hook;
    if (name && !hook) {
        gm_arena_refuse(system_scene->arena, "hook: there is no hook \"%.60s\"", name);
    }
    if (hook && !hook->suits(&system_scene->system)) {
        gm_arena_refuse(system_scene->arena, "the hook \"%s\" is for %s", hook->name, hook->needs);
    }
}
