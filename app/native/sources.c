/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where the sources of loops are, which a compiler reads. */
#include "app/native/sources.h"

#include <dlfcn.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* The program or the library that this is part of. */
static bool find_self(char self[4096])
{
    static const char part = 0;
    Dl_info here;
    const bool library = dladdr(&part, &here) && strstr(here.dli_fname, "libgeomint.so");
    char *found = realpath(library ? here.dli_fname : "/proc/self/exe", NULL);
    const bool known = found && snprintf(self, 4096, "%s", found) < 4096;
    free(found);
    return known;
}

/* bin/geomint, lib/libgeomint.so or lib/MACHINE/libgeomint.so beside share/geomint, wherever they have been
   moved together. */
static bool beside_program(char *path, size_t size)
{
    char self[4096];
    if (!find_self(self)) {
        return false;
    }
    char *slash = strrchr(self, '/');
    for (int up = 0; slash && up < 3; up++) {
        *slash = '\0';
        const int wanted = snprintf(path, size, "%s/share/geomint/kernel", self);
        if (up > 0 && wanted < (int)size && access(path, R_OK) == 0) {
            return true;
        }
        slash = strrchr(self, '/');
    }
    return false;
}

const char *gm_kernel_folder(char *path, size_t size)
{
    const char *own = getenv("GEOMINT_KERNEL");
    if (own && *own) {
        snprintf(path, size, "%s", own);
    } else if (!beside_program(path, size)) {
        snprintf(path, size, "%s", GM_KERNEL_FOLDER);
    }
    return path;
}
