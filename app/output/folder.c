/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Folders for output, made if they are missing. */
#include "app/output/folder.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "render/message.h"

/* Checks for an existing folder first: a user may be allowed to enter a folder, but not to make it. */
static bool make_one(const char *path)
{
    struct stat found;
    return !*path || stat(path, &found) == 0 || mkdir(path, 0777) == 0 || errno == EEXIST;
}

/* The folder of this path's first bytes, and every folder above it that is not there. */
static bool make(const char *path, size_t length, char *message)
{
    char *folder = strndup(path, length);
    bool made = folder != NULL;
    for (char *slash = made ? strchr(folder, '/') : NULL; slash && made; slash = strchr(slash + 1, '/')) {
        *slash = '\0';
        made = make_one(folder);
        *slash = '/';
    }
    made = (made && make_one(folder)) || gm_refuse(message, "%.*s could not be made: %s",
                                                   (int)(length < 360 ? length : 360), path, strerror(errno));
    free(folder);
    return made;
}

bool gm_folder_make(const char *path, char *message)
{
    return !path || make(path, strlen(path), message);
}

bool gm_folder_make_for(const char *file, char *message)
{
    const char *slash = strrchr(file, '/');
    return !slash || make(file, (size_t)(slash - file), message);
}

void gm_folder_free_file(const char *name, const char *ending, char *file, size_t size)
{
    int number = 1;
    do {
        snprintf(file, size, "%.80s-%04d%s", name, number, ending);
    } while (access(file, F_OK) == 0 && number++ < 9999);
}
