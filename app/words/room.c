/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rooms of files: the scenes that are made of them, and what is said where one is wrong. */
#include "app/words/room.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/base/exit.h"
#include "app/base/files.h"
#include "app/base/place.h"
#include "core/expression/reader.h"
#include "core/memory.h"
#include "render/files/regular_file.h"
#include "render/message.h"
#include "scenes/flow/user_room.h"

/* The scenes that were made. */
struct made {
    struct made *next;
    char *word, *text;
    const struct gm_scene *scene;
};
static struct made *all;
static pthread_mutex_t making = PTHREAD_MUTEX_INITIALIZER;

static void free_made(struct made *made)
{
    if (made) {
        free(made->word);
        free(made->text);
        free(made);
    }
}

static const struct gm_scene *make(struct made *made, const char *word, const struct gm_file *file,
                                   size_t length, int *status, char *message)
{
    struct gm_fault fault = {0};
    const unsigned long refusals = gm_memory_refusals();
    const char *slash = strrchr(file->path, '/');
    char *name = strdup(slash ? slash + 1 : file->path);
    made->word = strdup(word);
    if (name && made->word) {
        name[strlen(name) - strlen(gm_file_endings[GM_FILE_ROOM])] = '\0';
        const struct gm_room_file room = {made->text, length, name, word, file->path, file->built_in};
        made->scene = gm_user_room_open(&room, &fault, message);
    }
    free(name);
    *status = made->scene || fault.sentence[0] ? GM_EXIT_USAGE : GM_EXIT_FILE;
    if (!made->scene && gm_memory_refusals() != refusals) {
        *status = GM_EXIT_MEMORY;
        gm_refuse(message, "%.300s: not enough memory", file->path);
    } else if (fault.sentence[0]) {
        size_t line, column;
        gm_text_place(made->text, fault.offset, &line, &column);
        gm_refuse(message, "%.150s:%zu:%zu: %.300s", file->path, line, column, fault.sentence);
        gm_place_show(made->text, length, fault.offset, message);
    }
    return made->scene;
}

const struct gm_scene *gm_room_scene(const char *word, int *status, char *message)
{
    struct gm_file file;
    char reason[GM_REGULAR_REASON];
    size_t length = 0;
    const unsigned long refusals = gm_memory_refusals();
    if (!gm_file_find(GM_FILE_ROOM, word, &file)) {
        *status = GM_EXIT_USAGE;
        gm_refuse(message, "there is no room %.300s", word);
        return NULL;
    }
    char *text = gm_file_read(&file, GM_LARGEST_ROOM, &length, reason);
    *status = gm_memory_refusals() != refusals ? GM_EXIT_MEMORY : GM_EXIT_FILE;
    if (!text) {
        gm_refuse(message, "%.300s could not be read: %s", file.path, reason);
        return NULL;
    }
    *status = GM_EXIT_USAGE;
    const struct gm_scene *scene = NULL;
    struct made *made = calloc(1, sizeof *made);
    pthread_mutex_lock(&making);
    for (const struct made *known = all; known && !scene; known = known->next) {
        if (strcmp(known->word, word) == 0 && strlen(known->text) == length &&
            memcmp(known->text, text, length) == 0) {
            scene = known->scene;
        }
    }
    if (!scene && made) {
        made->text = text;
        text = NULL;
        scene = make(made, word, &file, length, status, message);
        if (scene) {
            made->next = all;
            all = made;
            made = NULL;
        }
    } else if (!scene) {
        *status = GM_EXIT_MEMORY;
        gm_refuse(message, "not enough memory");
    }
    pthread_mutex_unlock(&making);
    free_made(made);
    free(text);
    return scene;
}
