/* SPDX-License-Identifier: GPL-3.0-or-later */
/* All scenes there are, from the list scenes.def. A scene that is a built-in file is opened when it is first asked for,
   and lives as long as the program. */
#include <pthread.h>
#include <string.h>

#include "core/files/files.h"
#include "core/flow/room.h"
#include "core/memory.h"
#include "core/model/equations.h"
#include "scenes/common/system/variants.h"
#include "scenes/field/user_field.h"

#define GM_SYSTEM_SCENE(name)
#define GM_ROOM_SCENE(name)
#define GM_SCENE(name) extern const struct gm_scene gm_scene_##name;
#include "scenes/scenes.def"
#undef GM_SCENE
#undef GM_SYSTEM_SCENE
#undef GM_ROOM_SCENE

static pthread_mutex_t one_at_a_time = PTHREAD_MUTEX_INITIALIZER;

/* Why the last file could not be opened. */
static char reason[GM_MESSAGE] = "not enough memory";

/* Replaces a scene whose file could not be opened: it opens no lane. */
static bool refuse(const void *parameters, struct gm_problem *problem, char *sentence)
{
    (void)parameters;
    (void)problem;
    return gm_refuse(sentence, "%s", reason);
}

static const char *const no_schemes[] = {NULL};
static const struct gm_scene unavailable = {.name = "",
                                            .title = "",
                                            .blurb = "",
                                            .watch = "",
                                            .time = "",
                                            .size = sizeof(struct gm_timing),
                                            .schemes = no_schemes,
                                            .setup = refuse};

const struct gm_scene *gm_system_scene_open(struct gm_user_system *system,
                                            const struct gm_system_origin *origin,
                                            struct gm_system_opening *opening)
{
    const struct gm_system_maker *maker = gm_system_is_room(system)    ? &gm_system_rooms
                                          : gm_system_is_form(system)  ? &gm_system_forms
                                          : gm_system_is_field(system) ? &gm_system_fields
                                                                       : &gm_system_motions;
    return gm_system_scene_make(maker, system, origin, opening);
}

static const struct gm_scene *open_system(const struct gm_built_in *file, struct gm_fault *fault)
{
    const bool room = file->kind == GM_FILE_ROOM;
    struct gm_user_system system = gm_room_unread(file->text, file->length);
    if (!room && !gm_equations_open(&system, file->text, file->length, NULL, 0, fault)) {
        gm_system_close(&system);
        return NULL;
    }
    size_t others;
    const bool elsewhere =
        !room && gm_user_field_elsewhere(&system, system.texts[GM_WORD_SCHEMES], &others) > 0;
    return gm_system_scene_open(&system,
                                &(struct gm_system_origin){.name = file->name, .elsewhere = elsewhere},
                                &(struct gm_system_opening){.fault = fault, .sentence = reason});
}

/* Opens a scene's file. NULL, and a reason, if there is no memory or the file has a fault. */
static const struct gm_scene *open_file(const struct gm_built_in *file)
{
    struct gm_fault fault = {0};
    size_t line, column;
    const unsigned long refusals = gm_memory_refusals();
    const struct gm_scene *scene = open_system(file, &fault);
    if (!scene && gm_memory_refusals() != refusals) {
        gm_refuse(reason, "not enough memory");
    } else if (!scene && fault.sentence[0]) {
        gm_text_place(file->text, fault.offset, &line, &column);
        gm_refuse(reason, "%s:%zu:%zu: %s", file->path, line, column, fault.sentence);
    }
    return scene;
}

static struct {
    const struct gm_scene *scene; /* NULL: the file was not opened yet */
    const char *file;
    enum gm_file_kind kind;
} rows[] = {
#define GM_SYSTEM_SCENE(name) {.file = name, .kind = GM_FILE_SYSTEM},
#define GM_ROOM_SCENE(name) {.file = name, .kind = GM_FILE_ROOM},
#define GM_SCENE(name) {.scene = &gm_scene_##name},
#include "scenes/scenes.def"
#undef GM_SCENE
#undef GM_SYSTEM_SCENE
#undef GM_ROOM_SCENE
};

size_t gm_scene_count(void)
{
    return GM_COUNT(rows);
}

const struct gm_scene *gm_scene_at(size_t index)
{
    pthread_mutex_lock(&one_at_a_time);
    if (!rows[index].scene) {
        rows[index].scene = open_file(gm_built_in_find(rows[index].kind, rows[index].file));
    }
    const struct gm_scene *scene = rows[index].scene;
    pthread_mutex_unlock(&one_at_a_time);
    return scene ? scene : &unavailable;
}

const char *gm_scene_name(size_t index)
{
    return rows[index].file ? rows[index].file : rows[index].scene->name;
}

const char *gm_scene_title(size_t index)
{
    return rows[index].file ? gm_built_in_find(rows[index].kind, rows[index].file)->title
                            : rows[index].scene->title;
}

size_t gm_scene_number(const char *name)
{
    size_t index = 0;
    while (index < gm_scene_count() && strcmp(gm_scene_name(index), name) != 0) {
        index++;
    }
    return index;
}

const struct gm_scene *gm_scene_find(const char *name)
{
    const size_t index = gm_scene_number(name);
    return index < gm_scene_count() ? gm_scene_at(index) : NULL;
}
