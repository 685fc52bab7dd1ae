/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The list of scenes and tours: what is found and chosen, looked at and opened. */
#include "app/explorer/events.h"

#include <curses.h>
#include <string.h>

#include "app/explorer/surface/search.h"
#include "app/explorer/view/pages.h"
#include "render/clock.h"

/* The choice in the list of scenes rests for this long before it is looked at. */
enum { REST_MILLISECONDS = 150 };

static const struct gm_start_entry *chosen(const struct gm_explorer *explorer)
{
    const struct gm_start *start = &explorer->list.start;
    return start->choice < start->count ? &start->found[start->choice] : NULL;
}

/* Whether the worker is this scene's or this tour's. */
static bool is_open(const struct gm_explorer *explorer, const struct gm_start_entry *entry)
{
    if (entry->tour) {
        return explorer->open.touring && strcmp(entry->tour->name, explorer->open.guide.tour->name) == 0;
    }
    const struct gm_scene *scene = explorer->open.scene;
    const bool own = scene && scene->text; /* which is in no list */
    return !explorer->open.touring && (entry->scene ? entry->scene == scene : own);
}

bool gm_explorer_is_looked_at(const struct gm_explorer *explorer)
{
    const struct gm_start_entry *entry = chosen(explorer);
    return entry && entry->scene && is_open(explorer, entry);
}

void gm_explorer_look_soon(struct gm_explorer *explorer)
{
    const struct gm_start_entry *entry = chosen(explorer);
    bool due = entry && entry->scene && !is_open(explorer, entry);
    explorer->list.look_due = due ? gm_clock_milliseconds() + REST_MILLISECONDS : -1;
    explorer->dirty = true;
}

void gm_explorer_look(struct gm_explorer *explorer)
{
    explorer->list.look_due = -1;
    explorer->list.kept = false;
    if (!gm_open_scene(&explorer->open, chosen(explorer)->scene, true, explorer->message)) {
        gm_explorer_leave(explorer, GM_EXIT_USAGE);
    }
}

/* Takes what is found into the list, from place `first` on: the best answer to what was typed comes first. */
static void find(struct gm_start *start, size_t first, struct gm_start_entry entry, const char *const *texts)
{
    const int rank = gm_search_rank(start->typed, texts);
    if (rank < 0 || start->count == GM_START_ENTRIES) {
        return;
    }
    const size_t at = gm_search_place(start->ranks, first, start->count, rank);
    memmove(&start->found[at + 1], &start->found[at], (start->count++ - at) * sizeof entry);
    start->found[at] = entry;
}

/* What was chosen before stays so unless something else answers better. */
static void choose(struct gm_start *start, const struct gm_start_entry *before)
{
    start->choice = 0;
    for (size_t i = 1; i < start->count && before; i++) {
        const struct gm_start_entry *entry = &start->found[i];
        const bool same = entry->scene == before->scene && entry->tour == before->tour;
        const int rank = start->ranks[i], best = start->ranks[start->choice];
        start->choice = rank < best || (rank == best && same) ? i : start->choice;
    }
}

static void find_all(struct gm_explorer *explorer)
{
    struct gm_start *start = &explorer->list.start;
    const struct gm_start_entry *present = chosen(explorer);
    const struct gm_start_entry before = present ? *present : (struct gm_start_entry){0};
    start->count = 0;
    for (size_t i = 0; i < gm_scene_count(); i++) {
        const struct gm_scene *scene = gm_scene_at(i);
        const char *texts[] = {scene->name, scene->title, scene->blurb ? scene->blurb : "",
                               scene->watch ? scene->watch : "", NULL};
        find(start, 0, (struct gm_start_entry){.scene = scene}, texts);
    }
    const char *own[] = {GM_START_OWN, "a formula that you type, or a file", NULL};
    find(start, 0, (struct gm_start_entry){0}, own);
    start->scenes = start->count;
    for (size_t i = 0; i < explorer->list.tour_count; i++) {
        const struct gm_tour *tour = &explorer->list.tours[i];
        const char *texts[] = {tour->name, tour->title, tour->about ? tour->about : "", "tour", NULL};
        find(start, start->scenes, (struct gm_start_entry){.tour = tour}, texts);
    }
    choose(start, present ? &before : NULL);
    gm_explorer_look_soon(explorer);
}

