/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where the data are that the program brings. */
#include "app/request/share.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* bin/geomint beside share/geomint, wherever the two have been moved together. */
static bool beside_program(const char *name, char *path, size_t size)
{
    char program[4096];
    const ssize_t length = readlink("/proc/self/exe", program, sizeof program - 1);
    if (length <= 0) {
        return false;
    }
    program[length] = '\0';
    for (int i = 0; i < 2; i++) {
        char *slash = strrchr(program, '/');
        if (!slash) {
            return false;
        }
        *slash = '\0';
    }
    const int wanted = snprintf(path, size, "%s/share/geomint/%s", program, name);
    return wanted < (int)size && access(path, R_OK) == 0;
}

const char *gm_share_folder(const char *name, const char *variable, char *path, size_t size)
{
    const char *own = getenv(variable);
    if (own && *own) {
        snprintf(path, size, "%s", own);
    } else if (!beside_program(name, path, size)) {
        snprintf(path, size, "%s/%s", GM_SHARE, name);
    }
    return path;
}
