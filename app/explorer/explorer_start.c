/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The list of scenes: what is found and chosen, looked at and opened. */
#include "app/explorer/explorer_parts.h"

#include <curses.h>

#include "app/explorer/keys.h"
#include "app/explorer/modes.h"

/* The choice in the list of scenes rests for this long before it is looked at. */
enum { REST_MILLISECONDS = 150 };

const struct gm_scene *gm_explorer_chosen_scene(const struct gm_explorer *explorer)
{
    const struct gm_start *start = &explorer->start;
    return start->choice < start->count ? start->found[start->choice] : NULL;
}

void gm_explorer_look_soon(struct gm_explorer *explorer)
{
    explorer->look_due = gm_explorer_chosen_scene(explorer) == explorer->scene
                             ? -1
                             : gm_explorer_milliseconds() + REST_MILLISECONDS;
    explorer->dirty = true;
}

void gm_explorer_look(struct gm_explorer *explorer)
{
    const struct gm_scene *scene = gm_explorer_chosen_scene(explorer);
    explorer->look_due = -1;
    if (scene) {
        explorer->kept = false;
        gm_explorer_open_scene(explorer, scene, true);
    }
}

static void find_scenes(struct gm_explorer *explorer)
{
    struct gm_start *start = &explorer->start;
    const struct gm_scene *before = gm_explorer_chosen_scene(explorer);
    start->count = start->choice = 0;
    for (size_t i = 0; i < gm_scene_count() && start->count < GM_START_SCENES; i++) {
        const struct gm_scene *scene = gm_scene_at(i);
        const char *texts[] = {scene->name, scene->title, scene->blurb ? scene->blurb : "",
                               scene->watch ? scene->watch : "", NULL};
        if (gm_is_found(start->typed, texts)) {
            start->choice = scene == before ? start->count : start->choice;
            start->found[start->count++] = scene;
        }
    }
    gm_explorer_look_soon(explorer);
}

void gm_explorer_show_start(struct gm_explorer *explorer)
{
    explorer->at_start = true;
    explorer->start.typed[0] = '\0';
    find_scenes(explorer);
    for (size_t i = 0; i < explorer->start.count; i++) {
        if (explorer->start.found[i] == explorer->scene) {
            explorer->start.choice = i;
        }
    }
    explorer->kept = explorer->scene != NULL;
    gm_explorer_look_soon(explorer);
}

void gm_explorer_enter(struct gm_explorer *explorer)
{
    const struct gm_scene *scene = gm_explorer_chosen_scene(explorer);
    if (!scene) {
        return;
    }
    explorer->at_start = false;
    explorer->look_due = -1;
    explorer->face.parameter = 0;
    if (scene != explorer->scene || !explorer->kept) {
        gm_explorer_open_scene(explorer, scene, false);
    }
    explorer->dirty = explorer->fresh = true;
}

void gm_explorer_press_at_start(struct gm_explorer *explorer, int key)
{
    struct gm_start *start = &explorer->start;
    size_t count = start->count;
    explorer->dirty = true;
    if (gm_key_is_enter(key)) {
        gm_explorer_enter(explorer);
    } else if (gm_key_is_escape(key)) {
        start->typed[0] = '\0';
        find_scenes(explorer);
    } else if (key == 'q' && !start->typed[0]) {
        gm_explorer_leave(explorer, GM_EXIT_OK);
    } else if ((key == KEY_UP || key == KEY_DOWN) && count > 0) {
        start->choice = (start->choice + (key == KEY_UP ? count - 1 : 1)) % count;
        gm_explorer_look_soon(explorer);
    } else if ((key == KEY_HOME || key == KEY_END) && count > 0) {
        start->choice = key == KEY_HOME ? 0 : count - 1;
        gm_explorer_look_soon(explorer);
    } else if (gm_typed_key(start->typed, key)) {
        find_scenes(explorer);
    }
}