void gm_explorer_show_start(struct gm_explorer *explorer)
{
    char message[GM_MESSAGE]; /* a tour that cannot be read is for `geomint tour` to tell */
    if (!explorer->list.tours) {
        explorer->list.tours = gm_tours_read(&explorer->list.tour_count, message);
    }
    explorer->list.shown = true;
    explorer->editing = false;
    explorer->list.start.typed[0] = '\0';
    find_all(explorer);
    for (size_t i = 0; i < explorer->list.start.count; i++) {
        if (is_open(explorer, &explorer->list.start.found[i])) {
            explorer->list.start.choice = i;
        }
    }
    explorer->list.kept = explorer->open.scene != NULL;
    gm_explorer_look_soon(explorer);
}

/* A tour that was left goes on with the step where it was. */
static bool enter_tour(struct gm_explorer *explorer, const struct gm_tour *tour)
{
    struct gm_guide *guide = &explorer->open.guide;
    if (!guide->tour || strcmp(guide->tour->name, tour->name) != 0) {
        *guide = gm_guide_open(tour);
        explorer->face.guide = guide;
    }
    return gm_open_step(&explorer->open, explorer->message);
}

static bool enter_scene(struct gm_explorer *explorer, const struct gm_scene *scene)
{
    explorer->open.guide.tour = NULL;
    explorer->face.guide = NULL;
    return gm_open_scene(&explorer->open, scene, false, explorer->message);
}

void gm_explorer_enter(struct gm_explorer *explorer)
{
    const struct gm_start_entry *entry = chosen(explorer);
    if (!entry) {
        return;
    }
    const bool goes_on = explorer->list.kept && is_open(explorer, entry);
    if (!goes_on && !entry->tour && !entry->scene) {
        gm_explorer_ask_system(explorer);
        return;
    }
    if (!goes_on) {
        explorer->face.parameter = 0;
        if (!(entry->tour ? enter_tour(explorer, entry->tour) : enter_scene(explorer, entry->scene))) {
            gm_explorer_leave(explorer, GM_EXIT_USAGE);
        }
    }
    explorer->list.shown = false;
    explorer->dirty = explorer->fresh = true;
}

/* From the scenes to the tours and back. */
static void go_to_others(struct gm_explorer *explorer)
{
    struct gm_start *start = &explorer->list.start;
    size_t other = start->choice < start->scenes ? start->scenes : 0;
    if (other < start->count) {
        start->choice = other;
        gm_explorer_look_soon(explorer);
    }
}

void gm_explorer_press_in_list(struct gm_explorer *explorer, int key)
{
    struct gm_start *start = &explorer->list.start;
    size_t count = start->count;
    explorer->dirty = true;
    if (explorer->face.page != GM_PAGE_SCENE) {
        if (gm_pages_press(key, &explorer->face) == GM_KEY_LEAVE) {
            gm_explorer_leave(explorer, GM_EXIT_OK);
        }
    } else if (key == '?') {
        explorer->face.page = GM_PAGE_START;
        explorer->face.scroll = 0;
    } else if (gm_key_is_enter(key)) {
        gm_explorer_enter(explorer);
    } else if (gm_key_is_escape(key)) {
        start->typed[0] = '\0';
        find_all(explorer);
    } else if (key == 'q' && !start->typed[0]) {
        gm_explorer_leave(explorer, GM_EXIT_OK);
    } else if ((key == KEY_UP || key == KEY_DOWN) && count > 0) {
        start->choice = (start->choice + (key == KEY_UP ? count - 1 : 1)) % count;
        gm_explorer_look_soon(explorer);
    } else if ((key == KEY_HOME || key == KEY_END) && count > 0) {
        start->choice = key == KEY_HOME ? 0 : count - 1;
        gm_explorer_look_soon(explorer);
    } else if (key == '\t' || key == KEY_BTAB) {
        go_to_others(explorer);
    } else if (key == '/' && !start->typed[0]) {
        /* what is typed is looked for anyway */
    } else if (gm_typed_key(start->typed, key)) {
        find_all(explorer);
    }
}
