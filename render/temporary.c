/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "render/temporary.h"

#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

bool gm_temporary_fits(const char *path)
{
    struct stat status;
    return lstat(path, &status) != 0 || S_ISREG(status.st_mode);
}

char *gm_temporary_name(const char *path, const char *ending)
{
    static atomic_uint counter;
    const char *slash = strrchr(path, '/');
    const char *name = slash ? slash + 1 : path;
    int folder = (int)(name - path);
    char *temporary = NULL;
    /* a leading "./" keeps other programs from seeing an option in "-a" or a protocol in "a:b"; the name is
       cut, as it may be as long as the file system allows already */
    if (asprintf(&temporary, "%s%.*s.%.180s.%ld.%u%s", path[0] == '/' ? "" : "./", folder, path, name,
                 (long)getpid(), atomic_fetch_add(&counter, 1), ending) < 0) {
        return NULL;
    }
    return temporary;
}
