/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where systems are, and which of their names is near to a word. */
#include "app/words/lookup.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/base/arguments.h"
#include "app/base/share.h"
#include "app/words/room.h"
#include "core/expression/nearest.h"
#include "core/expression/reader.h"
#include "scenes/common/scene.h"

const char gm_system_ending[] = ".system";

/* The user's own folder; "" if there is none. */
static const char *own_folder(char *folder, size_t size)
{
    const char *own = getenv("XDG_CONFIG_HOME"), *home = getenv("HOME");
    const bool known = own && *own;
    snprintf(folder, size, "%s%s",
             known  ? own
             : home ? home
                    : "",
             known  ? "/geomint"
             : home ? "/.config/geomint"
                    : "");
    return folder;
}

bool gm_system_path(const char *word, char *path, size_t size)
{
    char folder[4096];
    if (gm_word_ends(word, gm_system_ending)) {
        snprintf(path, size, "%s", word); /* no file has a path that is longer */
        return true;
    }
    if (strchr(word, '/') || word[0] == '\0') {
        return false;
    }
    return gm_share_find(gm_share_folder("systems", "GEOMINT_SYSTEMS", folder, sizeof folder), word,
                         gm_system_ending, path, size) ||
           (own_folder(folder, sizeof folder)[0] &&
            gm_share_find(folder, word, gm_system_ending, path, size));
}

bool gm_system_folder(char *folder, size_t size)
{
    return access(gm_share_folder("systems", "GEOMINT_SYSTEMS", folder, size), X_OK) == 0;
}

void gm_system_each(void (*each)(const char *name, const void *data), const void *data)
{
    char folder[4096];
    gm_share_each(gm_share_folder("systems", "GEOMINT_SYSTEMS", folder, sizeof folder), gm_system_ending,
                  each, data);
    gm_share_each(own_folder(folder, sizeof folder), gm_system_ending, each, data);
}

static void add_to(const char *name, const void *names)
{
    /* one that memory was too short for is not proposed */
    gm_arguments_add(*(struct gm_arguments *const *)names, name);
}

static const char *name_at(size_t i, const void *names)
{
    return ((const struct gm_arguments *)names)->words[i];
}

const char *gm_system_near(const char *word, char near[GM_NEAR])
{
    struct gm_arguments names = {0}, *list = &names;
    for (size_t i = 0; i < gm_scene_count(); i++) {
        add_to(gm_scene_at(i)->name, &list);
    }
    gm_system_each(add_to, &list);
    gm_room_each(add_to, &list);
    const char *found = gm_nearest(word, (size_t)names.count, name_at, &names);
    snprintf(near, GM_NEAR, "%s", found ? found : "");
    gm_arguments_close(&names);
    return near[0] ? near : NULL;
}
