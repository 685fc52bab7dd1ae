/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A browser has no compiler, so the interpreter runs user-defined systems. */
#include "app/native/cache.h"

bool gm_compiler_find(char path[GM_CACHE_PATH], struct gm_digest *digest)
{
    (void)path, (void)digest;
    return false;
}

bool gm_compilation_start(struct gm_compilation *compilation, const char *folder,
                          const char *const *arguments, char *sentence)
{
    (void)compilation, (void)folder, (void)arguments, (void)sentence;
    return false;
}

enum gm_compiled gm_compilation_look(struct gm_compilation *compilation, char *sentence)
{
    (void)compilation, (void)sentence;
    return GM_COMPILES_NOT;
}
