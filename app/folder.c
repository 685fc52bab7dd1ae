/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "app/folder.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include "render/message.h"

bool gm_folder_make(const char *path, char *message)
{
    if (!path || mkdir(path, 0777) == 0 || errno == EEXIST) {
        return true;
    }
    snprintf(message, GM_MESSAGE, "%.360s could not be made: %s", path, strerror(errno));
    return false;
}
