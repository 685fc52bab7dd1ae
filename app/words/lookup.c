/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which name of a scene, a system or a room is near to a word. */
#include "app/words/lookup.h"

#include <stdio.h>

#include "app/base/arguments.h"
#include "app/base/files.h"
#include "core/expression/nearest.h"
#include "scenes/common/scene.h"

static void add_to(const struct gm_listed *listed, const void *names)
{
    /* one that memory was too short for is not proposed */
    gm_arguments_add(*(struct gm_arguments *const *)names, listed->name);
}

static const char *name_at(size_t i, const void *names)
{
    return ((const struct gm_arguments *)names)->words[i];
}

bool gm_system_near(const char *word, char near[GM_NEAR], char *message)
{
    struct gm_arguments names = {0}, *list = &names;
    message[0] = '\0';
    for (size_t i = 0; i < gm_scene_count(); i++) {
        gm_arguments_add(&names, gm_scene_name(i));
    }
    for (enum gm_file_kind kind = GM_FILE_SYSTEM; kind <= GM_FILE_ROOM; kind++) {
        gm_files_each(kind, add_to, &list, message);
    }
    const char *found = gm_nearest(word, (size_t)names.count, name_at, &names);
    snprintf(near, GM_NEAR, "%s", found ? found : "");
    gm_arguments_close(&names);
    return near[0] != '\0';
}
